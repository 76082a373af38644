// Finely cut ground of a height that a test chooses, and a coin of many sides to stand on it.
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <vector>

#include "odds/mesh/triangle_mesh.hpp"
#include "odds/ode/odds_ode.h"
#include "odds/query/shape.hpp"

namespace odds::test {

/// A closed slab of 1 m by 1 m about the origin, its top at `height(x, y)`, its bottom at z = -0.2 m; `cells` along
/// each side.
template <class Height>
std::shared_ptr<const query::Shape> slab_shape(std::uint32_t cells, const Height& height) {
  std::vector<Vec3> vertices;
  std::vector<mesh::Triangle> triangles;
  const auto at = [cells](std::uint32_t i, std::uint32_t k, std::uint32_t side) {
    return (side * (cells + 1) + i) * (cells + 1) + k;
  };
  const auto add = [&triangles](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    triangles.push_back({a, b, c});
    triangles.push_back({a, c, d});
  };
  for (std::uint32_t side = 0; side < 2; ++side) {
    for (std::uint32_t i = 0; i <= cells; ++i) {
      for (std::uint32_t k = 0; k <= cells; ++k) {
        const double x = static_cast<double>(i) / cells - 0.5;
        const double y = static_cast<double>(k) / cells - 0.5;
        vertices.push_back(Vec3(x, y, side == 0 ? height(x, y) : -0.2));
      }
    }
  }
  for (std::uint32_t i = 0; i < cells; ++i) {
    for (std::uint32_t k = 0; k < cells; ++k) {
      add(at(i, k, 0), at(i + 1, k, 0), at(i + 1, k + 1, 0), at(i, k + 1, 0));
      add(at(i, k, 1), at(i, k + 1, 1), at(i + 1, k + 1, 1), at(i + 1, k, 1));
    }
    add(at(i + 1, 0, 0), at(i, 0, 0), at(i, 0, 1), at(i + 1, 0, 1));
    add(at(i, cells, 0), at(i + 1, cells, 0), at(i + 1, cells, 1), at(i, cells, 1));
    add(at(0, i, 0), at(0, i + 1, 0), at(0, i + 1, 1), at(0, i, 1));
    add(at(cells, i + 1, 0), at(cells, i, 0), at(cells, i, 1), at(cells, i + 1, 1));
  }
  auto mesh = mesh::TriangleMesh::make(std::move(vertices), std::move(triangles), "slab");
  if (!mesh.ok()) throw std::runtime_error(mesh.error().message());
  auto shape = query::Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(mesh).value()));
  if (!shape.ok()) throw std::runtime_error(shape.error().message());
  return std::move(shape).value();
}

/// A prism with its axis along z as one of ODE's convexes, known to the library. Owns its geom.
class ConvexCoin {
 public:
  ConvexCoin(dSpaceID space, double radius, double height, unsigned sides) {
    for (unsigned k = 0; k < sides; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / sides;
      for (const double z : {-0.5 * height, 0.5 * height}) {
        points_.insert(points_.end(), {radius * std::cos(angle), radius * std::sin(angle), z});
      }
    }
    polygons_.push_back(sides);
    for (unsigned k = 0; k < sides; ++k) polygons_.push_back(2 * k + 1);
    polygons_.push_back(sides);
    for (unsigned k = sides; k-- > 0;) polygons_.push_back(2 * k);
    planes_ = {0, 0, 1, 0.5 * height, 0, 0, -1, 0.5 * height};
    for (unsigned k = 0; k < sides; ++k) {
      const unsigned next = (k + 1) % sides;
      polygons_.insert(polygons_.end(), {4, 2 * k, 2 * next, 2 * next + 1, 2 * k + 1});
      const double angle = 2.0 * std::numbers::pi * (k + 0.5) / sides;
      planes_.insert(planes_.end(), {std::cos(angle), std::sin(angle), 0, radius * std::cos(std::numbers::pi / sides)});
    }
    geom = dCreateConvex(space, planes_.data(), sides + 2, points_.data(), 2 * sides, polygons_.data());
    const int is_known = oddsRegisterConvex(geom, points_.data(), 2 * sides, polygons_.data(), sides + 2);
    if (is_known != 1) throw std::runtime_error(oddsGetLastError());
  }
  ~ConvexCoin() {
    oddsForgetGeom(geom);
    dGeomDestroy(geom);
  }
  ConvexCoin(const ConvexCoin&) = delete;
  ConvexCoin& operator=(const ConvexCoin&) = delete;

  dGeomID geom = nullptr;

 private:
  std::vector<dReal> points_;
  std::vector<dReal> planes_;
  std::vector<unsigned> polygons_;
};

}  // namespace odds::test
