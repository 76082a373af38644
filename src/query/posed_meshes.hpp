// The triangles of two meshes in one relative pose, for exact tests. All searches see them through this, so that all
// see the same doubles.
#pragma once

#include <span>

#include "odds/math/pose.hpp"
#include "odds/math/tolerances.hpp"
#include "odds/mesh/triangle_mesh.hpp"
#include "odds/query/contact_patch.hpp"
#include "odds/tree/topology.hpp"

namespace odds::query {

/// A rotation that is only just one makes no length greater than by this factor: with entries of R^T R - I within the
/// tolerance its greatest singular value squared is at most 1 and three times that.
inline constexpr double most_stretch = 1.0 + 2.0 * tolerances::pose_orthonormality;

/// Works in A's tree frame: the mesh's, moved so that `origin_a` is the origin. Both meshes must outlive it.
class PosedMeshes {
 public:
  PosedMeshes(const mesh::TriangleMesh& a, const mesh::TriangleMesh& b, const Vec3& origin_a, const Vec3& origin_b,
              const math::Pose& pose_b_in_a) noexcept
      : vertices_a_(a.vertices()),
        vertices_b_(b.vertices()),
        triangles_a_(a.triangles()),
        triangles_b_(b.triangles()),
        origin_a_(origin_a),
        origin_b_(origin_b) {
    // From mesh frames to tree frames: x_A = R x_B + t with x = local + origin on both sides.
    pose_.rotation = pose_b_in_a.rotation;
    pose_.translation = pose_b_in_a.rotation * origin_b + (pose_b_in_a.translation - origin_a);
  }

  /// Of B's tree frame in A's.
  [[nodiscard]] const math::Pose& pose() const noexcept { return pose_; }
  [[nodiscard]] const Vec3& origin_a() const noexcept { return origin_a_; }
  [[nodiscard]] const Vec3& origin_b() const noexcept { return origin_b_; }

  [[nodiscard]] tree::TriangleCorners corners_a(std::uint32_t triangle) const noexcept {
    const mesh::Triangle& t = triangles_a_[triangle];
    return {vertices_a_[t[0]] - origin_a_, vertices_a_[t[1]] - origin_a_, vertices_a_[t[2]] - origin_a_};
  }
  [[nodiscard]] tree::TriangleCorners corners_b(std::uint32_t triangle) const noexcept {
    const mesh::Triangle& t = triangles_b_[triangle];
    const auto moved = [this](std::uint32_t vertex) -> Vec3 { return pose_ * Vec3(vertices_b_[vertex] - origin_b_); };
    return {moved(t[0]), moved(t[1]), moved(t[2])};
  }
  /// The exact test, by the triangles' indices in the meshes.
  [[nodiscard]] bool meet(TrianglePair pair) const noexcept;

 private:
  std::span<const Vec3> vertices_a_;
  std::span<const Vec3> vertices_b_;
  std::span<const mesh::Triangle> triangles_a_;
  std::span<const mesh::Triangle> triangles_b_;
  Vec3 origin_a_;
  Vec3 origin_b_;
  math::Pose pose_;
};

}  // namespace odds::query
