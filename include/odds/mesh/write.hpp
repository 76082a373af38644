// Writing triangle meshes to OBJ, binary STL and PLY files.
#pragma once

#include <filesystem>
#include <optional>
#include <ostream>

#include "odds/math/error.hpp"
#include "odds/mesh/triangle_mesh.hpp"

namespace odds::mesh {

/// OBJ with the shortest decimal numbers that read back as the same doubles: nothing is lost. Metres.
void write_obj(const TriangleMesh& mesh, std::ostream& out);
/// Binary STL: coordinates are rounded to 32-bit floats and indices are lost, as the format has none. Metres.
void write_stl_binary(const TriangleMesh& mesh, std::ostream& out);
/// Binary little-endian PLY with 64-bit coordinates: nothing is lost. Metres.
void write_ply(const TriangleMesh& mesh, std::ostream& out);

/// Writes `path` in the format of its extension (.obj, .stl, .ply; any case), replacing a file that is there.
/// The error, if any, names the file and says why: unknown extension, or what the system answered.
[[nodiscard]] std::optional<Error> write(const TriangleMesh& mesh, const std::filesystem::path& path);

}  // namespace odds::mesh
