#include "soak/meshes.hpp"

#include <cstdio>
#include <cstdlib>

#include "odds/math/random.hpp"
#include "odds/mesh/made/by_name.hpp"

namespace odds::soak {
namespace {

/// Long thin triangles in every direction: a hundredth, a millionth or nothing of their length wide.
Mesh slivers() {
  math::Random random(11);
  std::vector<Vec3> vertices;
  std::vector<mesh::Triangle> triangles;
  for (std::uint32_t i = 0; i < 96; ++i) {
    const Vec3 from = random.direction();
    const Vec3 along = random.direction();
    const double width = i % 3 == 0 ? 1e-2 : i % 3 == 1 ? 1e-6 : 0.0;
    vertices.push_back(from);
    vertices.push_back(from + along);
    vertices.push_back(from + 0.5 * along + width * random.direction());
    triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return std::make_shared<const mesh::TriangleMesh>(
      std::move(mesh::TriangleMesh::make(std::move(vertices), std::move(triangles), "slivers")).value());
}

}  // namespace

Mesh made(const char* description) {
  auto mesh = mesh::made::make_shape(description);
  if (!mesh.ok()) {
    std::fprintf(stderr, "error: %s\n", mesh.error().message().c_str());
    std::exit(1);
  }
  return std::make_shared<const mesh::TriangleMesh>(std::move(mesh).value());
}

std::vector<MeshPair> mesh_pairs() {
  const Mesh bumps = made("made:bumpy_sphere:frequency=4,bumps=12,height=0.3,radius=1");
  const Mesh knot = made("made:torus_knot:along=48,across=4");
  const Mesh sheets = made("made:plates:count=3,thickness=0,gap=0.01,cells=5,side=1,wave=0.05");
  const Mesh shells = made("made:nested_shells:frequency=3,ratio=0.99,radius=1");
  const Mesh box = made("made:box:cells=3,x=1,y=0.7,z=0.4");
  const Mesh gear = made("made:gear:teeth=8,flank=2");
  const Mesh needles = slivers();
  return {{"bumps in bumps", bumps, bumps},     {"knot in knot", knot, knot},    {"sheets on sheets", sheets, sheets},
          {"shells on shells", shells, shells}, {"box on box", box, box},        {"gear on gear", gear, gear},
          {"slivers in bumps", bumps, needles}, {"knot on sheets", sheets, knot}};
}

}  // namespace odds::soak
