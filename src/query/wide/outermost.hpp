// Which of many points is the outermost one, eight at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "odds/math/types.hpp"
#include "odds/query/answer.hpp"
#include "query/wide/doubles.hpp"

namespace odds::query::wide {

/// Eight points, each with how deep it lies somewhere, metres. Not set at first.
struct alignas(64) EightPoints {
  static constexpr std::size_t count = 8;

  double at[3][count];
  double depth[count];

  void set(std::size_t lane, const Vec3& point, double to_depth) noexcept {
    for (int axis = 0; axis < 3; ++axis) at[axis][lane] = point[axis];
    depth[lane] = to_depth;
  }
  [[nodiscard]] Vec3 point(std::size_t lane) const noexcept { return {at[0][lane], at[1][lane], at[2][lane]}; }
  /// It counts nowhere.
  void leave_out(std::size_t lane) noexcept { set(lane, Vec3::Zero(), -std::numeric_limits<double>::infinity()); }
};

/// Of each `step`-th eight all that `least_depth` lets count, by number; of those that are as far out as each other the
/// first; no_feature: none counts. By so much, per metre of depth, a deeper point counts for as if it were farther out.
template <class L>
class OutermostKernel {
 public:
  /// With the greatest direction . x + per_depth * depth.
  static std::uint32_t along(std::span<const EightPoints> points, const Vec3& direction, double per_depth,
                             double least_depth, std::size_t step) noexcept {
    const D x = D::all(direction.x());
    const D y = D::all(direction.y());
    const D z = D::all(direction.z());
    return greatest(points, per_depth, least_depth, step, [&](const EightPoints& eight) {
      return (x * D::load(eight.at[0]) + y * D::load(eight.at[1])) + z * D::load(eight.at[2]);
    });
  }

  /// With the greatest square of the distance from a point plus per_depth * depth; the distance is taken across a unit
  /// vector or, if that is zero, as it is.
  static std::uint32_t from(std::span<const EightPoints> points, const Vec3& from, const Vec3& normal, double per_depth,
                            double least_depth, std::size_t step) noexcept {
    const D from_x = D::all(from.x());
    const D from_y = D::all(from.y());
    const D from_z = D::all(from.z());
    const D normal_x = D::all(normal.x());
    const D normal_y = D::all(normal.y());
    const D normal_z = D::all(normal.z());
    return greatest(points, per_depth, least_depth, step, [&](const EightPoints& eight) {
      const D x = D::load(eight.at[0]) - from_x;
      const D y = D::load(eight.at[1]) - from_y;
      const D z = D::load(eight.at[2]) - from_z;
      const D height = (x * normal_x + y * normal_y) + z * normal_z;
      const D across_x = x - height * normal_x;
      const D across_y = y - height * normal_y;
      const D across_z = z - height * normal_z;
      return (across_x * across_x + across_y * across_y) + across_z * across_z;
    });
  }

 private:
  using D = lanes::Doubles<typename lanes::DoublesOf<L>::Register>;

  template <class Value>
  ODDS_LANES_INLINE static std::uint32_t greatest(std::span<const EightPoints> points, double per_depth,
                                                  double least_depth, std::size_t step, const Value& value) noexcept {
    constexpr double nothing = -std::numeric_limits<double>::infinity();
    const D weight = D::all(per_depth);
    const D least = D::all(least_depth);
    D best = D::all(nothing);
    D best_eight = D::all(0.0);
    for (std::size_t i = 0; i < points.size(); i += step) {
      const D depth = D::load(points[i].depth);
      const D v = value(points[i]) + weight * depth;
      const auto better = (least <= depth) & (best < v);
      best = choose(better, v, best);
      best_eight = choose(better, D::all(static_cast<double>(i)), best_eight);
    }
    alignas(64) double values[EightPoints::count];
    alignas(64) double eights[EightPoints::count];
    best.store(values);
    best_eight.store(eights);
    double most = nothing;
    std::uint32_t found = no_feature;
    for (std::size_t lane = 0; lane < EightPoints::count; ++lane) {
      const auto number =
          static_cast<std::uint32_t>(EightPoints::count * static_cast<std::size_t>(eights[lane]) + lane);
      if (!(values[lane] > most) && !(values[lane] == most && number < found && most > nothing)) continue;
      most = values[lane];
      found = number;
    }
    return found;
  }
};

}  // namespace odds::query::wide
