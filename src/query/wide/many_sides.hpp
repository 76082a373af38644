// The many sides of a convex body, eight at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "odds/math/types.hpp"
#include "query/wide/doubles.hpp"

namespace odds::query::wide {

/// Eight half-spaces {x : normal . x <= offset}, metres; normals of unit length. By default they hold everything.
struct alignas(64) EightSides {
  static constexpr std::size_t count = 8;

  double normal[3][count] = {};
  double offset[count];

  EightSides() noexcept {
    for (double& x : offset) x = std::numeric_limits<double>::max();
  }
  void set(std::size_t lane, const Vec3& to_normal, double to_offset) noexcept {
    for (int axis = 0; axis < 3; ++axis) normal[axis][lane] = to_normal[axis];
    offset[lane] = to_offset;
  }
};

template <class L>
class ManySidesKernel {
 public:
  /// Writes for each eight which sides a ball is not wholly within, a bit for each. False, and the rest is not written,
  /// if it is wholly beyond one.
  static bool near(std::span<const EightSides> sides, const Vec3& center, double radius, std::uint8_t* lanes) noexcept {
    const D beyond = D::all(radius);
    const D within = D::all(-radius);
    for (const EightSides& eight : sides) {
      const D height = along(eight, center) - D::load(eight.offset);
      if ((beyond < height).bits() != 0) return false;
      *lanes++ = static_cast<std::uint8_t>((within < height).bits());
    }
    return true;
  }

  /// How far it is from an inner point along a unit vector to the border, metres; 0 from outside.
  static double way_out(std::span<const EightSides> sides, const Vec3& point, const Vec3& direction) noexcept {
    const D least_speed = D::all(1e-12);
    const D zero = D::all(0.0);
    const D none = D::all(std::numeric_limits<double>::infinity());
    D way = none;
    for (const EightSides& eight : sides) {
      const D speed = along(eight, direction);
      const D room = max(D::load(eight.offset) - along(eight, point), zero);
      const auto leads_out = least_speed <= speed;
      way = min(way, choose(leads_out, room / choose(leads_out, speed, D::all(1.0)), none));
    }
    alignas(64) double by_lane[EightSides::count];
    way.store(by_lane);
    double least = by_lane[0];
    for (const double x : by_lane) least = x < least ? x : least;
    return least;
  }

 private:
  using D = lanes::Doubles<typename lanes::DoublesOf<L>::Register>;

  ODDS_LANES_INLINE static D along(const EightSides& eight, const Vec3& v) noexcept {
    return D::all(v.x()) * D::load(eight.normal[0]) + D::all(v.y()) * D::load(eight.normal[1]) +
           D::all(v.z()) * D::load(eight.normal[2]);
  }
};

}  // namespace odds::query::wide
