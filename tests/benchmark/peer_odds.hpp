// This library, as one of the engines that are compared.
#pragma once

#include "benchmark/peer.hpp"
#include "odds/query/request.hpp"
#include "odds/volume/kind.hpp"

namespace odds::benchmark {

/// One bounding volume, one method, with or without a test of volumes between leaves, no budget. Throws
/// std::runtime_error if the mesh cannot be built.
[[nodiscard]] std::unique_ptr<Peer> make_odds_peer(const MeshPair& meshes, volume::Kind volume, query::Method method,
                                                   bool leaf_test, int builds);

}  // namespace odds::benchmark
