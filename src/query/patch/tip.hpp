// Overlaps that the triangles at their rim know all of.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "odds/math/tolerances.hpp"
#include "query/patch/components.hpp"
#include "query/patch/overlap.hpp"

namespace odds::query::patch {

/// What the triangles of one body at a rim have in common.
class CommonCorners {
 public:
  void add(std::uint32_t triangle, const mesh::Triangle& corners, const std::array<Vec3, 3>& places) noexcept {
    if (triangle == first_ || triangle == second_) return;
    (count_ == 0 ? first_ : second_) = triangle;
    if (count_++ == 0) {
      corners_ = corners;
      places_ = places;
      common_ = 3;
      return;
    }
    std::size_t kept = 0;
    for (std::size_t i = 0; i < common_; ++i) {
      if (std::find(corners.begin(), corners.end(), corners_[i]) == corners.end()) continue;
      corners_[kept] = corners_[i];
      places_[kept++] = places_[i];
    }
    common_ = kept;
  }
  /// Whether all are about a corner that is there.
  [[nodiscard]] bool are_about(const Vec3& place) const noexcept {
    const auto end = places_.begin() + static_cast<std::ptrdiff_t>(common_);
    return std::find(places_.begin(), end, place) != end;
  }
  /// Whether there are two at an edge through a place.
  [[nodiscard]] bool are_at_an_edge_through(const Vec3& place) const noexcept {
    if (count_ != 2 || common_ != 2) return false;
    const Vec3 edge = places_[1] - places_[0];
    return edge.cross(place - places_[0]).norm() <= tolerances::rim_noise * edge.squaredNorm();
  }
  /// There is one only, or two at one edge.
  [[nodiscard]] bool are_at_an_edge() const noexcept { return count_ == 1 || (count_ == 2 && common_ == 2); }

 private:
  mesh::Triangle corners_{};
  std::array<Vec3, 3> places_;
  std::size_t common_ = 0;
  std::size_t count_ = 0;  ///< of the triangles, more than once if a third comes in between
  std::uint32_t first_ = no_feature;
  std::uint32_t second_ = no_feature;
};

/// Whether what solids have in common within a rim is bounded by triangles that the rim crosses, and by no others, and
/// `deepest`, the deepest of these, is where it is deepest: as of a corner in a face or at an edge, or an edge across
/// an edge. The rim closes about one corner of one body and one edge or face of the other, or about both edges, and on
/// their near side, for its vector area leads out of both; and there the corner is over the face, or the edges cross.
/// No ray finds more then.
[[nodiscard]] inline bool is_a_tip(const PatchInput& input, const Rim& rim, const RimSums& sums,
                                   std::span<const std::uint32_t> pieces, const Witness& deepest) noexcept {
  constexpr std::size_t most_pieces = 32;
  if (!input.solid_a || !input.solid_b || !sums.closed() || pieces.size() > most_pieces) return false;
  const Vec3 area = sums.vector_area(rim.origin);
  if (!(area.dot(sums.normals_b) > 0.0) || !(area.dot(sums.normals_a) < 0.0)) return false;
  CommonCorners a;
  CommonCorners b;
  for (const std::uint32_t piece : pieces) {
    const PlacedPair& placed = rim.pairs[rim.pieces[piece].pair];
    a.add(placed.index.a, input.triangles_a[placed.index.a], placed.a);
    b.add(placed.index.b, input.triangles_b[placed.index.b], placed.b);
  }
  if (a.are_at_an_edge_through(deepest.on_a) && b.are_at_an_edge_through(deepest.on_b)) return true;
  return (b.are_at_an_edge() && a.are_about(deepest.on_a)) || (a.are_at_an_edge() && b.are_about(deepest.on_b));
}

}  // namespace odds::query::patch
