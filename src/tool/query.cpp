// `odds query A B --poses POSES.csv --out ANSWERS.csv`: one answer for each pose.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <limits>
#include <map>
#include <memory>
#include <vector>

#include "odds/query/pair.hpp"
#include "odds/realtime/clock.hpp"
#include "tool/answer_table.hpp"
#include "tool/answers_csv.hpp"
#include "tool/command.hpp"
#include "tool/pose_run.hpp"
#include "tool/progress_line.hpp"
#include "tool/shared_options.hpp"

namespace odds::tool {
namespace {

struct QueryOptions {
  PoseRunArguments run;
  query::Request request;
  std::uint32_t repeat = 1;
};

/// Answers pose after pose and takes the time of each query alone.
class Session {
 public:
  Session(query::Pair& pair, const std::vector<math::Pose>& poses, const query::Request& request, std::uint32_t repeat)
      : pair_(pair), poses_(poses), request_(request), clock_(realtime::fastest_clock()), runs_(repeat) {
    (void)pair_.run(poses_.front(), request_);  // touches code and memory once before anything is timed
    pair_.reset();
  }

  /// The run with the median wall time of `repeat` (the faster middle one of an even number).
  const AnswerRecord& answer(std::size_t row) {
    for (AnswerRecord& run : runs_) {
      set_coherence(row);
      const std::int64_t begin = clock_();
      const query::Answer& answer = pair_.run(poses_[row], request_);
      const std::int64_t end = clock_();
      run = AnswerRecord(answer, 1e-3 * static_cast<double>(end - begin));
    }
    const auto median = runs_.begin() + static_cast<std::ptrdiff_t>((runs_.size() - 1) / 2);
    std::nth_element(runs_.begin(), median, runs_.end(),
                     [](const AnswerRecord& x, const AnswerRecord& y) { return x.wall_us < y.wall_us; });
    return *median;
  }

 private:
  /// Each query stands alone, except that the incremental method has answered the row before, and that one only.
  void set_coherence(std::size_t row) {
    if (request_.method != query::Method::incremental) {
      pair_.reset();
    } else if (runs_.size() > 1) {
      pair_.reset();
      if (row > 0) (void)pair_.run(poses_[row - 1], request_);
    }
  }

  query::Pair& pair_;
  const std::vector<math::Pose>& poses_;
  const query::Request& request_;
  realtime::Clock clock_;
  std::vector<AnswerRecord> runs_;
};

int run(const QueryOptions& options) {
  Result<PoseRun> opened = PoseRun::open(options.run);
  if (!opened.ok()) return fail(opened.error());
  auto& [poses, out, pair] = opened.value();

  if (!options.request.leaf_test && pair.a().volume() == volume::Kind::wide) {
    return fail({options.run.pair.mesh_a, "", "the wide engine has no test of leaves to leave out",
                 "choose another volume by --bv, or leave out --no-leaf-test"});
  }
  const bool has_polygons = !options.request.polygon_free && pair.a().has_polygons() && pair.b().has_polygons();
  if (options.request.method == query::Method::exact && options.request.p_min < 1.0 && has_polygons) {
    return fail(
        {"", "", "the exact method never ends on a probability", "leave out --p-min, or take another --method"});
  }
  query::Request request = options.request;
  request.budget = options.run.limited(request.budget);
  std::vector<AnswerRecord> records;
  records.reserve(poses.size());
  {
    ProgressLine progress("querying");
    Session session(pair, poses, request, options.repeat);
    for (std::size_t row = 0; row < poses.size(); ++row) {
      records.push_back(session.answer(row));
      if (row % 64 == 0) progress.show(static_cast<double>(row) / static_cast<double>(poses.size()));
    }
  }
  out.write(answers_header);
  for (std::size_t row = 0; row < records.size(); ++row) out.write(answer_line(row, records[row]));
  if (const auto error = out.commit()) return fail(*error);
  const std::string table = answer_table(records, options.run.budget_us > 0.0);
  fmt::print(out.is_standard_output() ? stderr : stdout, "{}", table);
  return exit_good;
}

}  // namespace

void add_query(CLI::App& app, Action& action) {
  const auto options = std::make_shared<QueryOptions>();
  CLI::App* command = app.add_subcommand("query", "Answer whether A and B meet, for each pose of B in A's frame");
  add_pose_run_options(*command, options->run,
                       "CSV of answers, rows counted from 0 as the poses; - for standard output");
  const std::map<std::string, query::Method> methods = {{"exact", query::Method::exact},
                                                        {"incremental", query::Method::incremental},
                                                        {"time-critical", query::Method::time_critical}};
  add_choice(*command, "--method", options->request.method, methods, "exact, incremental or time-critical (default)");
  const std::map<std::string, query::EstimatorKind> estimators = {{"cells", query::EstimatorKind::cells},
                                                                  {"kinematic", query::EstimatorKind::kinematic}};
  add_choice(*command, "--estimator", options->request.estimator, estimators, "cells or kinematic (default)");
  add_shape_options(*command, options->run.pair.shape);
  CLI::Option* const p_min = command
                                 ->add_option("--p-min", options->request.p_min,
                                              "probability from which on a pair of nodes counts, (0, 1]; 1: never")
                                 ->check(share_of_one());
  command->add_option("--k-min", options->request.k_min, "such pairs that end the query with an estimated hit, >= 1")
      ->check(whole_number(1, std::numeric_limits<std::uint32_t>::max()))
      ->needs(p_min);
  command->add_option("--contacts", options->request.max_contacts, "most contacts, 0 .. 8")->check(whole_number(0, 8));
  add_calibration_option(*command, options->run.pair.options.calibration_poses);
  command->add_flag("--polygon-free", options->request.polygon_free,
                    "judge leaves by probability, not by their triangles");
  command->add_flag("!--no-leaf-test", options->request.leaf_test,
                    "test triangles of leaves without testing their volumes first; not with --bv wide");
  command->add_option("--repeat", options->repeat, "run each query so often and take the median time, 1 .. 10000")
      ->check(whole_number(1, 10000));
  command->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace odds::tool
