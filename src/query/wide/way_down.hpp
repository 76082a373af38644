// From the roots down to the leaves that a place belongs to: the nodes about it.
#pragma once

#include <algorithm>

#include "query/wide/lanes.hpp"
#include "query/wide/searches.hpp"

namespace odds::query::wide {

template <class L>
class WayDown {
 public:
  /// See Searches::slots_about. Both ways at the same time, for each step waits for the one before.
  static std::array<SlotsAbout, 2> run(const Place& a, const Place& b) noexcept {
    std::array<SlotsAbout, 2> about;
    for (SlotsAbout& slots : about) slots.fill(tree::WideTree::root);
    bool more = true;
    while (more) {
      more = step(a, about[0]);
      more = step(b, about[1]) || more;
    }
    return about;
  }

 private:
  using F = typename L::Float;

  /// A level down; false at a leaf.
  ODDS_LANES_INLINE static bool step(const Place& place, SlotsAbout& about) noexcept {
    const tree::WideNode* const nodes = place.tree.nodes();
    const tree::Slot slot = about.front();
    const tree::ChildRef child = nodes[slot / tree::wide_lanes].child[slot % tree::wide_lanes];
    if (child.is_leaf()) return false;
    std::copy_backward(about.begin(), about.end() - 1, about.end());
    about.front() = child.node_index() * tree::wide_lanes + lane_about(nodes[child.node_index()], place.at);
    return true;
  }

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
