#include "benchmark/peer_times.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

namespace odds::benchmark {
namespace {

void note(std::vector<std::string>& names, const std::string& name) {
  if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

double geometric_mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += std::log(value);
  return std::exp(sum / static_cast<double>(values.size()));
}

double least(const std::vector<double>& values) { return *std::min_element(values.begin(), values.end()); }

double mean_contacts(const PeerRun& run) {
  const auto sum = std::accumulate(run.contacts.begin(), run.contacts.end(), std::size_t{0});
  return static_cast<double>(sum) / static_cast<double>(std::max<std::size_t>(1, run.contacts.size()));
}

}  // namespace

double quantile(std::vector<double> values, double q) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  const double rank = std::ceil(q * static_cast<double>(values.size()));
  return values[static_cast<std::size_t>(std::max(1.0, rank)) - 1];
}

void print_runs(const std::vector<PeerRun>& runs) {
  std::printf("  %-26s %10s %10s %10s %9s %9s %9s %7s\n", "engine", "p50 us", "p99 us", "max us", "p50 ratio",
              "p99 ratio", "contacts", "wrong");
  const double p50 = quantile(runs.front().microseconds, 0.5);
  const double p99 = quantile(runs.front().microseconds, 0.99);
  for (const PeerRun& run : runs) {
    const double own_p50 = quantile(run.microseconds, 0.5);
    const double own_p99 = quantile(run.microseconds, 0.99);
    std::printf("  %-26s %10.2f %10.2f %10.2f %9.2f %9.2f %9.3g %7zu\n", run.engine.c_str(), own_p50, own_p99,
                quantile(run.microseconds, 1.0), own_p50 / p50, own_p99 / p99, mean_contacts(run), run.wrong);
  }
}

void print_footprints(const std::vector<std::unique_ptr<Peer>>& peers) {
  std::printf("  %-26s %10s %10s %16s\n", "engine", "build ms", "cpu ms", "bytes/triangle");
  for (const auto& peer : peers) {
    std::printf("  %-26s %10.1f %10.1f %16.0f\n", peer->name().c_str(), peer->footprint().build_ms,
                peer->footprint().build_cpu_ms, peer->footprint().bytes_per_triangle);
  }
}

void Ratios::add(const std::string& pose_class, const std::vector<PeerRun>& runs) {
  note(classes_, pose_class);
  const double p50 = quantile(runs.front().microseconds, 0.5);
  const double p99 = quantile(runs.front().microseconds, 0.99);
  for (const PeerRun& run : runs) {
    note(engines_, run.engine);
    Series& series = series_[{pose_class, run.engine}];
    series.p50.push_back(quantile(run.microseconds, 0.5) / p50);
    series.p99.push_back(quantile(run.microseconds, 0.99) / p99);
    series.wrong += run.wrong;
  }
}

void Ratios::print() const {
  std::printf("\nRatios to %s over meshes: geometric mean (least)\n  %-10s %-26s %20s %20s %7s\n",
              engines_.empty() ? "" : engines_.front().c_str(), "class", "engine", "p50", "p99", "wrong");
  for (const std::string& pose_class : classes_) {
    for (const std::string& engine : engines_) {
      const auto found = series_.find({pose_class, engine});
      if (found == series_.end()) continue;
      const Series& series = found->second;
      std::printf("  %-10s %-26s %10.2f (%7.2f) %10.2f (%7.2f) %7zu\n", pose_class.c_str(), engine.c_str(),
                  geometric_mean(series.p50), least(series.p50), geometric_mean(series.p99), least(series.p99),
                  series.wrong);
    }
  }
}

}  // namespace odds::benchmark
