// Numbers and durations as people read them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace odds::report {

[[nodiscard]] std::string grouped(std::uint64_t number);        ///< "12,345"
[[nodiscard]] std::string duration(double nanoseconds);         ///< "640 ns", "143 µs", "4.12 ms", "10.0 s"
[[nodiscard]] std::string percent(double share);                ///< of 1: "93.1 %"; never rounds a part to 0 or 100 %
[[nodiscard]] std::string utc_time(double epoch_seconds);       ///< "2024-05-01 12:00:00 UTC"
[[nodiscard]] std::string html_escaped(std::string_view text);  ///< safe between tags and in quoted attributes

/// A limit in microseconds, work units or both, for people: "100 µs", "2 000 work units", "none".
[[nodiscard]] std::string limit_text(double microseconds, std::uint64_t work_units);

}  // namespace odds::report
