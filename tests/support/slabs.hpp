// Slabs that stand on each other, and bodies of two parts.
#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "odds/math/pose.hpp"
#include "odds/mesh/made/by_name.hpp"

namespace odds::testing {

inline mesh::TriangleMesh made_mesh(const std::string& name) { return std::move(mesh::made::make_shape(name)).value(); }

/// 1 by 1, 0.2 high.
inline mesh::TriangleMesh slab(int cells = 3) {
  return made_mesh("made:box:x=1,y=1,z=0.2,cells=" + std::to_string(cells));
}

/// A stands on B, which has been turned about z by `turn` and about y by `tilt`, and pushed up until they overlap by
/// `depth` in the middle.
inline math::Pose below(double depth, double turn = 0.0, double tilt = 0.0) {
  math::Pose pose;
  pose.rotation = (Eigen::AngleAxisd(tilt, Vec3::UnitY()) * Eigen::AngleAxisd(turn, Vec3::UnitZ())).toRotationMatrix();
  pose.translation.z() = -0.1 - 0.1 / std::cos(tilt) + depth;
  return pose;
}

/// Both as one body, the second one moved.
inline mesh::TriangleMesh joined(const mesh::TriangleMesh& one, const mesh::TriangleMesh& other, const Vec3& moved) {
  std::vector<Vec3> vertices(one.vertices().begin(), one.vertices().end());
  std::vector<mesh::Triangle> triangles(one.triangles().begin(), one.triangles().end());
  const auto first = static_cast<std::uint32_t>(vertices.size());
  for (const Vec3& v : other.vertices()) vertices.push_back(v + moved);
  for (const mesh::Triangle& t : other.triangles()) triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  return std::move(mesh::TriangleMesh::make(std::move(vertices), std::move(triangles), "joined")).value();
}

}  // namespace odds::testing
