#include "odds/tree/wide_tree.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "odds/mesh/made/by_name.hpp"
#include "support/shapes.hpp"

namespace odds::tree {
namespace {

mesh::TriangleMesh made(const std::string& name) {
  auto mesh = mesh::made::make_shape(name);
  EXPECT_TRUE(mesh.ok()) << name;
  return std::move(mesh).value();
}

class WideTreeOf : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override { tree_ = WideTree::build(mesh_, {.leaf_triangles = 8}); }

  /// Calls visit(slot) for all slots below and with `slot`, and checks the way there.
  template <class Visit>
  void below(Slot slot, const Visit& visit) {
    visit(slot);
    const ChildRef child = tree_.nodes()[slot / wide_lanes].child[slot % wide_lanes];
    ASSERT_FALSE(child.is_nothing());
    if (child.is_leaf()) return;
    ASSERT_LT(child.index(), tree_.node_count());
    const WideNode& node = tree_.nodes()[child.index()];
    for (std::uint32_t lane = 0; lane < wide_lanes; ++lane) {
      if (!node.child[lane].is_nothing()) below(child.index() * wide_lanes + lane, visit);
    }
  }

  std::vector<std::uint32_t> triangles_below(Slot slot) {
    std::vector<std::uint32_t> triangles;
    below(slot, [&](Slot at) {
      const ChildRef child = tree_.nodes()[at / wide_lanes].child[at % wide_lanes];
      if (!child.is_leaf()) return;
      const WideLeaf& leaf = tree_.leaves()[child.index()];
      triangles.insert(triangles.end(), leaf.triangle, leaf.triangle + child.count());
    });
    return triangles;
  }

  mesh::TriangleMesh mesh_ = made(GetParam());
  WideTree tree_;
};

TEST_P(WideTreeOf, HoldsEveryTriangleOnce) {
  std::vector<int> seen(mesh_.triangles().size(), 0);
  for (const std::uint32_t triangle : triangles_below(WideTree::root)) ++seen[triangle];
  for (const int count : seen) ASSERT_EQ(count, 1);
}

TEST_P(WideTreeOf, EnclosesEveryCornerInBoxAndSlabExactly) {
  below(WideTree::root, [&](Slot slot) {
    const WideNode& node = tree_.nodes()[slot / wide_lanes];
    const std::uint32_t lane = slot % wide_lanes;
    Vec3 normal;
    Vec3 center;
    for (int i = 0; i < 3; ++i) {
      normal[i] = static_cast<double>(node.normal[i][lane]);
      center[i] = static_cast<double>(node.center[i][lane]);
    }
    ASSERT_LE(normal.norm(), 1.0);
    ASSERT_GE(normal.norm(), 1.0 - 1e-6);
    for (const std::uint32_t triangle : triangles_below(slot)) {
      for (const std::uint32_t vertex : mesh_.triangles()[triangle]) {
        const Vec3 corner = mesh_.vertices()[vertex] - tree_.origin();
        for (int i = 0; i < 3; ++i) {
          ASSERT_LE(std::abs(corner[i] - static_cast<double>(node.center[i][lane])),
                    static_cast<double>(node.half[i][lane]));
        }
        ASSERT_LE(std::abs(normal.dot(corner - center) - static_cast<double>(node.offset[lane])),
                  static_cast<double>(node.thickness[lane]) * (1.0 + 1e-15));
      }
    }
  });
}

TEST_P(WideTreeOf, KeepsLanesInUseFirstAndEmptyOnesEmpty) {
  for (std::size_t n = 0; n < tree_.node_count(); ++n) {
    bool ended = false;
    for (std::uint32_t lane = 0; lane < wide_lanes; ++lane) {
      const bool empty = tree_.nodes()[n].child[lane].is_nothing();
      ASSERT_FALSE(ended && !empty);
      ended = empty;
      if (empty) {
        ASSERT_LT(tree_.nodes()[n].half[0][lane], -1e29F);
      }
    }
  }
}

TEST_P(WideTreeOf, LeavesRepeatTheirFirstTriangleAndKeepCornersToHalfARounding) {
  below(WideTree::root, [&](Slot slot) {
    const WideNode& node = tree_.nodes()[slot / wide_lanes];
    const std::uint32_t lane = slot % wide_lanes;
    const ChildRef child = node.child[lane];
    if (!child.is_leaf()) return;
    const WideLeaf& leaf = tree_.leaves()[child.index()];
    for (std::uint32_t t = 0; t < wide_lanes; ++t) {
      if (t >= child.count()) {
        ASSERT_EQ(leaf.triangle[t], leaf.triangle[0]);
      }
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 corner = mesh_.vertices()[mesh_.triangles()[leaf.triangle[t]][k]] - tree_.origin();
        for (int i = 0; i < 3; ++i) {
          const double exact = corner[i] - static_cast<double>(node.center[i][lane]);
          ASSERT_NEAR(static_cast<double>(leaf.corner[k][static_cast<std::size_t>(i)][t]), exact,
                      std::abs(exact) * 0x1p-24);
        }
      }
    }
  });
}

TEST_P(WideTreeOf, CountsTheLevelsBelowEachLane) {
  below(WideTree::root, [&](Slot slot) {
    const ChildRef child = tree_.nodes()[slot / wide_lanes].child[slot % wide_lanes];
    std::uint32_t deepest = 0;
    if (!child.is_leaf()) {
      for (const ChildRef below : tree_.nodes()[child.index()].child) {
        if (!below.is_nothing()) deepest = std::max(deepest, below.height() + 1);
      }
    }
    ASSERT_EQ(child.height(), std::min(deepest, ChildRef::highest));
    ASSERT_EQ(tree_.statistics(slot).height, child.height());
  });
}

INSTANTIATE_TEST_SUITE_P(Shapes, WideTreeOf,
                         ::testing::Values("made:car_body:triangles=3000", "made:torus_knot", "made:plates",
                                           "made:bumpy_sphere"),
                         [](const auto& parameters) { return "shape" + std::to_string(parameters.index); });

TEST(WideTree, IsALeafOfItsOwnForOneTriangle) {
  const auto mesh = mesh::TriangleMesh::make({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
  ASSERT_TRUE(mesh.ok());
  const WideTree tree = WideTree::build(mesh.value(), {});
  EXPECT_EQ(tree.node_count(), 1u);
  EXPECT_TRUE(tree.nodes()[0].child[0].is_leaf());
  EXPECT_EQ(tree.nodes()[0].child[0].count(), 1u);
}

}  // namespace
}  // namespace odds::tree
