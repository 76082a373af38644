// Small meshes for tests that should not depend on the shapes under test.
#pragma once

#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "odds/mesh/triangle_mesh.hpp"

namespace odds::testing {

/// Closed unit sphere of `rings` rings with waves of relative height `waves`; outward; no degenerate triangle.
inline std::shared_ptr<const mesh::TriangleMesh> wavy_sphere(std::uint32_t rings, double waves = 0.1) {
  const std::uint32_t sectors = 2 * rings;
  std::vector<Vec3> vertices = {{0, 0, 1}};
  for (std::uint32_t i = 1; i < rings; ++i) {
    for (std::uint32_t j = 0; j < sectors; ++j) {
      const double theta = std::numbers::pi * i / rings;
      const double phi = 2.0 * std::numbers::pi * j / sectors;
      const double r = 1.0 + waves * std::sin(7.0 * theta) * std::sin(theta) * std::cos(5.0 * phi);
      vertices.emplace_back(r * std::sin(theta) * std::cos(phi), r * std::sin(theta) * std::sin(phi),
                            r * std::cos(theta));
    }
  }
  vertices.emplace_back(0, 0, -1);
  const auto south = static_cast<std::uint32_t>(vertices.size() - 1);
  const auto at = [&](std::uint32_t i, std::uint32_t j) { return 1 + (i - 1) * sectors + j % sectors; };
  std::vector<mesh::Triangle> triangles;
  for (std::uint32_t j = 0; j < sectors; ++j) {
    triangles.push_back({0, at(1, j), at(1, j + 1)});
    triangles.push_back({south, at(rings - 1, j + 1), at(rings - 1, j)});
    for (std::uint32_t i = 1; i + 1 < rings; ++i) {
      triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return std::make_shared<const mesh::TriangleMesh>(
      std::move(mesh::TriangleMesh::make(std::move(vertices), std::move(triangles), "wavy sphere")).value());
}

}  // namespace odds::testing
