// Numbers for people: grouping, units, as many digits as mean something.
#include "report/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>

namespace odds::report {

std::string grouped(std::uint64_t number) {
  const std::string digits = std::to_string(number);
  std::string text;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) text.push_back(',');
    text.push_back(digits[i]);
  }
  return text;
}

std::string duration(double nanoseconds) {
  if (!std::isfinite(nanoseconds)) return "unlimited";
  const char* unit = "ns";
  double value = nanoseconds;
  for (const char* larger : {"µs", "ms", "s"}) {
    if (std::abs(value) < 999.5) break;
    value /= 1000.0;
    unit = larger;
  }
  const double size = std::abs(value);
  const int decimals = size >= 99.95 || unit[0] == 'n' || size == 0.0 ? 0 : size >= 9.995 ? 1 : 2;
  return fmt::format("{:.{}f} {}", value, decimals, unit);
}

std::string percent(double share) {
  const double value = 100.0 * share;
  if (value > 0.0 && value < 0.01) return "< 0.01 %";
  if (value < 100.0 && value > 99.99) return "> 99.99 %";
  const double from_edge = std::min(value, 100.0 - value);
  return fmt::format("{:.{}f} %", value, from_edge == 0.0 ? 0 : from_edge < 1.0 ? 2 : 1);
}

std::string utc_time(double epoch_seconds) {
  constexpr double year_10000 = 253402300800.0;  // a time_t holds it; a NaN or 1e300 from a file it would not
  if (!(epoch_seconds >= 0.0 && epoch_seconds < year_10000)) return "unknown time";
  const auto seconds = static_cast<std::time_t>(epoch_seconds);
  std::tm parts{};
  char text[40];
  if (gmtime_r(&seconds, &parts) == nullptr || std::strftime(text, sizeof text, "%Y-%m-%d %H:%M:%S UTC", &parts) == 0) {
    return "unknown time";
  }
  return text;
}

std::string html_escaped(std::string_view text) {
  std::string safe;
  safe.reserve(text.size());
  for (const char c : text) {
    switch (c) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      case '\'':
        safe += "&#39;";
        break;
      case '\0':
        break;
      default:
        safe += c;
    }
  }
  return safe;
}

std::string limit_text(double microseconds, std::uint64_t work_units) {
  const bool units = work_units != std::numeric_limits<std::uint64_t>::max();
  const std::string count = units ? grouped(work_units) + " work units" : "";
  if (!std::isfinite(microseconds)) return units ? count : "none";
  return duration(microseconds * 1e3) + (units ? " and " + count : "");
}

}  // namespace odds::report
