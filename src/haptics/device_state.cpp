// What of a device's words can be used.
#include <cmath>

#include "odds/haptics/device.hpp"

namespace odds::haptics {
namespace {

constexpr double greatest_number = 1e12;  // as in tracks, so that what was used can be replayed

bool is_in_reason(const Vec3& v) noexcept { return (v.array().abs() <= greatest_number).all(); }  // nor is NaN

}  // namespace

bool make_usable(DeviceState& state) noexcept {
  const double length = state.orientation.coeffs().stableNorm();
  if (!(std::abs(length - 1.0) <= 1e-3)) return false;  // nor is NaN
  if (!is_in_reason(state.position_m) || !is_in_reason(state.velocity_m_per_s) ||
      !is_in_reason(state.angular_velocity_rad_per_s)) {
    return false;
  }
  if (std::abs(length - 1.0) > 1e-12) state.orientation.normalize();  // a written track must come back bit for bit
  return true;
}

DeviceState sensed(const DeviceSpec& spec, const DeviceState& said, const DeviceState& last) noexcept {
  DeviceState state = said;
  if (!spec.senses_position) {
    state.position_m = last.position_m;
    state.velocity_m_per_s.setZero();
  }
  if (!spec.senses_orientation) {
    state.orientation = last.orientation;
    state.angular_velocity_rad_per_s.setZero();
  }
  return state;
}

}  // namespace odds::haptics
