// The triangles of a wide tree that are near a segment or a point: the nearest one, or all within a distance.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "odds/math/types.hpp"
#include "odds/mesh/triangle_mesh.hpp"
#include "odds/tree/topology.hpp"
#include "odds/tree/wide_tree.hpp"
#include "query/wide/prefetch.hpp"
#include "query/wide/searches.hpp"

namespace odds::query {

/// {middle + t * half, -1 <= t <= 1}, as kernels want it.
[[nodiscard]] inline wide::SegmentInTree segment_about(const Vec3f& middle, const Vec3f& half) noexcept {
  const float square = half.squaredNorm();
  if (!(square > 0.0F)) return {middle, half};
  return {middle, half, 1.0F / square, 1.0F / std::sqrt(square)};
}

/// Made for one segment, in the mesh's frame, metres. Mesh and tree must outlive it; searching changes nothing.
class NearSegment {
 public:
  NearSegment(const mesh::TriangleMesh& mesh, const tree::WideTree& tree, const Vec3& begin, const Vec3& end) noexcept
      : mesh_(mesh), tree_(tree) {
    constexpr double of_floats = 16.0 * 0x1p-24;  // what the bounds of distances may be off
    const Vec3 middle = 0.5 * begin + 0.5 * end - tree.origin();
    const Vec3 half = 0.5 * end - 0.5 * begin;
    segment_ = segment_about(middle.cast<float>(), half.cast<float>());
    margin_ = of_floats * (tree.reach() + middle.norm() + half.norm());
  }

  /// What bounds of distances may be off, metres.
  [[nodiscard]] double margin() const noexcept { return margin_; }

  /// The triangle with the least `distance(triangle)` (metres; infinity: none) of no more than `within`, or no_feature.
  /// What cannot be nearer than the nearest so far by more than `not_nearer` is left out. Each node and leaf opened
  /// takes one from `nodes_left`; where that is 0, or `may_go_on()` is false, the nearest so far is given, and it is
  /// not `finished`. noexcept, no allocation.
  template <class Distance, class MayGoOn>
  [[nodiscard]] std::uint32_t nearest(double within, double not_nearer, const Distance& distance,
                                      const MayGoOn& may_go_on, std::uint64_t& nodes_left,
                                      bool& finished) const noexcept {
    std::uint32_t best = no_feature;
    double least = within;
    const auto is_near = [&](float bound) { return !(static_cast<double>(bound) - margin_ > least - not_nearer); };
    const auto take = [&](std::uint32_t triangle) {
      const double d = distance(triangle);
      if (d < least || (d == least && best == no_feature)) {
        least = d;
        best = triangle;
      }
      return true;
    };
    finished = search(is_near, may_go_on, take, nodes_left);
    return best;
  }

  /// Calls `take(triangle)` for all that may be within `distance`, of each node's children those in the nearest first,
  /// until it says false. False if that, `may_go_on` or `nodes_left` (as above) ended it.
  template <class Take, class MayGoOn>
  [[nodiscard]] bool all_within(double distance, const Take& take, const MayGoOn& may_go_on,
                                std::uint64_t& nodes_left) const noexcept {
    const auto is_near = [&](float bound) { return !(static_cast<double>(bound) - margin_ > distance); };
    return search(is_near, may_go_on, take, nodes_left);
  }

 private:
  struct Open {
    tree::ChildRef child;
    float bound;
    float order;
    Vec3f center;
  };

  template <class IsNear, class MayGoOn, class Take>
  [[nodiscard]] bool search(const IsNear& is_near, const MayGoOn& may_go_on, const Take& take,
                            std::uint64_t& nodes_left) const noexcept {
    std::array<Open, (tree::wide_lanes - 1) * (tree::deepest_level + 2)> stack;
    const wide::Searches& searches = *wide::searches_for(InstructionSet::best);
    const tree::WideNode& root = tree_.nodes()[0];
    stack[0] = {root.child[0], 0.0F, 0.0F, {root.center[0][0], root.center[1][0], root.center[2][0]}};
    std::size_t size = 1;
    float least[tree::wide_lanes];
    float order[tree::wide_lanes];
    while (size != 0) {
      const Open top = stack[--size];
      if (!is_near(top.bound)) continue;
      if (nodes_left == 0 || !may_go_on()) return false;
      --nodes_left;
      if (!top.child.is_leaf()) {
        const tree::WideNode& node = tree_.nodes()[top.child.node_index()];
        searches.children_near(node, segment_, least, order);
        const std::size_t first = size;
        for (std::uint32_t lane = 0; lane < tree::wide_lanes && !node.child[lane].is_nothing(); ++lane) {
          if (!is_near(least[lane])) continue;
          const Vec3f center(node.center[0][lane], node.center[1][lane], node.center[2][lane]);
          const Open child = {node.child[lane], least[lane], order[lane], center};
          // The nearest last, for it is visited first.
          std::size_t at = size++;
          for (; at > first && stack[at - 1].order < child.order; --at) stack[at] = stack[at - 1];
          stack[at] = child;
          prefetch(tree_, child.child);
        }
        continue;
      }
      const tree::WideLeaf& leaf = tree_.leaves()[top.child.index()];
      const std::uint32_t count = top.child.count();
      prefetch_triangles(mesh_, leaf, count);
      searches.triangles_near(leaf, count, top.center, segment_, least);
      unsigned near = 0;
      for (std::uint32_t lane = 0; lane < count; ++lane) near |= is_near(least[lane]) ? 1U << lane : 0U;
      prefetch_corners(mesh_, leaf, near);
      for (std::uint32_t lane = 0; lane < count; ++lane) {
        if (is_near(least[lane]) && !take(leaf.triangle[lane])) return false;
      }
    }
    return true;
  }

  const mesh::TriangleMesh& mesh_;
  const tree::WideTree& tree_;
  wide::SegmentInTree segment_;
  double margin_;
};

}  // namespace odds::query
