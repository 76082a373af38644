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
#include "tool/mesh_argument.hpp"
#include "tool/output_file.hpp"
#include "tool/pair_argument.hpp"
#include "tool/poses_csv.hpp"
#include "tool/progress_line.hpp"
#include "tool/shared_options.hpp"

namespace odds::tool {
namespace {

struct QueryOptions {
  PairArgument pair;
  std::string poses;
  std::string out;
  query::Request request;
  double budget_us = 0.0;  ///< 0: not given
  std::uint64_t work = 0;  ///< 0: not given
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
  const Result<std::vector<math::Pose>> poses = read_poses(options.poses);
  if (!poses.ok()) return fail(poses.error());
  if (const auto error = refuse_overwriting(options.out, {options.poses, options.pair.mesh_a, options.pair.mesh_b})) {
    return fail(*error);
  }
  Result<OutputFile> out = OutputFile::open(options.out);
  if (!out.ok()) return fail(out.error());
  Result<query::Pair> pair = make_pair(options.pair);
  if (!pair.ok()) return fail(pair.error());

  query::Request request = options.request;
  if (options.budget_us > 0.0) request.budget.microseconds = options.budget_us;
  if (options.work > 0) request.budget.work_units = options.work;
  std::vector<AnswerRecord> records;
  records.reserve(poses.value().size());
  {
    ProgressLine progress("querying");
    Session session(pair.value(), poses.value(), request, options.repeat);
    for (std::size_t row = 0; row < poses.value().size(); ++row) {
      records.push_back(session.answer(row));
      if (row % 64 == 0) progress.show(static_cast<double>(row) / static_cast<double>(poses.value().size()));
    }
  }
  out.value().write(answers_header);
  for (std::size_t row = 0; row < records.size(); ++row) out.value().write(answer_line(row, records[row]));
  if (const auto error = out.value().commit()) return fail(*error);
  const std::string table = answer_table(records, options.budget_us > 0.0);
  fmt::print(out.value().is_standard_output() ? stderr : stdout, "{}", table);
  return exit_good;
}

}  // namespace

void add_query(CLI::App& app, Action& action) {
  const auto options = std::make_shared<QueryOptions>();
  CLI::App* command = app.add_subcommand("query", "Answer whether A and B meet, for each pose of B in A's frame");
  command->add_option("A", options->pair.mesh_a, "mesh: " + mesh_argument_help())->required();
  command->add_option("B", options->pair.mesh_b, "mesh, as A")->required();
  command->add_option("--poses", options->poses, "CSV with columns x,y,z (metres), qw,qx,qy,qz: pose of B in A's frame")
      ->required();
  command->add_option("--out", options->out, "CSV of answers, rows counted from 0 as the poses; - for standard output")
      ->required();
  const std::map<std::string, query::Method> methods = {{"exact", query::Method::exact},
                                                        {"incremental", query::Method::incremental},
                                                        {"time-critical", query::Method::time_critical}};
  add_choice(*command, "--method", options->request.method, methods, "exact, incremental or time-critical (default)");
  const std::map<std::string, query::EstimatorKind> estimators = {{"cells", query::EstimatorKind::cells},
                                                                  {"kinematic", query::EstimatorKind::kinematic}};
  add_choice(*command, "--estimator", options->request.estimator, estimators, "cells or kinematic (default)");
  add_shape_options(*command, options->pair.shape);
  CLI::Option* budget = command->add_option("--budget-us", options->budget_us, "microseconds for one query, > 0");
  budget->check(positive_and_finite());
  command->add_option("--work", options->work, "work units for one query, > 0: repeatable bit for bit")
      ->check(whole_number(1, std::numeric_limits<std::uint64_t>::max()))
      ->excludes(budget);
  command
      ->add_option("--p-min", options->request.p_min,
                   "probability from which on a pair of nodes counts, (0, 1]; 1: never")
      ->check(share_of_one());
  command->add_option("--k-min", options->request.k_min, "such pairs that end the query with an estimated hit, >= 1")
      ->check(whole_number(1, std::numeric_limits<std::uint32_t>::max()));
  command->add_option("--contacts", options->request.max_contacts, "most contacts, 0 .. 8")->check(whole_number(0, 8));
  command->add_flag("--polygon-free", options->request.polygon_free,
                    "judge leaves by probability, not by their triangles");
  command->add_option("--repeat", options->repeat, "run each query so often and take the median time, 1 .. 10000")
      ->check(whole_number(1, 10000));
  command->add_option("--scale-a", options->pair.scale_a, "metres per unit of A's file")->check(positive_and_finite());
  command->add_option("--scale-b", options->pair.scale_b, "metres per unit of B's file")->check(positive_and_finite());
  command->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace odds::tool
