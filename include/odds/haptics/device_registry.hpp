// Devices by name: how a scene gets its device, and how a program adds one of its own.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "odds/haptics/device.hpp"
#include "odds/haptics/settings.hpp"
#include "odds/math/pose.hpp"

namespace odds::haptics {

/// Keys of a device's table that are not the device's: its type, the limits of the safety stages (safety.hpp), and the
/// scales (device.hpp).
inline constexpr std::array<std::string_view, 12> common_device_keys = {"type",
                                                                        "max_force_n",
                                                                        "max_torque_nm",
                                                                        "max_force_slew_n_per_s",
                                                                        "max_torque_slew_nm_per_s",
                                                                        "rise_s",
                                                                        "stale_after_s",
                                                                        "decay_s",
                                                                        "physical_damping_ns_per_m",
                                                                        "force_scale",
                                                                        "workspace_scale",
                                                                        "workspace_origin_m"};

/// What a device is made from.
struct DeviceRequest {
  const Settings* settings = nullptr;    ///< the device's table; the factory refuses keys that nobody knows
  std::filesystem::path base_directory;  ///< relative file names refer to it
};

using DeviceFactory = std::function<Result<std::unique_ptr<Device>>(const DeviceRequest&)>;

/// Offers a device type under a name; replaces one of the same name. Call it before scenes are loaded, from one thread.
void register_device(std::string name, DeviceFactory factory);

/// All names, in alphabetical order: those of this library and those registered.
[[nodiscard]] std::vector<std::string> device_names();

/// Makes a device of the type `name`; an unknown name is refused with the nearest valid one.
[[nodiscard]] Result<std::unique_ptr<Device>> make_device(std::string_view name, const DeviceRequest& request);

}  // namespace odds::haptics
