// This library, as one of the engines that are compared.
#pragma once

#include <limits>

#include "benchmark/peer.hpp"
#include "odds/query/request.hpp"
#include "odds/volume/kind.hpp"

namespace odds::benchmark {

/// How it is asked.
struct OddsSettings {
  volume::Kind volume = volume::Kind::wide;
  query::Method method = query::Method::exact;
  bool leaf_test = true;  ///< whether volumes of leaves are tested before their triangles
  double budget_us = std::numeric_limits<double>::infinity();
};

/// Throws std::runtime_error if the mesh cannot be built.
[[nodiscard]] std::unique_ptr<Peer> make_odds_peer(const MeshPair& meshes, const OddsSettings& settings, int builds);

}  // namespace odds::benchmark
