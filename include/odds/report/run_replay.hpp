// What a report needs to show a run again in three dimensions: meshes, bodies, and where the bodies were.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "odds/math/pose.hpp"
#include "odds/mesh/triangle_mesh.hpp"

namespace odds::report {

/// A mesh for the eye. Metres, in the mesh's own frame.
struct ReplayMesh {
  std::vector<std::array<float, 3>> vertices;
  std::vector<mesh::Triangle> triangles;
  std::uint64_t triangles_of_mesh = 0;  ///< before it was simplified
};

/// The mesh with at most about `most_triangles`: vertices that share a cell of a grid become one, triangles without
/// an area vanish. Small features may disappear; the collision queries never see it.
[[nodiscard]] ReplayMesh simplified(const mesh::TriangleMesh& mesh, std::size_t most_triangles);

struct ReplayBody {
  std::string name;
  std::size_t mesh = 0;  ///< index into RunReplay::meshes
  bool moves = false;
  bool follows_device = false;
  math::Pose pose;  ///< in the world, at the start
};

/// Where all moving bodies were at one time, in the order of the bodies that move.
struct ReplayFrame {
  std::uint64_t tick = 0;
  std::vector<math::Pose> poses;
};

struct RunReplay {
  std::vector<ReplayMesh> meshes;
  std::vector<ReplayBody> bodies;
  std::vector<ReplayFrame> frames;  ///< in order of time
};

}  // namespace odds::report
