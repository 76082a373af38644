// One function per file format; each reads the whole input or throws Refusal.
#pragma once

#include "mesh/input.hpp"
#include "mesh/mesh_builder.hpp"

namespace odds::mesh {

TriangleMesh read_obj(Input& input, MeshBuilder builder);
/// `largest_size` is the size beyond which no input is read: a binary header's claim beyond it is text.
TriangleMesh read_stl(Input& input, MeshBuilder builder, std::uint64_t largest_size);
TriangleMesh read_ply(Input& input, MeshBuilder builder);
TriangleMesh read_off(Input& input, MeshBuilder builder);

}  // namespace odds::mesh
