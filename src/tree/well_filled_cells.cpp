// The area of a triangle in each cell of a regular grid.
#include "odds/tree/well_filled_cells.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <utility>

#include "odds/math/tolerances.hpp"

namespace odds::tree {
namespace {

// Cell index of a grid coordinate; what lies outside belongs to the outermost cell. Safe for every value, NaN included.
int cell_of(double coordinate) noexcept {
  return static_cast<int>(std::min(kCellsPerAxis - 1.0, std::max(0.0, coordinate)));
}

// A corner in grid units: `w` along the axis of projection, `u` and `v` along the other two.
struct Point {
  double u;
  double v;
  double w;
};

// Where the line low -> high is at a level of w in between.
struct Side {
  Side(const Point& low, const Point& high) noexcept
      : low_(low), u_(high.u - low.u), v_(high.v - low.v), per_w_(1.0 / (high.w - low.w)) {}
  [[nodiscard]] Point at(double level) const noexcept {
    const double t = (level - low_.w) * per_w_;
    return {low_.u + t * u_, low_.v + t * v_, level};
  }

 private:
  Point low_;
  double u_;
  double v_;
  double per_w_;
};

// The places in (0, 1) where a coordinate that runs from `start` by `change` passes from one cell to the next; the one
// after the last is infinite.
struct Crossings {
  Crossings(int first, int last, double start, double end) noexcept
      : step(last > first ? 1 : -1), count(std::abs(last - first)) {
    const double per_change = 1.0 / (end - start);
    const double border = (last > first ? first + 1 : first) - start;
    for (int k = 0; k < kCellsPerAxis; ++k) place[k] = (border + k * step) * per_change;  // more than needed: no branch
    place[count] = std::numeric_limits<double>::infinity();
  }
  int step;
  int count;
  double place[kCellsPerAxis];
};

// Calls visit(cell, climb, share) for each piece of an edge within one cell: how far the edge climbs along v in it, and
// the area, projected along w, between it and the cell's far border along u. Cells are numbered in layers along w, rows
// along v, columns along u; an edge that stays in one layer is walked along u and v only.
template <bool across_layers, class Visit>
void walk(const Point& from, const Point& to, int layer, int last_layer, const Visit& visit) noexcept {
  const int column = cell_of(from.u);
  const int last_column = cell_of(to.u);
  const int row = cell_of(from.v);
  const int last_row = cell_of(to.v);
  const double run = to.u - from.u;
  const double rise = to.v - from.v;
  double border = column + 1 - from.u;
  double done = 0.0;
  int cell = (layer * kCellsPerAxis + row) * kCellsPerAxis + column;
  const auto go_to = [&](double place) {
    const double climb = (place - done) * rise;
    visit(static_cast<std::size_t>(cell), climb, climb * (border - 0.5 * (place + done) * run));
    done = place;
  };
  if (column != last_column || row != last_row || (across_layers && layer != last_layer)) {
    const Crossings along_u(column, last_column, from.u, to.u);
    const Crossings along_v(row, last_row, from.v, to.v);
    const double* u = along_u.place;
    const double* v = along_v.place;
    if constexpr (across_layers) {
      const Crossings along_w(layer, last_layer, from.w, to.w);
      const double* w = along_w.place;
      for (int steps = along_u.count + along_v.count + along_w.count; steps > 0; --steps) {
        const double place = std::min(std::min(*u, *v), *w);
        const int is_u = *u == place ? 1 : 0;
        const int is_v = *v == place ? 1 - is_u : 0;
        const int is_w = 1 - is_u - is_v;
        go_to(place);
        border += is_u * along_u.step;
        cell += is_u * along_u.step + kCellsPerAxis * (is_v * along_v.step + kCellsPerAxis * is_w * along_w.step);
        u += is_u;
        v += is_v;
        w += is_w;
      }
    } else {
      for (int steps = along_u.count + along_v.count; steps > 0; --steps) {
        const int is_u = *u < *v ? 1 : 0;
        go_to(std::min(*u, *v));
        border += is_u * along_u.step;
        cell += is_u * along_u.step + (1 - is_u) * kCellsPerAxis * along_v.step;
        u += is_u;
        v += 1 - is_u;
      }
    }
  }
  go_to(1.0);
}

// Share of a triangle's area below `level`; its corners' heights in ascending order, low < level < high.
double share_below(double low, double middle, double high, double level) noexcept {
  if (level <= middle) return (level - low) * (level - low) / ((high - low) * (middle - low));
  return 1.0 - (high - level) * (high - level) / ((high - low) * (high - middle));
}

constexpr std::size_t stride_of[3] = {kCellsPerAxis * kCellsPerAxis, kCellsPerAxis, 1};

}  // namespace

double max_section_area(const Vec3& sides) noexcept {
  double side[3] = {sides[0], sides[1], sides[2]};
  std::sort(side, side + 3);
  return side[2] * std::hypot(side[1], side[0]);
}

void CellCounter::begin(const Vec3& center, const Mat3& axes, const Vec3& half_extents) noexcept {
  center_ = center;
  area_.fill(0.0);
  const double largest = half_extents.maxCoeff();
  const double thinnest = largest > 0.0 ? tolerances::thinnest_extent * largest : 1.0;
  Vec3 cell_sides;
  for (int i = 0; i < 3; ++i) {
    const bool widened = half_extents[i] < thinnest;
    const double half_extent = widened ? thinnest : half_extents[i];
    cell_sides[i] = 2.0 * half_extent / kCellsPerAxis;
    to_grid_.row(i) = kCellsPerAxis / (2.0 * half_extent) * axes.col(i).transpose();
    middle_[i] = 0.5 * kCellsPerAxis + (widened ? 0.5 : 0.0);
  }
  max_area_ = max_section_area(cell_sides);
}

void CellCounter::add(const Vec3& a, const Vec3& b, const Vec3& c) noexcept {
  const double area = 0.5 * (b - a).cross(c - a).norm();
  if (!(area > 0.0) || !std::isfinite(area)) return;
  const Vec3 grid[3] = {to_grid_ * (a - center_) + middle_, to_grid_ * (b - center_) + middle_,
                        to_grid_ * (c - center_) + middle_};
  std::size_t first_cell = 0;
  int crossed_axes = 0;
  int crossed_axis = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const int cell = cell_of(std::min({grid[0][axis], grid[1][axis], grid[2][axis]}));
    first_cell += static_cast<std::size_t>(cell) * stride_of[axis];
    if (cell_of(std::max({grid[0][axis], grid[1][axis], grid[2][axis]})) != cell) {
      ++crossed_axes;
      crossed_axis = axis;
    }
  }
  if (crossed_axes == 0) {
    area_[first_cell] += area;
  } else if (crossed_axes == 1) {
    add_along(crossed_axis, grid[0][crossed_axis], grid[1][crossed_axis], grid[2][crossed_axis], first_cell, area);
  } else {
    add_across(grid, area);
  }
}

void CellCounter::add_along(int axis, double a, double b, double c, std::size_t cell, double area) noexcept {
  const double low = std::min({a, b, c});
  const double high = std::max({a, b, c});
  const double middle = std::max(std::min(a, b), std::min(std::max(a, b), c));
  const int last = cell_of(high);
  double below = 0.0;
  for (int k = cell_of(low); k < last; ++k, cell += stride_of[axis]) {
    const double share = share_below(low, middle, high, k + 1);
    area_[cell] += std::max(0.0, share - below) * area;
    below = share;
  }
  area_[cell] += std::max(0.0, 1.0 - below) * area;
}

// The triangle is cut into layers along one axis, and in each layer the area in every cell is found without making the
// pieces: it is the sum over the polygon's edges, with sign, of what lies between an edge and the far side of the grid.
// An edge gives each cell that it crosses the share to its right there, and all cells further right in that row the
// full height that it climbs in the cell; the latter is carried by a running sum.
void CellCounter::add_across(const Vec3 (&grid)[3], double area) noexcept {
  // All pieces lie in one plane: their areas relate to the triangle's as their projections do. The largest projection
  // loses least, and crosses the fewest layers.
  const Vec3 normal = (grid[1] - grid[0]).cross(grid[2] - grid[0]);
  if (!normal.allFinite()) return;  // too far off to be counted in cells so small
  int w = 0;
  normal.cwiseAbs().maxCoeff(&w);
  const int u = w == 2 ? 1 : 2;
  const int v = w == 0 ? 1 : 0;
  Point low{grid[0][u], grid[0][v], grid[0][w]};
  Point middle{grid[1][u], grid[1][v], grid[1][w]};
  Point high{grid[2][u], grid[2][v], grid[2][w]};
  if (middle.w < low.w) std::swap(low, middle);
  if (high.w < low.w) std::swap(low, high);
  if (high.w < middle.w) std::swap(middle, high);
  // The edges are summed in the order low, high, middle; a sum over edges is minus the area in counter-clockwise order.
  const double twice = (middle.u - low.u) * (high.v - low.v) - (high.u - low.u) * (middle.v - low.v);
  if (!(std::fabs(twice) > 0.0)) return;

  const auto add_piece = [this](std::size_t cell, double climb, double share) {
    pieces_[cell].share += share;
    pieces_[cell].climb += climb;
    touched_[cell / cells_per_layer] |= std::uint64_t{1} << cell % cells_per_layer;
  };
  const int first = cell_of(low.w);
  const int bend = cell_of(middle.w);
  const int last = cell_of(high.w);
  const auto add_edge = [&](const Point& from, const Point& to, int layer, int last_layer) {
    if (layer == last_layer) {
      walk<false>(from, to, layer, layer, add_piece);
    } else {
      walk<true>(from, to, layer, last_layer, add_piece);
    }
  };
  add_edge(low, high, first, last);
  add_edge(high, middle, last, bend);
  add_edge(middle, low, bend, first);
  const Side straight(low, high);
  const Side lower(low, middle);
  const Side upper(middle, high);
  for (int k = first; k < last; ++k) {
    const double level = k + 1;
    const Point from = straight.at(level);
    const Point to = level <= middle.w ? lower.at(level) : upper.at(level);
    walk<false>(from, to, k, k, [this](std::size_t cell, double climb, double share) {
      const std::uint64_t bit = std::uint64_t{1} << cell % cells_per_layer;
      pieces_[cell].share += share;
      pieces_[cell].climb += climb;
      touched_[cell / cells_per_layer] |= bit;
      pieces_[cell + cells_per_layer].share -= share;
      pieces_[cell + cells_per_layer].climb -= climb;
      touched_[cell / cells_per_layer + 1] |= bit;
    });
  }
  const std::size_t strides[3] = {stride_of[u], stride_of[v], stride_of[w]};
  for (int k = first; k <= last; ++k) collect_layer(static_cast<std::size_t>(k), strides, 2.0 * area / twice);
}

void CellCounter::collect_layer(std::size_t layer, const std::size_t (&strides)[3], double scale) noexcept {
  const std::uint64_t touched = std::exchange(touched_[layer], 0);
  for (std::size_t row = 0; row < kCellsPerAxis; ++row) {
    const auto columns = static_cast<std::uint8_t>(touched >> row * kCellsPerAxis);
    if (columns == 0) continue;
    const auto first = static_cast<std::size_t>(std::countr_zero(columns));
    const auto end = static_cast<std::size_t>(std::bit_width(columns));
    Piece* pieces = pieces_.data() + layer * cells_per_layer + row * kCellsPerAxis;
    double* cells = area_.data() + layer * strides[2] + row * strides[1];
    double height = 0.0;
    for (std::size_t i = first; i < end; ++i) {
      // Rounding may leave a trace below zero where there is nothing.
      cells[i * strides[0]] += std::max(0.0, scale * (height + pieces[i].share));
      height += pieces[i].climb;
      pieces[i] = {};
    }
  }
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
