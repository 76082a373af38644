// odds_ablation: what each part of the method buys, by leaving it out: estimator, volume of overlap, order of search,
// slabs, coherence, a pair's own odds. Prints two tables for each pair of meshes.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "ablation/node_pairs.hpp"
#include "ablation/without_slabs.hpp"
#include "calibration/logistic_fit.hpp"
#include "odds/realtime/clock.hpp"
#include "odds/report/accuracy/forecast.hpp"
#include "odds/report/accuracy/poses.hpp"
#include "query/shape_data.hpp"
#include "support/by_queue.hpp"

namespace odds::ablation {
namespace {

using calibration::SharedShape;
using query::EstimatorKind;
using query::Method;

struct Options {
  std::vector<std::string> meshes = {"made:car_body:triangles=60000", "made:torus_knot:along=600,across=20"};
  std::string volume = "obb";
  std::uint64_t poses = 40;
  std::uint64_t seed = 11;
  std::uint64_t units = 256;
  std::uint32_t calibration_poses = 480;
};

struct Posed {
  math::Pose pose;
  std::uint64_t line = 0;
  bool hit = false;
};

/// What one way of answering came to.
struct Tally {
  std::uint64_t poses = 0, proved = 0, wrong = 0;
  std::vector<report::Forecast> all, unproved;
  void add(const query::Answer& answer, bool hit) {
    ++poses;
    if (answer.basis == query::Basis::proved) ++proved;
    if ((answer.verdict == query::Verdict::hit) != hit) ++wrong;
    all.push_back({answer.probability, hit});
    if (answer.basis != query::Basis::proved) unproved.push_back(all.back());
  }
};

Result<std::vector<Posed>> make_poses(const SharedShape& wide, const Options& options) {
  auto maker = report::PoseMaker::make(wide, wide, report::Procedure::distance, options.seed);
  if (!maker.ok()) return maker.error();
  auto pair = query::Pair::make(wide, wide);
  if (!pair.ok()) return pair.error();
  std::vector<Posed> poses;
  const std::uint64_t bands = report::pose_bands(report::Procedure::distance).size();
  for (std::uint64_t i = 0; i < options.poses * bands; ++i) {
    const auto made = maker.value().pose(i);
    if (!made.ok()) return made.error();
    const math::Pose pose = made.value().pose();
    const bool hit =
        pair.value().run(pose, {.method = Method::exact, .max_contacts = 0}).verdict == query::Verdict::hit;
    poses.push_back({pose, i / bands, hit});
  }
  return poses;
}

double percent(std::uint64_t part, std::uint64_t whole) {
  return whole > 0 ? 100.0 * static_cast<double>(part) / static_cast<double>(whole) : 0.0;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double x : values) sum += x;
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

// Answers.

struct Variant {
  const char* name;
  EstimatorKind estimator = EstimatorKind::kinematic;
  bool by_queue = false;
  int most_contacts = 0;  ///< more than one: hits for a patch are looked for depth-first from the root
  bool own_odds = false;
};

constexpr std::array<Variant, 5> variants = {{{.name = "as it is"},
                                              {.name = "estimator: cells", .estimator = EstimatorKind::cells},
                                              {.name = "order: by a queue", .by_queue = true},
                                              {.name = "order: depth-first", .most_contacts = 2},
                                              {.name = "recalibration: the pair's own odds", .own_odds = true}}};

void print_answers(const char* name, const Tally& tally) {
  const report::ForecastQuality all = report::judge_forecasts(tally.all);
  const report::ForecastQuality unproved = report::judge_forecasts(tally.unproved);
  fmt::print("{:<40}{:>8.2f}%{:>8.2f}%{:>9.4f}{:>10}{:>9.3f}\n", name, percent(tally.proved, tally.poses),
             percent(tally.wrong, tally.poses), all.brier, unproved.count, unproved.calibration_error);
}

std::optional<Error> table_of_answers(const SharedShape& wide, const std::vector<Posed>& poses,
                                      const Options& options) {
  fmt::print("answers within {} work units\n{:<40}{:>9}{:>9}{:>9}{:>10}{:>9}\n", options.units, "", "proved", "wrong",
             "Brier", "unproved", "cal.err");
  for (const Variant& variant : variants) {
    query::PairOptions pair_options;
    if (variant.own_odds) pair_options.calibration_poses = options.calibration_poses;
    auto pair = query::Pair::make(wide, wide, pair_options);
    if (!pair.ok()) return pair.error();
    query::Request request;
    request.estimator = variant.estimator;
    if (variant.by_queue) request = testing::by_queue(request);
    request.budget = query::Budget::work(options.units);
    request.max_contacts = variant.most_contacts;
    Tally tally;
    for (const Posed& posed : poses) {
      pair.value().reset();
      tally.add(pair.value().run(posed.pose, request), posed.hit);
    }
    print_answers(variant.name, tally);
  }
  return std::nullopt;
}

// The exact search.

/// Of one exact search: pairs of nodes and of triangles, microseconds.
struct Work {
  std::vector<double> units, microseconds;
};

void search_exactly(const query::wide::Searches& searches, const query::Shape& shape, const Posed& posed, Work& work) {
  const tree::WideTree& tree = *std::get_if<tree::WideTree>(&shape.data().tree);
  static query::BucketQueue queue(4096);
  static query::HitList hits(256);
  const realtime::Clock clock = realtime::fastest_clock();
  double least = 1e300;
  query::Cost cost;
  for (int i = 0; i < 3; ++i) {  // the least of three: what other programs took does not count
    hits.clear();
    const std::int64_t begin = clock();
    const query::Request request{.method = Method::exact};
    query::Spending spending(request.budget);
    const query::PosedMeshes meshes(shape.mesh(), shape.mesh(), tree.origin(), tree.origin(), posed.pose);
    const query::wide::Encounter met(tree, tree, meshes, request.estimator);
    query::SearchResult result;
    query::wide::Task task{met, request, 1, &queue, hits, spending, result};
    if (!met.far_apart()) searches.exact(task);
    cost = spending.close();
    least = std::min(least, 1e-3 * static_cast<double>(clock() - begin));
  }
  work.units.push_back(static_cast<double>(cost.node_pairs + cost.triangle_pairs));
  work.microseconds.push_back(least);
}

void print_work(const char* name, const Work& work) {
  fmt::print("{:<40}{:>10.0f}{:>10.0f}{:>10.2f}{:>10.2f}\n", name, median(work.units), mean(work.units),
             median(work.microseconds), mean(work.microseconds));
}

/// Steps of 1e-4 of the size through a touch, fresh and from what the last step left.
void coherent(const SharedShape& wide, const std::vector<Posed>& poses, Work& fresh, Work& kept) {
  constexpr int steps = 100;
  auto pair = query::Pair::make(wide, wide);
  if (!pair.ok()) return;
  const double step_m = 1e-4 * wide->mesh().size();
  for (std::size_t i = 0; i < poses.size(); i += poses.size() / 20 + 1) {
    const Vec3 way = poses[i].pose.translation.normalized();
    for (const Method method : {Method::exact, Method::incremental}) {
      Work& work = method == Method::exact ? fresh : kept;
      pair.value().reset();
      for (int step = 0; step < steps; ++step) {
        math::Pose pose = poses[i].pose;
        pose.translation += (static_cast<double>(step) - 0.5 * steps) * step_m * way;
        query::Request request{.method = method, .max_contacts = 0};
        request.budget.microseconds = 1e6;  // never spent, but polled: what other programs took is told apart
        const query::Answer& answer = pair.value().run(pose, request);
        if (step == 0) continue;  // nothing to start from yet
        work.units.push_back(static_cast<double>(answer.cost.node_pairs + answer.cost.triangle_pairs));
        work.microseconds.push_back(answer.cost.net_us());
      }
    }
  }
}

void table_of_work(const SharedShape& wide, const std::vector<Posed>& poses) {
  fmt::print("the exact search\n{:<40}{:>10}{:>10}{:>10}{:>10}\n", "", "units p50", "mean", "us p50", "mean");
  const auto* with = searches_with_slabs();
  const auto* without = searches_without_slabs();
  if (with != nullptr && without != nullptr) {
    Work with_slabs, boxes_only;
    for (const Posed& posed : poses) {
      search_exactly(*with, *wide, posed, with_slabs);
      search_exactly(*without, *wide, posed, boxes_only);
    }
    print_work("as it is", with_slabs);
    print_work("slabs: none", boxes_only);
  }
  Work fresh, kept;
  coherent(wide, poses, fresh, kept);
  print_work("coherence: none, steps of 1e-4", fresh);
  print_work("coherence: incremental, the same steps", kept);
}

// Pairs of nodes.

/// A pair of meshes' own two numbers, learnt from the even lines and judged on the odd ones.
double recalibrated_error(const std::vector<JudgedNodes>& judged, std::size_t kind) {
  const auto logit = [kind](const JudgedNodes& one) {
    const double p = std::clamp(one.probability[kind], 1e-4, 1.0 - 1e-4);
    return std::log(p / (1.0 - p));
  };
  std::vector<calibration::Case> cases;
  for (const JudgedNodes& one : judged) {
    if (one.line % 2 == 0) cases.push_back({{1.0, logit(one)}, one.meet});
  }
  if (cases.empty()) return 0.0;
  const std::vector<double> weights = calibration::fit_logistic(cases, 1e-3);
  std::vector<report::Forecast> forecasts;
  for (const JudgedNodes& one : judged) {
    if (one.line % 2 == 1) {
      forecasts.push_back({calibration::forecast(weights, std::vector<double>{1.0, logit(one)}), one.meet});
    }
  }
  return report::judge_forecasts(forecasts).calibration_error;
}

std::optional<Error> table_of_nodes(const std::string& mesh, const std::vector<Posed>& poses, const Options& options) {
  const auto shape = calibration::named_shape(mesh, *volume::kind_from_name(options.volume));
  if (!shape.ok()) return shape.error();
  std::vector<JudgedNodes> judged;
  for (const Posed& posed : poses) judge_nodes(*shape.value(), *shape.value(), posed.pose, posed.line, judged);
  fmt::print("{} pairs of nodes, tree of {}\n{:<40}{:>9}{:>9}{:>9}{:>9}{:>11}\n", judged.size(), options.volume, "",
             "AUC", "P said", "meet", "cal.err", "recal.err");
  for (std::size_t kind = 0; kind < estimate_kinds.size(); ++kind) {
    std::vector<report::Forecast> forecasts;
    for (const JudgedNodes& one : judged) forecasts.push_back({one.probability[kind], one.meet});
    const report::ForecastQuality quality = report::judge_forecasts(forecasts);
    fmt::print("{:<40}{:>9.3f}{:>9.3f}{:>9.3f}{:>9.3f}{:>11.3f}\n", estimate_kinds[kind].name, separation(judged, kind),
               quality.mean_probability, quality.observed(), quality.calibration_error,
               recalibrated_error(judged, kind));
  }
  return std::nullopt;
}

std::optional<Error> run(const Options& options) {
  for (const std::string& mesh : options.meshes) {
    const auto wide = calibration::named_shape(mesh, volume::Kind::wide);
    if (!wide.ok()) return wide.error();
    const auto poses = make_poses(wide.value(), options);
    if (!poses.ok()) return poses.error();
    fmt::print("two copies of {}, {} poses about touch\n\n", mesh, poses.value().size());
    if (auto error = table_of_answers(wide.value(), poses.value(), options)) return error;
    fmt::print("\n");
    table_of_work(wide.value(), poses.value());
    fmt::print("\n");
    if (auto error = table_of_nodes(mesh, poses.value(), options)) return error;
    fmt::print("\n");
  }
  return std::nullopt;
}

}  // namespace
}  // namespace odds::ablation

int main(int argc, char** argv) {
  odds::ablation::Options options;
  CLI::App app("What each part of the method buys, by leaving it out");
  app.add_option("--mesh", options.meshes, "files or made: names, each with its copy");
  app.add_option("--bv", options.volume, "volume of the table of pairs of nodes, any but wide")
      ->check(CLI::IsMember(
          std::vector<std::string>(odds::volume::kind_names.begin(), odds::volume::kind_names.end() - 1)));
  app.add_option("--poses", options.poses, "for each of twelve distances")->check(CLI::Range(2, 100000));
  app.add_option("--work", options.units, "work units of the table of answers")->check(CLI::Range(1, 1000000));
  app.add_option("--seed", options.seed, "of the poses");
  CLI11_PARSE(app, argc, argv);
  if (const auto error = odds::ablation::run(options)) {
    fmt::print(stderr, "{}\n", error->message());
    return 1;
  }
  return 0;
}
