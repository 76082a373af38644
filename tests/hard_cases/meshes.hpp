// Meshes that are hard by nature, as OBJ files.
#pragma once

#include <string>

namespace odds::hard_cases {

/// Writes wedge.obj (a knife's edge of 2 degrees), spike.obj (a needle), sheet.obj (two triangles, open), slivers.obj
/// (a plate of 400 triangles each 0.1 m long and 1e-6 of that wide where they end) and micro.obj (a cube of 50
/// micrometres).
void write_meshes(const std::string& folder);

}  // namespace odds::hard_cases
