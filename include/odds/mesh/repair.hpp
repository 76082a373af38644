// Mending a mesh's faults, and saying what was done.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "odds/mesh/triangle_mesh.hpp"

namespace odds::mesh {

/// Which repairs to make, in this order. None moves a vertex or invents a triangle: holes stay open, slivers stay thin.
struct RepairOptions {
  bool weld = true;             ///< one vertex for all vertices at exactly the same position
  bool drop_degenerate = true;  ///< triangles with a repeated vertex or exactly zero area; none that closes a gap
  bool drop_duplicates = true;  ///< triangles with the same three vertices as an earlier one, in any order
  bool orient = true;           ///< turn triangles so that neighbours agree, and closed components outwards
  bool drop_unused = true;      ///< vertices in no triangle
};

/// How much each repair changed.
struct RepairLog {
  std::size_t welded_vertices = 0;
  std::size_t flipped_degenerate = 0;  ///< now part of the triangle beyond their long side, which was cut for them
  std::size_t dropped_degenerate = 0;
  std::size_t dropped_duplicates = 0;
  std::size_t turned_triangles = 0;         ///< to agree with their neighbours or to face outwards
  std::size_t turned_components = 0;        ///< closed and inside out
  std::size_t turned_inner_components = 0;  ///< closed, within one of those: turned over with it
  std::size_t cavities_kept = 0;            ///< closed components that face inwards inside another closed one: left so
  std::size_t unorientable_components = 0;  ///< left as they were (as a Moebius strip)
  std::size_t dropped_vertices = 0;

  [[nodiscard]] bool changed() const noexcept {
    return welded_vertices + flipped_degenerate + dropped_degenerate + dropped_duplicates + turned_triangles +
               dropped_vertices >
           0;
  }
  /// One sentence for each thing done or left; "nothing to repair" if there is none.
  [[nodiscard]] std::vector<std::string> lines() const;
};

struct Repaired {
  TriangleMesh mesh;
  RepairLog log;
};

/// Components for turning are connected through edges of exactly two triangles; of two orders the one that turns fewer
/// triangles is taken, the first triangle's where both turn as many. Fails only if no triangle is left. Thread-safe.
Result<Repaired> repair(const TriangleMesh& mesh, const RepairOptions& options = {});

}  // namespace odds::mesh
