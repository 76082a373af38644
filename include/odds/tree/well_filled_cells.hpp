// Well-filled cells: how much surface lies in each cell of a regular grid over a node's box, and how many cells are
// full.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "odds/math/types.hpp"

namespace odds::tree {

inline constexpr int kCellsPerAxis = 8;
inline constexpr std::size_t kCellsPerNode = 512;  ///< kCellsPerAxis^3

/// Area of the largest plane section of a cuboid with these sides (any order, any length unit): a * sqrt(b^2 + c^2) for
/// a >= b >= c, the section through two opposite longest edges (Klein and Zachmann 2003: "MaxArea").
[[nodiscard]] double max_section_area(const Vec3& sides) noexcept;

/// Sums the area of triangles, clipped exactly, in each of the 8^3 cells of an oriented box and counts the "possible
/// collision cells" of Klein and Zachmann 2003: those whose area reaches tau * MaxArea. For builds, not for queries: a
/// triangle inside one cell costs some 30 ns, each further cell that a triangle touches some 30 ns. No allocation. An
/// object is reused for any number of nodes, by one thread at a time.
class CellCounter {
 public:
  /// Starts a node: the box {center + axes * x : |x_i| <= half_extents_i}; lengths in metres, `axes` orthonormal with
  /// the box's directions as columns, half extents finite and >= 0. An extent below kThinnestExtent of the largest is
  /// widened to that, and the grid is shifted along it by half a cell: a flat surface then fills one layer of cells
  /// instead of wobbling, by rounding, between the two layers that meet in the middle. If all extents are 0, no cell
  /// can be filled.
  void begin(const Vec3& center, const Mat3& axes, const Vec3& half_extents) noexcept;

  /// Adds a triangle (metres, same frame as the box, finite). What sticks out of the box counts for the nearest cell,
  /// so that the total area is conserved whatever the box's rounding. A triangle without area adds nothing.
  void add(const Vec3& a, const Vec3& b, const Vec3& c) noexcept;

  /// Cells, 0 to 512, with area >= tau * MaxArea of a cell; tau > 0. Less by tolerances::cell_fill_slack still counts,
  /// lest rounding decide about a polygon that fills its cell exactly.
  [[nodiscard]] std::uint16_t count(double tau) const noexcept;

  /// Area in m^2 in the cell (x, y, z), each 0 to 7.
  [[nodiscard]] double area(int x, int y, int z) const noexcept;
  /// Sum over all cells, m^2.
  [[nodiscard]] double total_area() const noexcept;
  /// MaxArea of one cell of this node, m^2, after widening.
  [[nodiscard]] double max_area() const noexcept { return max_area_; }

 private:
  Vec3 center_ = Vec3::Zero();
  Mat3 to_box_ = Mat3::Identity();
  Vec3 cells_per_metre_ = Vec3::Ones();
  Vec3 middle_ = Vec3::Constant(0.5 * kCellsPerAxis);  // grid coordinate of the centre
  double max_area_ = 0.0;
  std::array<double, kCellsPerNode> area_{};
};

}  // namespace odds::tree
