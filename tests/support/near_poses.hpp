// Poses at a chosen distance from first touch, after Trenkel, Weller and Zachmann 2007: random rotation and direction,
// then bisection along the direction.
#pragma once

#include <cmath>
#include <functional>

#include "odds/math/pose.hpp"
#include "odds/math/random.hpp"

namespace odds::testing {

/// True if the surfaces meet in this pose of B in A.
using Collides = std::function<bool(const math::Pose&)>;

struct TouchingPose {
  math::Pose pose;  ///< B just clear of A (within the tolerance of the bisection)
  Vec3 direction = Vec3::UnitX();  ///< unit; moving B along it parts them
};

/// B comes in from far away along a random line through the centres' neighbourhood; the line's first touch is found by
/// steps of size/64 and then by bisection to size * 1e-12. `size`: about the larger diameter.
inline TouchingPose touching_pose(math::Random& random, const Vec3& center_a, const Vec3& center_b, double size,
                                  const Collides& collides) {
  for (;;) {
    const Quat rotation = random.rotation();
    const Vec3 direction = random.direction();
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

}  // namespace odds::testing
