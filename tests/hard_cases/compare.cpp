// Against the run without a limit, by the same figures as `odds compare`; the first onset with its sign.
#include "hard_cases/compare.hpp"

namespace odds::hard_cases {
namespace {

constexpr std::uint64_t least_ticks = 20;

int onset(const Figures& figures) {
  for (std::size_t i = 0; i < figures.samples.size(); ++i) {
    if (figures.samples[i].contacts > 0) return static_cast<int>(i);
  }
  return -1;
}

std::vector<report::ForceSample> forces(const std::vector<Sample>& samples) {
  std::vector<report::ForceSample> forces;
  for (const Sample& s : samples) {
    forces.push_back({s.t_s, Vec3(s.force_n[0], s.force_n[1], s.force_n[2]), s.contacts});
  }
  return forces;
}

}  // namespace

void compare(const Figures& exact, double touching_n, Figures& figures) {
  if (exact.samples.size() != figures.samples.size() || exact.samples.empty()) return;
  const report::ForceDifference difference =
      report::compare_forces(forces(exact.samples), forces(figures.samples), touching_n, rate_hz);
  if (difference.ticks < least_ticks) return;
  figures.force_error_p95 = difference.error_p95;
  figures.angle_error_p95_deg = difference.angle_p95_deg;
  figures.noise_share = difference.added_noise_share;
  if (onset(exact) >= 0 && onset(figures) >= 0) figures.onset_ticks = onset(figures) - onset(exact);
}

report::ForceDifference of_all_ticks(const std::vector<Outcome>& outcomes, std::size_t run) {
  std::vector<report::ForceSample> exact;
  std::vector<report::ForceSample> limited;
  for (const Outcome& outcome : outcomes) {
    // In units of what counts as touching in the case, for micrometres have micronewtons.
    const auto append = [&](const Figures& figures, std::vector<report::ForceSample>& to) {
      for (report::ForceSample sample : forces(figures.samples)) {
        sample.force_n /= outcome.hard_case->touching_n;
        to.push_back(sample);
      }
    };
    const Figures& first = outcome.runs.front();
    if (!first.has_hand || outcome.runs[run].samples.size() != first.samples.size()) continue;
    append(first, exact);
    append(outcome.runs[run], limited);
  }
  return report::compare_forces(exact, limited, 1.0, rate_hz);
}

}  // namespace odds::hard_cases
