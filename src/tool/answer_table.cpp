#include "tool/answer_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <vector>

namespace odds::tool {
namespace {

std::string counts(std::span<const AnswerRecord> records) {
  std::string text = fmt::format("{:<12}{:>10}{:>10}{:>10}\n", "answers", "proved", "estimated", "budget");
  for (const query::Verdict verdict : {query::Verdict::hit, query::Verdict::clear}) {
    text += fmt::format("{:<12}", name(verdict));
    for (const query::Basis basis : {query::Basis::proved, query::Basis::estimated, query::Basis::budget}) {
      const auto count = std::count_if(records.begin(), records.end(), [&](const AnswerRecord& record) {
        return record.answer.verdict == verdict && record.answer.basis == basis;
      });
      text += fmt::format("{:>10}", count);
    }
    text += "\n";
  }
  return text;
}

std::string times(std::string_view title, std::vector<double> values) {
  std::sort(values.begin(), values.end());
  std::string text = fmt::format("{:<12}", title);
  for (const double share : {0.5, 0.99, 0.999}) {
    const bool shown = static_cast<double>(values.size()) * (1.0 - share) >= 1.0 - 1e-9;
    text += shown ? fmt::format("{:>10.2f}", percentile(values, share)) : fmt::format("{:>10}", "-");
  }
  return text + fmt::format("{:>10.2f}\n", values.back());
}

}  // namespace

double percentile(std::span<const double> sorted, double share) {
  const double rank = std::ceil(share * static_cast<double>(sorted.size()) - 1e-9);
  return sorted[std::min(sorted.size() - 1, static_cast<std::size_t>(std::max(1.0, rank)) - 1)];
}

std::string answer_table(std::span<const AnswerRecord> records, bool has_time_budget) {
  std::vector<double> wall;
  std::vector<double> net;
  std::vector<double> overshoot;
  std::vector<double> net_overshoot;
  for (const AnswerRecord& record : records) {
    wall.push_back(record.wall_us);
    net.push_back(std::max(0.0, record.wall_us - record.answer.cost.stall_us));
    overshoot.push_back(record.answer.cost.overshoot_us);
    net_overshoot.push_back(record.answer.cost.net_overshoot_us);
  }
  std::string text = counts(records);
  text += fmt::format("{:<12}{:>10}{:>10}{:>10}{:>10}   ({} answers)\n", "microseconds", "p50", "p99", "p99.9", "max",
                      records.size());
  text += times("wall", std::move(wall));
  if (has_time_budget) {  // stalls are seen only where the clock is polled
    text += times("net", std::move(net));
    text += times("over, wall", std::move(overshoot));
    text += times("over, net", std::move(net_overshoot));
  }
  return text;
}

}  // namespace odds::tool
