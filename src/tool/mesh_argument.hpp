// A mesh named on the command line: a file, or a made shape as "made:NAME:key=value".
#pragma once

#include <string>

#include "odds/math/error.hpp"
#include "odds/mesh/triangle_mesh.hpp"

namespace odds::tool {

/// `scale` is metres per unit of a file; a made shape is in metres and takes 1 only.
Result<mesh::TriangleMesh> load_mesh(const std::string& argument, double scale);

/// Help text for such an argument.
std::string mesh_argument_help();

}  // namespace odds::tool
