// How deep meshes really lie in each other, whatever a collider says.
#pragma once

#include <map>
#include <memory>

#include "odds/math/pose.hpp"
#include "ode/mesh/prepared_mesh.hpp"

namespace odds::ode_scenes {

class Truth {
 public:
  using Mesh = std::shared_ptr<const mesh::TriangleMesh>;

  /// Metres: the farthest that a corner of either mesh, or the middle of one of its triangles, is from the other's
  /// surface, within it; 0: none is. Of closed meshes. Throws if a mesh cannot be asked.
  [[nodiscard]] double depth(const Mesh& a, const math::Pose& pose_a, const Mesh& b, const math::Pose& pose_b);

 private:
  const ode::PreparedMesh& prepared(const Mesh& mesh);

  std::map<const mesh::TriangleMesh*, std::shared_ptr<const ode::PreparedMesh>> prepared_;
};

}  // namespace odds::ode_scenes
