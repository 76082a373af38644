// The corner of a mesh with the greatest value of a function, by branch and bound in its wide tree.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "odds/math/types.hpp"
#include "odds/mesh/triangle_mesh.hpp"
#include "odds/query/answer.hpp"
#include "odds/tree/topology.hpp"
#include "odds/tree/wide_tree.hpp"
#include "query/wide/prefetch.hpp"
#include "query/wide/searches.hpp"

namespace odds::query {

/// Places are in the tree's frame, metres. A corner is a number: three times its triangle's, and which of its corners
/// it is. Mesh and tree must outlive it; searching changes nothing.
class CornerSearch {
 public:
  /// A number for each child of a node, or each triangle of a leaf.
  using OfLanes = float[tree::wide_lanes];

  CornerSearch(const mesh::TriangleMesh& mesh, const tree::WideTree& tree,
               const wide::Searches& kernels = *wide::searches_for(InstructionSet::best)) noexcept
      : mesh_(mesh), tree_(tree), kernels_(kernels) {}

  [[nodiscard]] static std::uint32_t triangle_of(std::uint32_t corner) noexcept { return corner / 3; }
  /// Which of the mesh's vertices.
  [[nodiscard]] std::uint32_t vertex_of(std::uint32_t corner) const noexcept {
    return mesh_.triangles()[corner / 3][corner % 3];
  }
  [[nodiscard]] Vec3 place(std::uint32_t corner) const noexcept {
    return mesh_.vertices()[vertex_of(corner)] - tree_.origin();
  }
  [[nodiscard]] const mesh::TriangleMesh& mesh() const noexcept { return mesh_; }
  [[nodiscard]] const wide::Searches& kernels() const noexcept { return kernels_; }
  /// By so much, times a direction's length, extents along it may be off, metres.
  [[nodiscard]] float margin() const noexcept { return 16.0F * 0x1p-24F * static_cast<float>(tree_.reach()); }

  /// The corner with the greatest `value(place)`, or no_feature if each is -infinity. What no value in the box of a
  /// child exceeds, or of a triangle, is said by `bounds.of(node, most)` and `bounds.of(leaf, center, most)`; -infinity
  /// leaves it out. One that is less by no more than `not_greater` may be given in its place. Each node and leaf opened
  /// takes one from `nodes_left`; where that is 0, or `may_go_on()` is false, the best so far is given. noexcept, no
  /// allocation.
  template <class Value, class Bounds, class MayGoOn>
  [[nodiscard]] std::uint32_t greatest(double not_greater, const Value& value, const Bounds& bounds,
                                       const MayGoOn& may_go_on, std::uint64_t& nodes_left) const noexcept;

 private:
  struct Open {
    float bound;
    tree::ChildRef child;
    Vec3f center;
  };

  const mesh::TriangleMesh& mesh_;
  const tree::WideTree& tree_;
  const wide::Searches& kernels_;
};

template <class Value, class Bounds, class MayGoOn>
std::uint32_t CornerSearch::greatest(double not_greater, const Value& value, const Bounds& bounds,
                                     const MayGoOn& may_go_on, std::uint64_t& nodes_left) const noexcept {
  double best = -std::numeric_limits<double>::infinity();
  std::uint32_t best_corner = no_feature;
  std::array<Open, (tree::wide_lanes - 1) * (tree::deepest_level + 2)> stack;
  std::size_t size = 0;
  OfLanes most;
  const auto push = [&](const tree::WideNode& node) {
    bounds.of(node, most);
    const std::size_t first = size;
    for (std::size_t lane = 0; lane < tree::wide_lanes && !node.child[lane].is_nothing(); ++lane) {
      if (!(static_cast<double>(most[lane]) > best + not_greater)) continue;
      // The greatest last, for it is visited first.
      std::size_t at = size++;
      for (; at > first && stack[at - 1].bound > most[lane]; --at) stack[at] = stack[at - 1];
      stack[at] = {most[lane], node.child[lane], {node.center[0][lane], node.center[1][lane], node.center[2][lane]}};
      prefetch(tree_, node.child[lane]);
    }
  };
  push(tree_.nodes()[0]);
  while (size != 0) {
    const Open top = stack[--size];
    if (!(static_cast<double>(top.bound) > best + not_greater)) continue;
    if (nodes_left == 0 || !may_go_on()) break;
    --nodes_left;
    if (!top.child.is_leaf()) {
      push(tree_.nodes()[top.child.node_index()]);
      continue;
    }
    const tree::WideLeaf& leaf = tree_.leaves()[top.child.index()];
    prefetch_triangles(mesh_, leaf, top.child.count());
    bounds.of(leaf, top.center, most);
    const auto is_greater = [&](std::uint32_t t) { return static_cast<double>(most[t]) > best + not_greater; };
    unsigned lanes = 0;
    for (std::uint32_t t = 0; t < top.child.count(); ++t) lanes |= is_greater(t) ? 1U << t : 0U;
    prefetch_corners(mesh_, leaf, lanes);
    for (std::uint32_t t = 0; t < top.child.count(); ++t) {
      if (!is_greater(t)) continue;
      for (std::uint32_t corner = 3 * leaf.triangle[t]; corner < 3 * leaf.triangle[t] + 3; ++corner) {
        const double v = value(place(corner));
        if (!(v > best)) continue;
        best = v;
        best_corner = corner;
      }
    }
  }
  return best_corner;
}

}  // namespace odds::query
