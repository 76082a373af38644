#include "ode/step_motion.hpp"

namespace odds::ode {
namespace {

Vec3 vector_of(const dReal* v) noexcept { return {v[0], v[1], v[2]}; }

}  // namespace

math::Pose before_step(dGeomID geom, const math::Pose& pose, double step_s) noexcept {
  const dBodyID body = dGeomGetBody(geom);
  if (body == nullptr) return pose;
  const Vec3 centre = vector_of(dBodyGetPosition(body));
  const Vec3 turn = -step_s * vector_of(dBodyGetAngularVel(body));
  const double angle = turn.norm();
  const Mat3 back = angle > 0.0 ? Mat3(Eigen::AngleAxisd(angle, turn / angle)) : Mat3(Mat3::Identity());
  const Vec3 centre_before = centre - step_s * vector_of(dBodyGetLinearVel(body));
  return {back * pose.rotation, centre_before + back * (pose.translation - centre)};
}

}  // namespace odds::ode
