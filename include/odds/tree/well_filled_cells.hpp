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

/// Sums the area of triangles, exactly, in each of the 8^3 cells of an oriented box and counts the "possible collision
/// cells" of Klein and Zachmann 2003: those whose area reaches tau * MaxArea. For builds, not for queries: a triangle
/// inside one cell costs some 20 ns, each further cell that a triangle touches some 15 ns. No allocation. An object is
/// reused for any number of nodes, by one thread at a time.
class CellCounter {
 public:
  /// Starts a node: the box {center + axes * x : |x_i| <= half_extents_i}; lengths in metres, `axes` orthonormal with
  /// the box's directions as columns, half extents finite and >= 0. An extent below tolerances::thinnest_extent of the
  /// largest is widened to that, and the grid is shifted along it by half a cell: a flat surface then fills one layer
  /// of cells instead of wobbling, by rounding, between the two layers that meet in the middle. If all extents are 0,
  /// no cell can be filled.
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
  static constexpr std::size_t cells_per_layer = std::size_t{kCellsPerAxis} * kCellsPerAxis;
  // Sums over the edges of a polygon, in one cell.
  struct Piece {
    double share = 0.0;
    double climb = 0.0;
  };

  // A triangle that passes borders of one axis only; `cell`: the first it touches.
  void add_along(int axis, double a, double b, double c, std::size_t cell, double area) noexcept;
  void add_across(const Vec3 (&grid)[3], double area) noexcept;
  void collect_layer(std::size_t layer, const std::size_t (&strides)[3], double scale) noexcept;

  Vec3 center_ = Vec3::Zero();
  Mat3 to_grid_ = Mat3::Identity();                    // metres to cells
  Vec3 middle_ = Vec3::Constant(0.5 * kCellsPerAxis);  // grid coordinate of the centre
  double max_area_ = 0.0;
  std::array<double, kCellsPerNode> area_{};
  // Of the triangle in hand; all zero between two calls.
  std::array<Piece, kCellsPerNode> pieces_{};
  std::array<std::uint64_t, kCellsPerAxis> touched_{};  // by layer, a bit for each cell
};

}  // namespace odds::tree
