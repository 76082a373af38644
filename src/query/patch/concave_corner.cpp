// Bundles of normals by farthest-first traversal (Gonzalez, Clustering to minimize the maximum intercluster distance,
// 1985), and one patch for each side where they form a corner.
#include "query/patch/concave_corner.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "odds/math/tolerances.hpp"
#include "query/patch/directions.hpp"
#include "query/patch/scratch.hpp"

namespace odds::query {
namespace patch {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

double angle_of(double cosine) noexcept { return std::acos(std::clamp(cosine, -1.0, 1.0)); }

/// Whether a piece says where a face is: no copy, nor a point.
bool tells(const RimPiece& piece, const Vec3& normal) noexcept {
  return piece.counts && piece.length > 0.0 && normal != Vec3::Zero();
}

}  // namespace

bool ConcaveCorner::may_be_of(bool of_b, const PatchInput& input, const RimSums& sums) noexcept {
  if (!input.solid_a && !input.solid_b) return false;  // nothing says which side of a sheet is its front
  const double bulge = sums.bulge(of_b);
  const double size = sums.diagonal();
  if (!(std::abs(bulge) > tolerances::corner_bulge * size)) return false;  // one face
  return bulge < tolerances::edge_bulge * size || !(of_b ? input.solid_b : input.solid_a);
}

/// Out of the body; of a sheet, to the side on which the other body is.
Vec3 ConcaveCorner::normal_of(const RimPiece& piece) const noexcept {
  const PlacedPair& placed = rim_.pairs[piece.pair];
  const Vec3& normal = of_b_ ? placed.normal_b : placed.normal_a;
  if (of_b_ ? input_.solid_b : input_.solid_a) return normal;
  const double facing = normal.dot(side_of_bodies(input_, piece.middle()));
  return (of_b_ ? facing : -facing) < 0.0 ? Vec3(-normal) : normal;
}

/// Begins a face with each normal that is far from all before it, and deals the pieces out to the nearest: `component`
/// is a piece's face from here on. False if there is but one.
bool ConcaveCorner::seed(Pieces pieces, Watch& watch) noexcept {
  Vec3 next = Vec3::Zero();
  for (std::size_t i = 0; i < pieces.size() && next == Vec3::Zero(); ++i) {
    if (const Vec3 normal = normal_of(rim_.pieces[pieces[i]]); tells(rim_.pieces[pieces[i]], normal)) next = normal;
  }
  if (next == Vec3::Zero()) return false;
  double least = -1.0;
  for (count_ = 0; count_ < most && least < tolerances::corner_bend && !watch.late(); ++count_) {
    const auto last = static_cast<std::uint32_t>(count_);
    const Vec3 begun = next;
    faces_[last].exit.direction = begun;
    least = 1.0;
    for (std::size_t i = 0; i < pieces.size() && !watch.late_in_small_steps(i); ++i) {
      RimPiece& piece = rim_.pieces[pieces[i]];
      const Vec3 normal = normal_of(piece);
      if (last == 0) piece.component = 0;
      double cosine = normal.dot(faces_[piece.component].exit.direction);
      if (const double to_last = normal.dot(begun); to_last > cosine) {
        piece.component = last;
        cosine = to_last;
      }
      if (!(cosine < least) || !tells(piece, normal)) continue;
      least = cosine;
      next = normal;
    }
  }
  return count_ > 1 && !watch.late();
}

/// Whether any face reaches in front of another, or lies at several heights, before more is made of them: most do not,
/// as of two bricks that lie askew.
bool ConcaveCorner::any_in_front(Pieces pieces, Watch& watch) const noexcept {
  struct Light {
    Vec3 moment = Vec3::Zero();
    double length = 0.0;
    double low = infinity;
    double high = -infinity;
  };
  std::array<Light, most> faces;
  for (std::size_t i = 0; i < pieces.size() && !watch.late_in_small_steps(i); ++i) {
    const RimPiece& piece = rim_.pieces[pieces[i]];
    if (!piece.counts) continue;
    Light& face = faces[piece.component];
    const Vec3 place = piece.middle() - rim_.origin;
    const double height = faces_[piece.component].exit.direction.dot(place);
    face.moment += piece.length * place;
    face.length += piece.length;
    face.low = std::min(face.low, height);
    face.high = std::max(face.high, height);
  }
  for (std::size_t i = 0; i < count_; ++i) {
    if (faces[i].high - faces[i].low > tolerances::level_face * sums_.diagonal()) return true;
    for (std::size_t j = 0; j < count_; ++j) {
      const Vec3 way = faces[j].moment / faces[j].length - faces[i].moment / faces[i].length;
      if (i != j && !(faces_[i].exit.direction.dot(way) <= 0.0)) return true;
    }
  }
  return false;
}

/// Sums up the faces. Pieces without a normal are taken off them.
void ConcaveCorner::gather(Pieces pieces, Watch& watch) noexcept {
  std::array<Vec3, most> normals;
  normals.fill(Vec3::Zero());
  for (std::size_t k = 0; k < count_; ++k) {
    faces_[k] = CornerFace{};
    faces_[k].exit = {Vec3::Zero(), rim_.origin, infinity, -infinity, of_b_};
  }
  for (std::size_t i = 0; i < pieces.size() && !watch.late_in_small_steps(i); ++i) {
    RimPiece& piece = rim_.pieces[pieces[i]];
    const Vec3 normal = normal_of(piece);
    if (normal == Vec3::Zero()) piece.component = most;
    if (piece.component == most) continue;
    CornerFace& face = faces_[piece.component];
    ++face.pieces;
    if (!tells(piece, normal)) continue;
    normals[piece.component] += piece.length * normal;
    face.sums.add(piece, rim_.pairs[piece.pair], rim_.origin);
  }
  for (std::size_t k = 0; k < count_; ++k) faces_[k].exit.direction = unit_or_zero(normals[k]);
  for (std::size_t i = 0; i < pieces.size() && !watch.late_in_small_steps(i); ++i) {
    const RimPiece& piece = rim_.pieces[pieces[i]];
    const Vec3 normal = normal_of(piece);
    if (!tells(piece, normal)) continue;
    CornerFace& face = faces_[piece.component];
    const double height = face.exit.direction.dot(piece.middle() - rim_.origin);
    face.exit.low = std::min(face.exit.low, height);
    face.exit.high = std::max(face.exit.high, height);
    face.spread = std::max(face.spread, 1.0 - normal.dot(face.exit.direction));
  }
  for (std::size_t k = 0; k < count_; ++k) faces_[k].spread = angle_of(1.0 - faces_[k].spread);
}

/// Parts flat faces of one normal that lie at different heights, as treads of stairs do: at half the height. True if
/// there were any.
bool ConcaveCorner::part_levels(Pieces pieces, Watch& watch) noexcept {
  std::array<std::size_t, most + 1> upper_of;  // where the upper pieces of a face go
  std::iota(upper_of.begin(), upper_of.end(), std::size_t{0});
  const std::size_t before = count_;
  for (std::size_t k = 0; k < before && count_ < most; ++k) {
    const auto& [exit, sums, spread, number] = faces_[k];
    const double bent = 2.0 * std::sin(spread) * sums.diagonal() + tolerances::level_face * sums_.diagonal();
    if (spread < tolerances::flat_from && exit.high - exit.low > bent) upper_of[k] = count_++;
  }
  if (count_ == before) return false;
  for (std::size_t i = 0; i < pieces.size() && !watch.late_in_small_steps(i); ++i) {
    RimPiece& piece = rim_.pieces[pieces[i]];
    const std::size_t upper = upper_of[piece.component];
    if (upper == piece.component) continue;
    const ExitRange& exit = faces_[piece.component].exit;
    if (exit.direction.dot(piece.middle() - rim_.origin) > 0.5 * (exit.low + exit.high)) {
      piece.component = static_cast<std::uint32_t>(upper);
    }
  }
  return true;
}

/// Which faces are in front of which, and which meet.
void ConcaveCorner::compare(Pieces pieces, Watch& watch) noexcept {
  for (std::size_t i = 0; i < count_; ++i) {
    meet_[i].fill(!sums_.closed() && !input_.found_all);  // where pieces of the rim are missing, they may
    for (std::size_t j = 0; j < count_; ++j) {
      const Vec3 way = faces_[j].sums.centre(rim_.origin) - faces_[i].sums.centre(rim_.origin);
      is_in_front_of_[j][i] = i != j && faces_[i].exit.direction.dot(way) > 0.0;
    }
  }
  for (std::size_t i = 0; i < pieces.size() && !watch.late_in_small_steps(i); ++i) {
    const std::uint32_t face = rim_.pieces[pieces[i]].component;
    for (const std::uint32_t neighbour : components_.first_at_ends_of(pieces[i])) {
      const std::uint32_t other = rim_.pieces[neighbour].component;
      meet_[face][other] = meet_[other][face] = true;
    }
  }
}

bool ConcaveCorner::are_one_side(std::size_t i, std::size_t j) const noexcept {
  const double between = angle_of(faces_[i].exit.direction.dot(faces_[j].exit.direction));
  const double narrow = std::max(tolerances::corner_spread * between, 2.0 * tolerances::flat_from);  // or two levels
  if (faces_[i].spread + faces_[j].spread > narrow) return true;
  return meet_[i][j] && !is_in_front_of_[i][j] && !is_in_front_of_[j][i];
}

void ConcaveCorner::join() noexcept {
  std::iota(side_of_.begin(), side_of_.end(), 0U);  // a side has the number of its first face
  for (std::size_t i = 0; i < count_; ++i) {
    for (std::size_t j = i + 1; j < count_; ++j) {
      const std::uint32_t first = std::min(side_of_[i], side_of_[j]);
      const std::uint32_t second = std::max(side_of_[i], side_of_[j]);
      if (first != second && are_one_side(i, j)) std::replace(side_of_.begin(), side_of_.end(), second, first);
    }
  }
  side_count_ = 0;
  for (std::size_t i = 0; i < count_; ++i) {  // now they are counted through
    if (side_of_[i] == i) {
      sides_[side_count_] = CornerSide{};
      sides_[side_count_].outwards = faces_[i].exit.direction;
      side_of_[i] = static_cast<std::uint32_t>(side_count_++);
    } else {
      side_of_[i] = side_of_[side_of_[i]];
    }
    CornerSide& side = sides_[side_of_[i]];
    side.sums.add(faces_[i].sums);
    side.pieces += faces_[i].pieces;
    ++side.faces;
  }
}

bool ConcaveCorner::find(std::span<std::uint32_t> pieces, Watch& watch) noexcept {
  if (!seed(pieces, watch) || !any_in_front(pieces, watch)) return false;
  do {
    gather(pieces, watch);
  } while (!watch.late() && part_levels(pieces, watch));
  if (watch.late()) return false;
  compare(pieces, watch);
  join();
  if (watch.late() || side_count_ < 2) return false;
  // Between its pieces a face may bend beyond them.
  const double rounding = tolerances::corner_bulge * (sums_.diagonal() + rim_.origin.cwiseAbs().maxCoeff());
  for (std::size_t k = 0; k < count_; ++k) {
    const double beyond = std::sin(faces_[k].spread) * faces_[k].sums.diagonal() + rounding;
    faces_[k].exit.low -= beyond;
    faces_[k].exit.high += beyond;
  }
  std::size_t sorted = 0;
  for (std::size_t side = 0; side < side_count_; ++side) {
    for (std::size_t i = sorted; i < pieces.size() && !watch.late_in_small_steps(i); ++i) {
      if (side_of_[rim_.pieces[pieces[i]].component] == side) std::swap(pieces[sorted++], pieces[i]);
    }
  }
  if (watch.late()) return false;
  return true;
}

bool ConcaveCorner::is_of_faces() const noexcept {
  for (std::size_t i = 0; i < count_; ++i) {
    for (std::size_t j = 0; j < count_; ++j) {
      if (i != j && !is_in_front_of_[i][j]) return false;
    }
  }
  return side_count_ == count_;
}

ExitRanges ConcaveCorner::exits_of(std::size_t side, std::array<ExitRange, most>& room) const noexcept {
  std::size_t count = 0;
  for (std::size_t k = 0; k < count_; ++k) {
    if (side_of_[k] == side && sides_[side].faces == 1) return {&faces_[k].exit, 1};
    bool all_in_front = true;
    for (std::size_t j = 0; j < count_; ++j) {
      all_in_front = all_in_front && (side_of_[j] != side || is_in_front_of_[j][k]);
    }
    if (!all_in_front) continue;
    room[count] = faces_[k].exit;
    room[count].low = room[count].high;
    room[count++].high = infinity;
  }
  return {room.data(), count};
}

}  // namespace patch

/// Replaces the last patch, of `indices`, by one for each side of a concave corner that it lies in: of a face, along
/// its normal. Unless these are deeper. `others`: how many patches are still to be made.
void PatchBuilder::Scratch::part_in_corner(const PatchInput& input, const patch::RimSums& sums,
                                           std::span<std::uint32_t> indices, std::size_t others,
                                           patch::Watch& watch) noexcept {
  const patch::Patch& common = patches[patch_count - 1];
  for (const bool of_b : {true, false}) {
    if (!patch::ConcaveCorner::may_be_of(of_b, input, sums)) continue;
    patch::ConcaveCorner corner(of_b, input, components, rim, sums);
    if (!corner.find(indices, watch)) continue;
    const std::span<const patch::CornerSide> sides = corner.sides();
    if (patch_count + sides.size() + others > patches.size()) return;
    const double limit = (corner.is_of_faces() ? tolerances::corner_deeper : tolerances::by_far_shorter) * common.depth;
    std::array<patch::ExitRange, patch::ConcaveCorner::most> room;
    std::size_t first = 0;
    bool shorter = true;
    for (std::size_t k = 0; k < sides.size() && shorter; ++k) {
      const patch::CornerSide& side = sides[k];
      const Indices own = indices.subspan(first, side.pieces);
      const patch::ExitRanges exits = corner.exits_of(k, room);
      patch::Patch& made = patches[patch_count + k];
      made = side.faces == 1 ? patch_along(of_b ? side.outwards : Vec3(-side.outwards), input, side.sums, own,
                                           patch::thorough, watch, exits)
                             : make_patch(input, side.sums, own, patch::thorough, watch, exits);
      if (watch.late()) return;
      made.component = common.component;
      made.in_corner = true;
      shorter = made.depth <= limit;
      first += side.pieces;
    }
    if (!shorter) continue;
    std::copy_n(patches.begin() + static_cast<std::ptrdiff_t>(patch_count), sides.size(),
                patches.begin() + static_cast<std::ptrdiff_t>(patch_count) - 1);
    patch_count += sides.size() - 1;
    return;
  }
}

}  // namespace odds::query
