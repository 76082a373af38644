// The binary tree under every hierarchy: all triangles once, bounded leaves and depth, the same on any number of
// threads.
#include "odds/tree/topology.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <thread>

#include <gtest/gtest.h>

#include "odds/mesh/made/by_name.hpp"
#include "odds/tree/hierarchy.hpp"

namespace odds::tree {
namespace {

std::vector<TriangleCorners> corners_of(const char* shape) {
  const auto mesh = mesh::made::make_shape(shape);
  return corners_about(mesh.value(), Vec3::Zero());
}

void expect_valid(const Topology& topology, std::size_t triangles, std::uint32_t leaf_triangles) {
  std::vector<std::uint32_t> order = topology.order;
  std::sort(order.begin(), order.end());
  std::vector<std::uint32_t> all(triangles);
  std::iota(all.begin(), all.end(), 0U);
  EXPECT_EQ(order, all);
  ASSERT_EQ(topology.nodes[0].begin, 0U);
  ASSERT_EQ(topology.nodes[0].end, triangles);
  std::size_t in_leaves = 0;
  std::uint32_t levels = 0;
  for (std::size_t i = 0; i < topology.nodes.size(); ++i) {
    const TopologyNode& node = topology.nodes[i];
    levels = std::max(levels, node.depth + 1U);
    if (node.is_leaf()) {
      EXPECT_EQ(node.first, node.begin);
      EXPECT_EQ(node.count, node.end - node.begin);
      EXPECT_LE(node.count, leaf_triangles);
      EXPECT_EQ(node.height, 0);
      in_leaves += node.count;
      continue;
    }
    ASSERT_GT(node.first, i);
    ASSERT_LT(node.first + 1, topology.nodes.size());
    const TopologyNode& left = topology.nodes[node.first];
    const TopologyNode& right = topology.nodes[node.first + 1];
    EXPECT_EQ(left.begin, node.begin);
    EXPECT_EQ(left.end, right.begin);
    EXPECT_EQ(right.end, node.end);
    EXPECT_LT(left.begin, left.end);
    EXPECT_LT(right.begin, right.end);
    EXPECT_EQ(left.depth, node.depth + 1);
    EXPECT_EQ(right.depth, node.depth + 1);
    EXPECT_EQ(node.height, 1 + std::max(left.height, right.height));
  }
  EXPECT_EQ(in_leaves, triangles);
  EXPECT_EQ(topology.levels, levels);
  EXPECT_LE(topology.levels, deepest_level);
}

void expect_same(const Topology& a, const Topology& b) {
  EXPECT_EQ(a.order, b.order);
  EXPECT_EQ(a.levels, b.levels);
  ASSERT_EQ(a.nodes.size(), b.nodes.size());
  for (std::size_t i = 0; i < a.nodes.size(); ++i) {
    const TopologyNode& p = a.nodes[i];
    const TopologyNode& q = b.nodes[i];
    ASSERT_TRUE(p.first == q.first && p.count == q.count && p.begin == q.begin && p.end == q.end &&
                p.depth == q.depth && p.height == q.height)
        << "node " << i;
  }
}

TEST(Topology, HoldsEveryTriangleOnceInBoundedLeaves) {
  for (const std::uint32_t leaf_triangles : {1U, 4U, 16U}) {
    const auto corners = corners_of("made:car_body:triangles=3000");
    expect_valid(build_topology(corners, leaf_triangles), corners.size(), leaf_triangles);
  }
}

TEST(Topology, IsTheSameOnAnyNumberOfThreads) {
  const auto corners = corners_of("made:car_body:triangles=40000");
  const Topology one = build_topology(corners, 4, {}, 1);
  expect_valid(one, corners.size(), 4);
  for (const std::size_t threads : {2U, 3U, 8U}) expect_same(one, build_topology(corners, 4, {}, threads));
}

TEST(Topology, SplitsCoincidingTrianglesAtTheMedian) {
  const TriangleCorners one = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  const std::vector<TriangleCorners> corners(10000, one);
  const Topology topology = build_topology(corners, 2);
  expect_valid(topology, corners.size(), 2);
  EXPECT_LE(topology.levels, 14U);
}

TEST(Topology, StaysWithinTheDeepestLevelWhereEachSplitTakesOneTriangleOff) {
  std::vector<TriangleCorners> corners;
  for (int i = 0; i < 120; ++i) {
    const double x = std::ldexp(1.0, -i);
    corners.push_back({Vec3(x, 0, 0), Vec3(1.1 * x, 0, 0), Vec3(x, 0.1 * x, 0)});
  }
  expect_valid(build_topology(corners, 1), corners.size(), 1);
}

TEST(Topology, TellsItsProgressInTheCallingThreadUpToAll) {
  const auto corners = corners_of("made:car_body:triangles=40000");
  const auto caller = std::this_thread::get_id();
  std::vector<double> shares;
  const Topology topology = build_topology(
      corners, 4,
      [&](double share) {
        EXPECT_EQ(std::this_thread::get_id(), caller);
        shares.push_back(share);
      },
      1);
  ASSERT_FALSE(shares.empty());
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  EXPECT_DOUBLE_EQ(shares.back(), 1.0);
}

TEST(OnThreads, ThrowsAgainWhatATaskThrew) {
  EXPECT_THROW(for_parts(1000, 10,
                         [](std::size_t begin, std::size_t) {
                           if (begin == 500) throw std::runtime_error("in a part");
                         }),
               std::runtime_error);
}

}  // namespace
}  // namespace odds::tree
