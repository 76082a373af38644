// Which patches have no direction of their own, but that of the others.
#include <algorithm>

#include "odds/math/tolerances.hpp"
#include "query/patch/scratch.hpp"

namespace odds::query {
namespace {

using patch::Patch;
using patch::thorough;
using patch::Watch;
using patch::Witness;

/// Whether a ray along the direction says that solids overlap by no more than `depth` at the patch's first contact. Its
/// faces may lean away all the same, as of a cone whose foot hangs over an edge by a trifle.
bool is_seen_through(const patch::PatchView& view, const Patch& made, const Vec3& direction, double depth,
                     Watch& watch) noexcept {
  if (!view.input.solid_a || !view.input.solid_b || made.chosen.count == 0) return false;
  const double reach = 2.0 * (view.sums.diagonal() + made.depth);
  Witness through;
  return patch::probe_overlap(view.input, made.chosen.witnesses[0].middle(), direction, reach, watch, through) &&
         through.depth <= depth;
}

}  // namespace

/// A few pieces that a search without time has left of a rim, say along the side of a brick that stands flush on
/// another, span an area of their own: where a brick hangs over by as little as it is deep, that points anywhere. Nor
/// has a crumb that rounding has left of a whole rim a direction of its own. What is no deeper than is believed, or
/// else than the rest is, along the direction that is known, or else that on which most of the rim agrees, belongs to
/// that.
void PatchBuilder::Scratch::straighten(const PatchInput& input, std::span<const patch::RimSums> sums,
                                       Watch& watch) noexcept {
  const double rounding = tolerances::rim_noise * rim.origin.cwiseAbs().maxCoeff();
  const std::span<const Patch> made(patches.data(), patch_count);
  const auto agree = [](const Vec3& x, const Vec3& y) noexcept { return x.dot(y) > tolerances::same_face; };
  const Vec3* chosen = input.known_normal;
  double longest = 0.0;
  for (std::size_t p = 0; p < patch_count && input.known_normal == nullptr; ++p) {
    double agreeing = 0.0;
    for (const Patch& other : made) agreeing += agree(other.normal, made[p].normal) ? other.length + rounding : 0.0;
    if (!(agreeing > longest)) continue;
    chosen = &made[p].normal;
    longest = agreeing;
  }
  if (chosen == nullptr) return;
  const Vec3 direction = *chosen;
  double deepest = 0.0;
  for (const Patch& patch : made) deepest = agree(patch.normal, direction) ? std::max(deepest, patch.depth) : deepest;
  const double limit = input.believed_depth > 0.0 ? input.believed_depth : deepest + rounding;
  for (std::size_t p = 0; p < patch_count && !watch.late(); ++p) {
    Patch& own = patches[p];
    if (own.in_corner || agree(own.normal, direction)) continue;
    const std::size_t i = own.component;
    const Indices indices = pieces_of(i);
    // A whole rim has a direction of its own, unless this is by far the shorter way out: as of a lump between faces
    // that are flush to within rounding, which overlaps from one end of them to the other.
    const bool is_whole = sums[i].closed() && sums[i].length > 0.0;
    const double most =
        is_whole ? std::min(tolerances::flush_lump * limit, tolerances::by_far_shorter * own.depth) : limit;
    const patch::PatchView view{input, *kernels, rim, sums[i], indices, thorough.sample};
    const bool is_of_it = is_whole && is_seen_through(view, own, direction, most, watch);
    if (!is_of_it && !patch::is_of_direction(view, direction, most, watch)) continue;
    const Patch straight = patch_along(direction, input, sums[i], indices, thorough, watch, {}, most);
    if (watch.late()) return;  // it was not measured to its end
    if (!(straight.depth <= most)) continue;
    own = straight;
    own.component = i;
  }
}

}  // namespace odds::query
