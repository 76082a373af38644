// A study in two or three sentences.
#include <fmt/format.h>

#include "odds/report/accuracy/report.hpp"
#include "report/text.hpp"

namespace odds::report {
namespace {

constexpr double bearable = 0.01;  ///< share of wrong verdicts that the headline looks for

const AccuracyRow* exact_row(const Study& study, const std::vector<AccuracyRow>& rows) {
  for (const AccuracyRow& row : rows) {
    if (row.scope == "all" && study.settings.trials[row.trial].kind == Trial::Kind::exact) return &row;
  }
  return nullptr;
}

/// Times before work units, the least threshold of doubt first, as the trials stand.
const AccuracyRow* chosen_row(const Study& study, const std::vector<AccuracyRow>& rows) {
  const AccuracyRow* last = nullptr;
  for (const AccuracyRow& row : rows) {
    const Trial& trial = study.settings.trials[row.trial];
    if (row.scope != "all" || trial.kind == Trial::Kind::exact) continue;
    if (last != nullptr && study.settings.trials[last->trial].kind != trial.kind) break;
    if (last != nullptr && study.settings.trials[last->trial].p_min != trial.p_min) break;
    last = &row;
    if (row.share_wrong() <= bearable) break;
  }
  return last;
}

/// "99.9 %", but never a rounded 0 or 100.
std::string bounds(const Interval& interval) { return percent(interval.low) + " to " + percent(interval.high); }

}  // namespace

std::string headline(const Study& study, const std::vector<AccuracyRow>& rows) {
  const AccuracyRow* row = chosen_row(study, rows);
  if (row == nullptr) return "No answers.";
  const Trial& trial = study.settings.trials[row->trial];
  const std::string stop = trial.p_min < 1.0 ? fmt::format(", or stopped at p ≥ {}", trial.p_min) : "";
  std::string text = fmt::format(
      "Within {}{}, {} of {} poses were proved and {} answered wrongly (95 %: {}).",
      trial.kind == Trial::Kind::time ? fmt::format("{} µs", trial.amount) : fmt::format("{} work units", trial.amount),
      stop, percent(row->share_proved()), grouped(row->poses), percent(row->share_wrong()),
      bounds(row->wrong_interval()));
  const ForecastQuality& q = row->unproved;
  if (q.count > 0) {
    text += fmt::format(" The {} answers without proof stated a hit with {} on average; {} were hits.",
                        grouped(q.count), percent(q.mean_probability), percent(q.observed()));
  }
  if (const AccuracyRow* exact = exact_row(study, rows)) {
    text += fmt::format(" The exact search without a limit took {} in the median, {} at the 99th percentile.",
                        duration(exact->wall_us.p50 * 1e3), duration(exact->wall_us.p99 * 1e3));
  }
  return text;
}

}  // namespace odds::report
