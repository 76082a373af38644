// Runs all hard cases, prints one line for each run, writes one page. Exit status 1 if a run is unsafe, or one with 50
// us feels different.
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "hard_cases/judgement.hpp"
#include "hard_cases/page.hpp"
#include "hard_cases/run_case.hpp"
#include "hard_cases/soak.hpp"
#include "hard_cases/troubled_device.hpp"
#include "support/allocation_counter.hpp"

namespace odds::hard_cases {
namespace {

void print(const Outcome& outcome) {
  for (const Figures& f : outcome.runs) {
    fmt::print(
        "{:<20} {:<6} {:5} ticks {:6.2f} s  largest {:8.3g} N  given {:8.2g} J  deep missed {} of {}  force {}  angle "
        "{}  same poses {}  contacts {}  {}\n",
        outcome.hard_case->name, f.budget, f.ticks, f.wall_s, f.largest_force_n, f.given_j, f.missed_deep, f.deep,
        f.force_error_p95 ? fmt::format("{:.1f} %", 100.0 * *f.force_error_p95) : "-",
        f.angle_error_p95_deg ? fmt::format("{:.1f} deg", *f.angle_error_p95_deg) : "-",
        f.at_same_poses && f.at_same_poses->ticks > 0
            ? fmt::format("{:.1f} % {:.1f} deg", 100.0 * f.at_same_poses->error_p95, f.at_same_poses->angle_p95_deg)
            : "-",
        f.most_contacts,
        !f.safe()        ? "UNSAFE"
        : !f.off.empty() ? "safe, feels different"
                         : "safe");
    for (const auto* list : {&f.harmful, &f.missed, &f.off}) {
      for (const std::string& what : *list) fmt::print("    {}\n", what);
    }
  }
}

void print(const std::vector<Tally>& tallies) {
  for (const Tally& t : tallies) {
    fmt::print("budget {:<6} safe {:2} of {:2} (no harm {:2} of {:2})", t.budget, t.safe, t.runs, t.harmless, t.runs);
    if (t.compared > 0) {
      fmt::print(
          "  feels as without a budget {:2} of {:2}  each run on its own near {:2} of {:2}, all {} ticks {:.1f} % "
          "{:.1f} deg",
          t.feels_right, t.compared, t.runs_near, t.runs_compared, t.all_ticks.ticks, 100.0 * t.all_ticks.error_p95,
          t.all_ticks.angle_p95_deg);
    }
    fmt::print("\n");
  }
}

// Every scene of a folder, or one scene.
int soak_all(const std::filesystem::path& place, double seconds) {
  std::vector<std::filesystem::path> scenes;
  if (std::filesystem::is_directory(place)) {
    for (const auto& entry : std::filesystem::directory_iterator(place)) scenes.push_back(entry.path());
  } else {
    scenes.push_back(place);
  }
  std::sort(scenes.begin(), scenes.end());
  bool all_hold = true;
  for (const std::filesystem::path& scene : scenes) {
    const Result<Soak> soaked = soak(scene.string(), seconds);
    if (!soaked) {
      fmt::print(stderr, "error: {}\n", soaked.error().message());
      all_hold = false;
      continue;
    }
    const Soak& s = soaked.value();
    all_hold = all_hold && s.holds();
    fmt::print(
        "{:<24} {:9} ticks in {:6.1f} s  {} allocations  {} effects{}  not finite {}  beyond the limit {}  faulted {}  "
        "rescued {}  largest {:.3g} N  lowest balance {:.2g} J  fastest {:.3g} m/s  fallen {} in {} rounds  {}\n",
        scene.filename().string(), s.ticks, s.wall_s,
        support::counts_allocations ? std::to_string(s.allocations) : "uncounted", s.effects,
        s.idle.empty() ? "" : ", never at work:" + s.idle, s.not_finite, s.beyond_limit, s.faulted, s.rescued,
        s.largest_force_n, s.least_energy_j, s.fastest_m_per_s, s.fallen, s.rounds, s.holds() ? "holds" : "BROKEN");
    std::fflush(stdout);
  }
  return all_hold ? 0 : 1;
}

/// 0 where the text is not a finite number greater than 0.
double positive(const char* text) {
  char* end = nullptr;
  const double number = std::strtod(text, &end);
  return end != text && *end == '\0' && std::isfinite(number) && number > 0.0 ? number : 0.0;
}

/// 0: not a number of work units.
std::uint64_t units(const std::string& text) {
  const double number = positive(text.c_str());
  return number >= 1.0 && number <= 1000.0 && number == std::floor(number) ? static_cast<std::uint64_t>(number) : 0;
}

int run(const std::string& folder, const std::string& only, const std::string& knot, const RunOptions& options) {
  const bool is_new = std::filesystem::create_directories(folder);
  register_troubled_device();
  const std::vector<HardCase> cases = all_cases(folder, knot);
  const auto is_wanted = [&](const HardCase& hard_case) { return only.empty() || hard_case.name == only; };
  if (std::none_of(cases.begin(), cases.end(), is_wanted)) {
    fmt::print(stderr, "error: there is no case '{}'; choose one of:", only);
    for (const HardCase& hard_case : cases) fmt::print(stderr, " {}", hard_case.name);
    fmt::print(stderr, "\n");
    if (is_new) std::filesystem::remove_all(folder);  // with the meshes of the cases
    return 2;
  }
  const auto began = std::chrono::steady_clock::now();
  std::vector<Outcome> outcomes;
  bool all_hold = true;
  for (const HardCase& hard_case : cases) {
    if (!is_wanted(hard_case)) continue;
    Result<Outcome> outcome = run_case(hard_case, folder, options);
    if (!outcome) {
      fmt::print(stderr, "error: {}: {}\n", hard_case.name, outcome.error().message());
      return 1;
    }
    print(outcome.value());
    for (const Figures& f : outcome.value().runs) all_hold = all_hold && f.holds();
    outcomes.push_back(std::move(outcome).value());
  }
  const std::vector<Tally> tallies = tally(outcomes);
  print(tallies);
  for (const Tally& t : tallies) all_hold = all_hold && (t.budget != "50 us" || t.all_ticks_near());
  const double took_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  std::ofstream(folder + "/hard_cases.html") << page_of(outcomes, took_s);
  fmt::print("page: {}/hard_cases.html\n", folder);
  return all_hold ? 0 : 1;
}

}  // namespace
}  // namespace odds::hard_cases

int main(int argc, char** argv) {
  std::string folder = "hard_cases";
  std::string only;
  std::string knot = "made:torus_knot";
  std::string soaked;
  odds::hard_cases::RunOptions options;
  double seconds = 3600.0;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--out" && i + 1 < argc) {
      folder = argv[++i];
    } else if (argument == "--only" && i + 1 < argc) {
      only = argv[++i];
    } else if (argument == "--knot" && i + 1 < argc) {
      knot = argv[++i];
    } else if (argument == "--soak" && i + 1 < argc) {
      soaked = argv[++i];
    } else if (argument == "--seconds" && i + 1 < argc) {
      seconds = odds::hard_cases::positive(argv[++i]);
    } else if (argument == "--share" && i + 1 < argc) {
      options.share_of_seconds = odds::hard_cases::positive(argv[++i]);
    } else if (argument == "--starved" && i + 1 < argc) {
      options.starved_units = odds::hard_cases::units(argv[++i]);
    } else {
      fmt::print(stderr,
                 "usage: odds_hard_cases [--out FOLDER] [--only CASE] [--share OF_THE_SECONDS] [--knot MESH]\n"
                 "                       [--starved UNITS]\n"
                 "       --knot: instead of made:torus_knot, in full_overlap and meshes_at_speed\n"
                 "       --starved: work units of the run with the least of them, 1 to 1000, instead of 20 (1 us)\n"
                 "       odds_hard_cases --soak SCENE_OR_FOLDER [--seconds S]   (an hour of each, simulated)\n");
      return 2;
    }
  }
  if (!(seconds > 0.0) || !(options.share_of_seconds > 0.0)) {
    fmt::print(stderr, "error: --seconds and --share take a finite number greater than 0\n");
    return 2;
  }
  if (options.starved_units == 0) {
    fmt::print(stderr, "error: --starved takes a whole number of work units from 1 to 1000\n");
    return 2;
  }
  if (!soaked.empty() && options.starved_units != odds::hard_cases::RunOptions{}.starved_units) {
    fmt::print(stderr, "error: --soak runs scenes with their own budgets; leave --starved out\n");
    return 2;
  }
  if (!soaked.empty()) return odds::hard_cases::soak_all(soaked, seconds);
  return odds::hard_cases::run(folder, only, knot, options);
}
