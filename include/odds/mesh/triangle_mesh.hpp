// The triangle mesh that everything else is made from.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "odds/math/error.hpp"
#include "odds/math/types.hpp"
#include "odds/mesh/shared_array.hpp"

namespace odds::mesh {

using Triangle = std::array<std::uint32_t, 3>;  ///< three vertex indices, counter-clockwise seen from outside

/// An immutable triangle soup that is valid if it exists: at least one triangle, indices in range, all coordinates
/// finite and at most 1e15 in magnitude. Degenerate, duplicate and unoriented triangles are allowed (real meshes have
/// them); `mesh::find_faults` tells. Coordinates in metres, in the mesh's own frame. Thread-safe to share.
class TriangleMesh {
 public:
  /// Greatest magnitude of a coordinate, metres: beyond it the exact predicates (degree 6) leave the range of doubles.
  static constexpr double largest_coordinate = 1e15;
  /// Greatest number of vertices, and of triangles.
  static constexpr std::size_t largest_count = std::size_t{1} << 30;

  /// Checks and takes the arrays. `name` stands in error messages (usually the file).
  static Result<TriangleMesh> make(std::vector<Vec3> vertices, std::vector<Triangle> triangles,
                                   std::string name = "mesh");

  /// The same of arrays that may stand in a mapped file, with the bounding box of their used vertices, which is
  /// believed if it is finite and not inside out: that spares reading each vertex once a triangle.
  static Result<TriangleMesh> adopt(SharedArray<Vec3> vertices, SharedArray<Triangle> triangles, std::string name,
                                    const Vec3& lower, const Vec3& upper);

  [[nodiscard]] std::span<const Vec3> vertices() const noexcept { return vertices_.span(); }
  [[nodiscard]] std::span<const Triangle> triangles() const noexcept { return triangles_.span(); }
  /// The same, to be kept.
  [[nodiscard]] const SharedArray<Vec3>& vertex_array() const noexcept { return vertices_; }
  [[nodiscard]] const SharedArray<Triangle>& triangle_array() const noexcept { return triangles_; }
  [[nodiscard]] const std::string& name() const noexcept { return name_; }
  [[nodiscard]] const Vec3& lower() const noexcept {
    return lower_;
  }  ///< least corner of the bounding box of used vertices
  [[nodiscard]] const Vec3& upper() const noexcept { return upper_; }  ///< greatest corner
  /// Length of the bounding box's diagonal, the "size" that relative distances in reports refer to.
  [[nodiscard]] double size() const noexcept { return (upper_ - lower_).norm(); }

 private:
  TriangleMesh() = default;
  SharedArray<Vec3> vertices_;
  SharedArray<Triangle> triangles_;
  std::string name_;
  Vec3 lower_ = Vec3::Zero();
  Vec3 upper_ = Vec3::Zero();
};

}  // namespace odds::mesh
