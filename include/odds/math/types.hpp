// Vector and matrix names used everywhere. Doubles in the public interface; floats only inside hierarchies.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace odds {

using Vec3 = Eigen::Vector3d;
using Vec3f = Eigen::Vector3f;
using Mat3 = Eigen::Matrix3d;
using Mat3f = Eigen::Matrix3f;
using Quat = Eigen::Quaterniond;

}  // namespace odds
