// `odds accuracy A B --out DIR`: what accuracy costs in time.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "odds/realtime/fitness.hpp"
#include "odds/report/accuracy/report.hpp"
#include "tool/accuracy_study.hpp"
#include "tool/accuracy_table.hpp"
#include "tool/command.hpp"
#include "tool/output_folder.hpp"
#include "tool/progress_line.hpp"
#include "tool/shape_argument.hpp"
#include "tool/shared_options.hpp"
#include "tree/checksum.hpp"

namespace odds::tool {
namespace {

using report::Trial;

struct AccuracyOptions {
  std::string mesh_a;
  std::string mesh_b;
  double scale_a = 1.0;
  double scale_b = 1.0;
  std::string out;
  ShapeWish shape;
  query::EstimatorKind estimator = query::EstimatorKind::kinematic;
  report::Procedure procedure = report::Procedure::distance;
  std::string budgets_us = "1,2,5,10,20,50,100";
  std::string work = "64,128,256,512,1024";
  std::string p_min = "1";
  std::uint32_t k_min = 10;
  int contacts = 1;
  std::uint64_t poses = 500;
  std::uint32_t calibration_poses = 0;
  std::uint64_t seed = 1;
  std::string shard = "0/1";
  std::vector<std::string> merge;
};

/// Numbers between commas, or "none". Empty text: not such a list, or out of range.
std::vector<double> numbers_in(const std::string& list) {
  std::vector<double> numbers;
  if (list == "none") return numbers;
  const char* at = list.data();
  const char* const end = list.data() + list.size();
  while (at != end) {
    double number = 0.0;
    const auto read = std::from_chars(at, end, number);
    if (read.ec != std::errc{} || (read.ptr != end && *read.ptr != ',') || read.ptr + 1 == end) return {};
    numbers.push_back(number);
    at = read.ptr == end ? end : read.ptr + 1;
  }
  return numbers;
}

/// A list of numbers in (0, greatest], whole ones if `whole`, none twice; "none" only if it may be empty.
CLI::Validator number_list(double greatest, bool whole, bool may_be_none) {
  return CLI::Validator(
      [=](const std::string& text) {
        std::vector<double> numbers = numbers_in(text);
        bool good = !numbers.empty() || (may_be_none && text == "none");
        for (const double x : numbers) good = good && x > 0.0 && x <= greatest && (!whole || x == std::floor(x));
        std::sort(numbers.begin(), numbers.end());
        good = good && std::adjacent_find(numbers.begin(), numbers.end()) == numbers.end();
        if (good) return std::string();
        return fmt::format("{} is not a list like 1,2,5 of {}numbers > 0 and <= {}, each once{}", text,
                           whole ? "whole " : "", greatest, may_be_none ? ", nor \"none\"" : "");
      },
      "");
}

bool read_shard(const std::string& text, report::Shard& shard) {
  const std::size_t slash = text.find('/');
  if (slash == std::string::npos) return false;
  const auto number = [](std::string_view part, std::uint64_t& value) {
    const auto end = std::from_chars(part.data(), part.data() + part.size(), value);
    return end.ec == std::errc{} && end.ptr == part.data() + part.size();
  };
  const std::string_view whole(text);
  return number(whole.substr(0, slash), shard.number) && number(whole.substr(slash + 1), shard.of) && shard.of >= 1 &&
         shard.of <= report::most_shards && shard.number < shard.of;
}

std::vector<Trial> trials_of(const AccuracyOptions& options) {
  std::vector<Trial> trials;
  std::vector<double> thresholds = numbers_in(options.p_min);
  std::sort(thresholds.rbegin(), thresholds.rend());
  for (const double p_min : thresholds) {
    for (const auto& [kind, list] :
         {std::pair{Trial::Kind::time, options.budgets_us}, std::pair{Trial::Kind::work, options.work}}) {
      std::vector<double> amounts = numbers_in(list);
      std::sort(amounts.begin(), amounts.end());
      for (const double amount : amounts) trials.push_back({kind, amount, p_min});
    }
  }
  trials.push_back({Trial::Kind::exact, 0.0, 1.0});
  return trials;
}

/// The shape as asked for, and that of the wide engine; one and the same if that was asked for.
std::optional<Error> load_both(const std::string& argument, double scale, const ShapeWish& wish,
                               std::shared_ptr<const query::Shape>& asked, std::shared_ptr<const query::Shape>& wide) {
  const auto loaded = load_shape(argument, scale, wish);
  if (!loaded.ok()) return loaded.error();
  asked = wide = loaded.value();
  if (auto error = refuse_polygon_free(*asked, argument)) return error;
  if (asked->volume() == volume::Kind::wide) return std::nullopt;
  // The mesh lives as long as the shape that holds it.
  const std::shared_ptr<const mesh::TriangleMesh> mesh(asked, &asked->mesh());
  ProgressLine progress("building " + mesh->name());
  const auto built = query::Shape::build(mesh, {}, [&](double share) { progress.show(share); });
  if (!built.ok()) return built.error();
  wide = built.value();
  return std::nullopt;
}

Result<StudyShapes> prepare(const AccuracyOptions& options) {
  StudyShapes shapes;
  if (auto error = load_both(options.mesh_a, options.scale_a, options.shape, shapes.a, shapes.wide_a)) return *error;
  if (options.mesh_a == options.mesh_b && options.scale_a == options.scale_b) {
    shapes.b = shapes.a;
    shapes.wide_b = shapes.wide_a;
    return shapes;
  }
  if (auto error = load_both(options.mesh_b, options.scale_b, options.shape, shapes.b, shapes.wide_b)) return *error;
  return shapes;
}

std::string checksum_of(const mesh::TriangleMesh& mesh) {
  return fmt::format("{:016x}{:016x}", tree::checksum(std::as_bytes(mesh.vertices())),
                     tree::checksum(std::as_bytes(mesh.triangles())));
}

Result<report::Study> measure(const AccuracyOptions& options) {
  const Result<StudyShapes> shapes = prepare(options);
  if (!shapes.ok()) return shapes.error();
  report::Study study;
  study.version = ODDS_VERSION;
  const std::chrono::duration<double> epoch = std::chrono::system_clock::now().time_since_epoch();
  study.started_epoch_s = epoch.count();
  (void)read_shard(options.shard, study.shard);
  report::StudySettings& s = study.settings;
  s.mesh_a = options.mesh_a;
  s.mesh_b = options.mesh_b;
  s.scale_a = options.scale_a;
  s.scale_b = options.scale_b;
  s.triangles_a = shapes.value().a->mesh().triangles().size();
  s.triangles_b = shapes.value().b->mesh().triangles().size();
  s.checksum_a = checksum_of(shapes.value().a->mesh());
  s.checksum_b = checksum_of(shapes.value().b->mesh());
  s.bounding_volume = volume::name(shapes.value().a->volume());
  s.tau = shapes.value().a->options().tau;
  s.estimator = options.estimator == query::EstimatorKind::cells ? "cells" : "kinematic";
  s.k_min = options.k_min;
  s.contacts = options.contacts;
  s.procedure = options.procedure;
  s.seed = options.seed;
  s.poses_per_band = options.poses;
  s.calibration_poses = options.calibration_poses;
  s.trials = trials_of(options);
  const realtime::Fitness fitness = realtime::probe_fitness();
  study.machine_fit = fitness.fit;
  study.machine_note = fitness.reason;
  if (auto error = carry_out(shapes.value(), options.estimator, study)) return *error;
  return study;
}

Result<report::Study> merge(const std::vector<std::string>& folders) {
  std::vector<report::Study> studies;
  ProgressLine progress("reading");
  for (const std::string& folder : folders) {
    Result<report::Study> study = report::read_study(folder);
    if (!study.ok()) return study.error();
    studies.push_back(std::move(study).value());
    progress.show(static_cast<double>(studies.size()) / static_cast<double>(folders.size()));
  }
  return report::merge_studies(std::move(studies), folders);
}

std::optional<Error> refuse_shard_as_output(const AccuracyOptions& options) {
  for (const std::string& folder : options.merge) {
    std::error_code unknown;
    if (!std::filesystem::equivalent(options.out, folder, unknown) || unknown) continue;
    return Error{options.out, "", "is also a shard to merge, which would be overwritten", "give another --out"};
  }
  return std::nullopt;
}

int run(const AccuracyOptions& options) {
  if (const auto error = refuse_shard_as_output(options)) return fail(*error);
  if (const auto error = prepare_folder(options.out, {"worst"})) return fail(*error);
  const Result<report::Study> study = options.merge.empty() ? measure(options) : merge(options.merge);
  if (!study.ok()) return fail(study.error());
  const std::vector<report::AccuracyRow> rows = report::accuracy_rows(study.value());
  const auto files = report::write_accuracy_report(options.out, study.value(), rows);
  if (!files.ok()) return fail(files.error());
  fmt::print("{}", accuracy_table(study.value(), rows));
  fmt::print("page: {}\n", files.value().page.string());
  return exit_good;
}

/// What the parser cannot say by itself.
void check_usage(const CLI::App& command, const AccuracyOptions& options) {
  if (options.merge.empty() && options.mesh_b.empty()) throw CLI::RequiredError("A and B, or --merge,");
  if (!options.merge.empty() && !options.mesh_a.empty()) {
    throw CLI::ValidationError("--merge", "the meshes are those of the shards; name none");
  }
  for (const CLI::Option* option : command.get_options()) {
    const std::string name = option->get_name();
    if (options.merge.empty() || option->count() == 0 || name == "--merge" || name == "--out") continue;
    throw CLI::ValidationError("--merge", "nothing is measured, so " + name + " changes nothing; leave it out");
  }
  if (options.budgets_us == "none" && options.work == "none") {
    throw CLI::ValidationError("--budgets-us", "no limit is left: give microseconds, work units or both");
  }
}

void add_limits(CLI::App& command, AccuracyOptions& options) {
  command.add_option("--budgets-us", options.budgets_us, "microseconds for one query, a list; none for none")
      ->capture_default_str()
      ->check(number_list(1e6, false, true));
  command.add_option("--work", options.work, "work units for one query, a list: repeatable bit for bit; none for none")
      ->capture_default_str()
      ->check(number_list(1e9, true, true));
  CLI::Option* const p_min =
      command.add_option("--p-min", options.p_min, "probabilities that stop a query, a list, (0, 1]; 1: never")
          ->capture_default_str()
          ->check(number_list(1.0, false, false));
  command.add_option("--k-min", options.k_min, "pairs of nodes with such a probability that stop a query, >= 1")
      ->capture_default_str()
      ->check(whole_number(1, std::numeric_limits<std::uint32_t>::max()))
      ->needs(p_min);
  add_calibration_option(command, options.calibration_poses);
  command.add_option("--contacts", options.contacts, "most contacts of an answer, 0 .. 8")
      ->capture_default_str()
      ->check(whole_number(0, 8));
}

void add_poses(CLI::App& command, AccuracyOptions& options) {
  command.add_option("--poses", options.poses, "poses for each distance, 1 .. 10000000")
      ->capture_default_str()
      ->check(whole_number(1, report::most_poses_per_band));
  std::map<std::string, report::Procedure> procedures;
  for (const report::Procedure procedure : report::procedures) procedures.emplace(name(procedure), procedure);
  add_choice(command, "--procedure", options.procedure, procedures,
             "distance (default): any direction, fixed surface distances; tumbling: about z, along x; nested: B in A");
  command.add_option("--seed", options.seed, "of the poses' random numbers")
      ->capture_default_str()
      ->check(whole_number(0, std::numeric_limits<std::uint64_t>::max()));
  command.add_option("--shard", options.shard, "i/n: poses i, i + n, i + 2n, ... only, to be merged later")
      ->capture_default_str()
      ->check(CLI::Validator(
          [](const std::string& text) {
            report::Shard shard;
            return read_shard(text, shard) ? std::string() : text + " is not i/n with 0 <= i < n";
          },
          ""));
}

}  // namespace

void add_accuracy(CLI::App& app, Action& action) {
  const auto options = std::make_shared<AccuracyOptions>();
  CLI::App* command = app.add_subcommand(
      "accuracy", "Measure what accuracy costs in time: wrong answers, proofs, contact errors, by limit and distance");
  command->add_option("A", options->mesh_a, shape_argument_help());
  command->add_option("B", options->mesh_b, "as A");
  command->add_option("--out", options->out, "directory for the page, the tables and the worst poses")->required();
  add_limits(*command, *options);
  add_poses(*command, *options);
  const std::map<std::string, query::EstimatorKind> estimators = {{"cells", query::EstimatorKind::cells},
                                                                  {"kinematic", query::EstimatorKind::kinematic}};
  add_choice(*command, "--estimator", options->estimator, estimators, "cells or kinematic (default)");
  add_shape_options(*command, options->shape);
  command->add_option("--scale-a", options->scale_a, "metres per unit of A's file")->check(positive_and_finite());
  command->add_option("--scale-b", options->scale_b, "metres per unit of B's file")->check(positive_and_finite());
  command->add_option("--merge", options->merge,
                      "folders of all shards of a study: one report of them, nothing measured");
  command->callback([options, command, &action] {
    check_usage(*command, *options);
    action = [options] { return run(*options); };
  });
}

}  // namespace odds::tool
