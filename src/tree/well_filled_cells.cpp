// Cutting triangles by the planes of a regular grid, and the areas of the pieces.
#include "odds/tree/well_filled_cells.hpp"

#include <algorithm>
#include <cmath>

#include "odds/math/tolerances.hpp"

namespace odds::tree {
namespace {

// A triangle cut by at most six planes has at most nine corners.
struct Polygon {
  static constexpr int kMaxCorners = 9;
  double corner[kMaxCorners + 1][3];
  int count = 0;

  void append(const double* point) noexcept {
    // Rounding can make a sliver slightly non-convex and yield one corner more per cut than geometry allows; such a
    // corner lies on its neighbour and may be dropped.
    if (count > kMaxCorners) return;
    for (int i = 0; i < 3; ++i) corner[count][i] = point[i];
    ++count;
  }
};

// Cell index of a grid coordinate; what lies outside belongs to the outermost cell. Safe for every value, NaN included.
int cell_of(double coordinate) noexcept {
  if (!(coordinate >= 1.0)) return 0;
  return coordinate < kCellsPerAxis - 1 ? static_cast<int>(coordinate) : kCellsPerAxis - 1;
}

struct Range {
  int first;
  int last;
};

Range cells_along(const Polygon& polygon, int axis) noexcept {
  double low = polygon.corner[0][axis];
  double high = low;
  for (int i = 1; i < polygon.count; ++i) {
    low = std::min(low, polygon.corner[i][axis]);
    high = std::max(high, polygon.corner[i][axis]);
  }
  return {cell_of(low), cell_of(high)};
}

// Both parts of a convex polygon on the two sides of the plane x_axis = plane.
void cut(const Polygon& polygon, int axis, double plane, Polygon& below, Polygon& above) noexcept {
  below.count = 0;
  above.count = 0;
  const double* previous = polygon.corner[polygon.count - 1];
  double previous_height = previous[axis] - plane;
  for (int i = 0; i < polygon.count; ++i) {
    const double* current = polygon.corner[i];
    const double height = current[axis] - plane;
    if ((height < 0.0 && previous_height > 0.0) || (height > 0.0 && previous_height < 0.0)) {
      const double t = previous_height / (previous_height - height);
      double crossing[3];
      for (int k = 0; k < 3; ++k) crossing[k] = previous[k] + t * (current[k] - previous[k]);
      crossing[axis] = plane;
      below.append(crossing);
      above.append(crossing);
    }
    if (height <= 0.0) below.append(current);
    if (height >= 0.0) above.append(current);
    previous = current;
    previous_height = height;
  }
}

// Area of the projection along `axis`, in grid units.
double projected_area(const Polygon& polygon, int axis) noexcept {
  const int u = axis == 2 ? 0 : axis + 1;
  const int v = axis == 0 ? 2 : axis - 1;
  double twice = 0.0;
  const double* origin = polygon.corner[0];
  for (int i = 2; i < polygon.count; ++i) {
    const double* p = polygon.corner[i - 1];
    const double* q = polygon.corner[i];
    twice += (p[u] - origin[u]) * (q[v] - origin[v]) - (p[v] - origin[v]) * (q[u] - origin[u]);
  }
  return 0.5 * std::fabs(twice);
}

// Spreads one triangle over the cells: slabs along x, rods along y, cells along z, each cut once.
class Slicer {
 public:
  // metres^2 per unit of area projected along `projection`.
  Slicer(double* cells, int projection, double scale) noexcept
      : cells_(cells), projection_(projection), scale_(scale) {}

  template <int Axis>
  void slice(const Polygon& polygon, std::size_t base) noexcept {
    if (polygon.count < 3) return;
    const Range range = cells_along(polygon, Axis);
    Polygon spare[2];
    Polygon piece;
    const Polygon* rest = &polygon;
    for (int k = range.first; k < range.last; ++k) {
      Polygon& above = spare[k & 1];
      cut(*rest, Axis, k + 1, piece, above);
      descend<Axis>(piece, base, k);
      rest = &above;
      if (above.count < 3) return;
    }
    descend<Axis>(*rest, base, range.last);
  }

 private:
  template <int Axis>
  void descend(const Polygon& piece, std::size_t base, int k) noexcept {
    const std::size_t cell = base * kCellsPerAxis + static_cast<std::size_t>(k);
    if constexpr (Axis == 2) {
      if (piece.count >= 3) cells_[cell] += scale_ * projected_area(piece, projection_);
    } else {
      slice<Axis + 1>(piece, cell);
    }
  }

  double* cells_;
  int projection_;
  double scale_;
};

}  // namespace

double max_section_area(const Vec3& sides) noexcept {
  double side[3] = {sides[0], sides[1], sides[2]};
  std::sort(side, side + 3);
  return side[2] * std::hypot(side[1], side[0]);
}

void CellCounter::begin(const Vec3& center, const Mat3& axes, const Vec3& half_extents) noexcept {
  center_ = center;
  to_box_ = axes.transpose();
  area_.fill(0.0);
  const double largest = half_extents.maxCoeff();
  const double thinnest = largest > 0.0 ? tolerances::thinnest_extent * largest : 1.0;
  Vec3 cell_sides;
  for (int i = 0; i < 3; ++i) {
    const bool widened = half_extents[i] < thinnest;
    const double half_extent = widened ? thinnest : half_extents[i];
    cell_sides[i] = 2.0 * half_extent / kCellsPerAxis;
    cells_per_metre_[i] = kCellsPerAxis / (2.0 * half_extent);
    middle_[i] = 0.5 * kCellsPerAxis + (widened ? 0.5 : 0.0);
  }
  max_area_ = max_section_area(cell_sides);
}

void CellCounter::add(const Vec3& a, const Vec3& b, const Vec3& c) noexcept {
  const Vec3 corner[3] = {to_box_ * (a - center_), to_box_ * (b - center_), to_box_ * (c - center_)};
  const Vec3 normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
  const double area = 0.5 * normal.norm();
  if (!(area > 0.0) || !std::isfinite(area)) return;

  Polygon triangle;
  for (const Vec3& x : corner) {
    const Vec3 grid = x.cwiseProduct(cells_per_metre_) + middle_;
    triangle.append(grid.data());
  }
  Range range[3];
  for (int axis = 0; axis < 3; ++axis) range[axis] = cells_along(triangle, axis);
  if (range[0].first == range[0].last && range[1].first == range[1].last && range[2].first == range[2].last) {
    area_[static_cast<std::size_t>((range[0].first * kCellsPerAxis + range[1].first) * kCellsPerAxis +
                                   range[2].first)] += area;
    return;
  }
  // All pieces lie in one plane: their areas relate to the triangle's as their projections do. The projection along the
  // largest component of the normal loses least.
  int projection = 0;
  normal.cwiseAbs().maxCoeff(&projection);
  const double whole = projected_area(triangle, projection);
  if (!(whole > 0.0)) return;
  Slicer(area_.data(), projection, area / whole).slice<0>(triangle, 0);
}

std::uint16_t CellCounter::count(double tau) const noexcept {
  const double threshold = tau * max_area_ * (1.0 - tolerances::cell_fill_slack);
  int filled = 0;
  for (const double area : area_) filled += area >= threshold ? 1 : 0;
  return static_cast<std::uint16_t>(filled);
}

double CellCounter::area(int x, int y, int z) const noexcept {
  return area_[static_cast<std::size_t>((x * kCellsPerAxis + y) * kCellsPerAxis + z)];
}

double CellCounter::total_area() const noexcept {
  double sum = 0.0;
  for (const double area : area_) sum += area;
  return sum;
}

}  // namespace odds::tree
