// A tree of boxes over items that finds the item with the greatest value of a function by branch and bound.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "odds/math/types.hpp"

namespace odds::ode {

constexpr std::uint32_t no_item = std::numeric_limits<std::uint32_t>::max();

/// Immutable after construction; thread-safe to read. It answers what the searches between two hierarchies do not: the
/// deepest vertex below a plane (a convex hull would be smaller, but is hard to build robustly in floating point, and
/// cannot tell the farthest vertex from a point) and the nearest triangle.
class BoxTree {
 public:
  struct Box {
    Vec3 lower;
    Vec3 upper;
  };

  BoxTree() = default;
  /// One finite box per item.
  explicit BoxTree(std::span<const Box> items);

  /// The item with the greatest `value(item)`, or no_item if every value is -infinity. `bound(center, half_extents)`
  /// must be at least every value inside that box; -infinity prunes it. Each visited node takes one from `nodes_left`;
  /// at 0 the best item so far is returned.
  template <class Value, class Bound>
  [[nodiscard]] std::uint32_t greatest(const Value& value, const Bound& bound,
                                       std::uint64_t& nodes_left) const noexcept;

 private:
  struct Node {
    Vec3 center;
    Vec3 half_extents;
    std::uint32_t first;  ///< leaf: first place in order_; inner: left child, the right child follows it
    std::uint32_t count;  ///< leaf: items; inner: 0
  };
  static constexpr std::uint32_t leaf_size = 4;
  static constexpr std::size_t stack_size = 64;  ///< median splits: depth is at most log2(2^32 / 4) + 1

  void build(std::span<const Box> items, std::uint32_t node, std::uint32_t first, std::uint32_t count);

  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

template <class Value, class Bound>
std::uint32_t BoxTree::greatest(const Value& value, const Bound& bound, std::uint64_t& nodes_left) const noexcept {
  using Open = std::pair<double, std::uint32_t>;  // bound, node
  double best = -std::numeric_limits<double>::infinity();
  std::uint32_t best_item = no_item;
  if (nodes_.empty()) return best_item;
  const auto open = [&](std::uint32_t node) {
    return Open(bound(nodes_[node].center, nodes_[node].half_extents), node);
  };
  std::array<Open, stack_size> stack;
  std::size_t size = 0;
  stack[size++] = open(0);
  while (size > 0) {
    const Open top = stack[--size];
    if (!(top.first > best)) continue;
    if (nodes_left == 0) return best_item;
    --nodes_left;
    const Node& node = nodes_[top.second];
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      const double v = value(order_[i]);
      if (v > best) {
        best = v;
        best_item = order_[i];
      }
    }
    if (node.count > 0) continue;
    Open near = open(node.first);
    Open far = open(node.first + 1);
    if (far.first > near.first) std::swap(near, far);
    if (far.first > best) stack[size++] = far;
    if (near.first > best) stack[size++] = near;
  }
  return best_item;
}

}  // namespace odds::ode
