// One piece of rim has no area: the direction is that of least overlap among the faces' normals, their mean and the
// last run's normal, and where that is a long way the line in which two walls cross (see normal.cpp).
#include "query/patch/one_pair.hpp"

#include <algorithm>
#include <cmath>

#include "odds/math/tolerances.hpp"
#include "query/patch/directions.hpp"

namespace odds::query::patch {
namespace {

/// The pair's piece of rim, unless there are more or its ends are one point.
bool cut_one(const PatchInput& input, const PlacedPair& placed, RimPiece& piece) noexcept {
  std::array<RimPiece, most_pieces_of_a_pair> pieces;
  if (rim_pieces(placed, input.solid_a && input.solid_b, 0, pieces) != 1) return false;
  piece = pieces[0];
  const double extent = 0.5 * piece.along().cwiseAbs().maxCoeff();
  const double reach = piece.from.cwiseAbs().maxCoeff();
  const double same_point = std::max(tolerances::same_joint * extent, tolerances::on_plane * reach);
  return piece.from.allFinite() && piece.to.allFinite() && 2.0 * extent > same_point;
}

/// Up to eight directions.
struct Asked {
  std::array<Vec3, eight> of;
  std::size_t count = 0;

  /// Also turned round if a surface has no outside. One too many, or without a length, is left out.
  void add(const Vec3& direction, bool both_ways) noexcept {
    const Vec3 unit = unit_or_zero(direction);
    if (unit == Vec3::Zero() || count + (both_ways ? 2 : 1) > of.size()) return;
    of[count++] = unit;
    if (both_ways) of[count++] = -unit;
  }
  [[nodiscard]] std::span<const Vec3> all() const noexcept { return {of.data(), count}; }
};

/// The faces' normals, their mean, which is along their difference, the last run's normal. A solid's lead out of it;
/// those of a sheet may be turned either way.
Asked candidates(const PatchInput& input, const PlacedPair& placed, const Vec3& difference) noexcept {
  Asked asked;
  Directions faces;
  Directions sheets;
  (input.solid_b ? faces : sheets).add(placed.normal_b, 1.0);
  (input.solid_a ? faces : sheets).add(-placed.normal_a, 1.0);
  for (std::size_t i = 0; i < faces.count; ++i) asked.add(faces.ones[i].mean(), false);
  for (std::size_t i = 0; i < sheets.count; ++i) asked.add(sheets.ones[i].mean(), true);
  asked.add(difference, !input.solid_a && !input.solid_b);
  if (input.previous_normal != nullptr) asked.add(*input.previous_normal, false);
  return asked;
}

/// The direction of least overlap of those that were offered.
class Least {
 public:
  Least(const PatchInput& input, const Vec3& side) noexcept : input_(input), side_(side) {}

  void offer(const Asked& asked, std::size_t from, std::size_t to, const CornersOfEight& corners) noexcept {
    for (std::size_t i = from; i < to; ++i) {
      if (asked.of[i].dot(side_) < -tolerances::weak_side) continue;  // towards the wrong side of a sheet
      const double overlap = hysteresis_of(input_, asked.of[i]) * corners.deepest[i];
      if (found_ && !(overlap < least_)) continue;
      found_ = true;
      least_ = overlap;
      best_ = i;
    }
  }
  [[nodiscard]] bool found() const noexcept { return found_; }
  [[nodiscard]] std::size_t best() const noexcept { return best_; }

 private:
  const PatchInput& input_;
  const Vec3& side_;
  double least_ = 0.0;
  std::size_t best_ = 0;
  bool found_ = false;
};

/// The direction, or the flat face that it is about, as snap_to_face has it. Between two that carry all of the rim it
/// stays what it was found to be.
Vec3 snapped(const PatchInput& input, const PlacedPair& placed, const Vec3& direction) noexcept {
  const Facing facing{direction, input.solid_a, input.solid_b};
  const Vec3 face_b = facing.of_b(placed);
  const Vec3 face_a = facing.of_a(placed);
  Directions faces;
  faces.add(face_b, 1.0);
  faces.add(face_a, 1.0);
  if (faces.count != 1) return direction;
  const Vec3 flat = unit_or_zero(faces.ones[0].sum);
  const double by_b = flatness(face_b, flat);
  const double by_a = flatness(face_a, flat);
  return snapped_to(by_b * face_b + by_a * face_a, std::max(by_b, by_a), direction);
}

/// Over the middle of the rim, at the height of the deepest place.
Contact contact_along(const PlacedPair& placed, const RimPiece& piece, const Vec3& direction,
                      const CornersOfEight& corners, std::size_t lane) noexcept {
  Contact contact{piece.middle(), direction, corners.deepest[lane], placed.index.a, placed.index.b};
  for (std::size_t kind = 0; kind < CornersOfEight::kinds; ++kind) {
    if ((corners.found[kind] >> lane & 1U) == 0 || corners.depth[kind][lane] != contact.depth) continue;
    const Vec3 deepest = corners.witness(placed, direction, kind, lane).middle();
    contact.position += direction.dot(deepest - contact.position) * direction;
    break;
  }
  return contact;
}

}  // namespace

std::optional<Contact> contact_of_one_pair(const PatchInput& input, const Kernels& kernels) noexcept {
  PlacedPair placed;
  if (kernels.place(input, input.hits.first(1), &placed) != 1) return std::nullopt;
  RimPiece piece;
  if (!cut_one(input, placed, piece)) return std::nullopt;
  const bool solid = input.solid_a && input.solid_b;
  const Vec3 side = side_of_bodies(input, piece.middle());
  const Vec3 line = placed.normal_b.cross(placed.normal_a);
  const double steepness = line.norm();
  const Vec3 difference = difference_of_normals(input, placed.normal_a, placed.normal_b, side);

  Asked asked = candidates(input, placed, difference);
  const std::size_t usual = asked.count;
  // Along walls: only of solids, for of a sheet the rim says nothing of what is missing.
  if (solid && steepness > tolerances::steep) asked.add(line, true);
  const Vec3 pressing = pressing_direction(input, difference, side);
  const double size = std::min((placed.a[1] - placed.a[0]).norm(), (placed.b[1] - placed.b[0]).norm());
  CornersOfEight pressed;
  kernels.corners_along(placed, asked.all(), -tolerances::pressing_share * size * pressing, pressed);
  Least least(input, side);
  least.offer(asked, 0, usual, pressed);
  if (!least.found()) return std::nullopt;

  // As they are: along what was found, along the walls, and along the faces that these are about.
  Asked ways;
  ways.add(asked.of[least.best()], false);
  for (std::size_t i = usual; i < asked.count; ++i) ways.add(asked.of[i], false);
  const std::size_t count = ways.count;
  for (std::size_t i = 0; i < count; ++i) ways.of[ways.count++] = snapped(input, placed, ways.of[i]);
  CornersOfEight as_they_are;
  kernels.corners_along(placed, ways.all(), Vec3::Zero(), as_they_are);
  std::size_t way = 0;
  const double rounding = tolerances::rim_noise * piece.middle().cwiseAbs().maxCoeff();
  if (solid && as_they_are.deepest[0] > piece.length + rounding) {
    if (usual < asked.count) {
      least.offer(asked, usual, asked.count, pressed);
      if (least.best() >= usual) way = least.best() - usual + 1;
    } else if (steepness < tolerances::flat_from && placed.normal_a.dot(placed.normal_b) > 0.0) {
      return std::nullopt;
    }
  }
  // A flat face's normal is the better one, but not the longer way out of a lump.
  std::size_t chosen = count + way;
  const double wide = (solid ? 1.0 : tolerances::lump_depth) * piece.length;
  if (as_they_are.deepest[chosen] > wide && as_they_are.deepest[way] < as_they_are.deepest[chosen]) chosen = way;
  const Contact contact = contact_along(placed, piece, ways.of[chosen], as_they_are, chosen);
  return contact.position.allFinite() ? std::optional(contact) : std::nullopt;
}

}  // namespace odds::query::patch
