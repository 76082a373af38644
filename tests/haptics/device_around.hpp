// A device around another one, for tests that change some of what it does.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include "odds/haptics/device.hpp"

namespace odds::testing {

class DeviceAround : public haptics::Device {
 public:
  explicit DeviceAround(std::unique_ptr<haptics::Device> inner) : inner_(std::move(inner)), spec_(inner_->spec()) {}

  [[nodiscard]] std::optional<Error> open() override { return inner_->open(); }
  void close() noexcept override { inner_->close(); }
  [[nodiscard]] const haptics::DeviceSpec& spec() const noexcept override { return spec_; }
  [[nodiscard]] bool read(std::int64_t now_ns, haptics::DeviceState& state) noexcept override {
    return inner_->read(now_ns, state);
  }
  bool write(const haptics::DeviceCommand& command) noexcept override { return inner_->write(command); }
  bool enable_forces(bool on) noexcept override { return inner_->enable_forces(on); }
  [[nodiscard]] std::string_view last_error() const noexcept override { return inner_->last_error(); }

 protected:
  [[nodiscard]] haptics::DeviceSpec& change_spec() noexcept { return spec_; }

 private:
  std::unique_ptr<haptics::Device> inner_;
  haptics::DeviceSpec spec_;
};

}  // namespace odds::testing
