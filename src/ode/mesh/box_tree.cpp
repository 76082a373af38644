// Building the box tree: median splits along the longest side of the items' centres.
#include "ode/mesh/box_tree.hpp"

#include <algorithm>
#include <numeric>

namespace odds::ode {

BoxTree::BoxTree(std::span<const Box> items) : order_(items.size()) {
  if (items.empty()) return;
  std::iota(order_.begin(), order_.end(), 0u);
  nodes_.reserve(items.size() + 1);
  nodes_.emplace_back();
  build(items, 0, 0, static_cast<std::uint32_t>(items.size()));
  nodes_.shrink_to_fit();
}

void BoxTree::build(std::span<const Box> items, std::uint32_t node, std::uint32_t first, std::uint32_t count) {
  const auto center_of = [items](std::uint32_t item) -> Vec3 {
    return 0.5 * items[item].lower + 0.5 * items[item].upper;
  };
  Box box = items[order_[first]];
  Box centers = {center_of(order_[first]), center_of(order_[first])};
  for (std::uint32_t i = first; i < first + count; ++i) {
    box = {box.lower.cwiseMin(items[order_[i]].lower), box.upper.cwiseMax(items[order_[i]].upper)};
    const Vec3 center = center_of(order_[i]);
    centers = {centers.lower.cwiseMin(center), centers.upper.cwiseMax(center)};
  }
  const Vec3 center = 0.5 * box.lower + 0.5 * box.upper;
  // The centre is rounded: the half extents are measured from it, so that the box surely holds every item.
  const Vec3 half_extents = (box.upper - center).cwiseMax(center - box.lower);
  if (count <= leaf_size) {
    nodes_[node] = {center, half_extents, first, count};
    return;
  }
  Eigen::Index axis = 0;
  (centers.upper - centers.lower).maxCoeff(&axis);
  const std::uint32_t half = count / 2;
  const auto begin = order_.begin() + first;
  std::nth_element(begin, begin + half, begin + count, [&](std::uint32_t a, std::uint32_t b) {
    const double x = center_of(a)[axis];
    const double y = center_of(b)[axis];
    return x != y ? x < y : a < b;  // ties by number: the same tree from every standard library
  });
  const auto left = static_cast<std::uint32_t>(nodes_.size());
  nodes_.emplace_back();
  nodes_.emplace_back();
  nodes_[node] = {center, half_extents, left, 0};
  build(items, left, first, half);
  build(items, left + 1, first + half, count - half);
}

}  // namespace odds::ode
