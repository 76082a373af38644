// Two meshes and the contacts between them, with triangle pairs and rays found by brute force.
#pragma once

#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "odds/mesh/made/by_name.hpp"
#include "odds/primitive/triangle_triangle.hpp"
#include "odds/query/contact_patch.hpp"

namespace odds::test {

/// A mesh under test: moved within its own frame if wanted.
struct Body {
  std::vector<Vec3> vertices;
  std::vector<mesh::Triangle> triangles;
  bool solid = true;
  Vec3 centre = Vec3::Zero();

  static Body made(const std::string& text, bool solid = true) {
    const auto mesh = mesh::made::make_shape(text);
    if (!mesh.ok()) throw std::runtime_error(mesh.error().message());
    Body body{{mesh.value().vertices().begin(), mesh.value().vertices().end()},
              {mesh.value().triangles().begin(), mesh.value().triangles().end()},
              solid,
              Vec3::Zero()};
    body.centre = 0.5 * (mesh.value().lower() + mesh.value().upper());
    return body;
  }
  static Body box(double x, double y, double z, int cells = 1) {
    return made("box:x=" + std::to_string(x) + ",y=" + std::to_string(y) + ",z=" + std::to_string(z) +
                ",cells=" + std::to_string(cells));
  }
  [[nodiscard]] Body moved(const math::Pose& pose) const {
    Body body = *this;
    for (Vec3& v : body.vertices) v = pose * v;
    body.centre = pose * centre;
    return body;
  }
  /// This and another mesh as one.
  [[nodiscard]] Body with(const Body& other) const {
    Body body = *this;
    const auto offset = static_cast<std::uint32_t>(vertices.size());
    body.vertices.insert(body.vertices.end(), other.vertices.begin(), other.vertices.end());
    for (const mesh::Triangle& t : other.triangles)
      body.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
    body.centre = 0.5 * (centre + other.centre);
    return body;
  }
};

inline math::Pose shift(double x, double y, double z) { return {Mat3::Identity(), {x, y, z}}; }
inline math::Pose turn(const Vec3& axis, double angle, const Vec3& translation = Vec3::Zero()) {
  return {Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix(), translation};
}

/// Brute-force ray for DepthProbe; `self` is a Body.
inline bool body_ray(const void* self, const Vec3& origin, const Vec3& direction, double max_distance, double* distance,
                     std::uint32_t* triangle) noexcept {
  const Body& body = *static_cast<const Body*>(self);
  bool found = false;
  for (std::uint32_t i = 0; i < body.triangles.size(); ++i) {
    const Vec3& p = body.vertices[body.triangles[i][0]];
    const Vec3 u = body.vertices[body.triangles[i][1]] - p;
    const Vec3 v = body.vertices[body.triangles[i][2]] - p;
    const Vec3 h = direction.cross(v);
    const double determinant = u.dot(h);
    if (determinant == 0.0) continue;
    const double s = (origin - p).dot(h) / determinant;
    const Vec3 q = (origin - p).cross(u);
    const double t = direction.dot(q) / determinant;
    const double reach = v.dot(q) / determinant;
    if (s < -1e-12 || t < -1e-12 || s + t > 1.0 + 1e-12 || reach < 0.0 || reach > max_distance) continue;
    if (found && *distance <= reach) continue;
    found = true;
    *distance = reach;
    *triangle = i;
  }
  return found;
}

/// A and B with B's pose; owns what a PatchInput refers to.
struct ContactScene {
  Body a;
  Body b;
  math::Pose pose_b_in_a;
  int max_contacts = 8;
  bool probes = true;
  std::optional<Vec3> previous = {};  ///< normal
  std::optional<Vec3> previous_position = {};
  std::vector<query::TrianglePair> hits = {};
  std::shared_ptr<query::PatchBuilder> builder = std::make_shared<query::PatchBuilder>(4096);

  void find_hits() {
    hits.clear();
    std::vector<Vec3> placed(b.vertices.size());
    for (std::size_t i = 0; i < placed.size(); ++i) placed[i] = pose_b_in_a * b.vertices[i];
    const auto box = [](const Vec3* t) {
      return std::pair<Vec3, Vec3>(t[0].cwiseMin(t[1]).cwiseMin(t[2]), t[0].cwiseMax(t[1]).cwiseMax(t[2]));
    };
    std::vector<std::pair<Vec3, Vec3>> boxes(b.triangles.size());
    for (std::size_t j = 0; j < boxes.size(); ++j) {
      const Vec3 t[3] = {placed[b.triangles[j][0]], placed[b.triangles[j][1]], placed[b.triangles[j][2]]};
      boxes[j] = box(t);
    }
    for (std::uint32_t i = 0; i < a.triangles.size(); ++i) {
      const Vec3 ta[3] = {a.vertices[a.triangles[i][0]], a.vertices[a.triangles[i][1]], a.vertices[a.triangles[i][2]]};
      const auto [low, high] = box(ta);
      for (std::uint32_t j = 0; j < b.triangles.size(); ++j) {
        if ((low.array() > boxes[j].second.array()).any() || (high.array() < boxes[j].first.array()).any()) continue;
        const Vec3 tb[3] = {placed[b.triangles[j][0]], placed[b.triangles[j][1]], placed[b.triangles[j][2]]};
        if (primitive::triangles_intersect(ta, tb)) hits.push_back({i, j});
      }
    }
  }
  [[nodiscard]] query::PatchInput input() const {
    query::PatchInput in;
    in.hits = hits;
    in.vertices_a = a.vertices;
    in.triangles_a = a.triangles;
    in.vertices_b = b.vertices;
    in.triangles_b = b.triangles;
    in.pose_b_in_a = pose_b_in_a;
    in.solid_a = a.solid;
    in.solid_b = b.solid;
    in.reference_a = a.centre;
    in.reference_b = pose_b_in_a * b.centre;
    in.previous_normal = previous ? &*previous : nullptr;
    in.previous_position = previous_position ? &*previous_position : nullptr;
    in.max_contacts = max_contacts;
    if (probes) {
      in.probe_a = {body_ray, &a};
      in.probe_b = {body_ray, &b};
    }
    return in;
  }
  /// Contacts in A's frame.
  std::vector<query::Contact> contacts() {
    find_hits();
    const auto made = builder->build(input());
    return {made.begin(), made.end()};
  }
};

/// Contacts of two bodies that stand in the world by their poses, given in the world's frame.
struct WorldScene {
  Body a;
  math::Pose pose_a;
  Body b;
  math::Pose pose_b;
  bool probes = true;
  int max_contacts = 8;

  [[nodiscard]] std::vector<query::Contact> contacts() const {
    ContactScene scene{a, b, pose_a.inverse() * pose_b};
    scene.probes = probes;
    scene.max_contacts = max_contacts;
    std::vector<query::Contact> made = scene.contacts();
    for (query::Contact& c : made) {
      c.position = pose_a * c.position;
      c.normal = pose_a.rotation * c.normal;
    }
    return made;
  }
};

inline double degrees_between(const Vec3& p, const Vec3& q) {
  return std::atan2(p.cross(q).norm(), p.dot(q)) * 57.29577951308232;
}

}  // namespace odds::test
