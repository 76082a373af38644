#include "tool/shared_options.hpp"

#include <charconv>
#include <cmath>
#include <optional>
#include <string>

namespace odds::tool {
namespace {

/// Plain decimals only, independent of the locale.
template <class Number>
std::optional<Number> number_in(const std::string& text) {
  Number value = 0;
  const auto end = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end.ec != std::errc{} || end.ptr != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

void add_calibration_option(CLI::App& command, std::uint32_t& poses) {
  command
      .add_option("--calibrate", poses,
                  "poses on which the pair first learns how true its odds are; 0 (default): the general odds")
      ->check(whole_number(0, 1'000'000));
}

CLI::Validator positive_and_finite() {
  return CLI::Validator(
      [](const std::string& text) {
        const std::optional<double> value = number_in<double>(text);
        return value && std::isfinite(*value) && *value > 0.0 ? std::string() : text + " is not a finite number > 0";
      },
      "");
}

CLI::Validator share_of_one() {
  return CLI::Validator(
      [](const std::string& text) {
        const std::optional<double> value = number_in<double>(text);
        return value && *value > 0.0 && *value <= 1.0 ? std::string() : text + " is not a number in (0, 1]";
      },
      "");
}

CLI::Validator whole_number(std::uint64_t least, std::uint64_t greatest) {
  return CLI::Validator(
      [=](const std::string& text) {
        const std::optional<std::uint64_t> value = number_in<std::uint64_t>(text);
        // CLI11 takes it for a number in base eight.
        if (value && text.size() > 1 && text.front() == '0') {
          return text + " begins with 0; write " + std::to_string(*value);
        }
        if (value && *value >= least && *value <= greatest) return std::string();
        return text + " is not a whole number from " + std::to_string(least) + " to " + std::to_string(greatest);
      },
      "");
}

}  // namespace odds::tool
