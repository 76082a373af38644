// The stages between a computed force and the device: a simulation aid, not a safety function.
#pragma once

#include <cstdint>
#include <limits>

#include "odds/haptics/device.hpp"
#include "odds/haptics/settings.hpp"
#include "odds/haptics/tick_record.hpp"

namespace odds::haptics {

/// What the stages hold to. SI; infinity switches a limit off.
struct SafetyLimits {
  double max_force_n = std::numeric_limits<double>::infinity();
  double max_torque_nm = std::numeric_limits<double>::infinity();
  double max_force_slew_n_per_s = std::numeric_limits<double>::infinity();
  double max_torque_slew_nm_per_s = std::numeric_limits<double>::infinity();
  double rise_s = 0.0;  ///< after the start, or a long gap, the force grows linearly to its full size over this time
  double stale_after_s = 0.02;     ///< a device state older than this is stale: the force decays ...; see also `rise_s`
  double decay_s = 0.05;           ///< ... to zero within this time
  std::uint32_t faulty_ticks = 5;  ///< so many ticks in a row without a finite force latch a fault
};

/// Reads the limits from a device's table; keys left out keep what `limits` holds.
void read_safety_limits(SettingsReader& reader, SafetyLimits& limits);

/// How many ticks each stage changed.
struct SafetyCounts {
  std::uint64_t ticks = 0;
  std::uint64_t not_finite = 0;
  std::uint64_t scaled = 0;
  std::uint64_t force_rise = 0;
  std::uint64_t force_clamped = 0;
  std::uint64_t torque_clamped = 0;
  std::uint64_t force_slewed = 0;
  std::uint64_t torque_slewed = 0;
  std::uint64_t stale = 0;
  std::uint64_t faulted = 0;
  std::uint64_t restarted = 0;  ///< ticks in which the rise began again after a gap
};

/// Applies, in this order: finite check, force scale, rise after start, clamp of the magnitude (direction kept), limit
/// of the change per second, decay while the device state is stale, latched fault. Comes in as the scene's force, goes
/// out as the device's: the limits are the device's. One per device; noexcept, no allocation.
class Safety {
 public:
  /// `force_scale` > 0: DeviceScale::force.
  explicit Safety(const SafetyLimits& limits, double force_scale = 1.0) : limits_(limits), force_scale_(force_scale) {}

  /// Changes force and torque of `command` and sets its flags. `dt_s` > 0: one period of the loop. `state_age_s` >= 0:
  /// of the device state that the force rests on. `passed_s`: since the last call; more than `dt_s` where ticks were
  /// missed, and less, from a clock that stood still or ran backwards, counts as `dt_s`. Rise and slew limit go on by
  /// one period a call, so that a step after a gap is no larger than any other; the decay goes on by the time that
  /// passed; after a gap longer than `stale_after_s` the rise begins again. What leaves is finite and within the
  /// limits, always.
  void apply(DeviceCommand& command, double dt_s, double state_age_s, double passed_s = 0.0) noexcept;

  /// Latches a fault: zero force from the next apply on, until reset().
  void trip() noexcept { faulted_ = true; }
  [[nodiscard]] bool faulted() const noexcept { return faulted_; }
  /// Takes back a fault and starts anew, rise included; counts are kept.
  void reset() noexcept;

  [[nodiscard]] const SafetyCounts& counts() const noexcept { return counts_; }
  [[nodiscard]] const SafetyLimits& limits() const noexcept { return limits_; }

 private:
  SafetyLimits limits_;
  double force_scale_;
  SafetyCounts counts_;
  Vec3 last_force_n_ = Vec3::Zero();  // before the decay of a stale state
  Vec3 last_torque_nm_ = Vec3::Zero();
  Vec3 sent_force_n_ = Vec3::Zero();
  Vec3 sent_torque_nm_ = Vec3::Zero();
  double since_start_s_ = 0.0;
  double stale_s_ = 0.0;
  std::uint32_t not_finite_in_a_row_ = 0;
  bool faulted_ = false;
};

}  // namespace odds::haptics
