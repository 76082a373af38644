// Pairs of nodes that a search may look at: what is known of them, and what was true.
#pragma once

#include <cstdint>
#include <vector>

#include "calibration/unproved.hpp"
#include "query/node_odds/node_odds.hpp"

namespace odds::calibration {

struct JudgedPair {
  query::NodeNumbers numbers;
  bool meet = false;       ///< triangles below both meet
  double offset = 0.0;     ///< of the pose from first touch, parts of the size; see report::PoseBand
  std::uint64_t line = 0;  ///< how many poses of this distance came before
};

/// Up to 48 pairs of each pose. Fails as reading, building and posing do. Precondition: a volume of the generic
/// framework.
[[nodiscard]] Result<std::vector<JudgedPair>> judged_pairs(const Meeting& meeting, volume::Kind volume,
                                                           std::uint64_t poses_per_band, std::uint64_t seed);

}  // namespace odds::calibration
