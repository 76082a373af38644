// A hand that repeats a recorded track.
#pragma once

#include <memory>

#include "odds/haptics/device.hpp"
#include "odds/haptics/device_registry.hpp"
#include "odds/haptics/device_track.hpp"

namespace odds::haptics {

/// Between two rows positions and velocities are interpolated linearly, orientations along the great arc; exactly at a
/// row the row's numbers come back bit for bit. What lies before a row that is not fresh is not fresh either. After the
/// last row the pose is held and no longer fresh.
class ReplayDevice final : public Device {
 public:
  explicit ReplayDevice(DeviceTrack track);
  /// Keys: file (relative to the scene).
  [[nodiscard]] static Result<std::unique_ptr<Device>> make(const DeviceRequest& request);

  [[nodiscard]] std::optional<Error> open() override { return std::nullopt; }
  void close() noexcept override {}
  [[nodiscard]] const DeviceSpec& spec() const noexcept override { return spec_; }
  [[nodiscard]] bool read(std::int64_t now_ns, DeviceState& state) noexcept override;
  bool write(const DeviceCommand&) noexcept override { return true; }
  bool enable_forces(bool) noexcept override { return true; }
  [[nodiscard]] std::string_view last_error() const noexcept override { return {}; }

 private:
  DeviceTrack track_;
  std::size_t row_ = 0;  // of the last read: time mostly moves on by one row
  DeviceSpec spec_;
};

}  // namespace odds::haptics
