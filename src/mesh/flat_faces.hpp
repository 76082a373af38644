// The large flat faces of a mesh, each as one polygon however many triangles it is cut into.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "odds/mesh/triangle_mesh.hpp"

namespace odds::mesh {

/// A convex polygon in the surface of a mesh, metres, in the mesh's frame.
struct FlatFace {
  static constexpr std::size_t most_corners = 8;  ///< as many as a pair of bodies has contacts

  Vec3 normal = Vec3::UnitZ();  ///< unit, to the side that the triangles' winding says is outside
  double offset = 0.0;          ///< normal . x of its points
  Vec3 centre = Vec3::Zero();
  double radius = 0.0;  ///< of its corners about the centre
  double beyond = 0.0;  ///< greatest distance of the face's own corners from the polygon, outside of it
  double uneven = 0.0;  ///< greatest distance of a corner of its triangles from the plane
  double thickness = std::numeric_limits<double>::infinity();  ///< least distance to a flat face behind it
  std::array<Vec3, most_corners> corner;
  std::size_t corner_count = 0;  ///< 3 or more; counter-clockwise, seen from outside
  std::uint32_t triangle = 0;    ///< the largest of those that it is made of

  [[nodiscard]] std::span<const Vec3> corners() const noexcept { return std::span(corner).first(corner_count); }
};

/// Faces of two triangles or more that are flat and convex, and no less than `least_share` of the surface each, or
/// `least_soft_share` where the surface turns by less than 20 degrees at some side, as between the facets of a round
/// body; the largest `most_faces`, largest first. A face with more than `most_corners` corners, as the end of a
/// cylinder, is given as the largest polygon of so many of them that leaving out one after the other finds: it lies
/// within the face. Takes some 0.4 us a triangle.
[[nodiscard]] std::vector<FlatFace> find_flat_faces(const TriangleMesh& mesh);

inline constexpr std::size_t most_faces = 64;
inline constexpr double least_share = 5e-4;
inline constexpr double least_soft_share = 0.02;

}  // namespace odds::mesh
