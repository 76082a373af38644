// A picture of an arena.
#pragma once

#include <string>

#include "ode_scenes/arena.hpp"
#include "support/picture.hpp"

namespace odds::ode_scenes {

using testing::View;

/// Bytes of a PNG file. Primitives are left out.
[[nodiscard]] std::string picture_of(const Arena& arena, const View& view);

}  // namespace odds::ode_scenes
