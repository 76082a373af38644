// Verdicts of every volume and method against FCL's, near contact.
#include <gtest/gtest.h>

#include "differential/fcl_oracle.hpp"
#include "odds/mesh/made/by_name.hpp"
#include "odds/query/pair.hpp"
#include "support/all_kinds.hpp"
#include "support/near_poses.hpp"

namespace odds::query {
namespace {

// Offsets from first touch, in units of the size; positive: apart.
constexpr double bands[] = {5e-2, 1e-2, 1e-3, 1e-4, 1e-6, -1e-6, -1e-4, -1e-3, -1e-2, -0.1};

class AgainstFcl : public ::testing::TestWithParam<const char*> {};

/// One pair of like shapes for each kind of volume.
std::vector<Pair> pairs_of(const std::shared_ptr<const mesh::TriangleMesh>& mesh) {
  std::vector<Pair> pairs;
  for (const volume::Kind kind : testing::all_kinds()) {
    const auto shape = Shape::build(mesh, {.volume = kind}).value();
    pairs.push_back(std::move(Pair::make(shape, shape)).value());
  }
  return pairs;
}

TEST_P(AgainstFcl, EveryVolumeAndMethodGivesTheSameVerdicts) {
  const std::string name = GetParam();
  auto made = mesh::made::make_shape(name);
  ASSERT_TRUE(made.ok()) << made.error().message();
  const auto mesh = std::make_shared<const mesh::TriangleMesh>(std::move(made).value());
  const testing::FclModel fcl(*mesh);
  std::vector<Pair> pairs = pairs_of(mesh);
  const Vec3 center = 0.5 * (mesh->lower() + mesh->upper());
  math::Random random(2003);
  int hits = 0;
  int queries = 0;
  for (int i = 0; i < 25; ++i) {
    const auto touching = testing::touching_pose(random, center, center, mesh->size(), [&](const math::Pose& pose) {
      return testing::fcl_collide(fcl, fcl, pose);
    });
    for (const double band : bands) {
      math::Pose pose = touching.pose;
      pose.translation += band * mesh->size() * touching.direction;
      const bool expected = testing::fcl_collide(fcl, fcl, pose);
      ++queries;
      hits += expected ? 1 : 0;
      for (Pair& pair : pairs) {
        for (const Method method : {Method::exact, Method::time_critical, Method::incremental}) {
          const Answer& answer = pair.run(pose, {.method = method, .max_contacts = 0});
          EXPECT_EQ(answer.verdict == Verdict::hit, expected)
              << name << " " << volume::name(pair.a().volume()) << " pose " << i << " band " << band << " method "
              << static_cast<int>(method);
          EXPECT_EQ(answer.basis, Basis::proved);
        }
      }
    }
  }
  EXPECT_GT(hits, queries / 4) << "the sample must mean something";
  EXPECT_LT(hits, queries * 3 / 4);
}

INSTANTIATE_TEST_SUITE_P(Shapes, AgainstFcl,
                         ::testing::Values("made:car_body:triangles=6000", "made:torus_knot", "made:bumpy_sphere",
                                           "made:gear", "made:plates", "made:terrain"),
                         [](const auto& tested) {
                           std::string text(tested.param);
                           return text.substr(5, text.find(':', 5) - 5);
                         });

}  // namespace
}  // namespace odds::query
