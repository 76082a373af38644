// Which triangles belong together: the binary tree before any bounding volume is fitted to it.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "odds/math/types.hpp"

namespace odds::tree {

using Progress = std::function<void(double share)>;
using TriangleCorners = std::array<Vec3, 3>;

/// Inner node: children are nodes `first` and `first + 1`, count = 0. Leaf: triangles order[first .. first + count).
/// Either way triangles order[begin .. end) are all those below the node. Children come after their parents.
struct TopologyNode {
  std::uint32_t first = 0;
  std::uint32_t count = 0;
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
  std::uint8_t depth = 0;
  std::uint8_t height = 0;
  [[nodiscard]] bool is_leaf() const noexcept { return count != 0; }
};

struct Topology {
  std::vector<TopologyNode> nodes;   ///< node 0 is the root
  std::vector<std::uint32_t> order;  ///< permutation of the triangles, leaves contiguous
  std::uint32_t levels = 0;          ///< depth of the deepest node + 1, at most deepest_level
};

/// Deeper than this a node is split at the median, so that stacks of fixed size hold every search.
inline constexpr std::uint32_t deepest_level = 64;

/// Top-down build by the surface area heuristic over 16 bins along each axis (Wald 2007); deterministic; O(n log n).
/// `leaf_triangles` in 1 .. 16. Big meshes are divided among `threads` threads (0: as many as there are processors),
/// which changes nothing in the result; `progress` is called by the calling thread only.
[[nodiscard]] Topology build_topology(std::span<const TriangleCorners> triangles, std::uint32_t leaf_triangles,
                                      const Progress& progress = {}, std::size_t threads = 0);

}  // namespace odds::tree
