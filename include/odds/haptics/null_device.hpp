// A device that is not there: rests at one pose and swallows forces.
#pragma once

#include <memory>

#include "odds/haptics/device.hpp"
#include "odds/haptics/device_registry.hpp"

namespace odds::haptics {

class NullDevice final : public Device {
 public:
  explicit NullDevice(const math::Pose& pose);
  /// Keys: position_m, orientation_wxyz.
  [[nodiscard]] static Result<std::unique_ptr<Device>> make(const DeviceRequest& request);

  [[nodiscard]] std::optional<Error> open() override { return std::nullopt; }
  void close() noexcept override {}
  [[nodiscard]] const DeviceSpec& spec() const noexcept override { return spec_; }
  [[nodiscard]] bool read(std::int64_t now_ns, DeviceState& state) noexcept override;
  bool write(const DeviceCommand&) noexcept override { return true; }
  bool enable_forces(bool) noexcept override { return true; }
  [[nodiscard]] std::string_view last_error() const noexcept override { return {}; }

 private:
  Vec3 position_m_;
  Quat orientation_;
  DeviceSpec spec_;
};

}  // namespace odds::haptics
