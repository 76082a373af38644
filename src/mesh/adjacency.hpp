// Which triangles share positions and edges; what finding and repairing faults start from. Private to mesh.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "odds/mesh/faults.hpp"
#include "odds/mesh/triangle_mesh.hpp"

namespace odds::mesh {

/// For each vertex the least index of a vertex at exactly the same position (0 equals -0).
std::vector<std::uint32_t> first_at_position(std::span<const Vec3> vertices);

[[nodiscard]] inline bool repeats_vertex(const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

/// One side of a triangle.
struct EdgeUse {
  Edge edge;               ///< smaller index first
  std::uint32_t triangle;  ///< index
  bool forward;            ///< whether the triangle runs from the smaller index to the greater
};

/// The sides of all triangles without a repeated vertex, sorted by edge, then triangle.
std::vector<EdgeUse> sorted_edge_uses(std::span<const Triangle> triangles);

/// Calls `visit` once for each edge with its uses.
void for_each_edge(std::span<const EdgeUse> uses, const std::function<void(std::span<const EdgeUse>)>& visit);

/// Indices of triangles that have the same three indices as an earlier one, in any order; ascending.
std::vector<std::uint32_t> later_duplicates(std::span<const Triangle> triangles);

/// Disjoint sets with a parity between members and their root: which triangles belong together and which of them would
/// have to be turned.
class ParitySets {
 public:
  explicit ParitySets(std::size_t count);
  struct Place {
    std::uint32_t root;
    bool odd;  ///< turned against the root
  };
  Place find(std::uint32_t item);
  /// Joins two sets so that a and b have (odd: opposite) parity; false if they were joined already the other way.
  bool join(std::uint32_t a, std::uint32_t b, bool odd);

 private:
  std::vector<std::uint32_t> parent_;
  std::vector<bool> odd_;
};

}  // namespace odds::mesh
