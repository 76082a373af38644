// What a search left undecided, in the numbers from which an answer's probability is made.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "odds/math/elementary.hpp"
#include "query/search/search.hpp"

namespace odds::query {

/// Without a unit, all of order 1 to 10.
struct Remains {
  float open = 0.0F;    ///< log2(1 + pairs of nodes left undecided)
  float spent = 0.0F;   ///< log2(1 + pairs of nodes looked at)
  float tested = 0.0F;  ///< log2(1 + pairs of triangles looked at), none of which met; without polygons, of 64 times
                        ///< the sum of the probabilities of the pairs of leaves looked at
  float logit = 0.0F;   ///< log2(p / (1 - p)) of the likeliest of them by the estimator, within 10
  float rank = 0.0F;    ///< of that pair, -10 .. 6
  float facing = 0.0F;  ///< how much its surfaces face the same way, 0 .. 1: then one lies behind the other
  float thin = 0.0F;    ///< log2 of how thick the thinner of them is, over the reach of the smaller body; -16 .. 0
  float small = 0.0F;   ///< log2 of the radius of its smaller node, over the same; -16 .. 0
};

/// `met` is an encounter; `spent` says what the search took; `probability` is that of the highest of the shortlist,
/// which must not be empty.
template <class Met>
[[nodiscard]] Remains remains_of(const Met& met, const SearchResult& result, const Cost& spent, float probability,
                                 bool polygon_free) noexcept {
  const NodePair& likeliest = result.shortlist.highest();
  const float p = std::clamp(probability, 1e-3F, 0.999F);
  Remains remains;
  remains.open = math::rough_log2(1.0 + static_cast<double>(result.open));
  remains.spent = math::rough_log2(1.0 + static_cast<double>(spent.node_pairs));
  constexpr float to_usual_range = 64.0F;
  remains.tested = math::rough_log2(1.0 + (polygon_free ? static_cast<double>(to_usual_range * result.judged.sum)
                                                        : static_cast<double>(spent.triangle_pairs)));
  remains.logit = math::rough_log2(static_cast<double>(p / (1.0F - p)));
  remains.rank = std::clamp(likeliest.rank, -10.0F, 6.0F);
  remains.facing = std::clamp(met.facing(likeliest.a, likeliest.b), 0.0F, 1.0F);
  const double reach = std::min(met.a().reach(), met.b().reach());
  // Without reach, as of a mesh that is one point, nothing is thin or small.
  const auto part = [&](double length) noexcept {
    return math::rough_log2(reach > 0.0 ? std::clamp(length / reach, 0x1p-16, 1.0) : 1.0);
  };
  remains.thin = part(met.thickness(likeliest.a, likeliest.b));
  remains.small = part(met.smaller_radius(likeliest.a, likeliest.b));
  return remains;
}

}  // namespace odds::query
