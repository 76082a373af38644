#include "query/wide/lookup.hpp"

#include <algorithm>
#include <cmath>

#include "odds/volume/box_overlap.hpp"

namespace odds::query::wide {

unsigned lanes_in_box(const tree::WideNode& node, const Vec3f& center, const Mat3f& axes, const Vec3f& half,
                      float margin) noexcept {
  unsigned met = 0;
  const Mat3f abs_axes = axes.cwiseAbs().array() + 2.4e-7F;
  for (std::uint32_t lane = 0; lane < tree::wide_lanes; ++lane) {
    if (node.child[lane].is_nothing()) break;
    const Vec3f own(node.half[0][lane], node.half[1][lane], node.half[2][lane]);
    const Vec3f middle(node.center[0][lane], node.center[1][lane], node.center[2][lane]);
    if (volume::faces_overlap(own, half, {center - middle, axes, abs_axes}, margin)) met |= 1U << lane;
  }
  return met;
}

}  // namespace odds::query::wide
