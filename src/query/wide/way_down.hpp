// From the root down to the leaf that a place belongs to: the nodes about it.
#pragma once

#include <algorithm>

#include "query/wide/lanes.hpp"
#include "query/wide/searches.hpp"

namespace odds::query::wide {

template <class L>
class WayDown {
 public:
  /// See Searches::slots_about.
  static SlotsAbout run(const tree::WideTree& tree, const Vec3f& place) noexcept {
    SlotsAbout about;
    about.fill(tree::WideTree::root);
    while (true) {
      const tree::Slot slot = about.front();
      const tree::ChildRef child = tree.nodes()[slot / tree::wide_lanes].child[slot % tree::wide_lanes];
      if (child.is_leaf()) return about;
      std::copy_backward(about.begin(), about.end() - 1, about.end());
      about.front() = child.node_index() * tree::wide_lanes + lane_about(tree.nodes()[child.node_index()], place);
    }
  }

 private:
  using F = typename L::Float;

  /// That from whose middle the place is the least part of its size away, what lies outside counts more. Of lanes of
  /// 1e19 m, and of a place that is none, the first.
  [[nodiscard]] ODDS_LANES_INLINE static unsigned lane_about(const tree::WideNode& node, const Vec3f& place) noexcept {
    constexpr float outside_counts = 16.0F;
    constexpr float least_size = 1e-37F;
    const F zero = L::all(0.0F);
    F away = zero;
    F outside = zero;
    F size = L::all(least_size);
    F along = zero - L::load(node.offset);
    for (int i = 0; i < 3; ++i) {
      const F d = L::all(place[i]) - L::load(node.center[i]);
      const F half = L::load(node.half[i]);
      const F out = L::max(L::abs(d) - half, zero);
      const F inner = L::max(half, zero);  // that of a lane without a child is negative
      along = along + L::load(node.normal[i]) * d;
      away = away + d * d;
      outside = outside + out * out;
      size = size + inner * inner;
    }
    const F above = L::max(L::abs(along) - L::load(node.thickness), zero);
    const unsigned lane = L::least(L::divide(away + L::all(outside_counts) * (outside + above * above), size));
    return lane < tree::wide_lanes && !node.child[lane].is_nothing() ? lane : 0;
  }
};

}  // namespace odds::query::wide
