// Silence, refusals and numbers that are none.
#include "hard_cases/troubled_device.hpp"

#include <array>
#include <limits>

#include "odds/haptics/device_registry.hpp"
#include "odds/haptics/scripted_device.hpp"

namespace odds::hard_cases {
namespace {

using haptics::DeviceState;

class TroubledDevice final : public haptics::Device {
 public:
  TroubledDevice(std::unique_ptr<haptics::ScriptedDevice> script, bool says_nan)
      : script_(std::move(script)), says_nan_(says_nan), spec_(script_->spec()) {
    spec_.name = "troubled";
  }
  [[nodiscard]] std::optional<Error> open() override { return std::nullopt; }
  void close() noexcept override {}
  [[nodiscard]] const haptics::DeviceSpec& spec() const noexcept override { return spec_; }
  [[nodiscard]] bool read(std::int64_t now_ns, DeviceState& state) noexcept override {
    if (!says_nan_ && now_ns > 450'000'000 && now_ns < 550'000'000) return false;
    if (!script_->read(now_ns, state)) return false;
    if (says_nan_ && now_ns > 0 && ++reads_ % 7 == 0) spoil(state);
    return true;
  }
  bool write(const haptics::DeviceCommand& command) noexcept override {
    return says_nan_ || command.t_ns < 900'000'000;
  }
  bool enable_forces(bool) noexcept override { return true; }
  [[nodiscard]] std::string_view last_error() const noexcept override { return "trouble"; }

 private:
  void spoil(DeviceState& state) noexcept {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    constexpr double infinity = std::numeric_limits<double>::infinity();
    switch ((reads_ / 7) % 4) {
      case 0:
        state.position_m.x() = nan;
        break;
      case 1:
        state.orientation.coeffs().setConstant(nan);
        break;
      case 2:
        state.velocity_m_per_s.z() = -infinity;
        break;
      default:
        state.angular_velocity_rad_per_s.setConstant(nan);
    }
  }
  std::unique_ptr<haptics::ScriptedDevice> script_;
  bool says_nan_;
  haptics::DeviceSpec spec_;
  std::uint64_t reads_ = 0;
};

}  // namespace

void register_troubled_device() {
  haptics::register_device("troubled",
                           [](const haptics::DeviceRequest& request) -> Result<std::unique_ptr<haptics::Device>> {
                             static constexpr std::array<std::string_view, 2> troubles = {"silent", "nan"};
                             haptics::SettingsReader reader(*request.settings);
                             reader.allow(haptics::common_device_keys);
                             std::size_t trouble = 0;
                             reader.choice("trouble", troubles, trouble);
                             auto script = haptics::ScriptedDevice::read_script(reader);
                             if (!script) return script.error();
                             if (auto error = reader.finish()) return *error;
                             return std::unique_ptr<haptics::Device>(
                                 std::make_unique<TroubledDevice>(std::move(script).value(), trouble == 1));
                           });
}

}  // namespace odds::hard_cases
