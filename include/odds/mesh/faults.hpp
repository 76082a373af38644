// What is wrong with a mesh, by triangle, edge and vertex.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "odds/mesh/triangle_mesh.hpp"

namespace odds::mesh {

/// How many of a kind, and the first few of them in ascending order.
template <class Item>
struct Finding {
  std::size_t count = 0;
  std::vector<Item> examples;  ///< at most FaultOptions::examples
};

using Edge = std::array<std::uint32_t, 2>;  ///< two vertex indices, the smaller first

struct FaultOptions {
  std::size_t examples = 16;    ///< indices kept per kind
  double sliver_height = 1e-3;  ///< a triangle lower than this share of its longest edge is a sliver, (0, 0.5]
};

/// A mesh's faults and topology. Vertices are compared by position, exactly (0 equals -0), so that a mesh whose
/// triangles do not share indices is judged like one whose do; edges and vertices are named by the least index at a
/// position. Edges are those of triangles without a repeated vertex.
struct Faults {
  // Triangles
  Finding<std::uint32_t> degenerate;  ///< a repeated position, or exactly zero area (exact arithmetic)
  Finding<std::uint32_t> duplicate;   ///< the same three positions as an earlier triangle, in any order
  Finding<std::uint32_t> sliver;      ///< thin, but not degenerate
  // Edges
  Finding<Edge> boundary;      ///< one triangle
  Finding<Edge> non_manifold;  ///< more than two triangles
  Finding<Edge> inconsistent;  ///< two triangles that run through it in the same direction
  // Vertices
  Finding<std::uint32_t> non_manifold_vertex;  ///< its triangles fall into more than one fan
  Finding<std::uint32_t> duplicate_vertex;     ///< the same position as an earlier vertex, both used
  Finding<std::uint32_t> unused_vertex;        ///< in no triangle

  bool closed = false;      ///< no boundary edge
  bool manifold = false;    ///< no non-manifold edge, no non-manifold vertex
  bool orientable = false;  ///< triangles can be turned so that no edge of two triangles is inconsistent
  std::size_t components =
      0;              ///< parts connected through edges; triangles with a repeated vertex have none and do not count
  double area = 0.0;  ///< square metres
  /// Cubic metres, positive if the triangles face outwards; only where closed and without inconsistent edges. Exactly 0
  /// where it is no more than rounding, as of a sheet whose triangles are there twice, once for each side.
  std::optional<double> volume;

  [[nodiscard]] bool consistent() const noexcept { return inconsistent.count == 0; }
  /// Nothing that asks for repair: no degenerate or duplicate triangle, manifold, consistent, facing outwards if
  /// closed.
  [[nodiscard]] bool clean() const noexcept {
    return degenerate.count == 0 && duplicate.count == 0 && manifold && consistent() && volume.value_or(0.0) >= 0.0;
  }
};

/// Time n log n, memory about 100 bytes a triangle. Thread-safe.
[[nodiscard]] Faults find_faults(const TriangleMesh& mesh, const FaultOptions& options = {});

/// Whether three points lie on a line: exact as long as no two coordinate differences of one axis are more than a
/// factor of 1e150 apart. Thread-safe.
[[nodiscard]] bool has_zero_area(const Vec3& a, const Vec3& b, const Vec3& c) noexcept;

/// A sentence if the mesh's size or place suggests another unit or a loss of accuracy, else empty. Only a hint.
[[nodiscard]] std::string units_hint(const TriangleMesh& mesh);

}  // namespace odds::mesh
