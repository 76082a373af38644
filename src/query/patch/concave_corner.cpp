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

void ConcaveCorner::look_up(Pieces pieces, Watch& watch) noexcept {
  told_ = told_.first(pieces.size());
  for (std::size_t i = 0; i < pieces.size() && !watch.late_in_small_steps(i); ++i) {
    const RimPiece& piece = rim_.pieces[pieces[i]];
    CornerPiece& told = told_[i];
    told.normal = normal_of(piece);
    told.place = piece.middle() - rim_.origin;
    told.length = piece.length;
    told.face = 0;
    told.counts = piece.counts;
    told.tells = piece.counts && piece.length > 0.0 && told.normal != Vec3::Zero();
  }
}

/// Begins a face with each normal that is far from all before it, and deals the pieces out to the nearest. False if
/// there is but one.
bool ConcaveCorner::seed(Watch& watch) noexcept {
  const auto first = std::find_if(told_.begin(), told_.end(), [](const CornerPiece& piece) { return piece.tells; });
  if (first == told_.end()) return false;
  Vec3 next = first->normal;
  double least = -1.0;
  for (count_ = 0; count_ < most && least < tolerances::corner_bend && !watch.late(); ++count_) {
    const auto last = static_cast<std::uint32_t>(count_);
    const Vec3 begun = next;
    faces_[last].exit.direction = begun;
    least = 1.0;
    for (std::size_t i = 0; i < told_.size() && !watch.late_in_small_steps(i); ++i) {
      CornerPiece& piece = told_[i];
      const double to_last = piece.normal.dot(begun);
      if (last == 0 || to_last > piece.cosine) {
        piece.face = last;
        piece.cosine = to_last;
      }
      if (!(piece.cosine < least) || !piece.tells) continue;
      least = piece.cosine;
      next = piece.normal;
    }
  }
  return count_ > 1 && !watch.late();
}

/// Whether any face reaches in front of another, or lies at several heights, before more is made of them: most do not,
/// as of two bricks that lie askew.
bool ConcaveCorner::any_in_front(Watch& watch) const noexcept {
  struct Light {
    Vec3 moment = Vec3::Zero();
    double length = 0.0;
    double low = infinity;
    double high = -infinity;
  };
  std::array<Light, most> faces;
  for (std::size_t i = 0; i < told_.size() && !watch.late_in_small_steps(i); ++i) {
    const CornerPiece& piece = told_[i];
    if (!piece.counts) continue;
    Light& face = faces[piece.face];
    const double height = faces_[piece.face].exit.direction.dot(piece.place);
    face.moment += piece.length * piece.place;
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

/// Finds where the faces are and how bent. Pieces without a normal are taken off them.
void ConcaveCorner::gather(Watch& watch) noexcept {
  std::array<Vec3, most> normals;
  normals.fill(Vec3::Zero());
  for (std::size_t k = 0; k < count_; ++k) {
    faces_[k] = CornerFace{};
    faces_[k].exit = {Vec3::Zero(), rim_.origin, infinity, -infinity, of_b_};
  }
  for (std::size_t i = 0; i < told_.size() && !watch.late_in_small_steps(i); ++i) {
    CornerPiece& piece = told_[i];
    if (piece.normal == Vec3::Zero()) piece.face = most;
    if (piece.face == most) continue;
    CornerFace& face = faces_[piece.face];
    ++face.pieces;
    if (!piece.tells) continue;
    normals[piece.face] += piece.length * piece.normal;
    face.moment += piece.length * piece.place;
    face.length += piece.length;
  }
  for (std::size_t k = 0; k < count_; ++k) faces_[k].exit.direction = unit_or_zero(normals[k]);
  for (std::size_t i = 0; i < told_.size() && !watch.late_in_small_steps(i); ++i) {
    const CornerPiece& piece = told_[i];
    if (!piece.tells) continue;
    CornerFace& face = faces_[piece.face];
    const double height = face.exit.direction.dot(piece.place);
    face.exit.low = std::min(face.exit.low, height);
    face.exit.high = std::max(face.exit.high, height);
    face.spread = std::max(face.spread, 1.0 - piece.normal.dot(face.exit.direction));
  }
  for (std::size_t k = 0; k < count_; ++k) faces_[k].spread = angle_of(1.0 - faces_[k].spread);
}

double ConcaveCorner::diagonal_of(std::size_t face, Pieces pieces, Watch& watch) const noexcept {
  Vec3 lower = Vec3::Constant(infinity);
  Vec3 upper = -lower;
  for (std::size_t i = 0; i < told_.size() && !watch.late_in_small_steps(i); ++i) {
    if (told_[i].face != face || !told_[i].tells) continue;
    const RimPiece& piece = rim_.pieces[pieces[i]];
    lower = lower.cwiseMin(piece.from).cwiseMin(piece.to);
    upper = upper.cwiseMax(piece.from).cwiseMax(piece.to);
  }
  return (upper - lower).norm();
}

/// Parts flat faces of one normal that lie at different heights, as treads of stairs do: at half the height. True if
/// there were any.
bool ConcaveCorner::part_levels(Pieces pieces, Watch& watch) noexcept {
  std::array<std::uint32_t, most + 1> upper_of;  // where the upper pieces of a face go
  std::iota(upper_of.begin(), upper_of.end(), 0U);
  const std::size_t before = count_;
  const double level = tolerances::level_face * sums_.diagonal();
  for (std::size_t k = 0; k < before && count_ < most; ++k) {
    const CornerFace& face = faces_[k];
    const double high = face.exit.high - face.exit.low;
    if (!(face.spread < tolerances::flat_from && high > level)) continue;
    const double bent = 2.0 * std::sin(face.spread) * diagonal_of(k, pieces, watch);
    if (high > bent + level) upper_of[k] = static_cast<std::uint32_t>(count_++);
  }
  if (count_ == before) return false;
  for (std::size_t i = 0; i < told_.size() && !watch.late_in_small_steps(i); ++i) {
    CornerPiece& piece = told_[i];
    if (upper_of[piece.face] == piece.face) continue;
    const ExitRange& exit = faces_[piece.face].exit;
    if (exit.direction.dot(piece.place) > 0.5 * (exit.low + exit.high)) piece.face = upper_of[piece.face];
  }
  return true;
}

/// Which faces are in front of which, and which meet.
void ConcaveCorner::compare(Pieces pieces, Watch& watch) noexcept {
  for (std::size_t i = 0; i < count_; ++i) {
    meet_[i].fill(!sums_.closed() && !input_.found_all);  // where pieces of the rim are missing, they may
    for (std::size_t j = 0; j < count_; ++j) {
      const Vec3 way = faces_[j].moment / faces_[j].length - faces_[i].moment / faces_[i].length;
      is_in_front_of_[j][i] = i != j && faces_[i].exit.direction.dot(way) > 0.0;
    }
  }
  for (std::size_t i = 0; i < told_.size() && !watch.late_in_small_steps(i); ++i) {
    rim_.pieces[pieces[i]].component = told_[i].face;
  }
  for (std::size_t i = 0; i < told_.size() && !watch.late_in_small_steps(i); ++i) {
    for (const std::uint32_t neighbour : components_.first_at_ends_of(pieces[i])) {
      const std::uint32_t other = rim_.pieces[neighbour].component;
      meet_[told_[i].face][other] = meet_[other][told_[i].face] = true;
    }
  }
}

/// Whether the bundles are wide for how far they are from each other.
bool ConcaveCorner::are_wide(std::size_t i, std::size_t j) const noexcept {
  const double between = angle_of(faces_[i].exit.direction.dot(faces_[j].exit.direction));
  const double narrow = std::max(tolerances::corner_spread * between, 2.0 * tolerances::flat_from);  // or two levels
  return faces_[i].spread + faces_[j].spread > narrow;
}

bool ConcaveCorner::are_one_side(std::size_t i, std::size_t j) const noexcept {
  return (meet_[i][j] && !is_in_front_of_[i][j] && !is_in_front_of_[j][i]) || are_wide(i, j);
}

/// Gives each face the number of its side; how many there are.
template <class AreOne>
std::size_t ConcaveCorner::join(const AreOne& are_one) noexcept {
  std::iota(side_of_.begin(), side_of_.end(), 0U);  // a side has the number of its first face
  for (std::size_t i = 0; i < count_; ++i) {
    for (std::size_t j = i + 1; j < count_; ++j) {
      const std::uint32_t first = std::min(side_of_[i], side_of_[j]);
      const std::uint32_t second = std::max(side_of_[i], side_of_[j]);
      if (first != second && are_one(i, j)) std::replace(side_of_.begin(), side_of_.end(), second, first);
    }
  }
  std::uint32_t count = 0;
  for (std::size_t i = 0; i < count_; ++i) {  // now they are counted through
    side_of_[i] = side_of_[i] == i ? count++ : side_of_[side_of_[i]];
  }
  return count;
}

void ConcaveCorner::sum_up(Pieces pieces, Watch& watch) noexcept {
  for (std::size_t i = 0; i < told_.size() && !watch.late_in_small_steps(i); ++i) {
    if (!told_[i].tells) continue;
    const RimPiece& piece = rim_.pieces[pieces[i]];
    faces_[told_[i].face].sums.add(piece, rim_.pairs[piece.pair], rim_.origin);
  }
  std::fill_n(sides_.begin(), side_count_, CornerSide{});
  for (std::size_t k = 0; k < count_; ++k) {
    CornerSide& side = sides_[side_of_[k]];
    if (side.faces == 0) side.outwards = faces_[k].exit.direction;
    side.sums.add(faces_[k].sums);
    side.pieces += faces_[k].pieces;
    ++side.faces;
  }
}

bool ConcaveCorner::find(std::span<std::uint32_t> pieces, Watch& watch) noexcept {
  look_up(pieces, watch);
  if (watch.late() || !seed(watch) || !any_in_front(watch)) return false;
  do {
    gather(watch);
  } while (!watch.late() && part_levels(pieces, watch));
  // Most that bend in several ways do so smoothly: that is seen before anything is looked up.
  if (watch.late() || join([this](std::size_t i, std::size_t j) noexcept { return are_wide(i, j); }) < 2) return false;
  compare(pieces, watch);
  side_count_ = join([this](std::size_t i, std::size_t j) noexcept { return are_one_side(i, j); });
  if (watch.late() || side_count_ < 2) return false;
  sum_up(pieces, watch);
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
    patch::ConcaveCorner corner(of_b, input, components, rim, sums, corner_pieces);
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
                                           patch::thorough, watch, exits, limit)
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
