// Boxes, and solids of revolution about z.
#include "scene/import/solids.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "math/rotation_between.hpp"

namespace odds::scene {
namespace {

constexpr std::uint32_t sides = 48;
constexpr std::uint32_t cap_rings = 12;  // of a hemisphere

Soup box(const Vec3& size) {
  Soup soup;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 sign((corner & 1) != 0 ? 0.5 : -0.5, (corner & 2) != 0 ? 0.5 : -0.5, (corner & 4) != 0 ? 0.5 : -0.5);
    soup.vertices.emplace_back(sign.cwiseProduct(size));
  }
  soup.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return soup;
}

struct ProfilePoint {
  double radius = 0.0;
  double z = 0.0;
};

// `profile` leads upwards from the lower pole to the upper one, which are added here.
Soup revolved(const std::vector<ProfilePoint>& profile, double lowest, double highest) {
  Soup soup;
  for (const ProfilePoint& point : profile) {
    for (std::uint32_t i = 0; i < sides; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / sides;
      soup.vertices.emplace_back(point.radius * std::cos(angle), point.radius * std::sin(angle), point.z);
    }
  }
  const auto bottom = static_cast<std::uint32_t>(soup.vertices.size());
  soup.vertices.emplace_back(0.0, 0.0, lowest);
  soup.vertices.emplace_back(0.0, 0.0, highest);
  const auto rings = static_cast<std::uint32_t>(profile.size());
  for (std::uint32_t i = 0; i < sides; ++i) {
    const std::uint32_t next = (i + 1) % sides;
    soup.triangles.push_back({bottom, next, i});
    for (std::uint32_t ring = 0; ring + 1 < rings; ++ring) {
      const std::uint32_t low = ring * sides;
      const std::uint32_t high = low + sides;
      soup.triangles.push_back({low + i, low + next, high + next});
      soup.triangles.push_back({low + i, high + next, high + i});
    }
    const std::uint32_t top = (rings - 1) * sides;
    soup.triangles.push_back({bottom + 1, top + i, top + next});
  }
  return soup;
}

// A sphere cut in two halves that are `length` apart.
Soup capsule(double radius, double length) {
  std::vector<ProfilePoint> profile;
  for (std::uint32_t i = 1; i <= 2 * cap_rings - 1; ++i) {
    const double angle = std::numbers::pi * i / (2 * cap_rings);
    const double half = i < cap_rings ? -0.5 * length : 0.5 * length;
    const ProfilePoint point{radius * std::sin(angle), -radius * std::cos(angle)};
    if (i == cap_rings && length > 0.0) profile.push_back({point.radius, point.z - half});
    profile.push_back({point.radius, point.z + half});
  }
  return revolved(profile, -0.5 * length - radius, 0.5 * length + radius);
}

}  // namespace

void Soup::add(const std::vector<Vec3>& more, const std::vector<mesh::Triangle>& faces, const math::Pose& pose,
               const Vec3& scale) {
  const auto first = static_cast<std::uint32_t>(vertices.size());
  const bool mirrors = scale.prod() < 0.0;
  for (const Vec3& v : more) vertices.emplace_back(pose * v.cwiseProduct(scale));
  for (const mesh::Triangle& t : faces) {
    triangles.push_back({first + t[0], first + t[mirrors ? 2 : 1], first + t[mirrors ? 1 : 2]});
  }
}

double Soup::volume(std::size_t first, const Vec3& from) const {
  double six_times = 0.0;
  for (std::size_t i = first; i < triangles.size(); ++i) {
    const auto& [a, b, c] = triangles[i];
    six_times += (vertices[a] - from).dot((vertices[b] - from).cross(vertices[c] - from));
  }
  return std::abs(six_times) / 6.0;  // as masses of scenes, a part may be wound inside out
}

Soup solid_of(const Geometry& geometry) {
  switch (geometry.kind) {
    case Geometry::Kind::sphere:
      return capsule(geometry.radius, 0.0);
    case Geometry::Kind::capsule:
      return capsule(geometry.radius, geometry.length);
    case Geometry::Kind::cylinder: {
      const double half = 0.5 * geometry.length;
      return revolved({{geometry.radius, -half}, {geometry.radius, half}}, -half, half);
    }
    case Geometry::Kind::plane: {
      const Soup slab = box({2.0 * plane_half_side_m, 2.0 * plane_half_side_m, plane_thickness_m});
      math::Pose pose;
      pose.rotation = math::rotation_between(Vec3::UnitZ(), geometry.normal).toRotationMatrix();
      pose.translation = -0.5 * plane_thickness_m * geometry.normal;
      Soup soup;
      soup.add(slab.vertices, slab.triangles, pose, Vec3::Ones());
      return soup;
    }
    case Geometry::Kind::box:
    case Geometry::Kind::mesh:
      break;
  }
  return box(geometry.size);
}

}  // namespace odds::scene
