// Pieces of scripted hand motion: positions and velocities as closed formulas of time.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "odds/math/types.hpp"

namespace odds::haptics {

enum class MotionKind : std::uint8_t {
  hold,    ///< stays
  press,   ///< goes `depth_m` along `direction`, stays there, and comes back
  slide,   ///< goes by `by_m`
  tap,     ///< `taps` times `depth_m` along `direction` and back, each one cosine
  sine,    ///< swings by `amplitude_m` along `direction` at `frequency_hz`, growing and fading over one period each
  spiral,  ///< `turns` around the start in the plane across `normal`, out to `radius_m` and back
};

inline constexpr std::array<std::string_view, 6> motion_names = {"hold", "press", "slide", "tap", "sine", "spiral"};

/// One piece; only the fields of its kind count. Every kind begins and ends at rest, so that pieces can follow each
/// other.
struct Motion {
  MotionKind kind = MotionKind::hold;
  double duration_s = 1.0;          ///< > 0
  Vec3 direction = -Vec3::UnitZ();  ///< unit: press, tap, sine
  double depth_m = 0.0;             ///< press, tap
  double rise_s = 0.0;              ///< press: time to go in, and to come back; > 0, at most half of the duration
  Vec3 by_m = Vec3::Zero();         ///< slide
  double taps = 1.0;                ///< tap: a whole number >= 1
  double amplitude_m = 0.0;         ///< sine
  double frequency_hz = 1.0;        ///< sine: at least two periods fit into the duration
  Vec3 normal = Vec3::UnitZ();      ///< unit: spiral
  double radius_m = 0.0;            ///< spiral
  double turns = 1.0;               ///< spiral
  Vec3 turn_axis = Vec3::UnitZ();   ///< unit, world frame: all kinds turn about it ...
  double turn_rad = 0.0;            ///< ... by this much over their duration
};

/// Where a piece has brought the hand, relative to where the piece began. World frame, SI.
struct MotionSample {
  Vec3 offset_m = Vec3::Zero();
  Vec3 velocity_m_per_s = Vec3::Zero();
  double turned_rad = 0.0;
  double turn_rate_rad_per_s = 0.0;
};

/// The piece at `time_s` after its begin, held at its end afterwards. noexcept, no allocation.
[[nodiscard]] MotionSample sample(const Motion& motion, double time_s) noexcept;

}  // namespace odds::haptics
