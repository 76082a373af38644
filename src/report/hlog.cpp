// Writing and reading the lines of the interval log; histogram_codec.cpp does the histograms in it.
#include "odds/report/hlog.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <istream>
#include <optional>
#include <ostream>

namespace odds::report {
namespace {

constexpr std::size_t longest_line = std::size_t{16} << 20;

std::optional<double> number(std::string_view text) {
  double value = 0.0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

/// Of the line "#[StartTime: SECONDS (seconds since epoch), ...]".
std::optional<double> start_time(std::string_view line) {
  constexpr std::string_view mark = "#[StartTime:";
  if (line.rfind(mark, 0) != 0) return std::nullopt;
  line.remove_prefix(std::min(line.find_first_not_of(' ', mark.size()), line.size()));
  return number(line.substr(0, line.find_first_of(" ,]")));
}

/// Cuts the text up to the next comma off `rest`.
std::string_view take_field(std::string_view& rest) {
  const auto comma = rest.find(',');
  const std::string_view field = rest.substr(0, comma);
  rest = comma == std::string_view::npos ? std::string_view{} : rest.substr(comma + 1);
  return field;
}

Error bad_line(const std::string& name, std::size_t line, std::string what) {
  return {name, std::to_string(line), std::move(what), "an interval log of HdrHistogram (.hlog) is expected"};
}

Result<HlogInterval> read_interval(std::string_view line, const std::string& name, std::size_t number_of_line) {
  HlogInterval interval;
  if (line.rfind("Tag=", 0) == 0) interval.tag = std::string(take_field(line).substr(4));
  const auto start = number(take_field(line));
  const auto length = number(take_field(line));
  const auto max = number(take_field(line));
  if (!start || !length || !max) {
    return bad_line(name, number_of_line, "not a line of start, length, maximum and encoded histogram");
  }
  interval.start_s = *start;
  interval.length_s = *length;
  Result<Histogram> histogram = decode_histogram(line);
  if (!histogram) return bad_line(name, number_of_line, histogram.error().what);
  interval.histogram = std::move(histogram).value();
  return interval;
}

}  // namespace

// Not the C library's numbers: a program may have set a locale in which they have commas.
void write_hlog_head(std::ostream& out, double start_epoch_s) {
  out << "#[Histogram log format version 1.3]\n";
  out << fmt::format("#[StartTime: {:.3f} (seconds since epoch)]\n", start_epoch_s);
  out << "\"StartTimestamp\",\"Interval_Length\",\"Interval_Max\",\"Interval_Compressed_Histogram\"\n";
}

void write_hlog_interval(std::ostream& out, const HlogInterval& interval) {
  if (!interval.tag.empty()) out << "Tag=" << interval.tag << ',';
  out << fmt::format("{:.3f},{:.3f},{:.3f},", interval.start_s, interval.length_s,
                     static_cast<double>(interval.histogram.max()) * 1e-6)
      << encode_histogram(interval.histogram) << '\n';
}

void write_hlog(std::ostream& out, const Hlog& log) {
  write_hlog_head(out, log.start_epoch_s);
  for (const HlogInterval& interval : log.intervals) write_hlog_interval(out, interval);
}

Result<Hlog> read_hlog(std::istream& in, const std::string& name) {
  Hlog log;
  std::string line;
  std::size_t number_of_line = 0;
  bool recognised = false;
  while (std::getline(in, line)) {
    ++number_of_line;
    if (line.size() > longest_line) return bad_line(name, number_of_line, "the line is longer than 16 MiB");
    while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.pop_back();
    if (line.empty()) continue;
    if (line[0] == '#') {
      if (line.rfind("#[Histogram log format version", 0) == 0) recognised = true;
      if (const auto start = start_time(line)) log.start_epoch_s = *start;
      continue;
    }
    if (line[0] == '"') continue;  // the heading
    if (!recognised) return bad_line(name, number_of_line, "the line with the format version is missing before it");
    Result<HlogInterval> interval = read_interval(line, name, number_of_line);
    if (!interval) return interval.error();
    log.intervals.push_back(std::move(interval).value());
  }
  if (!recognised) return bad_line(name, number_of_line, "the line with the format version is missing");
  return log;
}

}  // namespace odds::report
