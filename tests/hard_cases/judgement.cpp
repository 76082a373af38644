// What a run of a hard case must keep, and how near it must come to the run without a budget.
#include "hard_cases/judgement.hpp"

#include <fmt/core.h>

#include <cstdlib>

#include "hard_cases/compare.hpp"

namespace odds::hard_cases {
namespace {

constexpr double most_force_error = 0.07;  // what people begin to notice, of a force ...
constexpr double most_angle_deg = 18.0;    // ... and of its direction

bool is_near(double error, double angle_deg) { return error <= most_force_error && angle_deg <= most_angle_deg; }

void judge_safety(const HardCase& hard_case, Figures& f) {
  const auto harmful = [&](const std::string& what) { f.harmful.push_back(what); };
  if (f.not_finite > 0) harmful(fmt::format("{} ticks with numbers that are not finite", f.not_finite));
  if (f.largest_force_n > hard_case.max_force_n * (1.0 + 1e-9)) {
    harmful(fmt::format("a force of {:.3g} N, beyond the limit of {} N", f.largest_force_n, hard_case.max_force_n));
  }
  if (f.given_j > hard_case.given_j) {
    harmful(fmt::format("{:.3g} J given to the hand, {:.3g} allowed", f.given_j, hard_case.given_j));
  }
  if (f.missed_deep > 0) {
    f.missed.push_back(
        fmt::format("{} ticks without contact in a deep overlap, not the first of their row", f.missed_deep));
  }
  if (!hard_case.ends.empty() && !(f.end_height_m > hard_case.ends_above_m)) {
    f.missed.push_back(fmt::format("'{}' ends at {:.4g} m, not above {:.4g} m", hard_case.ends, f.end_height_m,
                                   hard_case.ends_above_m));
  }
}

void judge_feel(const HardCase& hard_case, Figures& f) {
  const auto off = [&](const std::string& what) { f.off.push_back(what); };
  if (f.at_same_poses && f.at_same_poses->error_p95 > most_force_error) {
    off(fmt::format("at the same poses contact forces are off by {:.1f} % at the 95th percentile ({:.0f} % allowed)",
                    100.0 * f.at_same_poses->error_p95, 100.0 * most_force_error));
  }
  if (f.at_same_poses && f.at_same_poses->angle_p95_deg > most_angle_deg) {
    off(fmt::format("at the same poses contact forces are off by {:.1f} degrees at the 95th percentile ({} allowed)",
                    f.at_same_poses->angle_p95_deg, most_angle_deg));
  }
  if (f.budget == "none" || !hard_case.compares) return;
  if (f.force_error_p95 && *f.force_error_p95 > most_force_error) {
    off(fmt::format("force off by {:.1f} % at the 95th percentile ({:.0f} % allowed)", 100.0 * *f.force_error_p95,
                    100.0 * most_force_error));
  }
  if (f.angle_error_p95_deg && *f.angle_error_p95_deg > most_angle_deg) {
    off(fmt::format("force off by {:.1f} degrees at the 95th percentile ({} allowed)", *f.angle_error_p95_deg,
                    most_angle_deg));
  }
  if (f.onset_ticks && std::abs(*f.onset_ticks) > 1) off(fmt::format("contact begins {} ticks off", *f.onset_ticks));
  if (f.noise_share && *f.noise_share > 0.01) {
    off(fmt::format("{:.2f} % added noise (1 % allowed)", 100.0 * *f.noise_share));
  }
}

}  // namespace

void judge(const HardCase& hard_case, Figures& figures) {
  judge_safety(hard_case, figures);
  judge_feel(hard_case, figures);
}

bool Tally::all_ticks_near() const { return is_near(all_ticks.error_p95, all_ticks.angle_p95_deg); }

bool stays_near(const Figures& figures) {
  return !figures.force_error_p95 || !figures.angle_error_p95_deg ||
         is_near(*figures.force_error_p95, *figures.angle_error_p95_deg);
}

bool compared(const Figures& figures) { return figures.at_same_poses && figures.at_same_poses->ticks > 0; }

std::vector<Tally> tally(const std::vector<Outcome>& outcomes) {
  std::vector<Tally> tallies;
  for (const Outcome& outcome : outcomes) {
    for (std::size_t i = tallies.size(); i < outcome.runs.size(); ++i) tallies.push_back({outcome.runs[i].budget});
    for (std::size_t i = 0; i < outcome.runs.size(); ++i) {
      const Figures& run = outcome.runs[i];
      Tally& sum = tallies[i];
      ++sum.runs;
      if (run.force_error_p95 && run.angle_error_p95_deg) {
        ++sum.runs_compared;
        if (stays_near(run)) ++sum.runs_near;
      }
      if (run.harmful.empty()) ++sum.harmless;
      if (run.safe()) ++sum.safe;
      if (!compared(run)) continue;
      ++sum.compared;
      if (run.off.empty()) ++sum.feels_right;
    }
  }
  for (std::size_t i = 0; i < tallies.size(); ++i) tallies[i].all_ticks = of_all_ticks(outcomes, i);
  return tallies;
}

}  // namespace odds::hard_cases
