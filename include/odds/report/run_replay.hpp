// What a report needs to show a run again in three dimensions: meshes, bodies, and where the bodies were.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "odds/math/pose.hpp"
#include "odds/mesh/triangle_mesh.hpp"
#include "odds/query/upper_boxes.hpp"

namespace odds::report {

/// A mesh for the eye. Metres, in the mesh's own frame.
struct ReplayMesh {
  std::vector<std::array<float, 3>> vertices;
  std::vector<mesh::Triangle> triangles;
  std::uint64_t triangles_of_mesh = 0;  ///< before it was simplified
  /// Of the hierarchy that the run searched. The page shows with them which boxes a search has to open: the front.
  std::vector<query::UpperBox> boxes = {};
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

/// A place where two bodies met, or where they most probably did. World frame.
struct ReplayMark {
  Vec3 position_m = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ();  ///< unit
  double depth_m = 0.0;         ///< >= 0
  double probability = 1.0;     ///< of a hit there; 1 for a contact
  bool cell_pair = false;       ///< true: the most probable pair of cells of a query without a proof
};

/// Where all moving bodies were at one time, in the order of the bodies that move.
struct ReplayFrame {
  std::uint64_t tick = 0;
  std::vector<math::Pose> poses;
  std::vector<ReplayMark> marks = {};  ///< at these poses
};

struct RunReplay {
  std::vector<ReplayMesh> meshes;
  std::vector<ReplayBody> bodies;
  std::vector<ReplayFrame> frames;  ///< in order of time
};

}  // namespace odds::report
