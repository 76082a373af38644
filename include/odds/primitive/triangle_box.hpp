// Triangle against oriented box: a conservative overlap test by separating axes.
#pragma once

#include "odds/math/types.hpp"

namespace odds::primitive {

/// False only if the triangle and the box {center + axes * x : |x_i| <= half_extents_i} are apart; true if they meet or
/// come within rounding (some 1e-13 of the largest distance involved) of it. All 13 axes are tried: 3 of the box, the
/// triangle's normal, 9 products of edges. Lengths in one unit below 1e100; `axes` orthonormal to rounding, the box's
/// directions as columns; half extents >= 0; triangles without area are welcome. No allocation; thread-safe. Source: T.
/// Akenine-Moeller, "Fast 3D Triangle-Box Overlap Testing", 2001.
[[nodiscard]] bool triangle_may_overlap_box(const Vec3 triangle[3], const Vec3& center, const Mat3& axes,
                                            const Vec3& half_extents) noexcept;

}  // namespace odds::primitive
