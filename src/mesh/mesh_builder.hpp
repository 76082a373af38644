// Collects vertices and polygons cut into triangles within the limits of ReadOptions and the bound on memory.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "mesh/input.hpp"
#include "mesh/polygon.hpp"
#include "odds/mesh/read.hpp"

namespace odds::mesh {

/// Errors take their place (line or byte) from the input that is being read.
class MeshBuilder {
 public:
  /// `stored_bytes` is the file's size as stored: the bound on memory refers to it.
  MeshBuilder(Input& input, const ReadOptions& options, std::uint64_t stored_bytes);

  /// Allocates for counts that were already compared with the bytes that are there.
  void reserve(std::uint64_t vertices, std::uint64_t triangles);
  /// Appends a vertex in the file's unit; refuses coordinates that are not finite or too large.
  void add_vertex(double x, double y, double z);
  /// The index of the vertex at exactly this position, appended if there is none yet (-0 equals 0).
  std::uint32_t weld_vertex(double x, double y, double z);

  void begin_polygon() noexcept {
    corners_ = 0;
    greatest_ = 0;
  }
  /// The next corner; from the third on each adds a triangle to the fan around the first. `vertex` < 2^32 may refer to
  /// a vertex that is still to come; the caller checks it.
  void add_corner(std::uint32_t vertex) {
    if (corners_ == 0) first_ = vertex;
    if (corners_ >= 2) add_triangle({first_, previous_, vertex});
    previous_ = vertex;
    greatest_ = std::max(greatest_, vertex);
    ++corners_;
  }
  /// Cuts the polygon otherwise where its fan would cover more than it. Refuses one of fewer than three corners.
  void end_polygon();
  void add_triangle(const Triangle& triangle) {
    if (triangles_.size() == triangles_.capacity()) grow_triangles();
    triangles_.push_back(triangle);
  }

  [[nodiscard]] std::uint64_t vertex_count() const noexcept { return vertices_.size(); }
  [[nodiscard]] std::uint64_t triangle_count() const noexcept { return triangles_.size(); }
  /// Refuses claims of a header beyond the limits of the options, before anything is allocated for them.
  void check_limits(std::uint64_t vertices, std::uint64_t triangles) const;
  /// The mesh. Refuses if there is no triangle; `hint` then says more, if it is not empty.
  TriangleMesh finish(const std::string& hint = "") &&;

 private:
  /// Room for `size` items and, where memory allows, for as many again, but never for more than `largest_size`: the
  /// limits of the options hold because a vector's capacity never exceeds them.
  template <class T>
  void grow(std::vector<T>& vector, std::uint64_t size, std::uint64_t largest_size);
  void grow_triangles();
  void grow_vertices();
  void grow_table();
  /// Mends a polygon's fan if it folds; its vertices are there.
  void unfold(std::uint64_t first_triangle, std::uint64_t triangles);
  [[nodiscard]] Vec3 checked(double x, double y, double z) const;
  [[nodiscard]] std::uint64_t held_bytes() const noexcept;
  [[noreturn]] void refuse_vertex_limit() const;
  [[noreturn]] void refuse_triangle_limit() const;

  Input& input_;
  double scale_;
  std::uint64_t max_vertices_;
  std::uint64_t max_triangles_;
  std::uint64_t max_bytes_;
  std::vector<Vec3> vertices_;
  std::vector<Triangle> triangles_;
  std::vector<std::uint32_t> table_;  // open addressing; vertex index + 1, 0 where empty; a power of two long
  struct LatePolygon {
    std::uint32_t first_triangle;
    std::uint32_t triangles;
  };
  std::vector<LatePolygon> late_polygons_;  // some of whose vertices were still to come
  std::vector<RingCorner> ring_;
  // For all polygons of the file: one of 20,000 corners needs most of them. Half a second, whoever made the file.
  std::uint64_t looks_left_ = std::uint64_t{1} << 28;
  std::uint32_t corners_ = 0;
  std::uint32_t greatest_ = 0;  // index of the polygon's corners
  std::uint32_t first_ = 0;
  std::uint32_t previous_ = 0;
};

}  // namespace odds::mesh
