// The one direction of a patch.
#pragma once

#include <cstdint>
#include <span>

#include "query/patch_components.hpp"

namespace odds::query::patch {

/// One patch with what its direction is chosen from.
struct PatchView {
  const PatchInput& input;
  const Rim& rim;
  const RimSums& sums;
  std::span<const std::uint32_t> pieces;  ///< indices of its pieces in the rim
  std::size_t sample = 24;                ///< most triangle pairs to look at when candidates are compared
};

/// Unit normal into A. When the time is up, what is known by then. See PatchBuilder for the rule. Always finite and of
/// unit length.
[[nodiscard]] Vec3 patch_normal(const PatchView& view, Watch& watch) noexcept;

/// The direction of least overlap among the normals of the patch's faces and its vector area, measured right through
/// the bodies. Unit.
[[nodiscard]] Vec3 shortest_way_out(const PatchView& view, Watch& watch) noexcept;

}  // namespace odds::query::patch
