// A shaded picture of bodies as a PNG, drawn without any graphics library.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string>

#include "odds/math/pose.hpp"
#include "odds/mesh/triangle_mesh.hpp"

namespace odds::testing {

/// A parallel projection: where it looks at, from where, how much it shows.
struct View {
  Vec3 centre = Vec3::Zero();
  Vec3 from = Vec3(1.0, -2.2, 1.0);  ///< direction towards the eye
  double width_m = 1.0;
  std::uint32_t columns = 360;
  std::uint32_t rows = 300;
  double cut_y = std::numeric_limits<double>::infinity();  ///< what stands still is not drawn nearer than this
};

struct Drawn {
  const mesh::TriangleMesh* mesh;
  math::Pose pose;
  bool fixed;  ///< grey
};

/// Bytes of a PNG file.
[[nodiscard]] std::string picture_of(std::span<const Drawn> bodies, const View& view);

}  // namespace odds::testing
