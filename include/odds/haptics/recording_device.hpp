// A device that is another device and remembers what it read.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "odds/haptics/device.hpp"
#include "odds/haptics/device_track.hpp"

namespace odds::haptics {

/// Passes every call on. What is recorded is what the loop knew at each of its times, whatever the device's own rate
/// and stamps: where a read brings nothing new, or fails, the last state once more, as one that is not fresh, so that a
/// replay gives every tick what it had. What the device does not sense (DeviceSpec) is as in the first state that could
/// be used, for the loop too, whatever the device says later. Memory for the track is taken, and its pages touched, at
/// construction; when it is full further states pass unrecorded and are counted.
class RecordingDevice final : public Device {
 public:
  RecordingDevice(std::unique_ptr<Device> inner, std::size_t capacity);

  [[nodiscard]] std::optional<Error> open() override { return inner_->open(); }
  void close() noexcept override { inner_->close(); }
  [[nodiscard]] const DeviceSpec& spec() const noexcept override { return inner_->spec(); }
  [[nodiscard]] bool read(std::int64_t now_ns, DeviceState& state) noexcept override;
  bool write(const DeviceCommand& command) noexcept override { return inner_->write(command); }
  bool enable_forces(bool on) noexcept override { return inner_->enable_forces(on); }
  [[nodiscard]] std::string_view last_error() const noexcept override { return inner_->last_error(); }

  /// What was read so far, one state that can be used per time of the loop, the last one of that time. Not while the
  /// loop runs.
  [[nodiscard]] DeviceTrack track() const;
  [[nodiscard]] std::size_t lost() const noexcept { return lost_; }

 private:
  void note(std::int64_t now_ns, const DeviceState& state, bool fresh) noexcept;

  std::unique_ptr<Device> inner_;
  std::vector<DeviceState> states_;
  std::optional<DeviceState> start_;
  std::size_t written_ = 0;
  std::size_t lost_ = 0;
};

}  // namespace odds::haptics
