#include "ode_scenes/truth.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "ode/mesh/nearest_surface.hpp"

namespace odds::ode_scenes {
namespace {

/// 0: it is not within.
double depth_of(const Vec3& point, const ode::PreparedMesh& in) {
  if (!ode::in_bounds(in, point)) return 0.0;
  std::uint64_t units = std::numeric_limits<std::uint64_t>::max();
  bool finished = false;
  const auto nearest = ode::nearest_surface(in, point, std::numeric_limits<double>::infinity(), query::no_feature, {},
                                            0, {0}, units, finished);
  return nearest && nearest->inside ? nearest->distance : 0.0;
}

/// Of corners and middles of triangles of `of` in `in`: corners of teeth lie in the other gear's sides.
double deepest_point(const ode::PreparedMesh& of, const ode::PreparedMesh& in, const math::Pose& pose) {
  double deepest = 0.0;
  for (const Vec3& vertex : of.mesh().vertices()) deepest = std::max(deepest, depth_of(pose * vertex, in));
  for (std::uint32_t t = 0; t < of.mesh().triangles().size(); ++t) {
    const auto [p, q, r] = of.corners(t);
    deepest = std::max(deepest, depth_of(pose * Vec3((p + q + r) / 3.0), in));
  }
  return deepest;
}

}  // namespace

const ode::PreparedMesh& Truth::prepared(const Mesh& mesh) {
  auto& kept = prepared_[mesh.get()];
  if (!kept) {
    auto shape = query::Shape::build(mesh);
    if (!shape) throw std::runtime_error(shape.error().message());
    kept = ode::PreparedMesh::make(std::move(shape).value());
  }
  return *kept;
}

double Truth::depth(const Mesh& a, const math::Pose& pose_a, const Mesh& b, const math::Pose& pose_b) {
  const math::Pose b_in_a = pose_a.inverse() * pose_b;
  return std::max(deepest_point(prepared(b), prepared(a), b_in_a),
                  deepest_point(prepared(a), prepared(b), b_in_a.inverse()));
}

}  // namespace odds::ode_scenes
