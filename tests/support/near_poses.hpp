// Poses at a chosen distance from first touch, after Trenkel, Weller and Zachmann 2007: random rotation and direction,
// then bisection along the direction.
#pragma once

#include <cmath>
#include <functional>
#include <random>

#include "odds/math/pose.hpp"

namespace odds::test {

/// True if the surfaces meet in this pose of B in A.
using Collides = std::function<bool(const math::Pose&)>;

struct TouchingPose {
  math::Pose pose;  ///< B just clear of A (within the tolerance of the bisection)
  Vec3 direction;   ///< unit; moving B along it parts them
};

/// B comes in from far away along a random line through the centres' neighbourhood; the line's first touch is found by
/// steps of size/64 and then by bisection to size * 1e-12. `size`: about the larger diameter.
inline TouchingPose touching_pose(std::mt19937_64& generator, const Vec3& center_a, const Vec3& center_b, double size,
                                  const Collides& collides) {
  std::normal_distribution<double> normal;
  for (;;) {
    const Quat rotation = Quat(normal(generator), normal(generator), normal(generator), normal(generator)).normalized();
    const Vec3 direction = Vec3(normal(generator), normal(generator), normal(generator)).normalized();
    const auto at = [&](double distance) {
      math::Pose pose{rotation.toRotationMatrix(), Vec3::Zero()};
      pose.translation = center_a + distance * direction - pose.rotation * center_b;
      return pose;
    };
    double clear = 1.25 * size;
    double hit = clear;
    while (hit > 0.0 && !collides(at(hit))) {
      clear = hit;
      hit -= size / 64.0;
    }
    if (hit <= 0.0) continue;  // passed through a hole
    while (clear - hit > 1e-12 * size) {
      const double middle = 0.5 * (clear + hit);
      (collides(at(middle)) ? hit : clear) = middle;
    }
    return {at(clear), direction};
  }
}

}  // namespace odds::test
