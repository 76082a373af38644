// A plane between two leaves: how far the bodies may move before what is in them can meet.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "odds/math/pose.hpp"
#include "query/wide/box_kernel.hpp"

namespace odds::query::wide {

/// Holds as long as no triangle of B's leaf comes through it, but for pairs of triangles that are apart by more than
/// the bodies have moved anyhow. What B moves along the plane does not count: bodies that slide on each other come no
/// nearer.
struct PartingPlane {
  float normal[3];  ///< from A to B, in A's tree frame, at most 1 long
  float center[3];  ///< of B's leaf, in B's tree frame
  float radius;     ///< of B's leaf about that, metres
  double limit;     ///< how far along the normal that centre is where a triangle of B would touch one of A, metres
  double turned;    ///< sum of B's turns when the limit was found
  double until;     ///< sum of B's motions at which pairs of triangles that it does not part may meet, metres

  /// All of B's triangles that it parts are at least so far beyond A's, metres; 0 or less says nothing. `turned_now`:
  /// the sum of turns by now (math::turn_bound), each of which brings no point of B's leaf nearer to A's by more than
  /// the radius times it.
  [[nodiscard]] double gap(const math::Pose& pose_b_in_a, double turned_now) const noexcept {
    const double along = along_normal(pose_b_in_a);
    // That of the centre's place is covered by what was taken off when the limit was found.
    const double rounding = 0x1p-48 * (std::abs(along) + std::abs(limit) + pose_b_in_a.translation.lpNorm<1>());
    return along - limit - static_cast<double>(radius) * (turned_now - turned) - rounding;
  }
  [[nodiscard]] double along_normal(const math::Pose& pose_b_in_a) const noexcept {
    const double* const r = pose_b_in_a.rotation.data();  // by columns
    double along = 0.0;
    for (int i = 0; i < 3; ++i) {
      const double placed = ((r[i] * static_cast<double>(center[0]) + r[i + 3] * static_cast<double>(center[1])) +
                             r[i + 6] * static_cast<double>(center[2])) +
                            pose_b_in_a.translation[i];
      along += static_cast<double>(normal[i]) * placed;
    }
    return along;
  }
};

/// How far two leaves are apart.
struct Parting {
  float gap = 0.0F;     ///< of all pairs of triangles, whatever way B moves; 0 or less says nothing
  bool parts = false;   ///< a plane tells more:
  float normal[3]{};    ///< its normal, from A to B, at most 1 long
  float along = 0.0F;   ///< of the pairs of triangles that it parts, along it; > 0
  float beside = 0.0F;  ///< of the others, whatever way B moves; > 0
};

/// As many planes as there is room for. What an entry of a front keeps of its own stands in one number, `Which`.
class PartingPlanes {
 public:
  /// Of an entry's plane. Other numbers: it has none, and none is looked for in some of the next looks at it.
  using Which = std::uint16_t;
  static constexpr Which none = 0xFFFF;

  explicit PartingPlanes(std::uint32_t capacity) : planes_(std::min(capacity, most)), free_(planes_.size()) {}

  void clear() noexcept { used_ = free_count_ = 0; }
  [[nodiscard]] static bool is_plane(Which which) noexcept { return which < most; }
  [[nodiscard]] const PartingPlane& operator[](Which which) const noexcept { return planes_[which]; }
  /// One more look at an entry: whether a plane is worth looking for. False: one was not found a few looks ago, or
  /// there is no room for it.
  [[nodiscard]] bool takes_look(Which& which) const noexcept {
    if (is_plane(which)) return true;
    if (which == none) return free_count_ > 0 || used_ < planes_.size();
    ++which;
    return false;
  }
  /// No plane parts the entry now.
  void give_up(Which& which) noexcept {
    if (is_plane(which)) free_[free_count_++] = which;
    which = none - patience;
  }
  /// Keeps a plane for an entry, if there is room.
  void keep(Which& which, const PartingPlane& plane) noexcept {
    if (!is_plane(which)) {
      if (free_count_ > 0) {
        which = free_[--free_count_];
      } else if (used_ < planes_.size()) {
        which = static_cast<Which>(used_++);
      } else {
        return;
      }
    }
    planes_[which] = plane;
  }

 private:
  /// Far more than stand near each other at a time.
  static constexpr std::uint32_t most = 1024;
  static constexpr Which patience = 8;  ///< looks

  std::vector<PartingPlane> planes_;
  std::vector<Which> free_;
  std::size_t used_ = 0;
  std::size_t free_count_ = 0;
};

}  // namespace odds::query::wide
