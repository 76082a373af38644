// Made shapes by name, as the command line and scene files ask for them: "made:torus:ring=0.2,tube=0.05".
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "odds/mesh/triangle_mesh.hpp"

namespace odds::mesh::made {

/// A mesh argument that begins with this is a made shape, not a file.
inline constexpr std::string_view prefix = "made:";

/// The mesh for "NAME" or "NAME:key=value,key=value", with or without the prefix; parameters left out keep their
/// defaults. Unknown names and keys are refused with the nearest valid one; values must be plain numbers within the
/// field's range.
Result<TriangleMesh> make_shape(std::string_view text);

/// All names, in alphabetical order.
[[nodiscard]] std::vector<std::string_view> shape_names();

/// One shape's name, meaning and parameters with defaults and ranges, as lines of text; empty for an unknown name.
[[nodiscard]] std::string describe_shape(std::string_view name);

}  // namespace odds::mesh::made
