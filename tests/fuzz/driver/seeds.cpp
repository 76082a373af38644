// The seeds: between them they reach every statement that the readers know.
#include "seeds.hpp"

#include "support/mesh_files.hpp"

namespace odds::fuzz {
namespace {

std::vector<Seed> text_seeds() {
  const std::string facet =
      "facet normal 0 0 1\n outer loop\n  vertex 0 0 0\n  vertex 1.5e0 0 0\n  vertex 0 1 -0\n endloop\nendfacet\n";
  return {
      {"obj", "corners",
       "# made\nmtllib a.mtl\no part\nv 0 0 0\nv 1 0 0 1.0\nv 1 1 0 .5 .5 .5\nv 0 1 0\nvt 0 0\nvn 0 0 1\ng a b\nusemtl "
       "m\ns "
       "off\nf 1/1/1 2/1/1 3/1/1 4/1/1\nf -4 -2//1 -1/1\nl 1 2\n"},
      {"obj", "continued", "f 1 2 \\\n 3\r\nv 1e-3 +2 \\\r\n -3.25\rv 0 0 0\nv 0 1 0 # end\n"},
      {"stl", "two_solids", "solid a b\n" + facet + facet + "endsolid a b\nSOLID\n" + facet + "ENDSOLID\n"},
      {"stl", "binary_solid", test::stl_claiming(2, 2, "solid made")},
      {"ply", "extras",
       "ply\nformat ascii 1.0\ncomment made\nobj_info x\nelement vertex 4\nproperty float x\nproperty double "
       "y\nproperty int8 "
       "z\nproperty list uchar int l\nelement edge 1\nproperty uint a\nelement face 2\nproperty list uint8 int32 "
       "vertex_index\nproperty uchar c\nend_header\n0 0 0 0\n1 0 0 1 7\n1 1 0 0\n0 1 0 2 7 7\n9\n4 0 1 2 3 255\n3 0 1 "
       "2 0\n"},
      {"ply", "small_types",
       "ply\r\nformat binary_big_endian 1.0\r\nelement vertex 3\r\nproperty short x\r\nproperty ushort y\r\nproperty "
       "uchar "
       "z\r\nelement face 1\r\nproperty list short char vertex_indices\r\nend_header\r\n" +
           std::string("\0\0\0\0\0\0\1\0\0\0\0\0\0\1\0\0\3\0\1\2", 20)},
      {"off", "polygons", "OFF # kind\n4 2 5\n0 0 0\n1 0 0\n1 1 0 # third\n0 1 0\n\n4 0 1 2 3 255 0 0\n3 0 1 2\n"},
      {"off", "colours",
       "STCNOFF\n3 1 0\n0 0 0 0 0 1 1 1 1 1 0 0\n1 0 0 0 0 1 1 1 1 1 0 0\n0 1 0 0 0 1 1 1 1 1 0 0\n3 0 1 2\n"},
      {"off", "glued", "OFF3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 1\n"},
  };
}

}  // namespace

std::vector<Seed> seeds() {
  std::vector<Seed> all = text_seeds();
  const auto made = mesh::TriangleMesh::make({{0, 0, 0}, {1, 0, 0}, {0, 0.1, 0}, {0, 0, 1e-5}}, {{0, 1, 2}, {0, 3, 1}});
  const mesh::TriangleMesh& mesh = made.value();
  all.push_back({"obj", "written", test::obj_file(mesh)});
  all.push_back({"stl", "written", test::stl_binary_file(mesh)});
  all.push_back({"stl", "ascii", test::stl_ascii_file(mesh)});
  all.push_back({"ply", "written", test::ply_written(mesh)});
  all.push_back({"ply", "ascii", test::ply_file(mesh, test::PlyEncoding::ascii)});
  all.push_back({"ply", "little_endian", test::ply_file(mesh, test::PlyEncoding::little_endian)});
  all.push_back({"ply", "big_endian", test::ply_file(mesh, test::PlyEncoding::big_endian)});
  all.push_back({"off", "written", test::off_file(mesh)});
  return all;
}

}  // namespace odds::fuzz
