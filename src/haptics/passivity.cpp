// The balance of work at the hand.
#include "odds/haptics/passivity.hpp"

#include <algorithm>

namespace odds::haptics {

void PassivityObserver::reset(const DeviceState& state) noexcept {
  *this = {};
  position_m_ = state.position_m;
  orientation_ = state.orientation;
}

void PassivityObserver::moved(const DeviceState& state) noexcept {
  step_m_ = state.position_m - position_m_;
  const Eigen::AngleAxisd turn(state.orientation * orientation_.conjugate());
  turn_rad_ = turn.angle() * turn.axis();
  energy_j_ -= force_n_.dot(step_m_) + torque_nm_.dot(turn_rad_);
  least_j_ = std::min(least_j_, energy_j_);
  position_m_ = state.position_m;
  orientation_ = state.orientation;
}

void PassivityObserver::sent(const Vec3& force_n, const Vec3& torque_nm) noexcept {
  force_n_ = force_n;
  torque_nm_ = torque_nm;
}

}  // namespace odds::haptics
