// Vertices and faces by formula.
#include "hard_cases/meshes.hpp"

#include <array>
#include <cmath>
#include <fstream>
#include <numbers>
#include <vector>

namespace odds::hard_cases {
namespace {

struct Obj {
  std::vector<std::array<double, 3>> vertices;
  std::vector<std::array<int, 3>> faces;  // from 0
  void write(const std::string& path) const {
    std::ofstream file(path);
    file.precision(17);
    for (const auto& v : vertices) file << "v " << v[0] << ' ' << v[1] << ' ' << v[2] << '\n';
    for (const auto& f : faces) file << "f " << f[0] + 1 << ' ' << f[1] + 1 << ' ' << f[2] + 1 << '\n';
  }
};

// The edge lies along x at z = 0, the back at z = 0.04.
Obj wedge() {
  const double w = 0.04 * std::tan(std::numbers::pi / 180.0);
  Obj m;
  m.vertices = {{-0.02, 0, 0}, {0.02, 0, 0}, {-0.02, -w, 0.04}, {-0.02, w, 0.04}, {0.02, -w, 0.04}, {0.02, w, 0.04}};
  m.faces = {{0, 2, 3}, {1, 5, 4}, {0, 1, 4}, {0, 4, 2}, {0, 3, 5}, {0, 5, 1}, {2, 4, 5}, {2, 5, 3}};
  for (auto& f : m.faces) std::swap(f[1], f[2]);
  return m;
}

// A cone of 12 sides: 40 mm high, 2 mm wide, its tip at the origin.
Obj spike() {
  Obj m;
  constexpr int sides = 12;
  m.vertices.push_back({0, 0, 0});
  for (int i = 0; i < sides; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / sides;
    m.vertices.push_back({0.001 * std::cos(angle), 0.001 * std::sin(angle), 0.04});
  }
  m.vertices.push_back({0, 0, 0.04});
  for (int i = 0; i < sides; ++i) {
    const int next = (i + 1) % sides;
    m.faces.push_back({0, 1 + next, 1 + i});
    m.faces.push_back({sides + 1, 1 + i, 1 + next});
  }
  return m;
}

Obj sheet() {
  Obj m;
  m.vertices = {{-0.1, -0.1, 0}, {0.1, -0.1, 0}, {0.1, 0.1, 0}, {-0.1, 0.1, 0}};
  m.faces = {{0, 1, 2}, {0, 2, 3}};
  return m;
}

// A box whose top and bottom are strips of ever narrower triangles.
Obj slivers() {
  Obj m;
  constexpr int strips = 100;
  for (int i = 0; i <= strips; ++i) {
    // Every second strip is a millionth as wide as its neighbour.
    const double y = -0.05 + 0.1 * ((i / 2) + (i % 2 == 0 ? 0.0 : 1e-6)) / (strips / 2);
    for (const double x : {-0.05, 0.05}) {
      for (const double z : {0.0, -0.02}) m.vertices.push_back({x, i == strips ? 0.05 : y, z});
    }
  }
  const auto at = [](int strip, int x, int z) { return 4 * strip + 2 * x + z; };
  const auto quad = [&](int a, int b, int c, int d) {
    m.faces.push_back({a, b, c});
    m.faces.push_back({a, c, d});
  };
  for (int i = 0; i < strips; ++i) {
    quad(at(i, 0, 0), at(i, 1, 0), at(i + 1, 1, 0), at(i + 1, 0, 0));
    quad(at(i, 0, 1), at(i + 1, 0, 1), at(i + 1, 1, 1), at(i, 1, 1));
    quad(at(i, 0, 1), at(i, 0, 0), at(i + 1, 0, 0), at(i + 1, 0, 1));
    quad(at(i, 1, 0), at(i, 1, 1), at(i + 1, 1, 1), at(i + 1, 1, 0));
  }
  quad(at(0, 0, 0), at(0, 0, 1), at(0, 1, 1), at(0, 1, 0));
  quad(at(strips, 0, 0), at(strips, 1, 0), at(strips, 1, 1), at(strips, 0, 1));
  return m;
}

Obj micro() {
  Obj m;
  const double s = 25e-6;
  for (int i = 0; i < 8; ++i)
    m.vertices.push_back({(i & 1) != 0 ? s : -s, (i & 2) != 0 ? s : -s, (i & 4) != 0 ? s : -s});
  m.faces = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
             {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return m;
}

// As the plate of most cases, but 1000 km along x.
Obj far_slab() {
  Obj m = micro();
  for (auto& v : m.vertices) v = {1e6 + (v[0] > 0.0 ? 0.1 : -0.1), v[1] > 0.0 ? 0.1 : -0.1, v[2] > 0.0 ? 0.02 : -0.02};
  return m;
}

}  // namespace

void write_meshes(const std::string& folder) {
  wedge().write(folder + "/wedge.obj");
  spike().write(folder + "/spike.obj");
  sheet().write(folder + "/sheet.obj");
  slivers().write(folder + "/slivers.obj");
  micro().write(folder + "/micro.obj");
  far_slab().write(folder + "/far_slab.obj");
}

}  // namespace odds::hard_cases
