// Other ways out of a patch than the one that its rim says.
#include <algorithm>
#include <array>
#include <cmath>

#include "odds/math/tolerances.hpp"
#include "query/patch/scratch.hpp"

namespace odds::query {
namespace {

using patch::Effort;
using patch::Patch;
using patch::Watch;
using patch::Witness;

/// How deep a patch is by how wide its rim is where it is narrow.
double slenderness(const Patch& made, const patch::PatchView& view) noexcept {
  return made.depth * view.sums.diagonal() / view.sums.vector_area(view.rim.origin).norm();
}

/// Whether a whole rim of solids may be only where something slender stands out of one of them at a side, as of a plate
/// that came through the top of a table and reaches over its edge.
bool may_be_at_a_side(const patch::PatchView& view) noexcept {
  const PatchInput& input = view.input;
  return input.solid_a && input.solid_b && input.probe_a && input.probe_b && !patch::is_part_of_a_rim(view);
}

/// Whether its area leads out there, the long way. Of what has only just met, as a knife that rests on an edge, the
/// area is right.
bool leads_out_at_a_side(const Patch& made, const patch::PatchView& view) noexcept {
  constexpr double slender = 2.0;
  return may_be_at_a_side(view) &&
         made.depth > tolerances::coherent_motion * patch::lever_of(view.input, made.centre) &&
         slenderness(made, view) > slender;
}

/// Whether another direction is known to lead out, across the area, through all of it. Not where that is rounding.
bool leads_across(const Patch& made, const patch::PatchView& view) noexcept {
  constexpr double across = 0.3;  // cosine
  const Vec3 area = view.sums.vector_area(view.rim.origin);
  const double reach = view.rim.origin.cwiseAbs().maxCoeff() + view.sums.diagonal();
  return may_be_at_a_side(view) && area.norm() > tolerances::rim_noise * reach * view.sums.length &&
         std::abs(made.normal.dot(area)) < across * area.norm() && slenderness(made, view) > 1.0;
}

}  // namespace

/// The patch, or another way out of it that is shorter. `known`: the shortest, or zero.
Patch PatchBuilder::Scratch::shorter_way_out(const Patch& made, const Vec3& known, const patch::PatchView& view,
                                             const Effort& effort, Watch& watch) noexcept {
  const patch::RimSums& sums = view.sums;
  // A lump at the corner of two faces that nearly coincide has an area of its own, along which the bodies overlap from
  // end to end. Where pieces of a rim are missing, what is left of it may be such a lump whatever its size.
  const double wide = (patch::is_part_of_a_rim(view) ? 1.0 : tolerances::lump_depth) * sums.diagonal();
  const bool is_lump = made.depth > wide;
  const bool is_known = known != Vec3::Zero();
  if (sums.length == 0.0 || watch.late()) return made;
  const auto along = [&](const Vec3& way) noexcept {
    return patch_along(way, view.input, sums, view.pieces, effort, watch);
  };
  if (!is_lump && is_known && leads_across(made, view)) {
    Patch held = made;
    reach_in(along(sums.vector_area(rim.origin).normalized()), view, held, watch);
    return held;
  }
  if (!is_lump && (is_known || !leads_out_at_a_side(made, view))) return made;
  const Vec3 way = is_known ? known : patch::shortest_way_out(view, watch);
  if (way == made.normal) return made;
  Patch other = along(way);
  if (!is_lump) reach_in(made, view, other, watch);
  return other.depth < (is_lump ? 1.0 : tolerances::by_far_shorter) * made.depth ? other : made;
}

/// Adds what lies where `run_in`, the same patch along its area, comes to its ends: the rim is at one side of a plate,
/// and held there alone the other side would sink.
void PatchBuilder::Scratch::reach_in(const Patch& run_in, const patch::PatchView& view, Patch& made,
                                     Watch& watch) noexcept {
  const double reach = 2.0 * (view.sums.diagonal() + run_in.depth);
  std::array<Witness, 3 * most_contacts> all;
  std::size_t count = 0;
  for (std::size_t i = 0; i < made.chosen.count; ++i) all[count++] = made.chosen.witnesses[i];
  for (std::size_t i = 0; i < run_in.chosen.count; ++i) {
    for (const Vec3& end : {run_in.chosen.witnesses[i].on_a, run_in.chosen.witnesses[i].on_b}) {
      const Vec3 place = end + 0.02 * (run_in.centre - end);  // a little inside, as where patches are measured
      if (patch::probe_overlap(view.input, place, made.normal, reach, watch, all[count])) ++count;
    }
  }
  if (watch.late() || count == 0) return;
  const patch::Frame frame(made.normal);
  const Witness deepest = patch::deepest_of({all.data(), count}, frame, made.centre, 0.25 * reach);
  for (std::size_t i = 0; i < count; ++i) all[i] = patch::pulled_in(all[i], deepest);
  made.depth = deepest.depth;
  made.chosen = patch::choose({all.data(), count}, frame, most_contacts,
                              patch::spacing(made.depth, patch::lever_of(view.input, made.centre)), &watch);
  made.centre.setZero();
  for (std::size_t i = 0; i < made.chosen.count; ++i) {
    const Witness& w = made.chosen.witnesses[i];
    made.centre += w.middle() / static_cast<double>(made.chosen.count);
    made.lower = made.lower.cwiseMin(w.middle());
    made.upper = made.upper.cwiseMax(w.middle());
    made.low = std::min(made.low, made.normal.dot(w.on_a - rim.origin));
    made.high = std::max(made.high, made.normal.dot(w.on_b - rim.origin));
  }
}

}  // namespace odds::query
