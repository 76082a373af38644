// Growing a made shape's vertices and triangles. Private to mesh/made.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "odds/mesh/triangle_mesh.hpp"

namespace odds::mesh::made {

/// Vertex indices along a closed or open curve. Rings around an axis run counter-clockwise seen from its positive end.
using Ring = std::vector<std::uint32_t>;

class Surface {
 public:
  std::uint32_t add(const Vec3& position);
  /// Adds `count` points of a circle around z, the first at angle `start`.
  Ring add_circle(double radius, double z, std::uint32_t count, double start = 0.0);
  /// Adds one point per angle.
  Ring add_circle(double radius, double z, std::span<const double> angles);

  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) { triangles_.push_back({a, b, c}); }
  /// Two triangles that share the diagonal a-c; counter-clockwise seen from outside.
  void quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d);
  /// Quads between two rings of equal count, closed around. With `upper` above `lower` they face away from the axis;
  /// with `upper` inside `lower` in one plane they face up; exchanged, the other way.
  void connect(const Ring& lower, const Ring& upper);
  /// Triangles from a centre to a ring, facing up, or down if `down`.
  void fan(std::uint32_t centre, const Ring& ring, bool down);
  /// Adds all of `other`, moved by the function's caller beforehand; turned inside out if `inverted`.
  void append(const Surface& other, bool inverted = false);

  [[nodiscard]] const std::vector<Vec3>& vertices() const { return vertices_; }
  [[nodiscard]] std::vector<Vec3>& vertices() { return vertices_; }
  [[nodiscard]] const std::vector<Triangle>& triangles() const { return triangles_; }
  /// Hands over the arrays; the surface is empty afterwards.
  Result<TriangleMesh> finish(std::string name);

 private:
  std::vector<Vec3> vertices_;
  std::vector<Triangle> triangles_;
};

}  // namespace odds::mesh::made
