// The Open Dynamics Engine's own triangle meshes (OPCODE), as one of the engines that are compared.
#pragma once

#include "benchmark/peer.hpp"

namespace odds::benchmark {

/// dCollide of two dTriMesh geoms: one unimportant contact for `collide`, room for so many `contacts` (1 to 65,535)
/// else; where more are found, it stops making them.
[[nodiscard]] std::unique_ptr<Peer> make_ode_peer(const MeshPair& meshes, int contacts, int builds);

}  // namespace odds::benchmark
