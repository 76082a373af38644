// Union-find over the ends of rim pieces, then a few merges among at most 32 curves.
#include "query/patch/components.hpp"

#include <algorithm>
#include <cmath>

#include "odds/math/random.hpp"
#include "odds/math/tolerances.hpp"

namespace odds::query::patch {
namespace {

std::size_t table_size(std::size_t entries) noexcept {
  std::size_t size = 64;
  while (size < 2 * entries) size *= 2;
  return size;
}

bool boxes_meet(const RimSums& i, const RimSums& j, double margin) noexcept {
  return ((i.lower.array() - margin) <= j.upper.array()).all() && ((j.lower.array() - margin) <= i.upper.array()).all();
}

Vec3 direction_of(const Vec3& v) noexcept {
  const double length = v.norm();
  return length > 0.0 ? Vec3(v / length) : Vec3::Zero();
}

}  // namespace

void RimSums::add(const RimPiece& piece, const PlacedPair& placed, const Vec3& origin) noexcept {
  lower = lower.cwiseMin(piece.from).cwiseMin(piece.to);
  upper = upper.cwiseMax(piece.from).cwiseMax(piece.to);
  const Vec3 from = piece.from - origin;
  const Vec3 to = piece.to - origin;
  area += 0.5 * from.cross(to);
  gap += to - from;
  const Vec3 weighed = piece.length * 0.5 * (from + to);
  moment += weighed;
  normals_a += piece.length * placed.normal_a;
  normals_b += piece.length * placed.normal_b;
  heights_a += weighed.dot(placed.normal_a);
  heights_b += weighed.dot(placed.normal_b);
  length += piece.length;
}

void RimSums::add(const RimSums& other) noexcept {
  lower = lower.cwiseMin(other.lower);
  upper = upper.cwiseMax(other.upper);
  area += other.area;
  gap += other.gap;
  moment += other.moment;
  normals_a += other.normals_a;
  normals_b += other.normals_b;
  heights_a += other.heights_a;
  heights_b += other.heights_b;
  length += other.length;
  loose_ends += other.loose_ends;
}

Vec3 RimSums::centre(const Vec3& origin) const noexcept {
  if (length > 0.0) return origin + moment / length;
  return 0.5 * (lower + upper);
}

Vec3 RimSums::vector_area(const Vec3& origin) const noexcept {
  return area - 0.5 * (centre(origin) - origin).cross(gap);
}

double RimSums::bulge(bool of_b) const noexcept {
  if (!(length > 0.0)) return 0.0;
  const double heights = of_b ? heights_b : heights_a;
  const Vec3& normals = of_b ? normals_b : normals_a;
  return (heights - normals.dot(moment) / length) / length;
}

Components::Components(std::size_t most_pieces, std::size_t most_pairs)
    : joints_(2 * most_pieces),
      joint_table_(table_size(2 * most_pieces)),
      copy_table_(table_size(most_pieces)),
      triangle_table_(table_size(2 * most_pairs)),
      ends_(most_pieces),
      piece_parents_(most_pieces),
      curve_of_root_(most_pieces),
      curves_(most_pieces),
      order_(most_pieces),
      curve_parents_(most_pieces),
      patch_of_curve_(most_pieces),
      patches_(most) {}

std::span<const RimSums> Components::group(const Rim& rim, bool solid_a, bool solid_b, Watch& watch) noexcept {
  if (rim.pieces.empty()) return {};
  prepare(rim, watch);
  if (watch.late()) return {};
  connect(rim, watch);
  if (watch.late()) return {};
  sum_up(rim, watch);
  if (watch.late()) return {};
  keep_the_longest(watch);
  if (watch.late()) return {};
  join_open_curves(rim, watch);
  if (watch.late()) return {};
  join_holes(rim, solid_a, solid_b, watch);
  if (watch.late()) return {};
  join_neighbours(rim, watch);
  if (watch.late()) return {};
  settle(rim, watch);
  if (watch.late()) return {};
  return {patches_.data(), kept_};
}

/// Joints stand in cells of a grid; a point near the border of its cell is looked for beyond it as well.
std::uint32_t Components::find_beyond(const Vec3& point, const Vec3& cells) const noexcept {
  const Cell low = cell_of(cells - Vec3::Constant(near_border));
  const Cell high = cell_of(cells + Vec3::Constant(near_border));
  std::uint32_t known = left_out;
  for (unsigned corner = 0; corner < 8 && known == left_out; ++corner) {
    known = find_joint(point, slot_of({(corner & 1U) != 0 ? high[0] : low[0], (corner & 2U) != 0 ? high[1] : low[1],
                                       (corner & 4U) != 0 ? high[2] : low[2]}));
  }
  return known;
}

/// The joint at a point; a new one if none is near.
std::uint32_t Components::joint_at(const Vec3& point, std::uint32_t piece) noexcept {
  // Shifted by an odd amount, so that rims in planes of round coordinates do not lie on the borders of cells.
  const Vec3 cells = cells_per_metre_ * point + Vec3::Constant(0.3819660);
  const std::size_t home = slot_of(cell_of(cells));
  const std::uint32_t known = find_joint(point, home);
  if (known != left_out) return known;
  const auto off_middle = [](double x) noexcept { return std::abs(x - ((x + to_integer) - to_integer)); };
  const double farthest = std::max({off_middle(cells.x()), off_middle(cells.y()), off_middle(cells.z())});
  if (!(farthest < 0.5 - near_border)) {
    const std::uint32_t beyond = find_beyond(point, cells);
    if (beyond != left_out) return beyond;
  }
  std::size_t slot = home;
  while (joint_table_[slot] != 0) slot = (slot + 1) & joint_mask_;
  const auto joint = static_cast<std::uint32_t>(joint_count_++);
  joints_[joint] = {point, 0, piece, left_out};
  joint_table_[slot] = joint + 1;
  return joint;
}

/// Remembers a directed piece; true if the same was there before. Of nearly all joints one piece leaves: only others
/// are looked up.
bool Components::is_copy(std::uint32_t from, std::uint32_t to) noexcept {
  std::uint32_t& first = joints_[from].leads_to;
  if (first == left_out) {
    first = to;
    return false;
  }
  return first == to || is_another_copy(from, to);
}

bool Components::is_another_copy(std::uint32_t from, std::uint32_t to) noexcept {
  const std::uint64_t key = (static_cast<std::uint64_t>(from + 1) << 32U) | (to + 1);
  const std::size_t mask = copy_mask_;
  std::size_t slot = static_cast<std::size_t>(math::scramble(key)) & mask;
  for (; copy_table_[slot] != 0; slot = (slot + 1) & mask) {
    if (copy_table_[slot] == key) return true;
  }
  copy_table_[slot] = key;
  return false;
}

void Components::prepare(const Rim& rim, Watch& watch) noexcept {
  double extent = 0.0;
  double reach = 0.0;
  for (std::size_t i = 0; i < rim.pieces.size() && !watch.late_in_small_steps(i); ++i) {
    const RimPiece& piece = rim.pieces[i];
    extent = std::max(extent, (piece.from - rim.origin).cwiseAbs().maxCoeff());
    extent = std::max(extent, (piece.to - rim.origin).cwiseAbs().maxCoeff());
    reach = std::max(reach, piece.from.cwiseAbs().maxCoeff());
  }
  same_point_ = std::max(tolerances::same_joint * extent, tolerances::on_plane * reach);
  const double cell = same_points_per_cell * same_point_;
  cells_per_metre_ = cell > 1e-290 ? 1.0 / cell : 0.0;  // so small a rim is one cell
  joint_mask_ = table_size(2 * rim.pieces.size()) - 1;  // only as much of the tables as is needed, for clearing costs
  copy_mask_ = table_size(rim.pieces.size()) - 1;
  std::fill_n(joint_table_.begin(), joint_mask_ + 1, 0U);
  std::fill_n(copy_table_.begin(), copy_mask_ + 1, std::uint64_t{0});
  joint_count_ = 0;
}

void Components::connect(const Rim& rim, Watch& watch) noexcept {
  for (std::uint32_t i = 0; i < rim.pieces.size() && !watch.late(i); ++i) {
    piece_parents_[i] = i;
    RimPiece& piece = rim.pieces[i];
    const std::uint32_t from = joint_at(piece.from - rim.origin, i);
    const std::uint32_t to = joint_at(piece.to - rim.origin, i);
    ends_[i] = {from, to};
    for (const std::uint32_t joint : {from, to}) {
      if (joints_[joint].first_piece == i) continue;
      const std::uint32_t here = root(piece_parents_, i);
      const std::uint32_t there = root(piece_parents_, joints_[joint].first_piece);
      piece_parents_[std::max(here, there)] = std::min(here, there);
    }
    piece.counts = from != to && !is_copy(from, to);
    if (!piece.counts) continue;
    ++joints_[from].balance;
    --joints_[to].balance;
  }
}

void Components::sum_up(const Rim& rim, Watch& watch) noexcept {
  curve_count_ = 0;
  for (std::uint32_t i = 0; i < rim.pieces.size() && !watch.late(i); ++i) {
    const std::uint32_t top = root(piece_parents_, i);
    if (top == i) {
      curve_of_root_[i] = static_cast<std::uint32_t>(curve_count_);
      curves_[curve_count_++] = RimSums{};
    }
    RimPiece& piece = rim.pieces[i];
    piece.component = curve_of_root_[top];
    RimSums& curve = curves_[piece.component];
    if (piece.counts) {
      curve.add(piece, rim.pairs[piece.pair], rim.origin);
    } else {
      curve.lower = curve.lower.cwiseMin(piece.from);
      curve.upper = curve.upper.cwiseMax(piece.from);
    }
  }
  for (std::size_t j = 0; j < joint_count_ && !watch.late_in_small_steps(j); ++j) {
    if (joints_[j].balance != 0) ++curves_[rim.pieces[joints_[j].first_piece].component].loose_ends;
  }
}

/// The longest curves stay, the longest first.
void Components::keep_the_longest(Watch& watch) noexcept {
  for (std::uint32_t i = 0; i < curve_count_; ++i) {
    order_[i] = i;
    curve_parents_[i] = i;
  }
  kept_ = std::min(curve_count_, most);
  const std::size_t sorted = std::min(curve_count_, most_compared);
  const auto longer = [this](std::uint32_t i, std::uint32_t j) {
    if (curves_[i].length != curves_[j].length) return curves_[i].length > curves_[j].length;
    return i < j;
  };
  std::partial_sort(order_.begin(), order_.begin() + static_cast<std::ptrdiff_t>(sorted),
                    order_.begin() + static_cast<std::ptrdiff_t>(curve_count_), longer);
  if (sorted > most) spread_equals({order_.data(), sorted}, watch);
}

/// Of curves that are about as long as the last that stays, those stay that are far from each other and from what is
/// longer: or rounding would leave a body on many feet those of one side.
void Components::spread_equals(std::span<std::uint32_t> sorted, Watch& watch) noexcept {
  const auto length = [this](std::uint32_t curve) noexcept { return curves_[curve].length; };
  const double last = length(sorted[most - 1]);
  // Of a rim in crumbs, or of points, lengths say nothing of who is equal.
  if (!curves_[sorted[most - 1]].closed() || last == 0.0) return;
  std::size_t taken = 0;
  while (length(sorted[taken]) > (1.0 + tolerances::equal_curves) * last) ++taken;
  std::size_t end = most;
  while (end < sorted.size() && length(sorted[end]) >= (1.0 - tolerances::equal_curves) * last) ++end;
  if (end == most) return;
  const auto middle = [this](std::uint32_t curve) noexcept {
    return Vec3(0.5 * (curves_[curve].lower + curves_[curve].upper));
  };
  std::array<double, most_compared> nearest;  // of those that are taken
  nearest.fill(std::numeric_limits<double>::infinity());
  const auto note = [&](std::uint32_t curve) noexcept {
    const Vec3 place = middle(curve);
    for (std::size_t i = taken; i < end; ++i) {
      nearest[i] = std::min(nearest[i], (middle(sorted[i]) - place).squaredNorm());
    }
  };
  for (std::size_t i = 0; i < taken; ++i) note(sorted[i]);
  for (; taken < most && !watch.late(); ++taken) {
    const auto first = nearest.begin() + static_cast<std::ptrdiff_t>(taken);
    const auto best = static_cast<std::size_t>(
        std::max_element(first, nearest.begin() + static_cast<std::ptrdiff_t>(end)) - nearest.begin());
    std::swap(sorted[taken], sorted[best]);
    std::swap(nearest[taken], nearest[best]);
    note(sorted[taken]);
  }
}

/// The curves that stand for what was kept and joined, each once.
std::span<const std::uint32_t> Components::roots() noexcept {
  std::size_t count = 0;
  for (std::size_t k = 0; k < kept_; ++k) {
    const std::uint32_t top = root(curve_parents_, order_[k]);
    const auto end = roots_.begin() + static_cast<std::ptrdiff_t>(count);
    if (std::find(roots_.begin(), end, top) == end) roots_[count++] = top;
  }
  return {roots_.data(), count};
}

void Components::join(std::uint32_t i, std::uint32_t j) noexcept {
  i = root(curve_parents_, i);
  j = root(curve_parents_, j);
  if (i == j) return;
  if (curves_[j].length > curves_[i].length || (curves_[j].length == curves_[i].length && j < i)) std::swap(i, j);
  curve_parents_[j] = i;
  curves_[i].add(curves_[j]);
}

/// Pieces of a rim of which parts are missing belong together if one triangle carries both.
void Components::join_open_curves(const Rim& rim, Watch& watch) noexcept {
  bool any = false;
  for (std::size_t i = 0; i < kept_; ++i) any = any || !curves_[order_[i]].closed();
  if (!any) return;
  const std::size_t mask = table_size(2 * rim.pairs.size()) - 1;
  std::fill_n(triangle_table_.begin(), mask + 1, std::uint64_t{0});
  for (std::size_t i = 0; i < rim.pieces.size() && !watch.late(i); ++i) {
    const RimPiece& piece = rim.pieces[i];
    const std::uint32_t top = root(curve_parents_, piece.component);
    if (curves_[top].closed()) continue;
    const TrianglePair& index = rim.pairs[piece.pair].index;
    for (const std::uint64_t triangle : {std::uint64_t{index.a} * 2 + 1, std::uint64_t{index.b} * 2 + 2}) {
      std::size_t slot = static_cast<std::size_t>(math::scramble(triangle)) & mask;
      while (triangle_table_[slot] != 0 && (triangle_table_[slot] >> 24U) != triangle) slot = (slot + 1) & mask;
      if (triangle_table_[slot] == 0) {
        triangle_table_[slot] = (triangle << 24U) | piece.component;
      } else {
        join(piece.component, static_cast<std::uint32_t>(triangle_table_[slot] & 0xffffffU));
      }
    }
  }
}

/// The inner rim of a ring (a pipe's end on a plane) runs the other way round: its vector area points against the
/// normals along it. It belongs to the smallest curve around it.
void Components::join_holes(const Rim& rim, bool solid_a, bool solid_b, Watch& watch) noexcept {
  if (!solid_a && !solid_b) return;
  const std::span<const std::uint32_t> all = roots();
  for (const std::uint32_t hole : all) {
    if (watch.late()) return;
    const RimSums& inner = curves_[hole];
    if (curve_parents_[hole] != hole || !inner.closed() || inner.length == 0.0) continue;
    // Turning a sheet around turns its normals and the rim: only the comparison with its own normals stays.
    Vec3 outwards = Vec3::Zero();
    if (solid_a) outwards += inner.normals_b;
    if (solid_b) outwards -= inner.normals_a;
    const double with = direction_of(inner.vector_area(rim.origin)).dot(outwards);
    if (with > -tolerances::hole_rim * inner.length) continue;
    std::uint32_t around = hole;
    for (const std::uint32_t other : all) {
      if (other == hole || curve_parents_[other] != other || curves_[other].length <= inner.length) continue;
      if (!boxes_meet(curves_[other], inner, 0.1 * inner.diagonal())) continue;
      if (around == hole || curves_[other].length < curves_[around].length) around = other;
    }
    if (around != hole) join(around, hole);
  }
}

/// Two curves of nearly the same normal that overlap are one contact (faces that are flush, rims that are doubled).
void Components::join_neighbours(const Rim& rim, Watch& watch) noexcept {
  const std::span<const std::uint32_t> all = roots();
  for (std::size_t k = 0; k < all.size() && !watch.late(); ++k) {
    for (std::size_t m = k + 1; m < all.size(); ++m) {
      const std::uint32_t i = root(curve_parents_, all[k]);
      const std::uint32_t j = root(curve_parents_, all[m]);
      if (i == j) continue;
      const RimSums& first = curves_[i];
      const RimSums& second = curves_[j];
      const double margin = tolerances::neighbour_share * (first.diagonal() + second.diagonal());
      if (!boxes_meet(first, second, margin)) continue;
      const bool no_direction = second.length == 0.0 || !second.closed();
      const double agreement =
          direction_of(first.vector_area(rim.origin)).dot(direction_of(second.vector_area(rim.origin)));
      if (no_direction || agreement > tolerances::same_normal) join(i, j);
    }
  }
}

void Components::settle(const Rim& rim, Watch& watch) noexcept {
  std::fill_n(patch_of_curve_.begin(), curve_count_, left_out);
  std::uint32_t patches = 0;
  for (const std::uint32_t curve : roots()) {
    patches_[patches] = curves_[curve];
    patch_of_curve_[curve] = patches++;
  }
  for (std::size_t i = 0; i < rim.pieces.size() && !watch.late_in_small_steps(i); ++i) {
    RimPiece& piece = rim.pieces[i];
    piece.component = patch_of_curve_[root(curve_parents_, piece.component)];
  }
  kept_ = patches;
}

}  // namespace odds::query::patch
