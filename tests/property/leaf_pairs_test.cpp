// What leaves leave to the exact test: every pair of triangles that meets, and few of those that lie side by side; that
// what they say meets does. And how far apart they say that the others are.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "odds/math/random.hpp"
#include "odds/math/tolerances.hpp"
#include "odds/primitive/triangle_distance.hpp"
#include "query/wide/encounter.hpp"
#include "query/wide/lanes.hpp"
#include "support/lanes_built_here.hpp"

namespace odds::query::wide {
namespace {

constexpr std::uint32_t triangles = 8;  // in one leaf or two

mesh::TriangleMesh mesh_of(std::vector<Vec3> corners) {
  std::vector<mesh::Triangle> indices;
  for (std::uint32_t i = 0; i + 2 < corners.size(); i += 3) indices.push_back({i, i + 1, i + 2});
  return std::move(mesh::TriangleMesh::make(std::move(corners), std::move(indices), "leaf")).value();
}

struct Leaf {
  explicit Leaf(std::vector<Vec3> corners) : mesh(mesh_of(std::move(corners))), tree(tree::WideTree::build(mesh, {})) {}
  mesh::TriangleMesh mesh;
  tree::WideTree tree;
};

struct Counts {
  int asked = 0;
  int met = 0;
  int certain = 0;   ///< meet, and the exact test is not asked
  int with_gap = 0;  ///< pairs that are known to be apart by something
};

/// The leaves' slots.
std::vector<Slot> leaves_of(const tree::WideTree& tree) {
  std::vector<Slot> slots;
  for (Slot slot = 0; slot < tree.node_count() * wide_lanes; ++slot) {
    if (tree.nodes()[slot / wide_lanes].child[slot % wide_lanes].is_leaf()) slots.push_back(slot);
  }
  return slots;
}

/// How many pairs are left to the exact test, and how many meet; fails if one that meets is not left to it. `finely`:
/// see leaf_pairs.
template <class L>
Counts compare(const Leaf& a, const Leaf& b, const math::Pose& pose, bool finely = true) {
  const PosedMeshes meshes(a.mesh, b.mesh, a.tree.origin(), b.tree.origin(), pose);
  const Encounter met(a.tree, b.tree, meshes, EstimatorKind::kinematic);
  Counts counts;
  for (const Slot slot_a : leaves_of(a.tree)) {
    for (const Slot slot_b : leaves_of(b.tree)) {
      float shift[3];
      met.shift(slot_a, slot_b, shift);
      const PlacedLeaf leaf_a = met.leaf(0, slot_a);
      const PlacedLeaf leaf_b = met.leaf(1, slot_b);
      const LeafPairs pairs = leaf_pairs<L>(leaf_a, leaf_b, met.turn_into(0), shift, met.margin(), finely);
      alignas(64) float gaps[wide_lanes][wide_lanes];
      triangle_gaps<L>(SpreadLeaves<L>(leaf_a, leaf_b, met.turn_into(0), shift, met.margin()), leaf_b.count(), gaps);
      for (std::uint32_t row = 0; row < leaf_b.count(); ++row) {
        for (std::uint32_t lane = 0; lane < leaf_a.count(); ++lane) {
          const bool asked = (pairs.rows >> row & 1U) != 0 && (pairs.lanes_a[row] >> lane & 1U) != 0;
          const std::uint32_t triangle_a = leaf_a.leaf.triangle[lane];
          const std::uint32_t triangle_b = leaf_b.leaf.triangle[row];
          const bool meet = met.triangles_meet(triangle_a, triangle_b);
          const bool certain = asked && pairs.certainly_meet(row, lane);
          EXPECT_TRUE(asked || !meet) << "lane " << lane << ", row " << row;
          EXPECT_TRUE(meet || !certain) << "lane " << lane << ", row " << row;
          counts.certain += certain ? 1 : 0;
          if (gaps[row][lane] > 0.0F) {
            const auto nearest =
                primitive::closest_points(meshes.corners_a(triangle_a).data(), meshes.corners_b(triangle_b).data());
            EXPECT_LE(static_cast<double>(gaps[row][lane]), (nearest.on_b - nearest.on_a).norm());
            ++counts.with_gap;
          }
          counts.asked += asked ? 1 : 0;
          counts.met += meet ? 1 : 0;
        }
      }
    }
  }
  return counts;
}

template <class L>
class LeafPairsOn : public ::testing::Test {};
TYPED_TEST_SUITE(LeafPairsOn, testing::LanesBuiltHere);

/// Corners on a grid of so few points that triangles share corners, sides and planes all the time, some without area;
/// slivers where one axis is short.
std::vector<Vec3> on_a_grid(math::Random& random, const Vec3& scale, bool flat) {
  std::vector<Vec3> corners;
  while (corners.size() < std::size_t{3} * triangles) {
    const auto at = [&random] { return static_cast<double>(random.below(4)); };
    corners.push_back(scale.cwiseProduct(Vec3(at(), at(), flat ? 0.0 : at())));
  }
  return corners;
}

TYPED_TEST(LeafPairsOn, MissNothingThatMeets) {
  math::Random random(21);
  Counts all;
  for (int i = 0; i < 4000; ++i) {
    const double size = std::exp2(static_cast<double>(random.below(120)) - 80.0);  // also where leaves are scaled
    const Vec3 scale = size * Vec3(1.0, 1.0, random.below(2) == 0 ? 1.0 : 1e-3);
    const bool flat = random.below(2) == 0;
    const Leaf a(on_a_grid(random, scale, flat));
    const Leaf b(on_a_grid(random, scale, flat));
    // Turned by a quarter or not at all, and moved along the grid, much lies in one plane; else next to it.
    math::Pose pose;
    if (random.below(2) == 0) pose.rotation << 0, -1, 0, 1, 0, 0, 0, 0, 1;
    pose.translation = scale.cwiseProduct(
        Vec3(static_cast<double>(random.below(5)) - 2.0, static_cast<double>(random.below(5)) - 2.0, 0.0));
    if (random.below(3) == 0) pose.translation += 1e-7 * size * random.direction();
    const Quat turn = random.rotation();
    // Turned both, nothing is along an axis any more: B stands in A as before, A's corners are others.
    if (random.below(2) == 0) {
      std::vector<Vec3> turned(a.mesh.vertices().begin(), a.mesh.vertices().end());
      for (Vec3& corner : turned) corner = turn * corner;
      pose = math::Pose{turn.toRotationMatrix(), Vec3::Zero()} * pose;
      const Counts counts = compare<TypeParam>(Leaf(std::move(turned)), b, pose);
      all.asked += counts.asked;
      all.met += counts.met;
      all.certain += counts.certain;
      all.with_gap += counts.with_gap;
    } else {
      const Counts counts = compare<TypeParam>(a, b, pose);
      all.asked += counts.asked;
      all.met += counts.met;
      all.certain += counts.certain;
      all.with_gap += counts.with_gap;
    }
    ASSERT_FALSE(this->HasFailure()) << i;
  }
  EXPECT_GT(all.met, 20000);
  EXPECT_GT(all.asked, all.met);
  EXPECT_GT(all.certain, 100);
  EXPECT_GT(all.with_gap, 20000);
}

TYPED_TEST(LeafPairsOn, SeeWhatLiesSideBySideInAPlane) {
  math::Random random(22);
  // A fan of eight slivers, and the same beside it, a hundredth of its size away.
  std::vector<Vec3> fan;
  for (int i = 0; i < static_cast<int>(triangles); ++i) {
    const auto rim = [](int k) { return Vec3(std::cos(0.05 * k), std::sin(0.05 * k), 0.0); };
    fan.insert(fan.end(), {Vec3::Zero(), rim(i), rim(i + 1)});
  }
  Counts all;
  for (int i = 0; i < 500; ++i) {
    const Mat3 turn = random.rotation().toRotationMatrix();
    std::vector<Vec3> turned;
    for (const Vec3& corner : fan) turned.emplace_back(turn * corner);
    // Both fans' boxes overlap nearly everywhere: B is turned in the common plane by more than a fan is wide.
    const Mat3 aside = Eigen::AngleAxisd(0.42, Vec3::UnitZ()).toRotationMatrix();
    const math::Pose pose{turn * aside, turn * Vec3(0.0, 0.01, 0.0)};
    const Counts counts = compare<TypeParam>(Leaf(std::move(turned)), Leaf(fan), pose);
    all.asked += counts.asked;
    all.with_gap += counts.with_gap;
  }
  EXPECT_LT(all.asked, 500);  // of 32,000
  EXPECT_GT(all.with_gap, 31500);
}

/// Long ones, a hundredth as wide, every way: their boxes are large and their planes cross each other, but they are
/// mostly apart.
std::vector<Vec3> slivers(math::Random& random) {
  std::vector<Vec3> corners;
  for (std::uint32_t i = 0; i < triangles; ++i) {
    const Vec3 from = 0.5 * random.direction();
    const Vec3 along = random.direction();
    corners.insert(corners.end(), {from - along, from + along, from + 0.02 * random.direction()});
  }
  return corners;
}

TYPED_TEST(LeafPairsOn, SeeThatSliversPassEachOther) {
  math::Random random(23);
  Counts all;
  for (int i = 0; i < 2000; ++i) {
    const math::Pose pose{random.rotation().toRotationMatrix(), 0.3 * random.direction()};
    const Counts counts = compare<TypeParam>(Leaf(slivers(random)), Leaf(slivers(random)), pose);
    all.asked += counts.asked;
    all.met += counts.met;
    all.certain += counts.certain;
  }
  EXPECT_GT(all.met, 500);
  EXPECT_GT(all.certain, 0.8 * all.met);
  EXPECT_LT(all.asked, 1.3 * all.met);  // by boxes, planes and outlines alone it is 36 times
}

/// A sheet folded as an accordion, four folds of two triangles, a fifth of its size from valley to ridge.
std::vector<Vec3> folded(double size) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 4; ++i) {
    const auto at = [size](int k, double y) -> Vec3 { return size * Vec3(0.25 * k - 0.5, y, k % 2 == 0 ? 0.0 : 0.2); };
    corners.insert(corners.end(), {at(i, -0.5), at(i + 1, -0.5), at(i + 1, 0.5)});
    corners.insert(corners.end(), {at(i, -0.5), at(i + 1, 0.5), at(i, 0.5)});
  }
  return corners;
}

std::vector<Vec3> turned_by(const Mat3& turn, const std::vector<Vec3>& corners) {
  std::vector<Vec3> turned;
  for (const Vec3& corner : corners) turned.emplace_back(turn * corner);
  return turned;
}

TYPED_TEST(LeafPairsOn, SeeWhatSlabsPart) {
  math::Random random(24);
  // Ridges across each other, and the valleys of one above the ridges of the other: planes of folds cut through what is
  // beyond them, and turned, so do boxes.
  Counts all;
  for (int i = 0; i < 500; ++i) {
    const Mat3 turn = random.rotation().toRotationMatrix();
    const Mat3 across = Eigen::AngleAxisd(1.3, Vec3::UnitZ()).toRotationMatrix();
    const math::Pose pose{turn * across, turn * Vec3(0.0, 0.0, 0.22)};
    all.asked += compare<TypeParam>(Leaf(turned_by(turn, folded(1.0))), Leaf(folded(1.0)), pose, false).asked;
  }
  EXPECT_EQ(all.asked, 0);  // of 32,000; 18,469 by boxes and planes alone
}

TYPED_TEST(LeafPairsOn, MissNothingThatMeetsWhereSlabsTouch) {
  math::Random random(25);
  Counts all;
  for (int i = 0; i < 4000; ++i) {
    const double size = std::exp2(static_cast<double>(random.below(120)) - 80.0);  // also where leaves are scaled
    const Mat3 turn = random.rotation().toRotationMatrix();
    const Mat3 turn_b = random.rotation().toRotationMatrix();
    // B, the larger one, lies on A by one corner, or is by some roundings in it.
    const auto end = [&random, size] { return random.below(2) == 0 ? 0.5 * size : -0.5 * size; };
    const Vec3 at(end(), end(), 0.0);
    const double deep = random.below(2) == 0 ? 0.0 : size * std::exp2(-20.0 - static_cast<double>(random.below(20)));
    // Only just as rigid as a query takes it: B's slab, as A sees it, leans. With a slack of one delta some are missed.
    Mat3 askew = Mat3::Identity();
    for (int k = 0; k < 3; ++k) {
      const double lean = (at[k] < 0.0 ? 0.49 : -0.49) * tolerances::pose_orthonormality * (i % 2 == 0 ? 1.0 : -1.0);
      if (k < 2) askew(2, k) = askew(k, 2) = lean;
    }
    askew(2, 2) += 0.49 * tolerances::pose_orthonormality * (i % 3 - 1);
    const Mat3 across = Eigen::AngleAxisd(1.3, Vec3::UnitZ()).toRotationMatrix() * askew;
    const double small = 0.01 * size;  // A's ridge at 0.2 of that
    const math::Pose pose{turn * across * turn_b.transpose(), turn * (Vec3(0, 0, 0.2 * small - deep) - across * at)};
    const Counts counts =
        compare<TypeParam>(Leaf(turned_by(turn, folded(small))), Leaf(turned_by(turn_b, folded(size))), pose);
    all.asked += counts.asked;
    all.met += counts.met;
    ASSERT_FALSE(this->HasFailure()) << i;
  }
  EXPECT_GT(all.met, 1000);
}

}  // namespace
}  // namespace odds::query::wide
