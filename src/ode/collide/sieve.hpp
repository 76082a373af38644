// What of a mesh comes near a convex body, or a part of its box.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
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
        region_(mesh.mesh(), *mesh.wide_tree, rounding * body.box_half_extents().norm()) {
    // Those of an octant are asked first: they turn most away. At first they hold everything.
    for (int axis = 0; axis < 3; ++axis) region_.add(Vec3::Unit(axis), std::numeric_limits<double>::max());
    const std::span<const HalfSpace> sides = body.sides();
    const std::size_t step = (sides.size() + most_sides - 1) / most_sides;
    for (std::size_t i = 0; i < sides.size(); i += step) {
      const HalfSpace side = in_mesh(sides[i]);
      region_.add(side.normal, side.offset);
    }
    has_all_ = step == 1;
  }

  /// Only what is in this octant of the box around the body, too.
  void set_octant(std::size_t octant) noexcept {
    for (std::size_t axis = 0; axis < of_octant; ++axis) {
      const double sign = (octant >> axis & 1U) != 0 ? 1.0 : -1.0;
      const auto i = static_cast<Eigen::Index>(axis);
      const HalfSpace side = in_mesh({-sign * Vec3::Unit(i), -sign * box_center_[i]});
      region_.set(axis, side.normal, side.offset);
    }
  }
  /// Of those sides the body's own, by which a triangle has still to be cut; all of them where the sieve has only some.
  [[nodiscard]] Sides of_body(Sides sides) const noexcept { return has_all_ ? sides >> of_octant : ~Sides{0}; }
  [[nodiscard]] const query::ConvexRegion& region() const noexcept { return region_; }

 private:
  static constexpr std::size_t of_octant = 3;
  static constexpr std::size_t most_sides = 32;
  static_assert(of_octant + most_sides <= query::wide::HalfSpaces::most);
  static constexpr double rounding = 1e-9;  // of the body's size: more than poses and corners are rounded by

  [[nodiscard]] HalfSpace in_mesh(const HalfSpace& side) const noexcept {
    const Vec3 normal = body_in_mesh_.rotation * side.normal;
    return {normal, side.offset + normal.dot(body_in_mesh_.translation)};
  }

  Vec3 box_center_;
  math::Pose body_in_mesh_;
  query::ConvexRegion region_;
  bool has_all_ = false;
};

}  // namespace odds::ode
