// The triangles of a wide tree in a convex region, which half-spaces bound.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "odds/math/types.hpp"
#include "odds/mesh/triangle_mesh.hpp"
#include "odds/tree/topology.hpp"
#include "odds/tree/wide_tree.hpp"
#include "query/wide/prefetch.hpp"
#include "query/wide/searches.hpp"

namespace odds::query {

/// At most wide::HalfSpaces::most half-spaces. Mesh and tree must outlive it. Not for sharing while it is changed;
/// searching changes nothing.
class ConvexRegion {
 public:
  using Sides = wide::HalfSpaces::Sides;  ///< a bit for each half-space, in the order of `add`
  enum class Visit : std::uint8_t { pass_over, open, end };
  enum class Way : std::uint8_t { forwards, backwards };

  /// `rounding`: what half-spaces and the mesh may be off against each other, metres.
  ConvexRegion(const mesh::TriangleMesh& mesh, const tree::WideTree& tree, double rounding) noexcept
      : mesh_(mesh), tree_(tree) {
    constexpr double of_floats = 64.0 * 0x1p-24;  // a sum of eight products
    spaces_.margin = static_cast<float>(of_floats * tree.reach() + rounding);
    spaces_.well_within = 2.0F * spaces_.margin;
  }

  /// {x : normal . x <= offset}; `normal` is a unit vector in the mesh's frame, metres.
  void add(const Vec3& normal, double offset) noexcept { set(spaces_.count++, normal, offset); }
  /// The same in place of one that was added.
  void set(std::size_t place, const Vec3& normal, double offset) noexcept {
    // One that is farther away has all of the mesh on one side.
    const double farthest = 2.0 * tree_.reach() + 4.0 * static_cast<double>(spaces_.well_within);
    const double from_origin = std::clamp(offset - normal.dot(tree_.origin()), -farthest, farthest);
    for (int axis = 0; axis < 3; ++axis) spaces_.normal[place][axis] = static_cast<float>(normal[axis]);
    spaces_.offset[place] = static_cast<float>(from_origin);
  }

  /// Depth first, each node's children and each leaf's triangles in their order or in the opposite one. `node(child,
  /// sides)` says what is done with a node or leaf that is not beyond a half-space, `sides` being those that may cut
  /// it; `take(triangle, sides)` gets each triangle that is not beyond one, and some that are by rounding, until it
  /// says false. Each node and leaf opened takes one from `nodes_left`. False if that, `node` or `take` ended it.
  /// noexcept, no allocation.
  template <class Node, class Take>
  [[nodiscard]] bool search(const Node& node, const Take& take, std::uint64_t& nodes_left,
                            Way way = Way::forwards) const noexcept {
    struct Open {
      tree::ChildRef child;
      Vec3f center;
      Sides sides;
    };
    std::array<Open, (tree::wide_lanes - 1) * (tree::deepest_level + 2)> stack;
    std::size_t size = 0;
    const wide::Searches& searches = *wide::searches_for(InstructionSet::best);
    wide::LanesWithin within;
    const auto end_of = [](unsigned lanes, bool lowest) {
      return lowest ? static_cast<unsigned>(std::countr_zero(lanes))
                    : static_cast<unsigned>(std::bit_width(lanes)) - 1U;
    };
    const bool forwards = way == Way::forwards;
    const auto push = [&](const tree::WideNode& opened) {
      for (unsigned lanes = within.lanes; lanes != 0;) {
        const unsigned lane = end_of(lanes, !forwards);  // what is pushed last is visited first
        lanes &= ~(1U << lane);
        const Vec3f center(opened.center[0][lane], opened.center[1][lane], opened.center[2][lane]);
        stack[size++] = {opened.child[lane], center, within.sides[lane]};
        prefetch(tree_, opened.child[lane]);
      }
    };
    searches.children_within(tree_.nodes()[0], spaces_, spaces_.all(), within);
    push(tree_.nodes()[0]);
    while (size != 0) {
      const Open top = stack[--size];
      const Visit visit = node(top.child, top.sides);
      if (visit == Visit::pass_over) continue;
      if (visit == Visit::end || nodes_left == 0) return false;
      --nodes_left;
      if (!top.child.is_leaf()) {
        const tree::WideNode& opened = tree_.nodes()[top.child.node_index()];
        searches.children_within(opened, spaces_, top.sides, within);
        push(opened);
        continue;
      }
      const tree::WideLeaf& leaf = tree_.leaves()[top.child.index()];
      prefetch_triangles(mesh_, leaf, top.child.count());
      searches.triangles_within(leaf, top.child.count(), top.center, spaces_, top.sides, within);
      prefetch_corners(mesh_, leaf, within.lanes);
      for (unsigned lanes = within.lanes; lanes != 0;) {
        const unsigned lane = end_of(lanes, forwards);
        lanes &= ~(1U << lane);
        if (!take(leaf.triangle[lane], within.sides[lane])) return false;
      }
    }
    return true;
  }

 private:
  const mesh::TriangleMesh& mesh_;
  const tree::WideTree& tree_;
  wide::HalfSpaces spaces_;
};

}  // namespace odds::query
