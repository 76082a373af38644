// The Flexible Collision Library, as one of the engines that are compared.
#pragma once

#include "benchmark/peer.hpp"

namespace odds::benchmark {

/// Hierarchies of OBBRSS in doubles; `contacts` asks for all of them.
[[nodiscard]] std::unique_ptr<Peer> make_fcl_peer(const MeshPair& meshes, int builds);

}  // namespace odds::benchmark
