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
// Of the square of the thickness: parts nearer together than its root have no lever to turn anything by.
constexpr double turned_by_nothing = 1e-4;

/// What pushes on some spheres, in units of `Law::unit`, with the weights that the eighth power gives the pairs.
struct Sum {
  Vec3 push = Vec3::Zero();
  Vec3 torque = Vec3::Zero();  // about the origin
  Vec3 place = Vec3::Zero();   // times the weight
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
    const Vec3 push = (weight / soft) * apart;
    const Vec3 place = other + apart * (other_radius / both);  // where they would just touch
    sum.push += push;
    sum.torque += place.cross(push);
    sum.place += weight * place;
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

/// Adds to the parts' pushes what turns the body besides: forces across the lines from their common middle, which sum
/// up to nothing, each by the part's weight. What one place alone turns cannot be had, and is left out.
void add_turning(const Vec3& torque, double weights, double unit, DeepOverlap& overlap,
                 const std::array<double, InnerSpheres::corners>& weight) noexcept {
  Vec3 middle = Vec3::Zero();
  Vec3 missing = torque;
  for (std::uint32_t i = 0; i < overlap.count; ++i) {
    middle += (weight[i] / weights) * overlap.parts[i].position;
    missing -= overlap.parts[i].position.cross(overlap.parts[i].push);
  }
  Mat3 inertia = turned_by_nothing * unit * unit * Mat3::Identity();
  for (std::uint32_t i = 0; i < overlap.count; ++i) {
    const Vec3 arm = overlap.parts[i].position - middle;
    inertia += (weight[i] / weights) * (arm.squaredNorm() * Mat3::Identity() - arm * arm.transpose());
  }
  const Vec3 turning = inertia.inverse() * missing;
  for (std::uint32_t i = 0; i < overlap.count; ++i) {
    overlap.parts[i].push += (weight[i] / weights) * turning.cross(overlap.parts[i].position - middle);
  }
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
        parts[c].torque += share * sum.torque;
        parts[c].place += share * sum.place;
        parts[c].weight += share * sum.weight;
      }
    }
  }
  if (!(eighth_power > 0.0)) return result;
  const double mean = std::sqrt(std::sqrt(std::sqrt(eighth_power)));  // the depth, in units
  result.depth = mean * law.unit;
  const double scale = mean / eighth_power;  // the depth, in units, to the power of -7
  std::array<double, InnerSpheres::corners> weight;
  Vec3 torque = Vec3::Zero();
  for (const Sum& sum : parts) {
    torque += scale * sum.torque;
    if (!(sum.weight > least_part * weights)) continue;
    weight[result.count] = sum.weight;
    result.parts[result.count++] = {sum.place / sum.weight, scale * sum.push};
  }
  add_turning(torque, weights, law.unit, result, weight);
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
