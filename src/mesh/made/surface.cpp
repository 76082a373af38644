#include "mesh/made/surface.hpp"

#include <cmath>
#include <numbers>
#include <utility>

namespace odds::mesh::made {

std::uint32_t Surface::add(const Vec3& position) {
  vertices_.push_back(position);
  return static_cast<std::uint32_t>(vertices_.size() - 1);
}

Ring Surface::add_circle(double radius, double z, std::uint32_t count, double start) {
  Ring ring(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const double angle = start + 2.0 * std::numbers::pi * i / count;
    ring[i] = add({radius * std::cos(angle), radius * std::sin(angle), z});
  }
  return ring;
}

Ring Surface::add_circle(double radius, double z, std::span<const double> angles) {
  Ring ring;
  ring.reserve(angles.size());
  for (const double angle : angles) ring.push_back(add({radius * std::cos(angle), radius * std::sin(angle), z}));
  return ring;
}

void Surface::quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  triangle(a, b, c);
  triangle(a, c, d);
}

void Surface::connect(const Ring& lower, const Ring& upper) {
  for (std::size_t i = 0; i < lower.size(); ++i) {
    const std::size_t next = (i + 1) % lower.size();
    quad(lower[i], lower[next], upper[next], upper[i]);
  }
}

void Surface::fan(std::uint32_t centre, const Ring& ring, bool down) {
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const std::uint32_t here = ring[i];
    const std::uint32_t next = ring[(i + 1) % ring.size()];
    triangle(centre, down ? next : here, down ? here : next);
  }
}

void Surface::append(const Surface& other, bool inverted) {
  const auto offset = static_cast<std::uint32_t>(vertices_.size());
  vertices_.insert(vertices_.end(), other.vertices_.begin(), other.vertices_.end());
  for (const Triangle& t : other.triangles_) {
    triangle(offset + t[0], offset + t[inverted ? 2 : 1], offset + t[inverted ? 1 : 2]);
  }
}

Result<TriangleMesh> Surface::finish(std::string name) {
  return TriangleMesh::make(std::exchange(vertices_, {}), std::exchange(triangles_, {}), std::move(name));
}

}  // namespace odds::mesh::made
