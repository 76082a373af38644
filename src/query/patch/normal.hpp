// The one direction of a patch.
#pragma once

#include <cstdint>
#include <span>

#include "odds/math/tolerances.hpp"
#include "query/patch/components.hpp"

namespace odds::query::patch {

/// One patch with what its direction is chosen from.
struct PatchView {
  const PatchInput& input;
  const Kernels& kernels;
  const Rim& rim;
  const RimSums& sums;
  std::span<const std::uint32_t> pieces;  ///< indices of its pieces in the rim
  std::size_t sample = 24;                ///< most triangle pairs to look at when candidates are compared
};

/// Whether some of the rim is missing. Solids cross in closed curves; a sheet's rim ends where the sheet does.
[[nodiscard]] inline bool is_part_of_a_rim(const PatchView& view) noexcept {
  return view.input.solid_a && view.input.solid_b && !view.sums.closed();
}

/// Whether a sheet's border has come into a body from one side, so that the rim ends where the sheet does.
[[nodiscard]] inline bool ends_at_a_border(const PatchView& view) noexcept {
  return view.input.found_all && !(view.input.solid_a && view.input.solid_b) && !view.sums.closed() &&
         view.sums.gap.norm() > tolerances::gap_of_a_border * view.sums.length;
}

struct PatchNormal {
  Vec3 into_a;        ///< unit
  Vec3 shortest_way;  ///< what shortest_way_out would find, if that was looked for; else zero
};

/// When the time is up, what is known by then. See PatchBuilder for the rule. Always finite and of unit length.
[[nodiscard]] PatchNormal patch_normal(const PatchView& view, Watch& watch) noexcept;

/// The direction of least overlap among the normals of the patch's faces and its vector area, measured right through
/// the bodies. Unit.
[[nodiscard]] Vec3 shortest_way_out(const PatchView& view, Watch& watch) noexcept;

/// Whether the patch, if more of its rim were known, may be one of this direction: it is no deeper along it than
/// `depth` (metres), for neither is its rim higher, nor do its pairs of triangles, a sample of them, overlap by more;
/// and most of the rim is on a face that leads there, or between faces that are flush and lead nowhere, or all of it is
/// a lump smaller than the depth. A wall whose triangles are larger than that never is of a direction along it. False
/// if the time is up.
[[nodiscard]] bool is_of_direction(const PatchView& view, const Vec3& direction, double depth, Watch& watch) noexcept;

}  // namespace odds::query::patch
