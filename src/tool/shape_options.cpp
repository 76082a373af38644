#include "tool/shape_options.hpp"

#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <string>

namespace odds::tool {
namespace {

/// Plain decimals only, independent of the locale.
std::optional<double> number_in(const std::string& text) {
  double value = 0.0;
  const auto end = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end.ec != std::errc{} || end.ptr != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

void add_shape_options(CLI::App& command, query::ShapeOptions& options) {
  std::map<std::string, volume::Kind> kinds;
  std::string names;
  for (const std::string_view kind : volume::kind_names) {
    kinds.emplace(kind, *volume::kind_from_name(kind));
    names += (names.empty() ? "" : ", ") + std::string(kind);
  }
  command.add_option("--bv", options.volume, "bounding volume: " + names + " (default obb)")
      ->transform(CLI::CheckedTransformer(kinds).description(""));
  command.add_option("--tau", options.tau, "share of the greatest area from which on a cell is well filled, (0, 1]")
      ->check(share_of_one());
}

CLI::Validator positive_and_finite() {
  return CLI::Validator(
      [](const std::string& text) {
        const std::optional<double> value = number_in(text);
        return value && std::isfinite(*value) && *value > 0.0 ? std::string() : text + " is not a finite number > 0";
      },
      "");
}

CLI::Validator share_of_one() {
  return CLI::Validator(
      [](const std::string& text) {
        const std::optional<double> value = number_in(text);
        return value && *value > 0.0 && *value <= 1.0 ? std::string() : text + " is not a number in (0, 1]";
      },
      "");
}

}  // namespace odds::tool
