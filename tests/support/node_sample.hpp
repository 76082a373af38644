// Pairs of nodes as a search meets them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "odds/math/random.hpp"
#include "query/search/search.hpp"

namespace odds::testing {

/// Up to `most` of the pairs that an exhaustive search looks at (of its first 20,000), each as likely as any other, and
/// never the roots.
template <volume::BoundingVolume V>
std::vector<query::NodePair> sample_nodes(const query::Encounter<V>& met, std::size_t most, std::uint64_t seed) {
  constexpr std::size_t most_looked_at = 20000;
  std::vector<query::NodePair> kept;
  if (met.far_apart() || !met.volumes_overlap(0, 0)) return kept;
  math::Random random(0xAB1A, seed);
  std::vector<query::NodePair> open = {{0, 0, 0.0F}};
  std::size_t seen = 0;
  while (!open.empty() && seen < most_looked_at) {
    const query::NodePair pair = open.back();
    open.pop_back();
    if (met.is_leaf_pair(pair.a, pair.b)) continue;
    const auto children = met.children(pair.a, pair.b);
    for (const query::NodePair& child : {children.first, children.second}) {
      if (!met.volumes_overlap(child.a, child.b)) continue;
      open.push_back(child);
      ++seen;
      if (kept.size() < most) {  // reservoir sampling
        kept.push_back(child);
      } else if (const auto at = static_cast<std::size_t>(random.below(seen)); at < most) {
        kept[at] = child;
      }
    }
  }
  return kept;
}

/// Whether triangles below both nodes meet. `hits` is memory for it.
template <volume::BoundingVolume V>
bool meet_below(const query::Encounter<V>& met, const query::NodePair& pair, query::HitList& hits) {
  query::Spending spending{query::Budget::unlimited()};
  query::SearchResult result;
  hits.clear();
  query::search_depth_first(met, pair, 1, hits, spending, result);
  return !hits.empty();
}

}  // namespace odds::testing
