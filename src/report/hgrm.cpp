// Writing and reading the percentile table.
#include "odds/report/hgrm.hpp"

#include <fmt/printf.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <istream>
#include <optional>
#include <ostream>
#include <string_view>

namespace odds::report {
namespace {

constexpr std::size_t longest_line = 4096;

// Not the C library's: a program may have set a locale whose numbers have commas.
template <class... Values>
void print(std::ostream& out, const char* format, Values... values) {
  out << fmt::sprintf(format, values...);
}

/// The number that `text` begins with, behind blanks, which is cut off.
template <class Number>
std::optional<Number> take_number(std::string_view& text) {
  text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
  Number value{};
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc{}) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return value;
}

/// The number behind "KEY =".
template <class Number>
std::optional<Number> number_of(std::string_view line, std::string_view key) {
  const std::size_t found = line.find(key);
  const std::size_t equals = found == std::string_view::npos ? found : line.find('=', found + key.size());
  if (equals == std::string_view::npos) return std::nullopt;
  line.remove_prefix(equals + 1);
  return take_number<Number>(line);
}

/// The next level at which HdrHistogram reports: steps are halved with each halving of the distance to 100 %.
double next_level(double level, int steps_per_half) {
  const double halvings = std::floor(std::log2(100.0 / (100.0 - level))) + 1.0;
  return level + 100.0 / (static_cast<double>(steps_per_half) * std::exp2(halvings));
}

Error bad_line(const std::string& name, std::size_t line, std::string what) {
  return {name, std::to_string(line), std::move(what), "a percentile table of HdrHistogram (.hgrm) is expected"};
}

/// Whether a data row continues the table: finite, in range, nothing falls.
bool continues(const HgrmTable& table, const HgrmRow& row) {
  if (!std::isfinite(row.value) || !(row.fraction >= 0.0 && row.fraction <= 1.0)) return false;
  if (table.rows.empty()) return true;
  const HgrmRow& last = table.rows.back();
  return row.value >= last.value && row.fraction >= last.fraction && row.total_count >= last.total_count;
}

bool read_footer(const std::string& line, HgrmTable& table) {
  const auto mean = number_of<double>(line, "#[Mean");
  const auto deviation = number_of<double>(line, ", StdDeviation");
  if (mean && deviation) {
    table.mean = *mean;
    table.standard_deviation = *deviation;
    return std::isfinite(*mean) && std::isfinite(*deviation);
  }
  const auto max = number_of<double>(line, "#[Max");
  const auto count = number_of<std::uint64_t>(line, ", Total count");
  if (max && count) {
    table.max = *max;
    table.count = *count;
    return std::isfinite(*max);
  }
  return true;  // other comments
}

}  // namespace

void write_hgrm(std::ostream& out, const Histogram& histogram, double unit, int steps_per_half) {
  print(out, "%12s %14s %10s %14s\n\n", "Value", "Percentile", "TotalCount", "1/(1-Percentile)");
  const int decimals = histogram.range().digits;
  const auto total = static_cast<double>(histogram.count());
  std::uint64_t seen = 0;
  double level = 0.0;
  for (std::size_t i = 0; i < histogram.counters().size() && seen < histogram.count(); ++i) {
    if (histogram.counters()[i] == 0) continue;
    seen += histogram.counters()[i];
    const double reached = 100.0 * static_cast<double>(seen) / total;
    const double value = static_cast<double>(std::min(histogram.highest_of(i), histogram.max())) / unit;
    while (level <= reached && level < 100.0) {
      const double fraction = level / 100.0;
      print(out, "%12.*f %2.12f %10llu %14.2f\n", decimals, value, fraction, static_cast<unsigned long long>(seen),
            1.0 / (1.0 - fraction));
      level = next_level(level, steps_per_half);
      if (seen == histogram.count()) break;  // the rest is the line for 100 %
    }
  }
  if (histogram.count() > 0) {
    print(out, "%12.*f %2.12f %10llu\n", decimals, static_cast<double>(histogram.max()) / unit, 1.0,
          static_cast<unsigned long long>(histogram.count()));
  }
  print(out, "#[Mean    = %12.*f, StdDeviation   = %12.*f]\n", decimals, histogram.mean() / unit, decimals,
        histogram.standard_deviation() / unit);
  print(out, "#[Max     = %12.*f, Total count    = %12llu]\n", decimals, static_cast<double>(histogram.max()) / unit,
        static_cast<unsigned long long>(histogram.count()));
  print(out, "#[Buckets = %12d, SubBuckets     = %12d]\n", histogram.buckets(), histogram.sub_buckets());
}

Result<HgrmTable> read_hgrm(std::istream& in, const std::string& name) {
  HgrmTable table;
  std::string line;
  std::size_t number = 0;
  bool header_seen = false;
  while (std::getline(in, line)) {
    ++number;
    if (line.size() > longest_line) return bad_line(name, number, "the line is longer than 4096 bytes");
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    if (line[0] == '#') {
      if (!read_footer(line, table)) return bad_line(name, number, "a figure is not finite");
      continue;
    }
    if (!header_seen) {
      if (line.find("Percentile") == std::string::npos) return bad_line(name, number, "the heading is missing");
      header_seen = true;
      continue;
    }
    std::string_view rest = line;
    const auto value = take_number<double>(rest);
    const auto fraction = take_number<double>(rest);
    const auto count = take_number<std::uint64_t>(rest);
    if (!value || !fraction || !count) return bad_line(name, number, "not a line of value, percentile and count");
    const HgrmRow row{*value, *fraction, *count};
    if (!continues(table, row))
      return bad_line(name, number, "values, percentiles and counts must be finite and never fall");
    table.rows.push_back(row);
  }
  if (!header_seen) return bad_line(name, number, "the file is empty");
  if (!table.rows.empty() && table.rows.back().total_count != table.count) {
    return bad_line(name, number, "the total count at the end does not match the last line");
  }
  return table;
}

}  // namespace odds::report
