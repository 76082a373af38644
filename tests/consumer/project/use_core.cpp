// Links the core: a mesh is checked by code that lives in the library.
#include <odds/mesh/triangle_mesh.hpp>

#include <cstdio>

int main() {
  const auto mesh = odds::mesh::TriangleMesh::make({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
  if (!mesh) return 1;
  std::printf("core: %zu triangle, size %.3f m\n", mesh.value().triangles().size(), mesh.value().size());
  return 0;
}
