// The Open Dynamics Engine's own triangle meshes (OPCODE), as one of the engines that are compared.
#pragma once

#include "benchmark/peer.hpp"

namespace odds::benchmark {

/// dCollide of two dTriMesh geoms: one unimportant contact for `collide`, 32 for `contacts`.
[[nodiscard]] std::unique_ptr<Peer> make_ode_peer(const MeshPair& meshes, int builds);

}  // namespace odds::benchmark
