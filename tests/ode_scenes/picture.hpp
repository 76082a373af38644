// A shaded picture of an arena as a PNG, drawn without any graphics library.
#pragma once

#include <string>

#include "ode_scenes/arena.hpp"

namespace odds::ode_scenes {

/// A parallel projection: where it looks at, from where, how much it shows.
struct View {
  Vec3 centre = Vec3::Zero();
  Vec3 from = Vec3(1.0, -2.2, 1.0);  ///< direction towards the eye
  double width_m = 1.0;
  std::uint32_t columns = 360;
  std::uint32_t rows = 300;
  double cut_y = std::numeric_limits<double>::infinity();  ///< what stands still is not drawn nearer than this
};

/// Bytes of a PNG file. Primitives are left out.
[[nodiscard]] std::string picture_of(const Arena& arena, const View& view);

}  // namespace odds::ode_scenes
