// Puts the steps together: rim, patches, normal, depth. Every loop looks at the deadline.
#include "odds/query/contact_patch.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>

#include "odds/math/tolerances.hpp"
#include "query/patch/eight.hpp"
#include "query/patch/scratch.hpp"
#include "query/patch/summit.hpp"
#include "query/patch/tip.hpp"
#include "query/spread_step.hpp"

namespace odds::query {
namespace {

using patch::Effort;
using patch::hasty_pieces;
using patch::least_pairs;
using patch::Patch;
using patch::thorough;
using patch::Watch;
using patch::Witness;

/// Centroid of the surface that the rim spans, which unlike the mean of the rim does not care how finely it is cut. Of
/// a rim that crosses itself as seen along the normal, or is not whole, areas of both signs may put it anywhere: never
/// beyond the rim's box.
Vec3 span_centre(const patch::Rim& rim, std::span<const std::uint32_t> indices, const patch::RimSums& sums,
                 const Vec3& normal, Watch& watch) noexcept {
  const Vec3 middle = sums.centre(rim.origin);
  Vec3 sum = Vec3::Zero();
  double weight = 0.0;
  double magnitude = 0.0;
  for (std::size_t i = 0; i < indices.size() && !watch.late_in_small_steps(i); ++i) {
    const patch::RimPiece& piece = rim.pieces[indices[i]];
    if (!piece.counts) continue;
    const Vec3 from = piece.from - middle;
    const Vec3 to = piece.to - middle;
    const double w = normal.dot(from.cross(to));
    sum += w * (from + to) / 3.0;
    weight += w;
    magnitude += std::abs(w);
  }
  if (!(std::abs(weight) > 0.1 * magnitude)) return middle;
  return (middle + sum / weight).cwiseMax(sums.lower).cwiseMin(sums.upper);
}

/// Where a whole rim of solids is on one flat face of a body and leads along its normal: through that face.
std::optional<patch::ExitRange> exit_through_face(const PatchInput& input, const patch::RimSums& sums,
                                                  const Vec3& origin, const Vec3& normal) noexcept {
  if (!input.solid_a || !input.solid_b || !sums.closed()) return std::nullopt;
  const auto all_on = [&](const Vec3& normals) noexcept {
    return normals.norm() > tolerances::one_face * sums.length &&
           normals.dot(normal) > tolerances::same_face * sums.length;
  };
  const bool of_b = all_on(sums.normals_b);
  if (!of_b && !all_on(-sums.normals_a)) return std::nullopt;
  const double height = (of_b ? sums.heights_b : sums.heights_a) / sums.length;
  const double slack = tolerances::off_face * sums.diagonal();
  return patch::ExitRange{(of_b ? sums.normals_b : sums.normals_a).normalized(), origin, height - slack, height + slack,
                          of_b};
}

}  // namespace

void PatchBuilder::Scratch::place_pairs(const PatchInput& input, Watch& watch) noexcept {
  const std::size_t count = std::min(input.hits.size(), pairs.size());
  const std::size_t taken = std::min<std::size_t>(count, input.most_pairs);
  const std::size_t step = count > 0 ? spread_step(count) % count : 0;
  std::array<TrianglePair, patch::eight> some;
  std::size_t next = 0;
  pair_count = 0;
  for (std::size_t i = 0; i < taken; i += some.size()) {
    if (watch.late_before_next(i) && pair_count >= least_pairs) break;
    const std::size_t asked = std::min(some.size(), taken - i);
    for (std::size_t k = 0; k < asked; ++k) {
      some[k] = input.hits[next];
      next += next + step < count ? step : step - count;
    }
    pair_count += kernels->place(input, {some.data(), asked}, pairs.data() + pair_count);
  }
}

void PatchBuilder::Scratch::make_rim(const PatchInput& input, std::size_t most_pairs, Watch& watch) noexcept {
  const std::size_t count = std::min(pair_count, most_pairs);
  cut_pairs(input, count, false, watch);
  if (piece_count == 0) cut_pairs(input, count, true, watch);
  Vec3 lower = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 upper = -lower;
  for (std::size_t i = 0; i < piece_count; ++i) {
    static_cast<void>(watch.late_in_small_steps(i));
    lower = lower.cwiseMin(pieces[i].from).cwiseMin(pieces[i].to);
    upper = upper.cwiseMax(pieces[i].from).cwiseMax(pieces[i].to);
  }
  rim.pieces = {pieces.data(), piece_count};
  rim.pairs = {pairs.data(), pair_count};
  rim.origin = piece_count > 0 ? Vec3(0.5 * lower + 0.5 * upper) : Vec3::Zero();
}

/// Coplanar triangles that face the same way are silent between solids: they speak only where nothing else does.
void PatchBuilder::Scratch::cut_pairs(const PatchInput& input, std::size_t count, bool silent_too,
                                      Watch& watch) noexcept {
  piece_count = 0;
  const bool skip_silent = input.solid_a && input.solid_b && !silent_too;
  std::array<patch::RimPiece, patch::most_pieces_of_a_pair> found;
  patch::CutEight cut;
  for (std::size_t i = 0; i < count && !watch.late_before_next(i); i += patch::eight) {
    const std::size_t lanes = std::min(patch::eight, count - i);
    kernels->cut(&pairs[i], lanes, cut);
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      if (piece_count + found.size() > pieces.size()) return;
      const auto pair = static_cast<std::uint32_t>(i + lane);
      if ((cut.plain >> lane & 1U) != 0) {
        pieces[piece_count++] = cut.piece(lane, pair);
        continue;
      }
      const std::size_t number = patch::rim_pieces(pairs[pair], skip_silent, pair, found);
      for (std::size_t k = 0; k < number; ++k) {
        if (found[k].from.allFinite() && found[k].to.allFinite()) pieces[piece_count++] = found[k];
      }
    }
  }
}

void PatchBuilder::Scratch::sort_by_patch(std::size_t count, Watch& watch) noexcept {
  first_of_patch.fill(0);
  for (std::size_t i = 0; i < piece_count && !watch.late_in_small_steps(i); ++i) {
    if (pieces[i].component < count) ++first_of_patch[pieces[i].component + 1];
  }
  for (std::size_t p = 1; p < first_of_patch.size(); ++p) first_of_patch[p] += first_of_patch[p - 1];
  std::array<std::uint32_t, patch::Components::most + 1> next = first_of_patch;
  for (std::uint32_t i = 0; i < piece_count && !watch.late_in_small_steps(i); ++i) {
    if (pieces[i].component < count) by_patch[next[pieces[i].component]++] = i;
  }
}

/// False if the time was up before all was done.
bool PatchBuilder::Scratch::make_patches(const PatchInput& input, Watch& watch) noexcept {
  patch_count = 0;
  make_rim(input, pair_count, watch);
  if (watch.late()) return false;
  const std::span<const patch::RimSums> sums = components.group(rim, input.solid_a, input.solid_b, watch);
  if (watch.late()) return false;
  sort_by_patch(sums.size(), watch);
  if (watch.late()) return false;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const Indices indices = pieces_of(i);
    if (indices.empty()) continue;
    patches[patch_count] = make_patch(input, sums[i], indices, thorough, watch);
    patches[patch_count++].component = i;
    if (watch.late()) return false;
    part_in_corner(input, sums[i], {by_patch.data() + first_of_patch[i], indices.size()}, sums.size() - i - 1, watch);
    if (watch.late()) return false;
  }
  if (input.believed_depth > 0.0 || (input.solid_a && input.solid_b && patch_count > 1)) straighten(input, sums, watch);
  return true;
}

/// The overlap's corners of up to eight pairs, one pair after the other.
void PatchBuilder::Scratch::add_witnesses(std::span<const patch::PlacedPair* const> asked,
                                          const patch::Frame& frame) noexcept {
  patch::CornersOfEight corners;
  kernels->corners(asked, frame, Vec3::Zero(), 0.0, corners);
  const std::array<std::uint16_t, patch::eight> kinds = corners.kinds_of_lanes();
  for (std::size_t lane = 0; lane < asked.size(); ++lane) {
    for (unsigned left = kinds[lane]; left != 0; left &= left - 1U) {
      if (witness_count == witnesses.size()) return;
      const auto kind = static_cast<std::size_t>(std::countr_zero(left));
      witnesses[witness_count++] = corners.witness(*asked[lane], frame.normal, kind, lane);
    }
  }
}

/// Fills `witnesses` with the overlap's corners of the pairs of the pieces; at least one.
void PatchBuilder::Scratch::find_witnesses(Indices indices, const patch::Frame& frame, Watch& watch) noexcept {
  witness_count = 0;
  std::array<const patch::PlacedPair*, patch::eight> asked;
  std::size_t count = 0;
  std::uint32_t last_pair = no_feature;
  for (std::size_t i = 0; i < indices.size(); ++i) {
    const std::uint32_t pair = pieces[indices[i]].pair;
    if (pair == last_pair) continue;  // the pieces of one pair follow each other
    last_pair = pair;
    asked[count++] = &pairs[pair];
    if (count < asked.size()) continue;
    add_witnesses(asked, frame);
    count = 0;
    if (watch.late()) break;
  }
  if (count > 0) add_witnesses({asked.data(), count}, frame);
  if (witness_count == 0) {  // rounding has parted triangles that only touch
    const patch::RimPiece& piece = pieces[indices[0]];
    const patch::PlacedPair& placed = pairs[piece.pair];
    witnesses[witness_count++] = {piece.middle(), piece.middle(), 0.0, placed.index.a, placed.index.b};
  }
}

/// Measures the overlap inside the rim: at the centre and a little inside of the points that span the patch. A deep
/// overlap's rim triangles reach only as far as they are large. Where the overlap is round (a ball), leaves out all but
/// its depth: what lies at its rim bears nothing.
std::size_t PatchBuilder::Scratch::probe(const PatchInput& input, const patch::RimSums& sums, const Vec3& centre,
                                         double reach, const patch::Frame& frame, const patch::Chosen& spread,
                                         patch::ExitRanges exits, double most_depth, Measured& measured,
                                         Watch& watch) noexcept {
  const auto measure = [&](const Vec3& place, Witness& found) noexcept {
    return !watch.late() && patch::probe_overlap(input, place, frame.normal, reach, watch, found) &&
           patch::all_have(exits, found);
  };
  std::size_t count = 0;
  Witness inside;
  patch::Summit summit(input, frame, centre, sums, exits);
  Witness start;  // the deepest, where it was measured
  const auto note = [&](const Witness& w) noexcept {
    summit.add(w);
    if (count == 0 || w.depth > start.depth) start = w;
  };
  if (measure(centre, inside)) {
    note(inside);
    measured[count++] = inside;
  }
  const bool has_centre = count > 0;
  const auto is_too_deep = [&]() noexcept { return count > 0 && start.depth > most_depth; };
  for (std::size_t i = 0; i < spread.count && !is_too_deep(); ++i) {
    Witness w = spread.witnesses[i];
    const Vec3 place = w.middle();
    const bool is_measured = measure(place + 0.02 * (centre - place), inside);
    note(is_measured && inside.depth > w.depth ? inside : w);
    if (is_measured && inside.depth > w.depth) {
      w = inside;
      w.on_a = place + frame.normal * frame.normal.dot(inside.on_a - place);
      w.on_b = place + frame.normal * frame.normal.dot(inside.on_b - place);
    }
    measured[count++] = w;
  }
  if (is_too_deep()) {
    measured[0] = start;
    return 1;
  }
  Witness deepest = patch::deepest_of({measured.data(), count}, frame, centre, 0.25 * reach);
  // The last run's summit is near this one's; starting from it, the climb follows one summit and does not flicker. That
  // of another patch, of another side or beside this one, is not in this overlap.
  if (input.previous_position != nullptr && input.previous_normal != nullptr &&
      input.previous_normal->dot(frame.normal) > tolerances::same_as_before &&
      summit.may_be_at(*input.previous_position, deepest.depth) && measure(*input.previous_position, inside) &&
      inside.depth > deepest.depth) {
    note(inside);
    deepest = inside;
    measured[count++] = inside;
  }
  Witness round_about = deepest;  // where it is roundest: among facets its lowest corner lies beside that
  const Witness higher = summit.climb(start, has_centre ? measured[0] : start, 0.25 * reach, reach, watch);
  if (higher.depth > (1.0 + tolerances::another_summit) * deepest.depth) {
    measured[count++] = deepest = round_about = higher;
  } else if (higher.depth > (1.0 + tolerances::level_overlap) * std::max(start.depth, deepest.depth)) {
    // A few facets away: the same place.
    const auto same = [&](const Witness& w) noexcept { return w.depth == deepest.depth && w.on_a == deepest.on_a; };
    *std::find_if(measured.begin(), measured.begin() + static_cast<std::ptrdiff_t>(count) - 1, same) = higher;
    deepest = higher;
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Witness& w = measured[i];
    const double linear = 0.5 * (w.depth + deepest.depth);
    const bool round = w.depth < 0.5 * deepest.depth && measure(0.5 * (w.middle() + round_about.middle()), inside) &&
                       inside.depth > linear + tolerances::round_overlap * deepest.depth;
    if (!round) measured[kept++] = patch::pulled_in(w, deepest);
  }
  return kept;
}

Patch PatchBuilder::Scratch::make_patch(const PatchInput& input, const patch::RimSums& sums, Indices indices,
                                        const Effort& effort, Watch& watch, patch::ExitRanges exits) noexcept {
  const patch::PatchView view{input, *kernels, rim, sums, indices, effort.sample};
  const patch::PatchNormal normal = patch::patch_normal(view, watch);
  const Patch made = patch_along(normal.into_a, input, sums, indices, effort, watch, exits);
  return shorter_way_out(made, normal.shortest_way, view, effort, watch);
}

Patch PatchBuilder::Scratch::patch_along(const Vec3& normal, const PatchInput& input, const patch::RimSums& sums,
                                         Indices indices, const Effort& effort, Watch& watch, patch::ExitRanges exits,
                                         double most_depth) noexcept {
  Patch made;
  made.lower = sums.lower;
  made.upper = sums.upper;
  made.normal = normal;
  made.length = sums.length;
  if (watch.late()) return made;  // here and below: what is not finished then is not used
  const patch::Frame frame(made.normal);
  const Vec3 centre = span_centre(rim, indices, sums, made.normal, watch);
  find_witnesses(effort.ends_only ? telling.ends_of(*kernels, rim, indices, frame, fan, centre, watch)
                                  : telling.of(*kernels, rim, indices, frame, fan, centre, watch),
                 frame, watch);
  if (watch.late()) return made;
  const double radius = 0.5 * sums.diagonal();
  const Witness deepest = patch::deepest_of({witnesses.data(), witness_count}, frame, centre, radius);
  patch::Extremes extremes(*kernels, frame, fan, centre, deepest);
  const std::span<const Witness> found{witnesses.data(), witness_count};
  for (std::size_t i = 0; i < found.size() && !watch.late_before_next(i); i += patch::Extremes::at_once) {
    extremes.add(found.subspan(i, std::min(patch::Extremes::at_once, found.size() - i)));
  }
  if (watch.late()) return made;
  made.centre = centre;
  const double lever = patch::lever_of(input, centre);
  made.depth = deepest.depth;
  if (made.depth > most_depth) return made;
  made.chosen = patch::choose(extremes.all(), frame, most_contacts, patch::spacing(made.depth, lever), &watch);
  Measured measured;
  std::size_t count = made.chosen.count;
  const bool can_measure = input.probe_a && input.probe_b && sums.length > 0.0 && !watch.late();
  const std::optional<patch::ExitRange> through_face = exit_through_face(input, sums, rim.origin, normal);
  if (exits.empty() && through_face) exits = {&*through_face, 1};
  const double reach = 2.0 * (sums.diagonal() + made.depth);
  if (can_measure && !patch::is_a_tip(input, rim, sums, indices, deepest)) {
    count = probe(input, sums, centre, reach, frame, made.chosen, exits, most_depth, measured, watch);
    if (watch.late()) return made;
    for (std::size_t i = 0; i < count; ++i) made.depth = std::max(made.depth, measured[i].depth);
    if (made.depth > most_depth) return made;
  } else {
    for (std::size_t i = 0; i < count; ++i) measured[i] = patch::pulled_in(made.chosen.witnesses[i], deepest);
    // Where there is more than a tip its centre bears, too: no force may jump where it becomes one.
    if (can_measure && patch::probe_overlap(input, centre, made.normal, reach, watch, measured[count]) &&
        patch::all_have(exits, measured[count])) {
      measured[count] = patch::pulled_in(measured[count], deepest);
      ++count;
    }
  }
  made.chosen =
      patch::choose({measured.data(), count}, frame, most_contacts, patch::spacing(made.depth, lever), &watch);
  made.low = std::numeric_limits<double>::infinity();
  made.high = -made.low;
  for (std::size_t i = 0; i < indices.size(); ++i) {
    static_cast<void>(watch.late_in_small_steps(i));
    const double height = made.normal.dot(pieces[indices[i]].middle() - rim.origin);
    made.low = std::min(made.low, height);
    made.high = std::max(made.high, height);
  }
  // What it reaches through is often not at its rim: that of a body that has come right through a plate is at one face.
  for (std::size_t i = 0; i < made.chosen.count; ++i) {
    const Witness& w = made.chosen.witnesses[i];
    made.low = std::min(made.low, made.normal.dot(w.on_a - rim.origin));
    made.high = std::max(made.high, made.normal.dot(w.on_b - rim.origin));
  }
  return made;
}

PatchBuilder::PatchBuilder(std::size_t hit_capacity)
    : scratch_(std::make_unique<Scratch>(std::clamp<std::size_t>(hit_capacity, 8, 65536))) {}
PatchBuilder::~PatchBuilder() = default;
PatchBuilder::PatchBuilder(PatchBuilder&&) noexcept = default;
PatchBuilder& PatchBuilder::operator=(PatchBuilder&&) noexcept = default;

std::span<const Contact> PatchBuilder::build(const PatchInput& input, const Deadline& deadline,
                                             const Deadline& last) noexcept {
  Scratch& s = *scratch_;
  s.kernels = input.kernels != nullptr ? input.kernels : &patch::best_kernels();
  Watch watch(deadline);
  s.place_pairs(input, watch);
  s.piece_count = 0;
  s.finished = s.make_patches(input, watch);
  s.most_wanted = static_cast<std::size_t>(std::clamp(input.max_contacts, 1, most_contacts));
  s.contact_count = 0;
  if (!s.finished) {
    s.make_hasty_contacts(input, last);
  } else {
    s.drop_crumbs();
    s.drop_opposed(input.previous_normal, watch);
    s.write(input, watch);
  }
  return {s.contacts.data(), s.contact_count};
}

bool PatchBuilder::finished() const noexcept { return scratch_->finished; }
std::uint32_t PatchBuilder::pairs_used() const noexcept {
  return static_cast<std::uint32_t>(scratch_->finished ? scratch_->pair_count
                                                       : std::min(scratch_->piece_count, hasty_pieces));
}

}  // namespace odds::query
