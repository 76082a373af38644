// Printed by odds_calibration --nodes --poses 6 (tests/calibration) of the 18 pairs of meshes that it named as of commit
// 70a52d9; the last row of node_weights with --poses 80. Do not edit by hand.
#pragma once

#include <array>

#include "query/node_odds/node_odds.hpp"

namespace odds::query {

/// By volume::Kind, of the generic framework.
inline constexpr std::array<NodeWeights, 7> node_weights = {{
    {0.9325F, 0.5016F, 0.4990F, 2.0275F, -0.0919F, 0.2472F, -1.7333F},  // aabb
    {0.9053F, 0.5802F, 0.7979F, 1.2206F, -0.0937F, 0.4965F, -1.4929F},  // obb
    {3.0320F, 0.5124F, 0.6690F, 2.4135F, -0.1175F, 0.3559F, -3.8036F},  // sphere
    {0.5156F, 0.4637F, 0.5384F, 1.9036F, -0.1008F, 0.2004F, -0.8332F},  // kdop14
    {0.4402F, 0.4467F, 0.5811F, 1.7293F, -0.0905F, 0.1742F, -0.5424F},  // kdop18
    {0.3810F, 0.3883F, 0.7004F, 1.5905F, -0.0895F, 0.2055F, -0.2840F},  // kdop26
    {2.1670F, 0.3118F, 0.3803F, 0.7706F, -0.2379F, 0.0761F, -1.1457F, -0.1992F, -0.3518F, 0.0395F, -1.4097F,
     -0.0976F},  // hull
}};
static_assert(node_weights.size() + 1 == volume::kind_names.size(), "a bounding volume but wide, the last, lacks its row");

/// What orders a search of hulls. The odds that know which surfaces face the same way are truer, and prove less.
inline constexpr NodeWeights hull_order = {1.7432F, 0.4108F, 0.8007F, 0.2896F, -0.1292F, 0.7450F, -0.1518F};

/// The weights of what orders a search, all of the usual numbers.
[[nodiscard]] constexpr const NodeWeights& order_weights(volume::Kind kind) noexcept {
  return kind == volume::Kind::hull ? hull_order : node_weights[static_cast<std::size_t>(kind)];
}

}  // namespace odds::query
