// Leaves with and without a test of their volumes: the same verdicts, other work.
#include <gtest/gtest.h>

#include "odds/math/random.hpp"
#include "odds/query/pair.hpp"
#include "support/all_kinds.hpp"
#include "support/shapes.hpp"

namespace odds::query {
namespace {

class LeafTest : public ::testing::TestWithParam<volume::Kind> {
 protected:
  [[nodiscard]] Pair pair() const {
    const auto shape = [&](std::uint32_t rings) {
      return Shape::build(testing::wavy_sphere(rings, 0.3), {.volume = GetParam()}).value();
    };
    return std::move(Pair::make(shape(8), shape(7))).value();
  }
};

TEST_P(LeafTest, ChangesTheWorkAndNeverTheVerdict) {
  Pair with = pair();
  Pair without = pair();
  math::Random random(11);
  std::uint64_t triangles_with = 0;
  std::uint64_t triangles_without = 0;
  int hits = 0;
  math::Pose pose;
  for (int i = 0; i < 400; ++i) {
    // Some steps are small, as the incremental method expects, and some are not.
    if (i % 40 == 0) pose = {random.rotation().toRotationMatrix(), random.uniform(1.5, 2.4) * random.direction()};
    pose.translation += 0.01 * random.direction();
    for (const Method method : {Method::exact, Method::incremental, Method::time_critical}) {
      Request request{.method = method, .max_contacts = 0};
      const Answer tested = with.run(pose, request);
      request.leaf_test = false;
      const Answer& untested = without.run(pose, request);
      ASSERT_EQ(tested.verdict, untested.verdict) << i;
      ASSERT_EQ(untested.basis, Basis::proved);
      hits += tested.verdict == Verdict::hit ? 1 : 0;
      triangles_with += tested.cost.triangle_pairs;
      triangles_without += untested.cost.triangle_pairs;
    }
  }
  EXPECT_GT(hits, 100);
  EXPECT_LT(hits, 1100);
  if (GetParam() == volume::Kind::wide) {
    EXPECT_EQ(triangles_without, triangles_with);
  } else {
    EXPECT_GT(triangles_without, triangles_with);
  }
}

INSTANTIATE_TEST_SUITE_P(AllVolumes, LeafTest, ::testing::ValuesIn(testing::all_kinds()),
                         [](const auto& tested) { return testing::name_of(tested.param); });

}  // namespace
}  // namespace odds::query
