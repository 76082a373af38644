// Planes between leaves: what they say is apart is, however B moves on.
#include "query/wide/parting_plane.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "odds/math/motion.hpp"
#include "odds/math/random.hpp"
#include "odds/primitive/triangle_distance.hpp"
#include "query/wide/encounter.hpp"
#include "query/wide/kinetic_front.hpp"
#include "query/wide/lanes.hpp"
#include "query/wide/part_leaves.hpp"
#include "support/lanes_built_here.hpp"

namespace odds::query::wide {
namespace {

constexpr std::uint32_t triangles = 8;    // in one leaf or two: the first is looked at
constexpr math::Reaches reach{4.0, 4.0};  // of B, more than enough

struct Leaf {
  explicit Leaf(std::vector<Vec3> corners) : mesh(make(std::move(corners))), tree(tree::WideTree::build(mesh, {})) {}
  static mesh::TriangleMesh make(std::vector<Vec3> corners) {
    std::vector<mesh::Triangle> indices;
    for (std::uint32_t i = 0; i + 2 < corners.size(); i += 3) indices.push_back({i, i + 1, i + 2});
    return std::move(mesh::TriangleMesh::make(std::move(corners), std::move(indices), "leaf")).value();
  }
  /// Of the first leaf.
  [[nodiscard]] Slot slot() const {
    Slot first = 0;
    while (!tree.nodes()[first / wide_lanes].child[first % wide_lanes].is_leaf()) ++first;
    return first;
  }
  [[nodiscard]] std::span<const std::uint32_t> indices() const {
    const tree::ChildRef child = tree.nodes()[slot() / wide_lanes].child[slot() % wide_lanes];
    return std::span(tree.leaves()[child.index()].triangle).first(child.count());
  }

  mesh::TriangleMesh mesh;
  tree::WideTree tree;
};

/// A fan over a dome: convex towards +z where `height` > 0, a bowl where it is less.
std::vector<Vec3> dome(double height) {
  std::vector<Vec3> corners;
  const auto rim = [](std::uint32_t k) {
    const double angle = 2.0 * 3.14159265358979 * k / triangles;
    return Vec3(std::cos(angle), std::sin(angle), 0.0);
  };
  for (std::uint32_t i = 0; i < triangles; ++i) corners.insert(corners.end(), {{0, 0, height}, rim(i), rim(i + 1)});
  return corners;
}

std::vector<Vec3> scattered(math::Random& random) {
  std::vector<Vec3> corners;
  for (std::uint32_t i = 0; i < triangles; ++i) {
    const Vec3 at = 0.7 * random.direction();
    for (int k = 0; k < 3; ++k) corners.emplace_back(at + 0.4 * random.direction());
  }
  return corners;
}

/// The least distance of all pairs of triangles.
double distance(const Leaf& a, const Leaf& b, const PosedMeshes& meshes) {
  double least = std::numeric_limits<double>::max();
  for (const std::uint32_t of_a : a.indices()) {
    for (const std::uint32_t of_b : b.indices()) {
      const auto nearest = primitive::closest_points(meshes.corners_a(of_a).data(), meshes.corners_b(of_b).data());
      least = std::min(least, (nearest.on_b - nearest.on_a).norm());
    }
  }
  return least;
}

template <class L>
Parting parting_of(const Leaf& a, const Leaf& b, const Encounter& met, const PosedMeshes& meshes, bool by_triangles) {
  float shift[3];
  met.shift(a.slot(), b.slot(), shift);
  const PlacedLeaf leaf_a = met.leaf(0, a.slot());
  const PlacedLeaf leaf_b = met.leaf(1, b.slot());
  const SpreadLeaves<L> leaves(leaf_a, leaf_b, met.turn_into(0), shift, met.margin());
  Parting parting;
  if (by_triangles) {
    part_by_triangles<L>(leaves, leaf_a.count(), leaf_b.count(), parting);
    return parting;
  }
  const GapsOfTriangles<L> gaps(leaves, leaf_b.count());
  parting.gap = gaps.least;
  const auto nearest = primitive::closest_points(meshes.corners_a(leaf_a.leaf.triangle[gaps.lane]).data(),
                                                 meshes.corners_b(leaf_b.leaf.triangle[gaps.row]).data());
  part_by_nearest<L>(leaves, gaps, nearest.on_b - nearest.on_a, parting);
  return parting;
}

/// How often a plane was found, and how often it still held after B had moved by more than the leaves were apart.
struct Held {
  int parted = 0;
  int outlived = 0;
};

/// B moves on from `pose` in small steps, and each time a plane says how far it is, it is at least so far.
template <class L>
void follow(const Leaf& a, const Leaf& b, math::Pose pose, bool by_triangles, math::Random& random, Held& held) {
  const PosedMeshes meshes(a.mesh, b.mesh, a.tree.origin(), b.tree.origin(), pose);
  const Encounter met(a.tree, b.tree, meshes, EstimatorKind::kinematic);
  const Parting parting = parting_of<L>(a, b, met, meshes, by_triangles);
  const double apart = distance(a, b, meshes);
  EXPECT_LE(static_cast<double>(parting.gap), apart);
  if (!parting.parts) return;
  ++held.parted;
  EXPECT_LE(static_cast<double>(std::min(parting.along, parting.beside)), apart);
  KineticFront front(8);
  front.move_to(meshes.pose(), reach);
  front.note_parting(0, parting, met.numbers(1, b.slot()));
  const Vec3 along = random.direction();
  const Quat turn(Eigen::AngleAxisd(0.003, random.direction()));
  for (int i = 0; i < 60; ++i) {
    pose.translation += 0.01 * along;
    pose.rotation = turn * pose.rotation;
    const PosedMeshes now(a.mesh, b.mesh, a.tree.origin(), b.tree.origin(), pose);
    front.move_to(now.pose(), reach);
    if (!front.is_parted(0)) continue;  // and may be again later
    const double apart_now = distance(a, b, now);
    EXPECT_GT(apart_now, 0.0) << i;
    EXPECT_LE(front.expiry(0) - front.travelled(), apart_now) << i;
    held.outlived += front.travelled() > apart ? 1 : 0;
  }
}

template <class L>
class PartingPlanesOn : public ::testing::Test {};
TYPED_TEST_SUITE(PartingPlanesOn, testing::LanesBuiltHere);

TYPED_TEST(PartingPlanesOn, PartWhatTheySayHoweverTheBodiesMove) {
  math::Random random(31);
  Held by_triangles;
  Held by_nearest;
  for (int i = 0; i < 1500; ++i) {
    const Leaf a(scattered(random));
    const Leaf b(scattered(random));
    const math::Pose pose{random.rotation().toRotationMatrix(), (1.0 + random.uniform()) * random.direction()};
    follow<TypeParam>(a, b, pose, true, random, by_triangles);
    follow<TypeParam>(a, b, pose, false, random, by_nearest);
    ASSERT_FALSE(this->HasFailure()) << i;
  }
  EXPECT_GT(by_triangles.parted, 100);
  EXPECT_GT(by_nearest.parted, 300);
  EXPECT_GT(by_triangles.outlived, 100);
  EXPECT_GT(by_nearest.outlived, 300);
}

// Domes, tip on tip: no more than a hundredth apart, and sliding by as much in every step.
TYPED_TEST(PartingPlanesOn, OutliveASlide) {
  math::Random random(32);
  for (const double gap : {1e-2, 1e-3, 1e-4}) {
    const Leaf a(dome(0.2));
    const Leaf b(dome(-0.2));
    math::Pose pose;
    pose.translation = Vec3(0.0, 0.0, 0.4 + gap);
    const PosedMeshes meshes(a.mesh, b.mesh, a.tree.origin(), b.tree.origin(), pose);
    const Encounter met(a.tree, b.tree, meshes, EstimatorKind::kinematic);
    const Parting parting = parting_of<TypeParam>(a, b, met, meshes, false);
    ASSERT_TRUE(parting.parts) << gap;
    EXPECT_GT(static_cast<double>(parting.along), 0.4 * gap);
    KineticFront front(8);
    front.move_to(meshes.pose(), reach);
    front.note_parting(0, parting, met.numbers(1, b.slot()));
    for (int i = 0; i < 50; ++i) {
      pose.translation.x() += 0.01;
      front.move_to(PosedMeshes(a.mesh, b.mesh, a.tree.origin(), b.tree.origin(), pose).pose(), reach);
      EXPECT_TRUE(front.is_parted(0)) << gap << ", step " << i;
    }
    pose.translation.z() -= 1.01 * gap;
    front.move_to(PosedMeshes(a.mesh, b.mesh, a.tree.origin(), b.tree.origin(), pose).pose(), reach);
    EXPECT_FALSE(front.is_parted(0)) << gap;
  }
}

TEST(PartingPlanes, HaveRoomAgainForWhatIsGivenUp) {
  PartingPlanes planes(2);
  PartingPlanes::Which first = PartingPlanes::none;
  PartingPlanes::Which second = PartingPlanes::none;
  PartingPlanes::Which third = PartingPlanes::none;
  PartingPlane plane{};
  planes.keep(first, plane);
  plane.radius = 2.0F;
  planes.keep(second, plane);
  planes.keep(third, plane);
  EXPECT_TRUE(PartingPlanes::is_plane(first));
  EXPECT_TRUE(PartingPlanes::is_plane(second));
  EXPECT_FALSE(PartingPlanes::is_plane(third)) << "there was no room";
  planes.give_up(first);
  EXPECT_FALSE(PartingPlanes::is_plane(first));
  plane.radius = 3.0F;
  planes.keep(third, plane);
  ASSERT_TRUE(PartingPlanes::is_plane(third));
  EXPECT_EQ(planes[third].radius, 3.0F);
  EXPECT_EQ(planes[second].radius, 2.0F);
}

TEST(PartingPlanes, AreNotLookedForAtOnceAgainWhereNoneWas) {
  PartingPlanes planes(2);
  PartingPlanes::Which which = PartingPlanes::none;
  EXPECT_TRUE(planes.takes_look(which));
  planes.give_up(which);
  int looks = 0;
  while (!planes.takes_look(which) && looks < 100) ++looks;
  EXPECT_EQ(looks, 8);
  const PartingPlane plane{};
  for (int i = 0; i < 2; ++i) {
    PartingPlanes::Which other = PartingPlanes::none;
    planes.keep(other, plane);
  }
  EXPECT_FALSE(planes.takes_look(which)) << "there is no room";
}

}  // namespace
}  // namespace odds::query::wide
