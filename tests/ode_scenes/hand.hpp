// A spring and damper that leads a body, as a haptic device or a robot's compliant wrist would, and what it feels.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "ode_scenes/arena.hpp"

namespace odds::ode_scenes {

struct Hand {
  Hand(dBodyID of, const Vec3& along, double about) : body(of), stiffness(along), turning(about) {}

  dBodyID body;
  Vec3 stiffness;                ///< N/m along the world's axes
  double turning;                ///< N m/rad
  double damping = 0.0;          ///< N s/m
  double turning_damping = 0.0;  ///< N m s/rad

  std::vector<double> change_n;  ///< of the force from one millisecond to the next
  double most_n = 0.0;

  /// Damps by `ratio` of critical. A body that is too light to be turned so stiffly by a loop of 1 kHz is turned
  /// softer.
  void damp(double ratio) {
    constexpr double step_s = 0.001;
    dMass mass;
    dBodyGetMass(body, &mass);
    const double inertia = std::min({mass.I[0], mass.I[5], mass.I[10]});
    turning = std::min(turning, 0.05 * inertia / (step_s * step_s));
    damping = 2.0 * ratio * std::sqrt(stiffness.maxCoeff() * mass.mass);
    turning_damping = 2.0 * ratio * std::sqrt(turning * inertia);
  }
  /// Pulls for one step. Explicit in time, as a loop of a device's own is.
  void pull(const Vec3& target, const Vec3& velocity, const Mat3& turned, const Vec3& spin) {
    const Vec3 stretch = target - position_of(body);
    const Eigen::AngleAxisd turn(turned * ode_rotation().transpose());
    const Vec3 force = stiffness.cwiseProduct(stretch) + damping * (velocity - velocity_of(body));
    const Vec3 torque = turning * turn.angle() * turn.axis() + turning_damping * (spin - spin_of(body));
    dBodyAddForce(body, force.x(), force.y(), force.z());
    dBodyAddTorque(body, torque.x(), torque.y(), torque.z());
    const Vec3 felt = stiffness.cwiseProduct(stretch);
    if (pulls_++ > 0) change_n.push_back((felt - last_).norm());
    last_ = felt;
    most_n = std::max(most_n, felt.norm());
  }
  [[nodiscard]] double felt_n() const { return last_.norm(); }

 private:
  [[nodiscard]] Mat3 ode_rotation() const {
    const dReal* r = dBodyGetRotation(body);
    Mat3 m;
    m << r[0], r[1], r[2], r[4], r[5], r[6], r[8], r[9], r[10];
    return m;
  }
  Vec3 last_ = Vec3::Zero();
  std::uint64_t pulls_ = 0;
};

}  // namespace odds::ode_scenes
