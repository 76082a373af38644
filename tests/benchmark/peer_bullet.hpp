// Bullet's GImpact meshes, as one of the engines that are compared; built only where Bullet is installed.
#pragma once

#include "benchmark/peer.hpp"

namespace odds::benchmark {

/// Two GImpact shapes in single precision, margin 0. GImpact knows no early end: `collide` finds all contacts too.
[[nodiscard]] std::unique_ptr<Peer> make_bullet_peer(const MeshPair& meshes, int builds);

}  // namespace odds::benchmark
