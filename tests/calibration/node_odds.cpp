#include "calibration/node_odds.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "calibration/logistic_fit.hpp"
#include "calibration/meetings.hpp"
#include "calibration/nodes.hpp"
#include "odds/report/accuracy/forecast.hpp"
#include "query/node_odds/node_odds_table.hpp"

namespace odds::calibration {
namespace {

struct Judged {
  Meeting meeting;
  std::vector<JudgedPair> pairs;
};

std::vector<Judged> judge(const std::vector<Meeting>& meetings, volume::Kind volume, std::uint64_t poses,
                          std::uint64_t seed) {
  std::vector<Judged> all;
  for (const Meeting& meeting : meetings) {
    auto pairs = judged_pairs(meeting, volume, poses, seed);
    if (!pairs.ok()) {
      fmt::print(stderr, "left out: {}\n", pairs.error().message());
      continue;
    }
    if (!pairs.value().empty()) all.push_back({meeting, std::move(pairs).value()});
  }
  return all;
}

query::NodeWeights fit(const std::vector<Judged>& training, std::size_t used) {
  std::vector<Case> cases;
  for (const Judged& judged : training) {
    // Each meeting counts the same, however many pairs it has; but a handful does not outweigh a thousand.
    const double weight = 1000.0 / std::max(300.0, static_cast<double>(judged.pairs.size()));
    for (const JudgedPair& pair : judged.pairs) {
      const auto* x = pair.numbers.x.data();
      cases.push_back({{x, x + used}, pair.meet, weight});
    }
  }
  const std::vector<double> found = fit_logistic(cases, 1.0);
  query::NodeWeights weights{};
  std::transform(found.begin(), found.end(), weights.begin(), [](double w) { return static_cast<float>(w); });
  return weights;
}

void print(const query::NodeWeights& weights, std::size_t used, std::string_view comment) {
  std::string list;
  for (std::size_t i = 0; i < used; ++i) list += fmt::format("{}{:.4f}F", list.empty() ? "" : ", ", weights[i]);
  fmt::print("    {{{}}},  // {}\n", list, comment);
}

/// The other half's forecasts, by two numbers learnt from the poses of even number.
std::vector<report::Forecast> learnt(const std::vector<JudgedPair>& pairs, const query::NodeWeights& weights) {
  std::vector<Case> cases;
  const auto numbers = [&](const JudgedPair& pair) {
    return std::vector<double>{1.0, static_cast<double>(query::log_odds(pair.numbers, weights))};
  };
  for (const JudgedPair& pair : pairs) {
    if (pair.line % 2 == 0) cases.push_back({numbers(pair), pair.meet, 1.0});
  }
  std::vector<report::Forecast> forecasts;
  if (cases.empty()) return forecasts;
  const std::vector<double> own = fit_logistic(cases, 1.0);
  for (const JudgedPair& pair : pairs) {
    if (pair.line % 2 == 1) forecasts.push_back({forecast(own, numbers(pair)), pair.meet});
  }
  return forecasts;
}

void show(const std::vector<Judged>& all, const query::NodeWeights& weights, const std::string& title) {
  struct Pool {
    std::vector<report::Forecast> stated;
    std::vector<report::Forecast> learnt;
  };
  fmt::print(stderr, "{}\n{:>8}{:>9}{:>8}{:>8}{:>8}\n", title, "pairs", "P said", "meet", "error", "learnt");
  const auto line = [](const Pool& pool, const std::string& name) {
    if (pool.stated.empty()) return;
    const report::ForecastQuality q = report::judge_forecasts(pool.stated);
    const report::ForecastQuality l = report::judge_forecasts(pool.learnt);
    fmt::print(stderr, "{:>8}{:>9.3f}{:>8.3f}{:>8.3f}{:>8.3f}  {}\n", q.count, q.mean_probability, q.observed(),
               q.calibration_error, l.calibration_error, name);
  };
  Pool apart;
  Pool nested;
  for (const Judged& judged : all) {
    Pool here;
    for (const JudgedPair& pair : judged.pairs) {
      const float p = query::probability_of_log_odds(query::log_odds(pair.numbers, weights));
      here.stated.push_back({static_cast<double>(p), pair.meet});
    }
    here.learnt = learnt(judged.pairs, weights);
    line(here, judged.meeting.a + " + " + judged.meeting.b);
    Pool& pool = judged.meeting.procedure == report::Procedure::nested ? nested : apart;
    pool.stated.insert(pool.stated.end(), here.stated.begin(), here.stated.end());
    pool.learnt.insert(pool.learnt.end(), here.learnt.begin(), here.learnt.end());
  }
  line(apart, "all that are not nested");
  line(nested, "all nested");
}

}  // namespace

void calibrate_nodes(const std::string& only, std::uint64_t poses_per_band, std::uint64_t seed,
                     const std::vector<std::string>& held_out, bool standing) {
  for (const std::string_view word : volume::kind_names) {
    const volume::Kind volume = *volume::kind_from_name(word);
    if (volume == volume::Kind::wide || (!only.empty() && only != word)) continue;
    if (standing) {
      show(judge(held_out_meetings(held_out), volume, poses_per_band, seed + 1),
           query::node_weights[static_cast<std::size_t>(volume)], fmt::format("{}: held out", word));
      continue;
    }
    const std::vector<Judged> training = judge(training_meetings(), volume, poses_per_band, seed);
    const std::size_t used = query::numbers_used(volume);
    const query::NodeWeights weights = fit(training, used);
    print(weights, used, word);
    if (used > query::NodeNumbers::usual) {
      constexpr std::size_t usual = query::NodeNumbers::usual;
      print(fit(training, usual), usual, fmt::format("{}, what orders a search", word));
    }
    show(training, weights, fmt::format("{}: fitted on", word));
    show(judge(held_out_meetings(held_out), volume, poses_per_band, seed + 1), weights,
         fmt::format("{}: held out", word));
  }
}

}  // namespace odds::calibration
