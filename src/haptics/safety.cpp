// The safety stages, in their order.
#include "odds/haptics/safety.hpp"

#include <algorithm>
#include <cmath>

namespace odds::haptics {
namespace {

// Shortens to a length, direction kept, if it is longer. True if it was.
bool shorten(Vec3& v, double longest, double length_then) noexcept {
  const double length = v.stableNorm();
  if (!(length > longest)) return false;
  v *= length_then / length;
  return true;
}

// To `limit`, less what whoever measures it might find beyond by rounding.
bool clamp_length(Vec3& v, double limit) noexcept {
  constexpr double rounding = 2e-15;
  return shorten(v, limit, (1.0 - rounding) * limit);
}

// Lets `v` differ from `last` by at most `limit`. True if it differed more.
bool limit_change(Vec3& v, const Vec3& last, double limit) noexcept {
  Vec3 change = v - last;
  if (!shorten(change, limit, limit)) return false;
  v = last + change;
  return true;
}

}  // namespace

void read_safety_limits(SettingsReader& reader, SafetyLimits& limits) {
  reader.number("max_force_n", Range::not_negative(), limits.max_force_n);
  reader.number("max_torque_nm", Range::not_negative(), limits.max_torque_nm);
  reader.number("max_force_slew_n_per_s", Range::positive(), limits.max_force_slew_n_per_s);
  reader.number("max_torque_slew_nm_per_s", Range::positive(), limits.max_torque_slew_nm_per_s);
  reader.number("rise_s", Range::not_negative(), limits.rise_s);
  reader.number("stale_after_s", Range::positive(), limits.stale_after_s);
  reader.number("decay_s", Range::positive(), limits.decay_s);
}

void Safety::apply(DeviceCommand& command, double dt_s, double state_age_s, double passed_s) noexcept {
  const double gone_s = passed_s > dt_s ? passed_s : dt_s;
  ++counts_.ticks;
  std::uint32_t flags = 0;
  const auto stage = [&](bool changed, SafetyFlag flag, std::uint64_t& count) {
    if (!changed) return;
    flags |= flag;
    ++count;
  };

  // A force that the scale takes beyond all numbers is as bad as one that came so.
  const Vec3 scaled_force_n = force_scale_ * command.force_n;
  const Vec3 scaled_torque_nm = force_scale_ * command.torque_nm;
  const bool finite = scaled_force_n.allFinite() && scaled_torque_nm.allFinite() && command.force_n.allFinite() &&
                      command.torque_nm.allFinite();
  if (!finite) {
    command.force_n.setZero();
    command.torque_nm.setZero();
  }
  not_finite_in_a_row_ = finite ? 0 : not_finite_in_a_row_ + 1;
  if (not_finite_in_a_row_ >= limits_.faulty_ticks) faulted_ = true;
  stage(!finite, safety_not_finite, counts_.not_finite);

  const bool scaled = finite && (scaled_force_n != command.force_n || scaled_torque_nm != command.torque_nm);
  if (scaled) {
    command.force_n = scaled_force_n;
    command.torque_nm = scaled_torque_nm;
  }
  stage(scaled, safety_scaled, counts_.scaled);

  const bool restarted =
      gone_s > limits_.stale_after_s && limits_.rise_s > 0.0 && since_start_s_ > 0.0 && gone_s > dt_s;
  if (restarted) since_start_s_ = 0.0;
  stage(restarted, safety_restarted, counts_.restarted);
  since_start_s_ += dt_s;
  const bool rising = since_start_s_ < limits_.rise_s;
  if (rising) {
    command.force_n *= since_start_s_ / limits_.rise_s;
    command.torque_nm *= since_start_s_ / limits_.rise_s;
  }
  stage(rising, safety_force_rise, counts_.force_rise);

  stage(clamp_length(command.force_n, limits_.max_force_n), safety_force_clamped, counts_.force_clamped);
  stage(clamp_length(command.torque_nm, limits_.max_torque_nm), safety_torque_clamped, counts_.torque_clamped);
  const bool stale = state_age_s > limits_.stale_after_s;
  if (!stale && stale_s_ > 0.0) {  // back again: the force grows from what was left of it
    last_force_n_ = sent_force_n_;
    last_torque_nm_ = sent_torque_nm_;
  }
  stage(limit_change(command.force_n, last_force_n_, limits_.max_force_slew_n_per_s * dt_s), safety_force_slewed,
        counts_.force_slewed);
  stage(limit_change(command.torque_nm, last_torque_nm_, limits_.max_torque_slew_nm_per_s * dt_s), safety_torque_slewed,
        counts_.torque_slewed);

  last_force_n_ = command.force_n;
  last_torque_nm_ = command.torque_nm;

  // Of a gap only what lies beyond the limit was stale.
  stale_s_ = stale ? stale_s_ + std::min(gone_s, std::max(dt_s, state_age_s - limits_.stale_after_s)) : 0.0;
  if (stale) {
    const double left = std::clamp(1.0 - stale_s_ / limits_.decay_s, 0.0, 1.0);
    command.force_n *= left;
    command.torque_nm *= left;
  }
  stage(stale, safety_stale, counts_.stale);

  if (faulted_) {
    command.force_n.setZero();
    command.torque_nm.setZero();
    last_force_n_.setZero();
    last_torque_nm_.setZero();
  }
  stage(faulted_, safety_faulted, counts_.faulted);

  sent_force_n_ = command.force_n;
  sent_torque_nm_ = command.torque_nm;
  command.flags = flags;
}

void Safety::reset() noexcept {
  faulted_ = false;
  last_force_n_.setZero();
  last_torque_nm_.setZero();
  sent_force_n_.setZero();
  sent_torque_nm_.setZero();
  since_start_s_ = 0.0;
  stale_s_ = 0.0;
  not_finite_in_a_row_ = 0;
}

}  // namespace odds::haptics
