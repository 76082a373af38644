// Depth and gradient of two packings of spheres.
#include <algorithm>
#include <array>
#include <cmath>

#include "odds/query/inner_spheres.hpp"

namespace odds::query {
namespace {

// Of the smaller radius: nearer than that, the way from centre to centre fades out instead of turning round at once.
constexpr double core = 0.25;
// Of all weights: a part that has less pushes nothing.
constexpr double least_part = 1e-9;

/// What pushes on some spheres, in units of `Law::unit`, with the weights that the eighth power gives the pairs.
struct Sum {
  Vec3 push = Vec3::Zero();
  Vec3 place = Vec3::Zero();  // times the weight
  double weight = 0.0;
  double eighth_power = 0.0;
};

struct Law {
  double unit;      // metres
  double per_cube;  // one by the smaller solid's

  /// One pair: `sum` is the inner sphere's.
  void add(const Vec3& center, double radius, const Vec3& other, double other_radius, Sum& sum) const noexcept {
    const Vec3 apart = center - other;
    const double square = apart.squaredNorm();
    const double both = radius + other_radius;
    if (square >= both * both) return;
    const double least = std::min(radius, other_radius);
    const double soft = std::sqrt(square + core * core * least * least);
    const double depth = (both - soft) / unit;
    if (!(depth > 0.0)) return;
    const double squared = depth * depth;
    const double weight = least * least * least * per_cube * squared * squared * squared * depth;
    sum.push += (weight / soft) * apart;
    sum.place += weight * (other + apart * (other_radius / both));  // where they would just touch
    sum.weight += weight;
    sum.eighth_power += weight * depth;
  }
};

/// What pushes on one sphere of the smaller solid; the larger one's groups that may meet it are in `near`.
Sum push_on(const Vec3& center, double radius, const InnerSpheres& larger, std::span<const std::uint32_t> near,
            const Law& law) noexcept {
  Sum sum;
  for (const std::uint32_t index : near) {
    const InnerSpheres::Group& group = larger.groups()[index];
    const double reach = radius + group.radius;
    if ((center - group.center).squaredNorm() >= reach * reach) continue;
    for (std::uint32_t i = group.first; i < group.first + group.count; ++i) {
      law.add(center, radius, larger.centers()[i], larger.radii()[i], sum);
    }
  }
  return sum;
}

/// In the larger solid's frame, with what pushes the smaller one out.
DeepOverlap overlap_in(const InnerSpheres& larger, const InnerSpheres& smaller, const math::Pose& pose) noexcept {
  DeepOverlap result;
  const Law law{std::min(larger.thickness(), smaller.thickness()), 1.0 / smaller.cubes()};
  std::array<Sum, InnerSpheres::corners> parts;
  double weights = 0.0;
  double eighth_power = 0.0;
  std::array<std::uint32_t, InnerSpheres::most / InnerSpheres::group_size> near;
  for (const InnerSpheres::Group& group : smaller.groups()) {
    const Vec3 group_center = pose * group.center;
    std::size_t near_count = 0;
    for (std::uint32_t i = 0; i < larger.groups().size(); ++i) {
      const double reach = larger.groups()[i].radius + group.radius;
      if ((larger.groups()[i].center - group_center).squaredNorm() < reach * reach) near[near_count++] = i;
    }
    if (near_count == 0) continue;
    for (std::uint32_t i = group.first; i < group.first + group.count; ++i) {
      const Sum sum = push_on(pose * smaller.centers()[i], smaller.radii()[i], larger, {near.data(), near_count}, law);
      if (!(sum.weight > 0.0)) continue;
      weights += sum.weight;
      eighth_power += sum.eighth_power;
      for (std::size_t c = 0; c < parts.size(); ++c) {
        const double share = smaller.corner_shares()[i][c];
        parts[c].push += share * sum.push;
        parts[c].place += share * sum.place;
        parts[c].weight += share * sum.weight;
      }
    }
  }
  if (!(eighth_power > 0.0)) return result;
  const double mean = std::sqrt(std::sqrt(std::sqrt(eighth_power)));  // the depth, in units
  result.depth = mean * law.unit;
  for (const Sum& sum : parts) {
    if (!(sum.weight > least_part * weights)) continue;
    result.parts[result.count++] = {sum.place / sum.weight, sum.push * (mean / eighth_power), sum.weight / weights};
  }
  return result;
}

}  // namespace

DeepOverlap deep_overlap(const InnerSpheres& a, const InnerSpheres& b, const math::Pose& b_in_a) noexcept {
  if (!(a.cubes() < b.cubes())) {
    DeepOverlap result = overlap_in(a, b, b_in_a);
    for (std::uint32_t i = 0; i < result.count; ++i) result.parts[i].push = -result.parts[i].push;
    return result;
  }
  DeepOverlap result = overlap_in(b, a, b_in_a.inverse());
  for (std::uint32_t i = 0; i < result.count; ++i) {
    DeepOverlap::Part& part = result.parts[i];
    part.position = b_in_a * part.position;
    part.push = b_in_a.rotation * part.push;
  }
  return result;
}

}  // namespace odds::query
