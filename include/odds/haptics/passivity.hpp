// How much energy passed between the hand and the simulation: the sign of it tells a passive loop from an active one.
#pragma once

#include "odds/haptics/device.hpp"

namespace odds::haptics {

/// Passivity observer (Hannaford and Ryu, IEEE Trans. Robotics and Automation 18, 2002) at the hand, in six degrees of
/// freedom. The force sent in one tick is held until the next: its work on the hand is force times the way that the
/// hand went meanwhile. The simulation has taken in `energy_j()`; below zero it has given more than it got. What the
/// scene stores at the start (a raised weight, a wound spring) may be given without fault. noexcept, no allocation.
class PassivityObserver {
 public:
  /// Begins anew from a state of the device.
  void reset(const DeviceState& state) noexcept;
  /// The hand has moved to `state` under the force of the last sent().
  void moved(const DeviceState& state) noexcept;
  /// Force and torque on the hand from now on, as sent and taken by the device.
  void sent(const Vec3& force_n, const Vec3& torque_nm) noexcept;

  [[nodiscard]] double energy_j() const noexcept { return energy_j_; }
  [[nodiscard]] double least_j() const noexcept { return least_j_; }  ///< lowest so far, <= 0
  /// The hand's way between the last two states of moved() ...
  [[nodiscard]] const Vec3& step_m() const noexcept { return step_m_; }
  /// ... and its turn, axis times angle. Both in the frame of those states; in a Renderer the device's own, world axes,
  /// unscaled. Zero after a tick whose read failed or told nothing new: the next that does has the whole way since.
  [[nodiscard]] const Vec3& turn_rad() const noexcept { return turn_rad_; }

 private:
  double energy_j_ = 0.0;
  double least_j_ = 0.0;
  Vec3 position_m_ = Vec3::Zero();
  Quat orientation_ = Quat::Identity();
  Vec3 step_m_ = Vec3::Zero();
  Vec3 turn_rad_ = Vec3::Zero();
  Vec3 force_n_ = Vec3::Zero();
  Vec3 torque_nm_ = Vec3::Zero();
};

}  // namespace odds::haptics
