// Lookups in one wide tree: boxes.
#pragma once

#include <cstdint>
#include <span>

#include "odds/mesh/triangle_mesh.hpp"
#include "odds/tree/wide_tree.hpp"
#include "odds/volume/concept.hpp"

namespace odds::query::wide {

/// Bits of the lanes whose boxes meet the oriented box {center + axes * x, |x_i| <= half_i}, all widened by `margin`.
[[nodiscard]] unsigned lanes_in_box(const tree::WideNode& node, const Vec3f& center, const Mat3f& axes,
                                    const Vec3f& half, float margin) noexcept;

}  // namespace odds::query::wide
