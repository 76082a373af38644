// Vector area of the rim; the face normal where the overlap is flat; the direction of least overlap where there is no
// area.
#include "query/patch/normal.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

#include "query/patch/directions.hpp"
#include "query/patch/eight.hpp"
#include "query/patch/overlap.hpp"

namespace odds::query::patch {
namespace {

/// The inner rim of a ring whose outer rim is missing, for the search was cut short: it runs the other way round.
bool is_hole_alone(const PatchView& view, const Vec3& normal) noexcept {
  if (!view.input.solid_a || !view.input.solid_b) return false;
  return normal.dot(view.sums.normals_b - view.sums.normals_a) < -tolerances::hole_rim * view.sums.length;
}

/// The faces that a flat patch may lie on. Of some triangles of a rim one is on such a face and one is not, in no
/// order: the usual ones are taken eight at a time.
class FlatFaces {
 public:
  FlatFaces(const PatchView& view, const Vec3& normal) noexcept
      : view_(view), facing_{normal, view.input.solid_a, view.input.solid_b} {}

  /// The mean of those on which most of the rim is; zero if there are none, or two as good.
  [[nodiscard]] Vec3 heaviest(Watch& watch) noexcept {
    for_eights(watch, [this](const EightPieces& eight) noexcept { add(eight); });
    if (faces_.count == 0) return Vec3::Zero();
    faces_.ones[0].sum += sums_.normals();
    faces_.ones[0].weight += sums_.lengths();
    const auto heaviest =
        std::max_element(faces_.ones.begin(), faces_.ones.begin() + static_cast<std::ptrdiff_t>(faces_.count),
                         [](const auto& i, const auto& j) { return i.weight < j.weight; });
    // Two faces that cross in a line both carry all of it: nothing but the order of the bodies would say which.
    constexpr double all = 1.0 - 1e-9;
    const auto carries_as_much = [&](const Directions::One& one) noexcept {
      return &one != heaviest && one.weight >= all * heaviest->weight;
    };
    if (std::any_of(faces_.ones.begin(), faces_.ones.begin() + static_cast<std::ptrdiff_t>(faces_.count),
                    carries_as_much)) {
      return Vec3::Zero();
    }
    return unit_or_zero(heaviest->sum);
  }
  /// How much of the rim is on a flat face, metres, and the sum of the normals there, times length.
  void weigh(const Vec3& flat, double& share, Vec3& sum, Watch& watch) noexcept {
    FaceSums sums;
    for_eights(watch, [&](const EightPieces& eight) noexcept {
      for (unsigned left = view_.kernels.flat_faces(eight, facing_, flat, sums); left != 0; left &= left - 1U) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(left));
        const Vec3 face_b = facing_.of_b(*eight.pairs[lane]);
        const Vec3 face_a = facing_.of_a(*eight.pairs[lane]);
        const double by_b = flatness(face_b, flat);
        const double by_a = flatness(face_a, flat);
        share += eight.length[lane] * std::max(by_a, by_b);
        sum += eight.length[lane] * (by_b * face_b + by_a * face_a);
      }
    });
    share += sums.lengths();
    sum += sums.normals();
  }

 private:
  template <class Each>
  void for_eights(Watch& watch, Each&& each) noexcept {
    EightPieces eight;
    for (const std::uint32_t index : view_.pieces) {
      const RimPiece& piece = view_.rim.pieces[index];
      if (!piece.counts) continue;
      eight.add(piece, view_.rim.pairs[piece.pair]);
      if (eight.count < eight.pairs.size()) continue;
      each(eight);
      eight.clear();
      if (watch.late()) return;
    }
    if (eight.count > 0) each(eight);
  }
  void add(const EightPieces& eight) noexcept {
    if (faces_.count == 0) {
      for (std::size_t lane = 0; lane < eight.count; ++lane) add(eight, lane, true, true);
      return;
    }
    const unsigned others = view_.kernels.same_faces(eight, facing_, faces_.ones[0].first, sums_);
    for (unsigned left = (others | others >> 8U) & 0xFFU; left != 0; left &= left - 1U) {
      const auto lane = static_cast<unsigned>(std::countr_zero(left));
      add(eight, lane, (others >> lane & 1U) != 0, (others >> (lane + 8U) & 1U) != 0);
    }
  }
  void add(const EightPieces& eight, std::size_t lane, bool b, bool a) noexcept {
    if (b) faces_.add(facing_.of_b(*eight.pairs[lane]), eight.length[lane]);
    if (a) faces_.add(facing_.of_a(*eight.pairs[lane]), eight.length[lane]);
  }

  const PatchView& view_;
  Facing facing_;
  Directions faces_;
  FaceSums sums_;  ///< of those that are one with the first
};

/// On a flat patch (a face of one body carries nearly all of the rim) the face's normal is the better one: where a face
/// hangs over a ledge, the vector area leans by depth / width, and where parts of the rim are missing, by more.
Vec3 snap_to_face(const PatchView& view, const Vec3& normal, Watch& watch) noexcept {
  FlatFaces faces(view, normal);
  const Vec3 flat = faces.heaviest(watch);
  if (flat == Vec3::Zero()) return normal;
  double share = 0.0;
  Vec3 mean = Vec3::Zero();
  faces.weigh(flat, share, mean, watch);
  return watch.late() ? normal : snapped_to(mean, share / view.sums.length, normal);
}

/// Compares directions by the overlap along them, on a sample of the patch's triangle pairs.
class LeastOverlap {
 public:
  LeastOverlap(const PatchView& view, Watch& watch) noexcept
      : view_(view), watch_(watch), side_(side_of_bodies(view.input, view.sums.centre(view.rim.origin))) {
    const Vec3 pressing = pressing_direction(view.input, difference_of_normals(), side_);
    // Where the bodies only touch, every direction that parts them has no overlap. Pressing them together by a trifle
    // first tells the face's own normal from those that merely do.
    double size = 0.0;
    for (std::size_t i = 0; i < view.pieces.size(); i += stride()) {
      const PlacedPair& placed = pair_at(i);
      // The smaller: a ground may be of triangles much larger than the body that is pressed on it.
      size = std::max(size, std::min((placed.a[1] - placed.a[0]).norm(), (placed.b[1] - placed.b[0]).norm()));
    }
    shift_ = -tolerances::pressing_share * size * pressing;
    spread_ = view.sums.length > 0.0;
    if (spread_ && has_probes()) find_places(Frame(pressing == Vec3::Zero() ? Vec3(Vec3::UnitZ()) : pressing));
  }

  void offer(const Vec3& direction, double factor) noexcept {
    const Vec3 unit = unit_or_zero(direction);
    if (unit == Vec3::Zero()) return;
    const double facing = unit.dot(side_);
    if (found_ && watch_.late()) return;
    if (facing < -tolerances::weak_side) return;  // towards the wrong side of a sheet
    factor *= hysteresis_of(view_.input, unit);
    const double of_pairs = overlap_of_pairs(unit, shift_, factor);
    if (found_ && !(factor * of_pairs < least_)) return;
    const double through = overlap_through(unit, factor);
    if (found_ && watch_.late()) return;  // it was not measured to its end
    const double overlap = factor * std::max(of_pairs, through);
    const bool equal = overlap == least_ && factor * of_pairs < least_of_pairs_;
    if (found_ && !(overlap < least_ || equal)) return;
    found_ = true;
    least_ = overlap;
    least_of_pairs_ = factor * of_pairs;
    through_ = through;
    best_ = unit;
  }
  void offer_both(const Vec3& direction, double factor) noexcept {
    offer(direction, factor);
    offer(-direction, factor);
  }
  [[nodiscard]] Vec3 best() const noexcept { return found_ ? best_ : Vec3::Zero(); }
  /// Of all of the rim.
  [[nodiscard]] Vec3 difference_of_normals() const noexcept {
    return patch::difference_of_normals(view_.input, view_.sums.normals_a, view_.sums.normals_b, side_);
  }
  /// Whether the bodies overlap along the best direction by more than the rim is wide (and than rounding).
  [[nodiscard]] bool is_a_long_way() const noexcept {
    const double reach = view_.rim.origin.cwiseAbs().maxCoeff();
    const double wide = view_.sums.width() + tolerances::rim_noise * reach;
    return !found_ || std::max(through_, overlap_of_pairs(best_, Vec3::Zero())) > wide;
  }

 private:
  [[nodiscard]] bool has_probes() const noexcept { return view_.input.probe_a && view_.input.probe_b; }
  [[nodiscard]] std::size_t stride() const noexcept {
    return std::max<std::size_t>(1, (view_.pieces.size() + view_.sample - 1) / view_.sample);
  }
  [[nodiscard]] const PlacedPair& pair_at(std::size_t i) const noexcept {
    return view_.rim.pairs[view_.rim.pieces[view_.pieces[i]].pair];
  }
  /// The largest of the sample's depths, or of some of them, if times `factor` it is no less than the best direction's.
  [[nodiscard]] double overlap_of_pairs(const Vec3& direction, const Vec3& shift, double factor = 0.0) const noexcept {
    const Frame frame(direction);
    const double enough = found_ && factor > 0.0 ? least_ : std::numeric_limits<double>::infinity();
    double deepest = 0.0;
    for (std::size_t i = 0; i < view_.pieces.size() && factor * deepest < enough && !watch_.late();) {
      const std::array<double, eight> depths = depths_of_next(i, frame, shift);
      deepest = std::max(deepest, *std::max_element(depths.begin(), depths.end()));
    }
    return deepest;
  }
  /// Of up to eight pairs of the sample, from that of piece `i` on, which is moved on.
  [[nodiscard]] std::array<double, eight> depths_of_next(std::size_t& i, const Frame& frame,
                                                         const Vec3& shift) const noexcept {
    std::array<const PlacedPair*, eight> asked;
    std::size_t count = 0;
    for (; i < view_.pieces.size() && count < asked.size(); i += stride()) asked[count++] = &pair_at(i);
    CornersOfEight corners;
    view_.kernels.corners({asked.data(), count}, frame, shift, 0.0, corners);
    return std::to_array(corners.deepest);
  }

  /// Places inside the overlap where directions are measured: the middle of the rim, and, between solids, a little
  /// inside of a few of its pieces, first where the triangles overlap most. The middle of a crescent is not in it.
  void find_places(const Frame& pressing) noexcept {
    places_[place_count_++] = view_.sums.centre(view_.rim.origin);
    if (ends_at_a_border(view_)) return find_places_on_sheet();
    if (!view_.input.solid_a || !view_.input.solid_b) return;
    // A quarter of the mean width of the surface that the rim spans; no less than what rays tell apart.
    const double reach = view_.rim.origin.cwiseAbs().maxCoeff() + view_.sums.diagonal();
    const double inwards = std::max(0.5 * view_.sums.vector_area(view_.rim.origin).norm() / view_.sums.length,
                                    tolerances::within_both * reach);
    const auto add = [&](std::size_t i) noexcept {
      const RimPiece& piece = view_.rim.pieces[view_.pieces[i]];
      const PlacedPair& placed = pair_at(i);
      const Vec3 into_both = unit_or_zero(-placed.normal_a - placed.normal_b);
      if (piece.counts && into_both != Vec3::Zero()) places_[place_count_++] = piece.middle() + inwards * into_both;
    };
    std::size_t deepest = 0;
    double depth = -1.0;
    Vec3 into_all = Vec3::Zero();  // from a crumb at a corner, one face's side is not inside of the others
    for (std::size_t next = 0; next < view_.pieces.size() && !watch_.late();) {
      std::size_t i = next;
      for (const double here : depths_of_next(next, pressing, shift_)) {
        if (i >= next) break;
        into_all -= pair_at(i).normal_a + pair_at(i).normal_b;
        if (here > depth) deepest = i;
        depth = std::max(depth, here);
        i += stride();
      }
    }
    if (is_part_of_a_rim(view_)) places_[place_count_++] = places_[0] + 2.0 * inwards * unit_or_zero(into_all);
    add(deepest);
    add(view_.pieces.size() / 5);
    add(view_.pieces.size() / 2);
    add(view_.pieces.size() * 4 / 5);
  }

  /// Places of a sheet beyond the rim of a solid: all that is there goes no farther in than to the sheet's border.
  void find_places_on_sheet() noexcept {
    if (!view_.input.solid_a && !view_.input.solid_b) return;
    for (const std::size_t part : {1U, 3U, 5U, 7U}) {
      const RimPiece& piece = view_.rim.pieces[view_.pieces[view_.pieces.size() * part / 8]];
      const PlacedPair& placed = view_.rim.pairs[piece.pair];
      const Vec3& outwards = view_.input.solid_a ? placed.normal_a : placed.normal_b;
      const std::array<Vec3, 3>& corners = view_.input.solid_a ? placed.b : placed.a;
      const Vec3& inmost =
          *std::min_element(corners.begin(), corners.end(),
                            [&](const Vec3& p, const Vec3& q) noexcept { return outwards.dot(p) < outwards.dot(q); });
      places_[place_count_++] = 0.5 * (piece.middle() + inmost);
    }
  }

  /// The rim's triangles reach only as far as they are large: a direction that seems the shortest is measured right
  /// through, until it is seen not to be. Where no place lies in the overlap it is taken for as long as the rim is wide
  /// that way, for the rim bounds the common volume on all sides; where no ray comes to an end (along a face of many
  /// triangles it may not), for as long as the rim is wide at all, and for longer than any that is known if some of the
  /// rim is missing: a way that nobody has seen the end of is not short.
  [[nodiscard]] double overlap_through(const Vec3& direction, double factor) noexcept {
    if (!spread_) return 0.0;
    const double reach = 4.0 * view_.sums.diagonal();
    double deepest = -1.0;
    bool seen = !has_probes() || !view_.input.solid_a || !view_.input.solid_b;
    for (std::size_t i = 0; i < place_count_ && !(found_ && factor * deepest >= least_); ++i) {
      Witness through;
      switch (probe_line(view_.input, places_[i], direction, reach, watch_, through)) {
        case Probing::overlap:
          deepest = std::max(deepest, through.depth);
          break;
        case Probing::apart:
          seen = true;
          break;
        case Probing::unknown:
        case Probing::missed:
          break;
      }
    }
    if (deepest >= 0.0) return deepest;
    if (seen) return width_of_rim(direction);
    return is_part_of_a_rim(view_) ? std::numeric_limits<double>::max() : view_.sums.diagonal();
  }

  [[nodiscard]] double width_of_rim(const Vec3& direction) const noexcept {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (std::size_t i = 0; i < view_.pieces.size(); i += stride()) {
      const double height = direction.dot(view_.rim.pieces[view_.pieces[i]].middle() - view_.rim.origin);
      low = std::min(low, height);
      high = std::max(high, height);
    }
    return high - low;
  }

  const PatchView& view_;
  Watch& watch_;
  Vec3 side_;
  Vec3 shift_ = Vec3::Zero();
  Vec3 best_ = Vec3::Zero();
  double least_ = 0.0;
  double least_of_pairs_ = 0.0;  ///< decides between directions that nobody has seen the end of
  double through_ = 0.0;
  std::array<Vec3, 6> places_;
  std::size_t place_count_ = 0;
  bool found_ = false;
  bool spread_ = false;
};

/// A crumb of a rim may be of walls only, of which no face leads out: where two walls cross, at a corner, the line in
/// which they do leads there, and where two lie on each other, the ways across their triangles' sides.
Directions ways_along_walls(const PatchView& view, Watch& watch) noexcept {
  Directions ways;
  const auto across_sides = [&ways](const std::array<Vec3, 3>& t, const Vec3& normal) noexcept {
    for (std::size_t k = 0; k < 3; ++k) ways.add(unit_or_zero(normal.cross(t[(k + 1) % 3] - t[k])), 1.0);
  };
  for (std::size_t i = 0; i < view.pieces.size() && ways.count < ways.ones.size() && !watch.late(i); ++i) {
    const PlacedPair& placed = view.rim.pairs[view.rim.pieces[view.pieces[i]].pair];
    const Vec3 line = placed.normal_b.cross(placed.normal_a);
    if (line.norm() > tolerances::steep) {
      ways.add(line.normalized(), 1.0);
    } else if (line.norm() < tolerances::flat_from && placed.normal_a.dot(placed.normal_b) > 0.0) {
      across_sides(placed.a, placed.normal_a);
      across_sides(placed.b, placed.normal_b);
    }
  }
  return ways;
}

/// The vector area of the rim; zero where that is rounding.
Vec3 noticeable_area(const PatchView& view) noexcept {
  const RimSums& sums = view.sums;
  const Vec3 area = sums.vector_area(view.rim.origin);
  const double reach = view.rim.origin.cwiseAbs().maxCoeff() + sums.diagonal();
  return area.norm() > tolerances::rim_noise * reach * sums.length ? area : Vec3::Zero();
}

/// The candidates: the faces' normals, the area, the mean of the normals, the last run's normal.
Vec3 least_overlap(const PatchView& view, const Vec3& area, Watch& watch) noexcept {
  LeastOverlap search(view, watch);
  const bool solid = view.input.solid_a && view.input.solid_b;
  const auto offer = [&search](const Vec3& direction, double factor, bool both_ways) noexcept {
    search.offer(direction, factor);
    if (both_ways) search.offer(-direction, factor);
  };
  // The area of a rim of which pieces are missing is one candidate of many: where it is small, so may be what is left.
  // Of one that ends with a sheet it is along the sheet's normal, whichever way the border came in.
  const bool at_border = ends_at_a_border(view);
  const bool is_open = is_part_of_a_rim(view) || at_border;
  offer(area, is_open ? 1.0 : tolerances::area_preferred, !solid);
  Directions faces;   // of solids: out of them
  Directions sheets;  // may be turned either way
  const bool in_part = view.input.believed_depth > 0.0;
  for (std::size_t i = 0; i < view.pieces.size() && !watch.late(i); ++i) {
    const RimPiece& piece = view.rim.pieces[view.pieces[i]];
    const PlacedPair& placed = view.rim.pairs[piece.pair];
    // Solids on the same side of a wall that both have do not part across it, however little the walls overlap in what
    // a search without time has left of the rim.
    if (solid && in_part && placed.normal_a.dot(placed.normal_b) > tolerances::same_face) continue;
    const double weight = piece.length;
    (view.input.solid_b ? faces : sheets).add(placed.normal_b, weight);
    (view.input.solid_a ? faces : sheets).add(-placed.normal_a, weight);
  }
  for (std::size_t i = 0; i < faces.count; ++i) offer(faces.ones[i].mean(), 1.0, false);
  for (std::size_t i = 0; i < sheets.count; ++i) offer(sheets.ones[i].mean(), 1.0, true);
  // Of a crumb along an edge, all that a sample has left of a long rim, the mean of the two faces' normals cuts the
  // corner: at places near the rim it seems shorter than it is. So it does at a border, whose sheet's normal leads
  // aside.
  const bool is_crumb = is_part_of_a_rim(view) && !in_part && faces.count == 2 && view.input.max_contacts > 1;
  if (!(is_crumb || at_border) || search.best() == Vec3::Zero()) {
    offer(search.difference_of_normals(), 1.0, !view.input.solid_a && !view.input.solid_b);
  }
  if (view.input.previous_normal != nullptr) search.offer(*view.input.previous_normal, 1.0);
  const bool walls_only = is_part_of_a_rim(view) || view.sums.length == 0.0;
  if (walls_only && !watch.late() && ((in_part && faces.count + sheets.count == 0) || search.is_a_long_way())) {
    const Directions ways = ways_along_walls(view, watch);
    for (std::size_t i = 0; i < ways.count; ++i) search.offer_both(ways.ones[i].first, 1.0);
  }
  if (search.best() != Vec3::Zero()) return search.best();
  return unit_or_zero(view.input.reference_a - view.input.reference_b);
}

}  // namespace

PatchNormal patch_normal(const PatchView& view, Watch& watch) noexcept {
  const RimSums& sums = view.sums;
  const Vec3 area = noticeable_area(view);
  const bool noticeable = area != Vec3::Zero();
  // The isoperimetric quotient: 1 for a circle, 0.8 for a square, 0 for a line.
  const double roundness = sums.length > 0.0 ? 4.0 * std::numbers::pi * area.norm() / (sums.length * sums.length) : 0.0;
  PatchNormal made{Vec3::Zero(), Vec3::Zero()};
  Vec3& normal = made.into_a;
  // Above 1 more is missing of a rim than is there: what its pieces seem to span is where they lie.
  const bool round = roundness > (sums.closed() ? tolerances::round_closed_rim : tolerances::round_open_rim) &&
                     !(roundness > 1.0 && is_part_of_a_rim(view)) && !ends_at_a_border(view);
  if (noticeable && round) {
    normal = area.normalized();
    if (normal.dot(side_of_bodies(view.input, view.sums.centre(view.rim.origin))) < 0.0) normal = -normal;
    if (is_hole_alone(view, normal)) normal = -normal;
  } else {
    made.shortest_way = normal = least_overlap(view, area, watch);
  }
  if (normal == Vec3::Zero()) {
    normal = Vec3::UnitZ();  // two points on one another: no direction is better than another
  } else if (sums.length > 0.0) {
    normal = snap_to_face(view, normal, watch);
  }
  return made;
}

Vec3 shortest_way_out(const PatchView& view, Watch& watch) noexcept {
  return least_overlap(view, noticeable_area(view), watch);
}

bool is_of_direction(const PatchView& view, const Vec3& direction, double depth, Watch& watch) noexcept {
  const auto leads = [&direction](const Vec3& face, bool solid) noexcept {
    const double facing = face.dot(direction);
    return (solid ? facing : std::abs(facing)) > tolerances::same_face;
  };
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  double not_against = 0.0;
  for (std::size_t i = 0; i < view.pieces.size() && !watch.late(i); ++i) {
    const RimPiece& piece = view.rim.pieces[view.pieces[i]];
    const double from = direction.dot(piece.from - view.rim.origin);
    const double to = direction.dot(piece.to - view.rim.origin);
    low = std::min({low, from, to});
    high = std::max({high, from, to});
    if (!piece.counts) continue;
    const PlacedPair& placed = view.rim.pairs[piece.pair];
    const bool flush =
        view.input.solid_a && view.input.solid_b && placed.normal_a.dot(placed.normal_b) > tolerances::same_face;
    if (flush || leads(placed.normal_b, view.input.solid_b) || leads(-placed.normal_a, view.input.solid_a)) {
      not_against += piece.length;
    }
  }
  if (watch.late() || !(high - low <= depth)) return false;
  if (!(view.sums.diagonal() <= depth || not_against >= tolerances::snap_from * view.sums.length)) return false;
  const Frame frame(direction);
  const std::size_t stride = std::max<std::size_t>(1, (view.pieces.size() + view.sample - 1) / view.sample);
  for (std::size_t i = 0; i < view.pieces.size(); i += stride) {
    const PlacedPair& placed = view.rim.pairs[view.rim.pieces[view.pieces[i]].pair];
    if (watch.late(i / stride) || !(pair_depth(placed, frame, Vec3::Zero()) <= depth)) return false;
  }
  return true;
}

}  // namespace odds::query::patch
