// A hand that follows a script: pieces of motion one after another, whatever force it feels.
#pragma once

#include <memory>
#include <vector>

#include "odds/haptics/device.hpp"
#include "odds/haptics/device_registry.hpp"
#include "odds/haptics/motion.hpp"

namespace odds::haptics {

/// Pose and motion are functions of the loop's time alone. Force commands are taken and felt by nobody.
class ScriptedDevice final : public Device {
 public:
  /// The motions follow each other from the start pose on; after the last the hand stays where it is, or begins again
  /// if `repeat` (then the script should end where it began). Without motions it stays.
  ScriptedDevice(const math::Pose& start, std::vector<Motion> motions, bool repeat);

  /// Keys: position_m, orientation_wxyz, repeat, and [[motion]] tables with kind, duration_s and the keys of the kind.
  [[nodiscard]] static Result<std::unique_ptr<Device>> make(const DeviceRequest& request);

  /// The same keys out of a table that has others too: for devices that follow a script in their own way. Neither the
  /// common keys nor unknown ones are looked at.
  [[nodiscard]] static Result<std::unique_ptr<ScriptedDevice>> read_script(SettingsReader& reader);

  [[nodiscard]] std::optional<Error> open() override { return std::nullopt; }
  void close() noexcept override {}
  [[nodiscard]] const DeviceSpec& spec() const noexcept override { return spec_; }
  [[nodiscard]] bool read(std::int64_t now_ns, DeviceState& state) noexcept override;
  bool write(const DeviceCommand&) noexcept override { return true; }
  bool enable_forces(bool) noexcept override { return true; }
  [[nodiscard]] std::string_view last_error() const noexcept override { return {}; }

  [[nodiscard]] double duration_s() const noexcept { return duration_s_; }

 private:
  struct Piece {
    Motion motion;
    double begin_s = 0.0;
    Vec3 position = Vec3::Zero();
    Quat orientation = Quat::Identity();
  };
  std::vector<Piece> pieces_;
  double duration_s_ = 0.0;
  bool repeat_ = false;
  DeviceSpec spec_;
};

}  // namespace odds::haptics
