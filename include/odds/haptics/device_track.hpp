// A recorded path of a device, and the CSV file that holds it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "odds/haptics/device.hpp"
#include "odds/math/error.hpp"

namespace odds::haptics {

/// States in strictly increasing time, at least one; times count from the first.
struct DeviceTrack {
  std::vector<DeviceState> states;
  bool gives_velocities = true;  ///< false: those of `states` follow from the poses
};

struct Velocities {
  Vec3 linear_m_per_s;
  Vec3 angular_rad_per_s;  ///< about a fixed axis, by at most half a turn
};
/// Of the straight and steady way from one state to a later one, in the world frame.
[[nodiscard]] Velocities velocities_between(const DeviceState& from, const DeviceState& to) noexcept;

/// Reads a track. The first line that is neither empty nor begins with '#' names the columns, each with its unit:
///   t_ns | t_us | t_ms | t_s          time, strictly increasing
///   px_m py_m pz_m (or px_mm ...)     position
///   qw qx qy qz                       orientation, a unit quaternion within 1e-3
///   vx_m_per_s ... wx_rad_per_s ...   optional, all six: velocities; otherwise differences of the poses
///   buttons                           optional, a whole number
///   fresh                             optional, 1 or 0: DeviceState::fresh; otherwise every row is
/// in any order; other columns are refused with the nearest valid name. Errors name file and line.
Result<DeviceTrack> read_track(const std::filesystem::path& path);
/// The same from text; `name` stands in error messages.
Result<DeviceTrack> parse_track(std::string_view text, const std::string& name);

/// Writes all columns; reading it back gives the same bits.
std::optional<Error> write_track(const std::filesystem::path& path, const DeviceTrack& track);

}  // namespace odds::haptics
