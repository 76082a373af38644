// How deep bodies can be by what earlier runs knew, whichever of them comes first.
#include "query/known/known_depth.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "odds/math/random.hpp"
#include "odds/query/pair.hpp"
#include "support/brute_force.hpp"
#include "support/slabs.hpp"

namespace odds::query {
namespace {

TEST(KnownDepth, OfASmallBodyGrowsByItsOwnMotionWhicheverComesFirst) {
  const math::Pose before{Mat3::Identity(), Vec3(0.0, 0.0, -300.0)};  // of the ground in a crate's frame
  const Mat3 rocked = Eigen::AngleAxisd(1e-3, Vec3::UnitY()).toRotationMatrix();
  const math::Pose after{rocked, rocked * before.translation};
  KnownDepth depth;
  depth.note(before, 0.01);
  EXPECT_NEAR(depth.most(after, {1.0, 1000.0}), 0.011, 1e-4);
  depth.note(before.inverse(), 0.01);
  EXPECT_NEAR(depth.most(after.inverse(), {1000.0, 1.0}), 0.011, 1e-4);
}

/// The deepest contact of a rod that sinks into hills by a centimetre at most while it rocks.
double deepest_in_hills(bool rod_first, int max_contacts) {
  const auto hills = testing::made_mesh("made:terrain");
  const double scale = 1000.0 / hills.size();
  const Vec3 middle = 0.5 * scale * (hills.lower() + hills.upper());
  const auto ground = Shape::build(testing::changed(hills, scale, {Mat3::Identity(), -middle}, 0)).value();
  const auto rod =
      Shape::build(std::make_shared<const mesh::TriangleMesh>(testing::made_mesh("made:box:x=3,y=0.1,z=0.1"))).value();
  Pair finder = Pair::make(ground, rod).value();
  Pair pair = (rod_first ? Pair::make(rod, ground) : Pair::make(ground, rod)).value();
  math::Random random(1);
  double deepest = 0.0;
  for (int fall = 0; fall < 30; ++fall) {
    const Mat3 rotation = random.rotation().toRotationMatrix();
    const Vec3 axis = random.direction();
    const Vec3 place(random.uniform(-300.0, 300.0), random.uniform(-300.0, 300.0), 0.0);
    const auto at = [&](double height, double turn) {
      return math::Pose{Eigen::AngleAxisd(turn, axis).toRotationMatrix() * rotation, place + height * Vec3::UnitZ()};
    };
    double above = 0.5 * scale * (hills.upper().z() - hills.lower().z()) + 3.0;
    const auto meets = [&](double height) {
      return finder.run(at(height, 0.0), {.method = Method::exact, .max_contacts = 0}).verdict == Verdict::hit;
    };
    while (!meets(above - 0.25)) above -= 0.25;
    double below = above - 0.25;
    for (int i = 0; i < 40; ++i) {
      const double half = 0.5 * (above + below);
      (meets(half) ? below : above) = half;
    }
    pair.reset();
    for (int run = 0; run < 200; ++run) {
      const math::Pose pose = at(above + 1e-3 - 5e-5 * run, 1e-3 * std::sin(0.3 * run));
      const Request request{.method = Method::incremental, .max_contacts = max_contacts};
      const Answer& answer = pair.run(rod_first ? pose.inverse() : pose, request);
      for (const Contact& contact : answer.contacts) deepest = std::max(deepest, contact.depth);
    }
  }
  return deepest;
}

// What had moved was the ground in the frame of the rod, half a metre where the rod turned by a thousandth: so deep a
// single contact was believed to be, of a rod that was a centimetre deep.
TEST(KnownDepth, HoldsASingleContactInHillsWhicheverComesFirst) {
  EXPECT_LT(deepest_in_hills(false, 1), 0.03);
  EXPECT_LT(deepest_in_hills(true, 1), 0.03);
}

// Whence the rod came was taken from the middle of a triangle of the hills, metres away: it was pushed out of a sheet
// sideways, from end to end.
TEST(Hills, AreLeftToTheSideFromWhichARodThatRocksHasCome) {
  EXPECT_LT(deepest_in_hills(false, 4), 0.03);
  EXPECT_LT(deepest_in_hills(true, 4), 0.03);
}

}  // namespace
}  // namespace odds::query
