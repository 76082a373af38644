// A mesh made ready for queries: hierarchy and node statistics, with the bounding volume chosen by name.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include "odds/math/error.hpp"
#include "odds/math/types.hpp"
#include "odds/mesh/triangle_mesh.hpp"
#include "odds/volume/kind.hpp"

namespace odds::query {

/// Called with the share done in [0, 1] during a build, from the building thread; may be empty.
using Progress = std::function<void(double share)>;

struct ShapeOptions {
  volume::Kind volume = volume::Kind::wide;
  std::uint32_t leaf_triangles = 0;  ///< most triangles in a leaf, 1 .. 16 (wide: 8); 0: 8 for wide, 4 for others
  double tau = 0.25;  ///< a cell is well filled from tau * MaxArea on, in (0, 1]; the book's value 1 is dead
                      ///< on smooth meshes (measured: 0-1 of 512 cells below the top levels)
};

/// Numbers about a hierarchy for people.
struct ShapeSummary {
  std::size_t triangles = 0;
  std::size_t nodes = 0;
  std::size_t leaves = 0;
  std::uint32_t depth = 0;  ///< levels, root = 1
  double mean_leaf_triangles = 0.0;
  std::size_t bytes = 0;                ///< hierarchy, statistics and triangles together, without the mesh
  std::size_t mesh_bytes = 0;           ///< vertices and indices of the mesh
  std::size_t polygon_free_bytes = 0;   ///< what Shape::without_polygons keeps of both
  double mean_well_filled_cells = 0.0;  ///< of 512, over all inner nodes
  double build_ms = 0.0;
  double load_ms = 0.0;  ///< of a saved shape; 0 for one that was built here
};

/// Immutable; shareable among threads and pairs. Holds the mesh alive.
class Shape {
 public:
  struct Data;  // private to src/query

  /// Builds the hierarchy of a mesh, whose coordinates are metres, in its own frame. An error names the mesh, what is
  /// wrong and what to do: no mesh, `leaf_triangles` or `tau` out of range, a wide tree of too many nodes. For set-up,
  /// not for a loop: it allocates, and takes a microsecond or two a triangle, of large meshes divided among threads of
  /// its own. The shape does not depend on how many. Any number of threads may build at once, of one mesh too. May
  /// throw std::bad_alloc, and what `progress` throws.
  static Result<std::shared_ptr<const Shape>> build(std::shared_ptr<const mesh::TriangleMesh> mesh,
                                                    const ShapeOptions& options = {}, const Progress& progress = {});
  /// For src/query, where Data is known.
  static std::shared_ptr<const Shape> of(std::unique_ptr<Data> data);
  ~Shape();
  Shape(const Shape&) = delete;
  Shape& operator=(const Shape&) = delete;

  /// The same hierarchy without its polygons, after the book's footnote 6: it still answers queries, by probability at
  /// the leaves, so never with a proved hit, and without contacts; distances, rays and boxes find nothing. Shares what
  /// it keeps with this shape.
  [[nodiscard]] std::shared_ptr<const Shape> without_polygons() const;
  [[nodiscard]] bool has_polygons() const noexcept;

  /// Without polygons: the surface of the mesh's bounding box, under the mesh's name.
  [[nodiscard]] const mesh::TriangleMesh& mesh() const noexcept;
  [[nodiscard]] volume::Kind volume() const noexcept;
  [[nodiscard]] const ShapeOptions& options() const noexcept;
  [[nodiscard]] const ShapeSummary& summary() const noexcept;
  /// Closed, consistently wound, outwards: inside and outside are known. Otherwise the mesh is a two-sided sheet.
  [[nodiscard]] bool is_solid() const noexcept;
  /// Looks for the large flat faces of a solid now, some 0.4 us a triangle, for contacts in short budgets; else the
  /// first pair with PairOptions::late_contacts does it. Once; thread-safe. May throw std::bad_alloc.
  void find_flat_faces() const;
  [[nodiscard]] const Data& data() const noexcept { return *data_; }

 private:
  explicit Shape(std::unique_ptr<Data> data);
  std::unique_ptr<Data> data_;
};

/// Indices of all triangles that meet the oriented box {center + axes * x, |x_i| <= half_extents_i}, given in the
/// mesh's frame, and of some of which only the extents along its axes do, written to `found` until it is full or
/// `budget_nodes` nodes were visited; returns how many. noexcept, no allocation. `complete` (if not null) says whether
/// nothing was cut off, `visited` (likewise) how many nodes were visited.
std::size_t triangles_in_box(const Shape& shape, const Vec3& center, const Mat3& axes, const Vec3& half_extents,
                             std::span<std::uint32_t> found, std::uint64_t budget_nodes, bool* complete,
                             std::uint64_t* visited = nullptr) noexcept;

}  // namespace odds::query
