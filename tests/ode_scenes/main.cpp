// Runs the scenes, prints a line for each run, writes one page and one table. Exit status 1 if a bar is missed.
#include <fmt/core.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>

#include "ode_scenes/page.hpp"
#include "ode_scenes/scenes.hpp"

namespace odds::ode_scenes {
namespace {

struct Options {
  std::string folder = "ode_scenes";
  std::string only;
  double soak_s = 0.0;
  Plan plan;
};

constexpr double least_budget_us = 0.1;

using Scene = Section (*)(const Plan&);
constexpr std::pair<const char*, Scene> all[] = {
    {"stacks", &stacks}, {"peg", &peg_in_hole}, {"gears", &gears},       {"bolt", &bolt_and_nut},    {"drag", &drag},
    {"crowd", &crowd},   {"wall", &wall},       {"partners", &partners}, {"behaviours", &behaviours}};

int usage() {
  fmt::print(
      stderr,
      "usage: odds_ode_scenes [--out FOLDER] [--only stacks|peg|gears|bolt|drag|crowd|wall|partners|behaviours] "
      "[--quick]\n"
      "                       [--seconds S] [--budgets US,US,...] [--work | --counted NS] [--bricks N,N,...] [--gaps "
      "MM,MM,...] "
      "[--ours] "
      "[--gimpact] [--seed N]\n"
      "       odds_ode_scenes --soak [--seconds S] [--out FOLDER]   (stacks of five, ten minutes)\n"
      "--quick: ten seconds, one gap, stacks of 2 and 5; --bricks, --gaps: of stacks, else 2,5,10 and 0,0.1,0.5,1 mm;\n"
      "--budgets: of ours, else 100,5,10,20 us; --work: as 20 work units each, the same on every run;\n"
      "--counted: so much time passes at each look at the clock (some 350 ns on an EPYC of 2.4 GHz), and none "
      "between:\n"
      "the same on every run, too, and with contacts that are late;\n"
      "--ours: without those that it is compared with;\n"
      "--seed: of how the fifty bodies are placed, else 7;\n"
      "--gimpact: Bullet's GImpact, too, if built with Bullet\n");
  return 2;
}

/// Numbers between commas, none below `least`.
bool read_list(const char* text, std::vector<double>& numbers, double least) {
  numbers.clear();
  for (char* end = nullptr; numbers.empty() || *end == ','; text = end + 1) {
    numbers.push_back(std::strtod(text, &end));
    if (end == text || !(numbers.back() >= least)) return false;
    if (*end == '\0') return true;
  }
  return false;
}

bool read(int argc, char** argv, Options& options) {
  double seconds = 0.0;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--out" && i + 1 < argc) {
      options.folder = argv[++i];
    } else if (argument == "--only" && i + 1 < argc) {
      options.only = argv[++i];
    } else if (argument == "--seconds" && i + 1 < argc) {
      std::vector<double> one;
      if (!read_list(argv[++i], one, 1e-3) || one.size() != 1) return false;
      seconds = one.front();
    } else if (argument == "--quick") {
      options.plan.seconds = 10.0;
      options.plan.gaps_mm = {0.1};
      options.plan.bricks = {2, 5};
    } else if (argument == "--budgets" && i + 1 < argc) {
      if (!read_list(argv[++i], options.plan.budgets_us, least_budget_us)) return false;
    } else if (argument == "--gaps" && i + 1 < argc) {
      if (!read_list(argv[++i], options.plan.gaps_mm, 0.0)) return false;
    } else if (argument == "--bricks" && i + 1 < argc) {
      std::vector<double> counts;
      if (!read_list(argv[++i], counts, 1.0)) return false;
      options.plan.bricks.assign(counts.begin(), counts.end());
    } else if (argument == "--seed" && i + 1 < argc) {
      std::vector<double> one;
      if (!read_list(argv[++i], one, 0.0) || one.size() != 1 || !(one.front() <= 1e9)) return false;
      if (one.front() != std::floor(one.front())) return false;
      options.plan.seed = static_cast<std::uint64_t>(one.front());
    } else if (argument == "--ours") {
      options.plan.others = false;
    } else if (argument == "--work") {
      options.plan.in_work = true;
    } else if (argument == "--counted" && i + 1 < argc) {
      std::vector<double> one;
      if (!read_list(argv[++i], one, 1.0) || one.size() != 1 || one.front() > 1e6) return false;
      options.plan.look_ns = std::lround(one.front());
    } else if (argument == "--gimpact") {
      options.plan.gimpact = true;
    } else if (argument == "--soak") {
      options.soak_s = 600.0;
    } else {
      return false;
    }
  }
  if (options.plan.in_work && options.plan.look_ns > 0) return false;  // one kind of budget
  if (seconds > 0.0) (options.soak_s > 0.0 ? options.soak_s : options.plan.seconds) = seconds;
  return true;
}

int run(const Options& options) {
  std::filesystem::create_directories(options.folder);
  const auto began = std::chrono::steady_clock::now();
  std::vector<Section> sections;
  if (options.soak_s > 0.0) {
    sections.push_back(soak(options.soak_s));
  } else {
    for (const auto& [name, scene] : all) {
      if (options.only.empty() || options.only == name) sections.push_back(scene(options.plan));
    }
  }
  if (sections.empty()) return usage();
  const double took_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  std::ofstream page(options.folder + "/ode_scenes.html");
  page << page_of(sections, took_s);
  std::ofstream table(options.folder + "/ode_scenes.csv");
  table << csv_of(sections);
  if (!page.flush() || !table.flush()) {
    fmt::print(stderr, "error: {}: cannot be written; give another folder with --out\n", options.folder);
    return 1;
  }
  const std::vector<std::string> missed = misses(sections);
  for (const std::string& miss : missed) fmt::print("missed: {}\n", miss);
  fmt::print("page: {}/ode_scenes.html, table: {}/ode_scenes.csv\n", options.folder, options.folder);
  return missed.empty() ? 0 : 1;
}

}  // namespace
}  // namespace odds::ode_scenes

int main(int argc, char** argv) {
  odds::ode_scenes::Options options;
  if (!odds::ode_scenes::read(argc, argv, options)) return odds::ode_scenes::usage();
  try {
    return odds::ode_scenes::run(options);
  } catch (const std::exception& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return 1;
  }
}
