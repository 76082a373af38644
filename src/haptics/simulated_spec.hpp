// What the devices without hardware say about themselves.
#pragma once

#include <limits>
#include <string>

#include "odds/haptics/device.hpp"

namespace odds::haptics {

/// Limits of a common desktop device (5 N, 0.2 N m, 1000 N/m, 0.2 m: the defaults of CHAI3D's template for new
/// devices), so that a scene that works with it has a chance to work with a real one. Its mechanism's damping is not
/// known. Its
/// workspace is about `start_m`, where it begins.
inline DeviceSpec simulated_spec(std::string name, const Vec3& start_m) {
  DeviceSpec spec;
  spec.name = std::move(name);
  spec.maker = "odds";
  spec.max_force_n = 5.0;
  spec.max_torque_nm = 0.2;
  spec.max_stiffness_n_per_m = 1000.0;
  spec.max_angular_stiffness_nm_per_rad = 10.0;
  spec.workspace_radius_m = 0.2;
  spec.workspace_center_m = start_m;
  spec.actuates_force = true;
  spec.actuates_torque = true;
  return spec;
}

}  // namespace odds::haptics
