// The coupling's rows.
#include "ode/world/coupling_joint.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace odds::ode {
namespace {

struct Rows {
  Vec3 velocity = Vec3::Zero();
  double softness = 0.0;  // CFM
  bool on = false;
};

Rows rows(const Vec3& error, const Vec3& target_velocity, double stiffness, double damping, double most,
          double step_s) {
  Rows result;
  Vec3 spring = stiffness * error;
  const double length = spring.stableNorm();
  // At its limit it is as stiff as what gives the limit there: a force that changes no more may not damp as the spring.
  if (length > most) {
    spring *= most / length;
    stiffness *= most / length;
  }
  const double weight = step_s * stiffness + damping;
  result.velocity = (spring + damping * target_velocity) / weight;
  result.softness = 1.0 / weight;
  result.on = weight > 0.0 && result.velocity.allFinite() && std::isfinite(result.softness / step_s);
  return result;
}

// The shortest rotation that leads from `from` to `to`, axis times angle.
Vec3 rotation_vector(const Mat3& from, const Mat3& to) {
  const Eigen::AngleAxisd turn(to * from.transpose());
  return turn.angle() * turn.axis();
}

constexpr std::array<int, 3> velocity_parameter = {dParamVel1, dParamVel2, dParamVel3};
constexpr std::array<int, 3> softness_parameter = {dParamCFM1, dParamCFM2, dParamCFM3};
constexpr std::array<int, 3> strength_parameter = {dParamFMax1, dParamFMax2, dParamFMax3};

void configure(dJointID joint, void (*set)(dJointID, int, dReal), const Rows& rows) {
  for (std::size_t i = 0; i < 3; ++i) {
    set(joint, velocity_parameter[i], rows.on ? rows.velocity[static_cast<Eigen::Index>(i)] : 0.0);
    set(joint, softness_parameter[i], rows.on ? rows.softness : 0.0);
    set(joint, strength_parameter[i], rows.on ? dInfinity : 0.0);  // no strength: the rows are left out
  }
}

}  // namespace

CouplingJoint::CouplingJoint(dWorldID world, dBodyID body)
    : body_(body), linear_(dJointCreateLMotor(world, nullptr)), angular_(dJointCreateAMotor(world, nullptr)) {
  dJointAttach(linear_, body, nullptr);
  dJointSetLMotorNumAxes(linear_, 3);
  dJointAttach(angular_, body, nullptr);
  dJointSetAMotorMode(angular_, dAMotorUser);
  dJointSetAMotorNumAxes(angular_, 3);
  for (int i = 0; i < 3; ++i) {
    const Vec3 axis = Vec3::Unit(i);
    dJointSetLMotorAxis(linear_, i, 0, axis.x(), axis.y(), axis.z());
    dJointSetAMotorAxis(angular_, i, 0, axis.x(), axis.y(), axis.z());
  }
  dJointSetFeedback(linear_, &linear_feedback_);
  dJointSetFeedback(angular_, &angular_feedback_);
}

void CouplingJoint::begin_step(const Vec3& center_m, double step_s) noexcept {
  forget_wrench();
  const Coupling& c = coupling_;
  const dReal* p = dBodyGetPosition(body_);
  const dReal* r = dBodyGetRotation(body_);
  Mat3 rotation;
  rotation << r[0], r[1], r[2], r[4], r[5], r[6], r[8], r[9], r[10];
  const Vec3 arm = c.target.rotation * center_m;
  const Vec3 error = c.target.translation + arm - Vec3(p[0], p[1], p[2]);
  const Vec3 velocity = c.target_velocity_m_per_s + c.target_angular_velocity_rad_per_s.cross(arm);
  configure(linear_, &dJointSetLMotorParam,
            rows(error, velocity, c.stiffness_n_per_m, c.damping_ns_per_m, c.max_spring_force_n, step_s));
  configure(angular_, &dJointSetAMotorParam,
            rows(rotation_vector(rotation, c.target.rotation), c.target_angular_velocity_rad_per_s,
                 c.angular_stiffness_nm_per_rad, c.angular_damping_nms_per_rad, c.max_spring_torque_nm, step_s));
}

void CouplingJoint::forget_wrench() noexcept {
  linear_feedback_ = {};
  angular_feedback_ = {};
}

Wrench CouplingJoint::wrench() const noexcept {
  const dReal* f = linear_feedback_.f1;
  const dReal* t = angular_feedback_.t1;
  return {{f[0], f[1], f[2]}, {t[0], t[1], t[2]}};
}

}  // namespace odds::ode
