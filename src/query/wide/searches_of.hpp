// All searches for one instruction set, for the files that compile them; nobody else includes this.
#pragma once

#include "query/wide/beside_faces.hpp"
#include "query/wide/exact.hpp"
#include "query/wide/extents.hpp"
#include "query/wide/half_spaces.hpp"
#include "query/wide/incremental.hpp"
#include "query/wide/many_sides.hpp"
#include "query/wide/near_segment.hpp"
#include "query/wide/nearest.hpp"
#include "query/wide/outermost.hpp"
#include "query/wide/patch_kernel.hpp"
#include "query/wide/ray_cast.hpp"
#include "query/wide/time_critical.hpp"
#include "query/wide/way_down.hpp"

namespace odds::query::wide {

template <class L>
constexpr Searches searches_of() noexcept {
  return {L::name,
          &Exact<L>::run_from_roots,
          &TimeCritical<L>::run,
          &Incremental<L>::run,
          &BesideFaces<L>::run,
          &Nearest<L>::run,
          &RayCast<L>::run,
          &RayCast<L>::run_two,
          &WayDown<L>::run,
          &HalfSpaceKernel<L>::children,
          &HalfSpaceKernel<L>::triangles,
          &ExtentsKernel<L>::children,
          &ExtentsKernel<L>::triangles,
          &NearSegmentKernel<L>::children,
          &NearSegmentKernel<L>::triangles,
          &ManySidesKernel<L>::near,
          &ManySidesKernel<L>::way_out,
          &OutermostKernel<L>::along,
          &OutermostKernel<L>::from,
          PatchKernel<L>::table()};
}

}  // namespace odds::query::wide
