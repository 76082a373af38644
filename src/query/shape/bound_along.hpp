// How far along a direction the corners in a wide tree's nodes and leaves can be.
#pragma once

#include <cstddef>

#include "query/shape/corner_search.hpp"
#include "query/wide/extents.hpp"

namespace odds::query {

/// For CornerSearch::greatest: bounds of direction . x, in the tree's frame.
class BoundAlong {
 public:
  BoundAlong(const CornerSearch& search, const Vec3& direction) noexcept
      : kernels_(search.kernels()), direction_(direction.cast<float>()), margin_(search.margin() * direction_.norm()) {}

  /// A bound exceeds what it is of by no more than that, but for the size of boxes.
  [[nodiscard]] double excess() const noexcept { return 2.0 * static_cast<double>(margin_); }

  void of(const tree::WideNode& node, CornerSearch::OfLanes& most) const noexcept {
    wide::Extents extents;
    kernels_.extents_of_children(node, direction_, extents);
    for (std::size_t k = 0; k < tree::wide_lanes; ++k) most[k] = extents.greatest[k] + margin_;
  }
  void of(const tree::WideLeaf& leaf, const Vec3f& center, CornerSearch::OfLanes& most) const noexcept {
    wide::Extents extents;
    kernels_.extents_of_triangles(leaf, center, direction_, extents);
    for (std::size_t k = 0; k < tree::wide_lanes; ++k) most[k] = extents.greatest[k] + margin_;
  }

 private:
  const wide::Searches& kernels_;
  Vec3f direction_;
  float margin_;
};

}  // namespace odds::query
