// Flat faces that lay on each other and lean now: what their polygons say.
#include <gtest/gtest.h>

#include <cmath>

#include "math/rotation_between.hpp"
#include "odds/math/tolerances.hpp"
#include "support/flush_slabs.hpp"

namespace odds::query {
namespace {

using testing::below;
using testing::contacts_of;
using testing::slab;
using testing::written;

// As of a crate that is tripped: it stands on an edge of its face, and the other's normal is the direction.
TEST(LeaningFaces, OfAFaceThatLeansAreAtItsEdge) {
  constexpr double tilt = 0.2;
  for (const bool upper_leans : {false, true}) {
    auto flush = contacts_of(slab(), slab());
    ASSERT_FALSE(written(flush, below(1e-3), testing::under_slab).empty());
    // B is the lower one. Its edge stands in A's face, but for its ends, where sides cross; or A's in its own.
    math::Pose pose = below(0.0, 0.0, tilt);
    const Vec3 edge_b(-0.5, 0.0, 0.1);
    const Vec3 edge_a(-0.5, 0.0, -0.1);
    const Vec3 at = upper_leans ? Vec3(edge_a - pose.rotation * Vec3(-0.2, 0.0, 0.1))
                                : Vec3(Vec3(-0.2, 0.0, -0.1) - pose.rotation * edge_b);
    pose.translation = at + 1e-3 * (upper_leans ? Vec3(pose.rotation.col(2)) : Vec3(Vec3::UnitZ()));
    flush.begin();
    flush.move_to(pose);
    EXPECT_TRUE(flush.overlap());
    EXPECT_FALSE(flush.serves()) << "what touches beside is unknown";
    ASSERT_TRUE(flush.serves(true));
    const auto contacts = flush.contacts();
    ASSERT_FALSE(contacts.empty());
    const Vec3 normal = upper_leans ? Vec3(pose.rotation.col(2)) : Vec3(Vec3::UnitZ());
    const Vec3 edge = upper_leans ? edge_a : Vec3(pose * edge_b);
    for (const Contact& contact : contacts) EXPECT_GT(contact.normal.dot(normal), 1.0 - 1e-12);
    EXPECT_NEAR(std::abs(contacts.front().position.y()), 0.5, 0.03);
    EXPECT_LT((contacts.front().position - edge).cwiseProduct(Vec3(1, 0, 1)).norm(), 0.02);
  }
}

// The end that comes deepest hangs over A's side: there two edges cross.
TEST(LeaningFaces, WhereEdgesCrossTheyPartAcrossBoth) {
  auto flush = contacts_of(slab(), slab());
  ASSERT_FALSE(written(flush, below(1e-3), testing::under_slab).empty());
  const Vec3 along = Vec3(0.0, 1.0, 0.1).normalized();  // B's edge
  math::Pose pose;
  pose.rotation = math::rotation_between(Vec3::UnitY(), along) * Eigen::AngleAxisd(0.2, Vec3::UnitY());
  const Vec3 crossing(-0.2, 0.5, -0.1);
  pose.translation = crossing + Vec3(0.0, 0.0, 1e-3) - pose * Vec3(-0.5, 0.1, 0.1);
  flush.begin();
  flush.move_to(pose);
  ASSERT_TRUE(flush.serves(true));
  const auto contacts = flush.contacts();
  ASSERT_FALSE(contacts.empty());
  EXPECT_GT(contacts.front().normal.dot(Vec3::UnitX().cross(along)), 1.0 - 1e-9);
  EXPECT_LT((contacts.front().position - crossing).norm(), 0.02);
}

TEST(LeaningFaces, AreKeptInMindUntilTheyTilt) {
  auto flush = contacts_of(slab(), slab());
  const double most = std::acos(tolerances::leaning_faces);
  ASSERT_FALSE(written(flush, below(1e-3), testing::under_slab).empty());
  const auto tilted = [](double tilt) { return below(-0.5 * std::sin(tilt), 0.0, tilt); };
  for (const double tilt : {0.5, 0.96}) {
    flush.begin();
    flush.move_to(tilted(tilt * most));
    flush.begin();
    flush.move_to(below(1e-4));
    EXPECT_TRUE(flush.serves()) << tilt;
  }
  flush.begin();
  flush.move_to(tilted(1.04 * most));
  flush.begin();
  flush.move_to(below(1e-4));
  EXPECT_FALSE(flush.serves());
}

}  // namespace
}  // namespace odds::query
