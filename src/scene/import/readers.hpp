// The two formats that are read.
#pragma once

#include "scene/import/description.hpp"
#include "scene/import/xml_reader.hpp"

namespace odds::scene {

/// Root element <robot>. Throws ImportFailure.
[[nodiscard]] Description read_urdf(const XmlReader& xml);

/// Root element <sdf>. Throws ImportFailure.
[[nodiscard]] Description read_sdf(const XmlReader& xml);

}  // namespace odds::scene
