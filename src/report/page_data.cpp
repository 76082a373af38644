// The numbers behind the page's charts: curves, bars, and time lines thinned so that no extreme is lost.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <string_view>
#include <vector>

#include "report/run_files.hpp"
#include "report/skipped_periods.hpp"

namespace odds::report {
namespace {

using haptics::TickRecord;

constexpr std::uint64_t most_points = 2000;  ///< of a time line; more than a screen has columns

/// Appends JSON; numbers that JSON cannot hold become null.
class Writer {
 public:
  void key(std::string_view name) { fmt::format_to(out(), "{}\"{}\":", separator(), name), fresh_ = true; }
  void open(char bracket) { fmt::format_to(out(), "{}{}", separator(), bracket), fresh_ = true; }
  void close(char bracket) { text_.push_back(bracket), fresh_ = false; }
  void number(double value) {
    if (std::isfinite(value)) {
      fmt::format_to(out(), "{}{:.5g}", separator(), value);
    } else {
      fmt::format_to(out(), "{}null", separator());
    }
  }
  template <class Numbers>
  void array(std::string_view name, const Numbers& numbers) {
    key(name);
    open('[');
    for (const auto value : numbers) number(static_cast<double>(value));
    close(']');
  }
  [[nodiscard]] std::string text() const { return fmt::to_string(text_); }

 private:
  std::back_insert_iterator<fmt::memory_buffer> out() { return std::back_inserter(text_); }
  std::string_view separator() {
    const bool was_fresh = fresh_;
    fresh_ = false;
    return was_fresh ? "" : ",";
  }
  fmt::memory_buffer text_;
  bool fresh_ = true;
};

/// One stretch of the time line: the largest of each quantity, so that no peak disappears.
struct Stretch {
  double begin_s = 0.0;
  std::uint64_t ticks = 0;
  double wake_us = NAN, tick_us = NAN, gross_us = NAN, net_us = NAN, stall_us = NAN, step_us = NAN;
  double depth_mm = NAN, contacts = NAN, undecided = NAN;
  double energy_j = NAN;                                                   ///< at the hand, the lowest
  std::array<double, 3> force_n{NAN, NAN, NAN}, torque_nm{NAN, NAN, NAN};  ///< of the tick where they are largest
  double force_size_n = NAN, torque_size_nm = NAN;
  std::array<std::uint64_t, 4> answers{};  ///< proved, estimated, budget, no query
  std::uint64_t late = 0, skipped = 0;
};

void raise(double& largest, double value) {
  if (std::isfinite(value) && !(largest >= value)) largest = value;
}

void take_larger(std::array<double, 3>& kept, double& size, const std::array<double, 3>& vector) {
  const double new_size = std::hypot(vector[0], vector[1], vector[2]);
  if (!std::isfinite(new_size) || size >= new_size) return;
  size = new_size;
  kept = vector;
}

void add(Stretch& stretch, const TickRecord& t, std::int64_t period_ns) {
  ++stretch.ticks;
  raise(stretch.wake_us, static_cast<double>(t.woke_ns - t.planned_ns) * 1e-3);
  raise(stretch.tick_us, static_cast<double>(t.done_ns - t.planned_ns) * 1e-3);
  raise(stretch.step_us, t.step_us);
  raise(stretch.depth_mm, t.max_depth_m * 1e3);
  stretch.energy_j = std::fmin(stretch.energy_j, t.observed_energy_j);  // fmin drops NaN
  raise(stretch.contacts, t.contacts);
  take_larger(stretch.force_n, stretch.force_size_n, t.force_n);
  take_larger(stretch.torque_nm, stretch.torque_size_nm, t.torque_nm);
  stretch.late += t.done_ns - t.planned_ns > period_ns ? 1 : 0;
  stretch.skipped += t.skipped_before;
  if (t.queries == 0) {
    ++stretch.answers[3];
    return;
  }
  raise(stretch.gross_us, t.query_gross_us);
  raise(stretch.net_us, t.query_net_us);
  raise(stretch.stall_us, t.query_stall_us);
  ++stretch.answers[std::min<std::size_t>(static_cast<std::size_t>(t.basis), 2)];
  if (t.basis != query::Basis::proved) raise(stretch.undecided, std::min(t.probability, 1.0 - t.probability));
}

std::vector<Stretch> time_line(const RunInfo& info, std::span<const TickRecord> ticks) {
  std::vector<Stretch> line;
  if (ticks.empty()) return line;
  const std::uint64_t first = ticks.front().tick;
  const std::uint64_t periods = ticks.back().tick - first + 1;
  const std::uint64_t per_stretch = (periods + most_points - 1) / most_points;
  std::uint64_t current = UINT64_MAX;
  for (const TickRecord& tick : ticks) {
    const std::uint64_t stretch = (tick.tick - first) / per_stretch;
    if (stretch != current) {
      current = stretch;
      line.emplace_back();
      line.back().begin_s = static_cast<double>(stretch * per_stretch) * static_cast<double>(info.period_ns) * 1e-9;
    }
    add(line.back(), tick, info.period_ns);
  }
  line.back().skipped += skipped_at_the_end(info, ticks);
  return line;
}

template <class Get>
void column(Writer& json, std::string_view name, const std::vector<Stretch>& line, Get get) {
  json.key(name);
  json.open('[');
  for (const Stretch& stretch : line) json.number(static_cast<double>(get(stretch)));
  json.close(']');
}

void write_time_line(Writer& json, const std::vector<Stretch>& line) {
  json.key("time");
  json.open('{');
  json.key("t");
  json.open('[');
  for (const Stretch& stretch : line) json.number(stretch.begin_s);
  json.close(']');
  column(json, "wake", line, [](const Stretch& s) { return s.wake_us; });
  column(json, "tick", line, [](const Stretch& s) { return s.tick_us; });
  column(json, "gross", line, [](const Stretch& s) { return s.gross_us; });
  column(json, "net", line, [](const Stretch& s) { return s.net_us; });
  column(json, "stall", line, [](const Stretch& s) { return s.stall_us; });
  column(json, "step", line, [](const Stretch& s) { return s.step_us; });
  column(json, "depth", line, [](const Stretch& s) { return s.depth_mm; });
  column(json, "contacts", line, [](const Stretch& s) { return s.contacts; });
  column(json, "undecided", line, [](const Stretch& s) { return s.undecided; });
  column(json, "late", line, [](const Stretch& s) { return s.late; });
  column(json, "skipped", line, [](const Stretch& s) { return s.skipped; });
  static constexpr std::array<const char*, 4> answers{"proved", "estimated", "budget", "none"};
  for (std::size_t i = 0; i < answers.size(); ++i)
    column(json, answers[i], line, [i](const Stretch& s) { return s.answers[i]; });
  static constexpr std::array<const char*, 3> axes{"x", "y", "z"};
  for (std::size_t i = 0; i < axes.size(); ++i) {
    column(json, std::string("force_") + axes[i], line, [i](const Stretch& s) { return s.force_n[i]; });
    column(json, std::string("torque_") + axes[i], line, [i](const Stretch& s) { return s.torque_nm[i]; });
  }
  column(json, "force", line, [](const Stretch& s) { return s.force_size_n; });
  column(json, "torque", line, [](const Stretch& s) { return s.torque_size_nm; });
  column(json, "energy", line, [](const Stretch& s) { return s.energy_j; });
  json.close('}');
}

/// The percentile curve: pairs of 1/(1 - percentile) and microseconds, ten points per decade, up to the sample size.
void write_curve(Writer& json, std::string_view name, const Histogram& histogram) {
  json.key(name);
  json.open('[');
  const auto point = [&](double x, double ns) {
    json.open('[');
    json.number(x);
    json.number(ns * 1e-3);
    json.close(']');
  };
  const auto count = static_cast<double>(histogram.count());
  for (int i = 0; std::pow(10.0, i / 10.0) < count; ++i) {
    const double x = std::pow(10.0, i / 10.0);
    point(x, static_cast<double>(histogram.value_at_percentile(100.0 - 100.0 / x)));
  }
  if (histogram.count() > 0) point(count, static_cast<double>(histogram.max()));
  json.close(']');
}

constexpr int bins_per_decade = 20;

/// How many values fall into each bin; bin i begins at 10^(i / bins_per_decade) nanoseconds.
std::vector<std::uint64_t> binned(const Histogram& histogram) {
  std::vector<std::uint64_t> bins(12 * bins_per_decade + 1, 0);
  const auto counters = histogram.counters();
  for (std::size_t i = 0; i < counters.size(); ++i) {
    if (counters[i] == 0) continue;
    const auto value = static_cast<double>(std::max<std::int64_t>(histogram.middle_of(i), 1));
    bins[std::min(static_cast<std::size_t>(std::log10(value) * bins_per_decade), bins.size() - 1)] += counters[i];
  }
  return bins;
}

void write_bars(Writer& json, const RunSummary& s) {
  const std::array bars{binned(s.wake), binned(s.query_net), binned(s.tick)};
  std::size_t begin = bars[0].size();
  std::size_t end = 0;
  for (const auto& series : bars) {
    for (std::size_t i = 0; i < series.size(); ++i) {
      if (series[i] == 0) continue;
      begin = std::min(begin, i);
      end = std::max(end, i + 1);
    }
  }
  json.key("bars");
  json.open('{');
  json.key("from_us");
  json.open('[');
  for (std::size_t i = begin; i < end; ++i)
    json.number(std::pow(10.0, static_cast<double>(i) / bins_per_decade) * 1e-3);
  json.close(']');
  static constexpr std::array<const char*, 3> names{"wake", "net", "tick"};
  for (std::size_t series = 0; series < names.size(); ++series) {
    const std::span<const std::uint64_t> whole(bars[series]);
    json.array(names[series], whole.subspan(std::min(begin, end), end - std::min(begin, end)));
  }
  json.close('}');
}

}  // namespace

std::string page_data(const RunInfo& info, const RunSummary& summary, std::span<const TickRecord> ticks) {
  const std::vector<Stretch> line = time_line(info, ticks);
  Writer json;
  json.open('{');
  json.key("period_us");
  json.number(static_cast<double>(info.period_ns) * 1e-3);
  json.key("budget_us");
  json.number(info.budget_us);
  json.key("stalls_measured");
  json.number(info.simulated_time ? 0.0 : 1.0);
  json.key("end_s");
  json.number(static_cast<double>(summary.planned) * static_cast<double>(info.period_ns) * 1e-9);
  json.key("curves");
  json.open('{');
  write_curve(json, "wake", summary.wake);
  write_curve(json, "gross", summary.query_gross);
  write_curve(json, "net", summary.query_net);
  write_curve(json, "tick", summary.tick);
  json.close('}');
  write_bars(json, summary);
  json.array("answers", summary.by_basis);
  write_time_line(json, line);
  json.close('}');
  return json.text();
}

}  // namespace odds::report
