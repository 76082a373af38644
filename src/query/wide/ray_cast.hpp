// Rays through the wide tree: eight boxes cut by slabs at once, then eight triangles.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <span>

#include "odds/primitive/ray_triangle.hpp"
#include "odds/tree/topology.hpp"
#include "odds/volume/concept.hpp"
#include "query/wide/lanes.hpp"
#include "query/wide/searches.hpp"

namespace odds::query::wide {

/// Where a ray is in the slabs {|x - center| <= half} across one direction: between middle - reach and middle + reach,
/// with middle = (center - origin) * turned and reach = (half + margin) * inverse. A ray that hardly moves across is
/// taken to move by 1e-6 of its way: its slab is crossed later than it is, by less than the margin covers.
template <class L>
struct SlabCrossing {
  using F = typename L::Float;
  F enter;
  F leave;

  ODDS_LANES_INLINE void clip(F from_origin, F half, F turned, F inverse) noexcept {
    const F middle = from_origin * turned;
    const F reach = half * inverse;
    enter = L::max(enter, middle - reach);
    leave = L::min(leave, middle + reach);
  }
};

template <class L>
class RayCast {
 public:
  static std::optional<RayHit> run(const RayTask& task) noexcept { return RayCast(task).finish(); }
  /// Two at a time take 1.4 times as long as one: each step of a ray waits for the one before it, and for memory.
  static RayHits run_two(const RayTask& first, const RayTask& second) noexcept {
    RayCast one(first);
    RayCast other(second);
    while (!one.at_end() && !other.at_end()) {
      one.step();
      other.step();
    }
    return {one.finish(), other.finish()};
  }

 private:
  using F = typename L::Float;
  /// A slot to be visited, and where the ray enters it, 0 or more. One number, for halves that are written apart have
  /// to be waited for where they are read as one.
  class Open {
   public:
    Open() = default;
    Open(tree::Slot slot, float enter) noexcept
        : bits_(std::uint64_t{std::bit_cast<std::uint32_t>(enter) & 0x7FFFFFFFU} << 32U | slot) {}  // no -0
    [[nodiscard]] tree::Slot slot() const noexcept { return static_cast<tree::Slot>(bits_); }
    [[nodiscard]] float enter() const noexcept {
      return std::bit_cast<float>(static_cast<std::uint32_t>(bits_ >> 32U));
    }
    [[nodiscard]] bool is_nearer_than(Open other) const noexcept { return bits_ >> 32U < other.bits_ >> 32U; }

   private:
    std::uint64_t bits_;
  };
  static constexpr float least_motion = 1e-6F;

  RayCast(const RayCast&) = delete;
  RayCast& operator=(const RayCast&) = delete;
  explicit RayCast(const RayTask& task) noexcept
      : task_(task), segment_(volume::RaySegment::make(task.origin, task.direction, task.length, task.tree.reach())) {
    *top_++ = Open(tree::WideTree::root, 0.0F);
    constexpr double round_down = 1.0 - 1e-6;
    begin_ = task.after > 0.0 ? static_cast<float>(task.after * round_down) : 0.0F;
    // The motion across a slab may be off by 2e-6 of the way, and the way is at most a millionth of 16 margins.
    margin_ = 4.0F * segment_.margin;
    for (int i = 0; i < 3; ++i) {
      const float across = segment_.direction[i];
      const float motion = std::max(across < 0.0F ? -across : across, least_motion);
      inverse_[i] = 1.0F / motion;
      // Not 0 of a ray along an axis, or it would be in every slab across it.
      turned_[i] = across < 0.0F ? -inverse_[i] : inverse_[i];
    }
  }

  [[nodiscard]] bool at_end() const noexcept { return top_ == stack_.data() || task_.allowance.is_up(visited_); }

  ODDS_LANES_INLINE void step() noexcept {
    ++visited_;
    const Open open = *--top_;
    if (open.enter() > segment_.length + margin_) return;
    const tree::ChildRef child = node_of(open.slot()).child[open.slot() % tree::wide_lanes];
    if (child.is_leaf()) {
      test_leaf(open, child);
    } else {
      push_children(child.node_index());
    }
  }

  std::optional<RayHit> finish() noexcept {
    while (!at_end()) step();
    task_.effort = {visited_, top_ == stack_.data()};
    return nearest_;
  }

  [[nodiscard]] const tree::WideNode& node_of(tree::Slot slot) const noexcept {
    return task_.tree.nodes()[slot / tree::wide_lanes];
  }

  /// Lanes that the segment may meet, and where it enters each.
  ODDS_LANES_INLINE unsigned lanes_met(const tree::WideNode& node, float (&enter)[tree::wide_lanes]) const noexcept {
    SlabCrossing<L> crossing{L::all(begin_), L::all(segment_.length)};
    const F margin = L::all(margin_);
    F from[3];
    for (int i = 0; i < 3; ++i) {
      from[i] = L::load(node.center[i]) - L::all(segment_.origin[i]);
      crossing.clip(from[i], L::load(node.half[i]) + margin, L::all(turned_[i]), L::all(inverse_[i]));
    }
    F middle = L::load(node.offset);  // of the slab, from the ray's origin, along its normal
    F across = L::all(0.0F);
    for (int i = 0; i < 3; ++i) {
      const F normal = L::load(node.normal[i]);
      middle = middle + normal * from[i];
      across = across + normal * L::all(segment_.direction[i]);
    }
    const F inverse = L::divide(L::all(1.0F), L::max(L::abs(across), L::all(least_motion)));
    crossing.clip(middle, L::load(node.thickness) + margin, across * inverse * inverse, inverse);
    L::store(enter, crossing.enter);
    // Each end is wrong by a few roundings of its own size.
    const F slack = L::all(4e-7F) * (L::abs(crossing.enter) + L::abs(crossing.leave));
    return L::less_equal(crossing.enter, crossing.leave + slack);
  }

  ODDS_LANES_INLINE void push_children(std::uint32_t index) noexcept {
    alignas(64) float enter[tree::wide_lanes];
    const Open* const first = top_;
    Open* top = top_;
    for (unsigned lanes = lanes_met(task_.tree.nodes()[index], enter); lanes != 0; lanes &= lanes - 1U) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(lanes));
      const Open added(index * static_cast<std::uint32_t>(tree::wide_lanes) + lane, enter[lane]);
      // The nearest last, for it is visited first and shortens the segment.
      Open* at = top++;
      for (; at != first && at[-1].is_nearer_than(added); --at) *at = at[-1];
      *at = added;
    }
    top_ = top;
  }

  /// Triangles of the leaf that the ray's line may cross: those about whose three edges it does not certainly turn both
  /// ways. In single precision from where the ray enters, about the leaf's centre, so that errors are relative to the
  /// leaf's size.
  ODDS_LANES_INLINE unsigned triangles_met(const Open& open, const tree::WideLeaf& leaf) const noexcept {
    const tree::WideNode& node = node_of(open.slot());
    const std::uint32_t lane = open.slot() % tree::wide_lanes;
    float span = 0.0F;
    F from[3];
    for (int i = 0; i < 3; ++i) {
      const double at = task_.origin[i] + static_cast<double>(open.enter()) * task_.direction[i] -
                        static_cast<double>(node.center[i][lane]);
      const auto place = static_cast<float>(at);
      from[i] = L::all(place);
      span = std::max(span, node.half[i][lane] + (place < 0.0F ? -place : place));
    }
    F corner[3][3];
    for (int k = 0; k < 3; ++k) {
      for (int i = 0; i < 3; ++i) corner[k][i] = L::load(leaf.corner[k][i]) - from[i];
    }
    F low = L::all(0.0F);
    F high = low;
    for (int k = 0; k < 3; ++k) {
      const F(&u)[3] = corner[k];
      const F(&v)[3] = corner[(k + 1) % 3];
      const F turn = (L::all(segment_.direction[0]) * (u[1] * v[2] - u[2] * v[1]) +
                      L::all(segment_.direction[1]) * (u[2] * v[0] - u[0] * v[2])) +
                     L::all(segment_.direction[2]) * (u[0] * v[1] - u[1] * v[0]);
      low = k == 0 ? turn : L::min(low, turn);
      high = k == 0 ? turn : L::max(high, turn);
    }
    // A coordinate errs by 3 roundings of `span`, a direction's by one: three sums of products of two below
    // 40 roundings of span^2. Where they underflow all are candidates.
    const F tolerance = L::all(64.0F * 0x1p-24F * span * span + std::numeric_limits<float>::min());
    const unsigned apart = ~L::less_equal(low * L::all(-1.0F), tolerance) & ~L::less_equal(high, tolerance);
    return ~apart & 0xFFU;
  }

  ODDS_LANES_INLINE double distance_to(const mesh::Triangle& triangle) const noexcept {
    const std::span<const Vec3> vertices = task_.mesh.vertices();
    if (task_.watertight != nullptr) {
      const Vec3 corners[3] = {vertices[triangle[0]], vertices[triangle[1]], vertices[triangle[2]]};
      return task_.watertight->crossing(corners);
    }
    const Vec3& origin = task_.tree.origin();
    const Vec3 corners[3] = {vertices[triangle[0]] - origin, vertices[triangle[1]] - origin,
                             vertices[triangle[2]] - origin};
    return primitive::distance_along_ray(corners, task_.origin, task_.direction);
  }

  void test_leaf(const Open& open, tree::ChildRef child) noexcept {
    const tree::WideLeaf& leaf = task_.tree.leaves()[child.index()];
    const unsigned used = (2U << (child.count() - 1U)) - 1U;
    for (unsigned lanes = triangles_met(open, leaf) & used; lanes != 0; lanes &= lanes - 1U) {
      const std::uint32_t index = leaf.triangle[std::countr_zero(lanes)];
      const double distance = distance_to(task_.mesh.triangles()[index]);
      if (!(distance >= 0.0 && distance > task_.after && distance <= task_.length)) continue;
      if (nearest_ && distance >= nearest_->distance) continue;
      nearest_ = RayHit{distance, index};
      segment_.length = static_cast<float>(distance * (1.0 + 1e-6));
    }
  }

  const RayTask& task_;
  volume::RaySegment segment_;
  float margin_;
  float begin_;  ///< nothing nearer counts
  float inverse_[3];
  float turned_[3];
  std::array<Open, (tree::wide_lanes - 1) * (tree::deepest_level + 2)> stack_;
  Open* top_ = stack_.data();  ///< above the newest
  std::uint64_t visited_ = 0;
  std::optional<RayHit> nearest_;
};

}  // namespace odds::query::wide
