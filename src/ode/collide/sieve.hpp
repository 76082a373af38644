// What of a mesh comes near a convex body, or a part of its box.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "odds/math/pose.hpp"
#include "ode/geom/convex_body.hpp"
#include "ode/mesh/prepared_mesh.hpp"
#include "query/shape/convex_region.hpp"

namespace odds::ode {

/// The half-spaces that bound a body: of many sides some will do, for what they let pass is cut by all of them later.
class Sieve {
 public:
  using Sides = query::ConvexRegion::Sides;
  using Visit = query::ConvexRegion::Visit;

  Sieve(const PreparedMesh& mesh, const ConvexBody& body, const math::Pose& body_in_mesh) noexcept
      : box_center_(body.box_center()),
        body_in_mesh_(body_in_mesh),
        region_(*mesh.wide_tree, rounding * body.box_half_extents().norm()) {
    const std::span<const HalfSpace> sides = body.sides();
    const std::size_t step = (sides.size() + most_sides - 1) / most_sides;
    for (std::size_t i = 0; i < sides.size(); i += step) add(sides[i]);
    of_body_ = region_.count();
    has_all_ = step == 1;
  }

  /// Only what is in this octant of the box around the body, too.
  void set_octant(std::size_t octant) noexcept {
    region_.keep(of_body_);
    for (int axis = 0; axis < 3; ++axis) {
      const double sign = (octant >> axis & 1U) != 0 ? 1.0 : -1.0;
      add({-sign * Vec3::Unit(axis), -sign * box_center_[axis]});
    }
  }
  /// Of those sides the body's own, by which a triangle has still to be cut; all of them where the sieve has only some.
  [[nodiscard]] Sides of_body(Sides sides) const noexcept {
    return has_all_ ? sides & ((Sides{1} << of_body_) - 1) : ~Sides{0};
  }
  [[nodiscard]] const query::ConvexRegion& region() const noexcept { return region_; }

 private:
  static constexpr std::size_t most_sides = query::wide::HalfSpaces::most - 3;
  static constexpr double rounding = 1e-9;  // of the body's size: more than poses and corners are rounded by

  void add(const HalfSpace& side) noexcept {
    const Vec3 normal = body_in_mesh_.rotation * side.normal;
    region_.add(normal, side.offset + normal.dot(body_in_mesh_.translation));
  }

  Vec3 box_center_;
  math::Pose body_in_mesh_;
  query::ConvexRegion region_;
  std::size_t of_body_ = 0;
  bool has_all_ = false;
};

}  // namespace odds::ode
