// A device that is another device and remembers what it read.
#pragma once

#include <memory>
#include <vector>

#include "odds/haptics/device.hpp"
#include "odds/haptics/device_track.hpp"

namespace odds::haptics {

/// Passes every call on. Memory for the track is taken, and its pages touched, at construction; when it is full further
/// states pass unrecorded and are counted.
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

  /// What was read so far: the fresh states that can be used, one per time of the loop. Not while the loop runs.
  [[nodiscard]] DeviceTrack track() const;
  [[nodiscard]] std::size_t lost() const noexcept { return lost_; }

 private:
  std::unique_ptr<Device> inner_;
  std::vector<DeviceState> states_;
  std::size_t used_ = 0;
  std::size_t lost_ = 0;
};

}  // namespace odds::haptics
