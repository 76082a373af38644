// Scripted motion in closed form, with exact derivatives.
#include "odds/haptics/motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace odds::haptics {
namespace {

constexpr double two_pi = 2.0 * std::numbers::pi;

struct Scalar {
  double value = 0.0;
  double rate = 0.0;  // per second
};

// The minimum-jerk step from 0 to 1 (Flash and Hogan, J. Neuroscience 5, 1985): how hands move from rest to rest.
Scalar minimum_jerk(double time_s, double duration_s) noexcept {
  const double u = std::clamp(time_s / duration_s, 0.0, 1.0);
  return {u * u * u * (10.0 + u * (-15.0 + 6.0 * u)), 30.0 * u * u * (1.0 - u) * (1.0 - u) / duration_s};
}

Scalar product(const Scalar& a, const Scalar& b) noexcept {
  return {a.value * b.value, a.rate * b.value + a.value * b.rate};
}

Scalar press(const Motion& m, double t) noexcept {
  const Scalar in = minimum_jerk(t, m.rise_s);
  const Scalar out = minimum_jerk(t - (m.duration_s - m.rise_s), m.rise_s);
  return {m.depth_m * (in.value - out.value), m.depth_m * (in.rate - out.rate)};
}

Scalar tap(const Motion& m, double t) noexcept {
  const double omega = two_pi * m.taps / m.duration_s;
  return {0.5 * m.depth_m * (1.0 - std::cos(omega * t)), 0.5 * m.depth_m * omega * std::sin(omega * t)};
}

Scalar sine(const Motion& m, double t) noexcept {
  const double omega = two_pi * m.frequency_hz;
  const double period_s = 1.0 / m.frequency_hz;
  const Scalar wave = {m.amplitude_m * std::sin(omega * t), m.amplitude_m * omega * std::cos(omega * t)};
  const Scalar in = minimum_jerk(t, period_s);
  const Scalar out = minimum_jerk(m.duration_s - t, period_s);
  return product(wave, product(in, {out.value, -out.rate}));
}

void spiral(const Motion& m, double t, MotionSample& sample) noexcept {
  const Vec3 u = m.normal.unitOrthogonal();
  const Vec3 v = m.normal.cross(u);
  const double half = std::sin(std::numbers::pi * t / m.duration_s);
  const double radius = m.radius_m * half * half;
  const double radius_rate = m.radius_m * std::numbers::pi / m.duration_s * std::sin(two_pi * t / m.duration_s);
  const double omega = two_pi * m.turns / m.duration_s;
  const Vec3 outward = std::cos(omega * t) * u + std::sin(omega * t) * v;
  const Vec3 around = -std::sin(omega * t) * u + std::cos(omega * t) * v;
  sample.offset_m = radius * outward;
  sample.velocity_m_per_s = radius_rate * outward + radius * omega * around;
}

}  // namespace

MotionSample sample(const Motion& motion, double time_s) noexcept {
  const double t = std::clamp(time_s, 0.0, motion.duration_s);
  MotionSample result;
  Scalar along;
  Vec3 axis = motion.direction;
  switch (motion.kind) {
    case MotionKind::hold:
      break;
    case MotionKind::press:
      along = press(motion, t);
      break;
    case MotionKind::tap:
      along = tap(motion, t);
      break;
    case MotionKind::sine:
      along = sine(motion, t);
      break;
    case MotionKind::slide:
      along = minimum_jerk(t, motion.duration_s);
      axis = motion.by_m;
      break;
    case MotionKind::spiral:
      spiral(motion, t, result);
      break;
  }
  if (motion.kind != MotionKind::spiral) {
    result.offset_m = along.value * axis;
    result.velocity_m_per_s = along.rate * axis;
  }
  const Scalar turn = minimum_jerk(t, motion.duration_s);
  result.turned_rad = motion.turn_rad * turn.value;
  result.turn_rate_rad_per_s = motion.turn_rad * turn.rate;
  if (time_s < 0.0 || time_s > motion.duration_s) {
    result.velocity_m_per_s.setZero();
    result.turn_rate_rad_per_s = 0.0;
  }
  return result;
}

}  // namespace odds::haptics
