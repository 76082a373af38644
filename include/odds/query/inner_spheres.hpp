// A solid filled with spheres, and how deep two solids filled so lie in each other: the law for deep overlap, where
// triangles that cross no longer say which way is out.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "odds/math/error.hpp"
#include "odds/math/pose.hpp"
#include "odds/query/shape.hpp"

namespace odds::query {

/// Spheres within a solid that touch its surface and fill as much of it as their number allows; they overlap (after the
/// inner sphere trees of Weller and Zachmann 2009, flat). Immutable; shareable among threads.
class InnerSpheres {
 public:
  static constexpr std::uint32_t fewest = 8;
  static constexpr std::uint32_t most = 512;
  static constexpr std::size_t group_size = 8;
  static constexpr std::size_t corners = 8;

  /// Neighbours in space: [first, first + count) of the spheres, and a sphere around them.
  struct Group {
    Vec3 center = Vec3::Zero();  ///< mesh frame, metres
    double radius = 0.0;
    std::uint32_t first = 0;
    std::uint32_t count = 0;
  };

  /// Finds balls that touch the surface at two places (shrinking balls, Ma, Bae and Choi 2012) under points spread
  /// evenly over it, and keeps those that fill most, `count` (fewest .. most) at most. Refuses a shape without
  /// polygons, and one that is not solid. 0.03 to 0.3 s, whatever the mesh's size; the same input gives the same
  /// spheres.
  static Result<InnerSpheres> pack(const std::shared_ptr<const Shape>& shape, std::uint32_t count = 128);

  [[nodiscard]] std::span<const Vec3> centers() const noexcept { return centers_; }  ///< mesh frame, metres
  [[nodiscard]] std::span<const double> radii() const noexcept { return radii_; }
  [[nodiscard]] std::span<const Group> groups() const noexcept { return groups_; }
  /// Of each sphere: how it is shared among the corners of the box of all centres, trilinear; the sum is 1.
  [[nodiscard]] std::span<const std::array<double, corners>> corner_shares() const noexcept { return corner_shares_; }
  /// Sum of the cubes of the radii, m^3.
  [[nodiscard]] double cubes() const noexcept { return cubes_; }
  /// Mean radius, each weighted by its volume: half of how thick the solid is, metres.
  [[nodiscard]] double thickness() const noexcept { return thickness_; }

 private:
  InnerSpheres() = default;
  std::vector<Vec3> centers_;
  std::vector<double> radii_;
  std::vector<Group> groups_;
  std::vector<std::array<double, corners>> corner_shares_;
  double cubes_ = 0.0;
  double thickness_ = 0.0;
};

/// How deep two solids lie in each other, as a function of their pose, and its gradient in parts.
struct DeepOverlap {
  /// What the spheres near one corner of the smaller solid's box contribute, as one force at one place. Parts without
  /// overlap are left out.
  struct Part {
    Vec3 position = Vec3::Zero();  ///< A's mesh frame, metres
    Vec3 push = Vec3::Zero();      ///< A's mesh frame: the way A has to go; the parts' sum is the gradient of the depth
  };

  double depth = 0.0;  ///< metres; 0 where no spheres overlap
  std::array<Part, InnerSpheres::corners> parts;
  std::uint32_t count = 0;
};

/// The power mean of order 8 of the depths of all overlapping pairs of spheres, each by its share of the smaller
/// solid's volume: every pair that is pushed deeper makes it greater, so that it leads out, and deep pairs count most.
/// Its square has a continuous gradient wherever the spheres may lie, at the first touch and centres upon centres
/// included: forces of stiffness * depth * push at the parts' places are those of a potential, torques too except where
/// all parts lie in one place. Nothing is known where the spheres of a solid leave gaps, as in large flat bodies. Sums
/// run in one order: the same input gives the same bits. At most count(a) * count(b) pairs are looked at, in two
/// levels: some 2 to 15 us for 128 spheres each, and 70 where almost all overlap. `b_in_a` must be rigid. noexcept, no
/// allocation; thread-safe.
[[nodiscard]] DeepOverlap deep_overlap(const InnerSpheres& a, const InnerSpheres& b, const math::Pose& b_in_a) noexcept;

}  // namespace odds::query
