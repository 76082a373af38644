// What a proved hit says of runs that a budget ends.
#include "query/last_hit.hpp"

#include <gtest/gtest.h>

#include "odds/mesh/made/by_name.hpp"
#include "odds/query/pair.hpp"

namespace odds::query {
namespace {

math::Pose moved(double by) { return {Mat3::Identity(), Vec3(by, 0.0, 0.0)}; }

TEST(LastHit, LastsWhileTheBodiesHaveHardlyMoved) {
  LastHit hit;
  EXPECT_EQ(hit.probability({}, 1.0, 1.0), 0.0) << "nothing was proved";
  hit.note({});
  EXPECT_EQ(hit.probability({}, 1.0, 2.0), LastHit::stays);
  EXPECT_EQ(hit.probability(moved(0.9 * 2.0 * LastHit::near), 1.0, 2.0), LastHit::stays);
  const double later = hit.probability(moved(2.0 * (LastHit::near + LastHit::far) / 2.0), 1.0, 2.0);
  EXPECT_GT(later, 0.5);
  EXPECT_LT(later, LastHit::stays);
  EXPECT_EQ(hit.probability(moved(1.1 * 2.0 * LastHit::far), 1.0, 2.0), 0.0);
  const math::Pose turned{Eigen::AngleAxisd(1.0, Vec3::UnitX()).toRotationMatrix(), Vec3::Zero()};
  EXPECT_EQ(hit.probability(turned, 1.0, 2.0), 0.0) << "turning moves the surface too";
  hit.forget();
  EXPECT_EQ(hit.probability({}, 1.0, 2.0), 0.0);
}

TEST(LastHit, HoldsTheVerdictOfARunWithoutTime) {
  // A search from the roots in a few looks guesses; where a run proved that they meet, they do for a while.
  const auto knot =
      Shape::build(std::make_shared<const mesh::TriangleMesh>(mesh::made::make_shape("torus_knot").value())).value();
  const double size = knot->mesh().size();
  const Request glance{.method = Method::time_critical, .budget = Budget::work(40)};
  auto pair = std::move(Pair::make(knot, knot)).value();
  int doubtful = 0;
  for (int i = 0; i < 400; ++i) {
    const math::Pose pose{Eigen::AngleAxisd(0.1 * i, Vec3(1, 2, 3).normalized()).toRotationMatrix(),
                          {0.002 * size * i, 0.0, 0.0}};
    pair.reset();
    const Answer guess = pair.run(pose, glance);
    if (guess.basis != Basis::budget || guess.probability >= LastHit::stays) continue;
    if (pair.run(pose, {}).verdict != Verdict::hit) continue;
    ++doubtful;
    const math::Pose close{pose.rotation, pose.translation + Vec3(0.01 * size, 0.0, 0.0)};
    const Answer& known = pair.run(close, glance);
    EXPECT_EQ(known.basis, Basis::budget) << "not a proof";
    EXPECT_EQ(known.verdict, Verdict::hit);
    EXPECT_GE(known.probability, LastHit::stays);
    ASSERT_EQ(pair.run({Mat3::Identity(), {3.0 * size, 0.0, 0.0}}, {}).verdict, Verdict::clear);
    EXPECT_EQ(pair.run(pose, glance).probability, guess.probability) << "a proof of being apart is newer";
    static_cast<void>(pair.run(pose, {}));
    pair.reset();
    EXPECT_EQ(pair.run(pose, glance).probability, guess.probability) << "as new";
  }
  EXPECT_GT(doubtful, 3);
}

}  // namespace
}  // namespace odds::query
