// odds_calibration: fits what an answer without a proof states as its probability, or with --nodes a pair of nodes, and
// says how true that is on meshes and poses that it was not fitted on. Prints the tables of
// src/query/answer_odds/answer_odds_table.hpp and src/query/node_odds/node_odds_table.hpp.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "calibration/ascending.hpp"
#include "calibration/logistic_fit.hpp"
#include "calibration/meetings.hpp"
#include "calibration/node_odds.hpp"
#include "calibration/unproved.hpp"
#include "odds/report/accuracy/forecast.hpp"
#include "query/answer_odds/answer_odds.hpp"
#include "query/answer_odds/odds_for.hpp"

namespace odds::calibration {
namespace {

using report::Procedure;

struct Options {
  std::uint64_t poses = 30;
  std::uint64_t seed = 1;
  std::string volume;  ///< empty: all
  std::vector<std::string> held_out;
  bool nodes = false;
  bool standing = false;
  bool polygon_free = false;
};

struct Kept {
  Meeting meeting;
  std::vector<Unproved> answers;
};

/// What a table of odds is for: answers of one estimator, found in one order, or without polygons.
struct Table {
  std::string_view name;
  std::vector<Way> ways;  ///< that it is for; the first stands for all
};

std::vector<Table> tables_of(const Options& options) {
  using query::EstimatorKind;
  using query::Method;
  std::vector<Table> tables;
  for (const EstimatorKind estimator : {EstimatorKind::cells, EstimatorKind::kinematic}) {
    const bool cells = estimator == EstimatorKind::cells;
    const Way likeliest_first{estimator, Method::time_critical, options.polygon_free};
    if (options.polygon_free) {
      tables.push_back({cells ? "cells, without polygons" : "kinematic, without polygons", {likeliest_first}});
      continue;
    }
    tables.push_back({cells ? "cells, exact and incremental" : "kinematic, exact and incremental",
                      {{estimator, Method::exact}, {estimator, Method::incremental}}});
    tables.push_back({cells ? "cells, time-critical" : "kinematic, time-critical", {likeliest_first}});
  }
  return tables;
}

/// For each table, the answers of all meetings that left any.
std::vector<std::vector<Kept>> gather(const std::vector<Meeting>& meetings, volume::Kind volume,
                                      const std::vector<Table>& tables, const Options& options, std::uint64_t seed) {
  Asked asked;
  asked.volume = volume;
  std::vector<std::size_t> table_of_way;
  for (std::size_t i = 0; i < tables.size(); ++i) {
    asked.ways.insert(asked.ways.end(), tables[i].ways.begin(), tables[i].ways.end());
    table_of_way.resize(asked.ways.size(), i);
  }
  asked.units = {64, 128, 256, 512, 1024, 2048};
  asked.poses_per_band = options.poses;
  asked.seed = seed;
  std::vector<std::vector<Kept>> gathered(tables.size());
  for (const Meeting& meeting : meetings) {
    const auto answers = unproved_answers(meeting, asked);
    if (!answers.ok()) fmt::print(stderr, "left out: {}\n", answers.error().message());
    for (auto& kept : gathered) kept.push_back({meeting, {}});
    for (std::size_t way = 0; answers.ok() && way < asked.ways.size(); ++way) {
      const std::vector<Unproved>& found = answers.value()[way];
      auto& all = gathered[table_of_way[way]].back().answers;
      all.insert(all.end(), found.begin(), found.end());
    }
  }
  for (auto& table : gathered) std::erase_if(table, [](const Kept& kept) { return kept.answers.empty(); });
  return gathered;
}

/// Each meeting counts the same, however many of its answers have no proof; but a handful does not outweigh a thousand.
double weight_in(const Kept& kept) { return 1000.0 / std::max(300.0, static_cast<double>(kept.answers.size())); }

/// Shares of hits by what the regression says: pooled until they ascend (isotonic regression), read at every knot. Of
/// shells, or of all else.
query::AnswerOdds::Line line_seen(const std::vector<Kept>& all, const query::AnswerOdds& odds, bool of_shells) {
  std::vector<Case> cases;
  for (const Kept& kept : all) {
    for (const Unproved& one : kept.answers) {
      const auto facing = static_cast<double>(one.remains.facing);
      const double weight = weight_in(kept) * (of_shells ? facing : 1.0 - facing);
      if (weight > 0.0) cases.push_back({{static_cast<double>(query::regression(odds, one.remains))}, one.hit, weight});
    }
  }
  query::AnswerOdds::Line line{};
  if (cases.empty()) return line;
  const std::vector<Level> levels = ascending_levels(std::move(cases), of_shells ? 20 : 40);  // shells are few
  constexpr std::size_t pieces = query::AnswerOdds::pieces;
  for (std::size_t k = 0; k <= pieces; ++k) {
    line[k] = static_cast<float>(level_at(levels, static_cast<double>(k) / static_cast<double>(pieces)));
  }
  return line;
}

query::AnswerOdds fit(const std::vector<Kept>& all) {
  std::vector<Case> cases;
  for (const Kept& kept : all) {
    for (const Unproved& one : kept.answers) {
      const auto numbers = query::numbers_of(one.remains);
      cases.push_back({{numbers.begin(), numbers.end()}, one.hit, weight_in(kept)});
    }
  }
  // Each meeting counts 1000: what is learnt of shells moves only where most of them agree.
  constexpr double usual = 1.0;
  constexpr double counted_again = 10.0;
  constexpr double of_shells = 1e4;
  constexpr double of_constants = 1e-9;
  std::array<double, query::AnswerOdds::count> ridge{};
  for (std::size_t i = 0; i < ridge.size(); ++i) {
    ridge[i] = i < 2                    ? of_constants
               : query::is_of_shells(i) ? of_shells
               : query::counts_again(i) ? counted_again
                                        : usual;
  }
  const std::vector<double> weights = fit_logistic(cases, ridge);
  query::AnswerOdds odds;
  std::transform(weights.begin(), weights.end(), odds.weights.begin(), [](double w) { return static_cast<float>(w); });
  odds.seen = line_seen(all, odds, false);
  odds.seen_of_shells = line_seen(all, odds, true);
  return odds;
}

/// How far from first touch, in parts of the size, whichever side: each such set holds hits and misses.
std::string distance_name(double offset) {
  const double away = std::abs(offset);
  if (away > 0.02) return "5 to 30 %";
  for (const auto& [limit, name] : {std::pair{5e-6, "1e-6"}, {5e-4, "1e-4"}, {1.5e-3, "0.1 %"}, {5e-3, "0.2 %"}}) {
    if (away < limit) return name;
  }
  return "1 %";
}

void judge(const std::vector<Kept>& all, const query::AnswerOdds& odds, const char* title) {
  std::vector<report::Forecast> apart;
  std::vector<report::Forecast> nested;
  std::vector<report::Forecast> judged_hits;  // without polygons
  std::vector<report::Forecast> judged_clear;
  std::map<std::string, std::vector<report::Forecast>> by_distance;
  std::vector<double> alone;  // errors of each pair of meshes
  fmt::print(stderr, "{}\n{:>8}{:>9}{:>8}{:>8}\n", title, "answers", "P said", "hits", "error");
  const auto line = [](const std::vector<report::Forecast>& forecasts, const std::string& name) {
    if (forecasts.empty()) return;
    const report::ForecastQuality q = report::judge_forecasts(forecasts);
    fmt::print(stderr, "{:>8}{:>9.3f}{:>8.3f}{:>8.3f}  {}\n", q.count, q.mean_probability, q.observed(),
               q.calibration_error, name);
  };
  for (const Kept& kept : all) {
    std::vector<report::Forecast> here;
    for (const Unproved& one : kept.answers) {
      here.push_back({query::probability_of_hit(odds, one.remains), one.hit});
      if (one.judged) (one.remains.logit >= 0.0F ? judged_hits : judged_clear).push_back(here.back());
      if (kept.meeting.procedure != Procedure::nested) by_distance[distance_name(one.offset)].push_back(here.back());
    }
    line(here, kept.meeting.a + " + " + kept.meeting.b);
    auto& pool = kept.meeting.procedure == Procedure::nested ? nested : apart;
    if (&pool == &apart) alone.push_back(report::judge_forecasts(here).calibration_error);
    pool.insert(pool.end(), here.begin(), here.end());
  }
  line(apart, "all that are not nested");
  fmt::print(
      stderr, "{:>33.3f}  of these, mean error of one pair of meshes; Brier score {:.4f}\n",
      std::accumulate(alone.begin(), alone.end(), 0.0) / static_cast<double>(std::max<std::size_t>(alone.size(), 1)),
      apart.empty() ? 0.0 : report::judge_forecasts(apart).brier);
  for (const auto& [name, forecasts] : by_distance) line(forecasts, "of these at " + name);
  line(nested, "all nested");
  line(judged_hits, "judged hits");
  line(judged_clear, "judged clear");
}

void print(const query::AnswerOdds& odds, const std::string& comment) {
  const auto list = [](std::span<const float> numbers) {
    std::string text;
    for (const float x : numbers) text += fmt::format("{}{:.4f}F", text.empty() ? "" : ", ", x);
    return text;
  };
  fmt::print("    // {}\n    {{{{{}}},\n     {{{}}},\n     {{{}}}}},\n", comment, list(odds.weights), list(odds.seen),
             list(odds.seen_of_shells));
}

const query::AnswerOdds& standing(volume::Kind volume, const Way& way) {
  return query::odds_for(volume, way.estimator, way.method, way.polygon_free);
}

void run(const Options& options) {
  const std::vector<Table> tables = tables_of(options);
  for (const std::string_view word : volume::kind_names) {
    const volume::Kind volume = *volume::kind_from_name(word);
    if (!options.volume.empty() && options.volume != word) continue;
    const auto gathered = [&](const std::vector<Meeting>& meetings, std::uint64_t seed) {
      return gather(meetings, volume, tables, options, seed);
    };
    const auto held_out = gathered(held_out_meetings(options.held_out), options.seed + 1);
    const auto training = options.standing ? held_out : gathered(training_meetings(), options.seed);
    for (std::size_t i = 0; i < tables.size(); ++i) {
      const std::string name = fmt::format("{}, {}", word, tables[i].name);
      if (options.standing) {
        judge(held_out[i], standing(volume, tables[i].ways.front()), (name + ": held out, as it stands").c_str());
        continue;
      }
      const query::AnswerOdds odds = fit(training[i]);
      print(odds, name);
      judge(training[i], odds, (name + ": fitted on").c_str());
      judge(held_out[i], odds, (name + ": held out").c_str());
    }
  }
}

}  // namespace
}  // namespace odds::calibration

int main(int argc, char** argv) {
  odds::calibration::Options options;
  CLI::App app("Fits the probabilities of answers without a proof: prints the tables, and on stderr how true they are");
  app.add_option("--poses", options.poses, "for each distance")->check(CLI::Range(1, 100000));
  app.add_option("--seed", options.seed, "of the training poses; the held-out ones have the next");
  app.add_option("--held-out", options.held_out, "more meshes to judge by, each with its copy");
  app.add_option("--bv", options.volume, "tables of this volume alone; default: of all");
  app.add_flag("--nodes", options.nodes, "the odds of pairs of nodes, not of answers");
  app.add_flag("--standing", options.standing, "fits nothing: judges what stands in the library");
  app.add_flag("--polygon-free", options.polygon_free, "tables of searches that do without polygons");
  CLI11_PARSE(app, argc, argv);
  if (options.nodes) {
    odds::calibration::calibrate_nodes(options.volume, options.poses, options.seed, options.held_out, options.standing);
  } else {
    odds::calibration::run(options);
  }
  return 0;
}
