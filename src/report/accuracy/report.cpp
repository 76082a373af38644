// Puts the files of a study into their directory, and reads them back.
#include "odds/report/accuracy/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <utility>

#include "report/accuracy/study_files.hpp"
#include "report/write_file.hpp"

namespace odds::report {
namespace {

namespace fs = std::filesystem;

/// A file as a shell reads it back; one like -x.obj as ./-x.obj, which no command takes for an option.
std::string quoted(const std::string& file) {
  std::string word = file.starts_with('-') ? "./" + file : file;
  const bool plain = !word.empty() && std::all_of(word.begin(), word.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || std::string_view("_-./:=,+").find(static_cast<char>(c)) != std::string_view::npos;
  });
  if (plain) return word;
  std::string text = "'";
  for (const char c : word) {
    if (c == '\'') {
      text += "'\\''";
    } else if (c != '\n' && c != '\r') {  // stands in a comment of one line
      text += c;
    }
  }
  return text + "'";
}

std::string worst_text(const Study& study, const WorstPose& worst, const std::string& file) {
  const PoseTruth& truth = study.poses[worst.pose];
  const Trial& trial = study.settings.trials[worst.trial];
  const Sample& sample = study.samples[worst.trial][worst.pose];
  return fmt::format(
             "# pose {}, {}; truth: {}; squared error of the probability, added over all limits: {:.4g}\n"
             "# at {}: {} with P = {}\n# to answer it again, where the study was run:\n# {}\n",
             truth.pose.index, pose_bands(study.settings.procedure)[truth.pose.band].name, truth.hit ? "hit" : "clear",
             worst.error, trial.label(), name(sample.verdict), sample.probability,
             replay_command(study.settings, trial, file)) +
         one_pose_csv(study, worst.pose);
}

std::optional<Error> write_worst(const fs::path& directory, const Study& study, AccuracyFiles& files) {
  std::error_code code;
  fs::create_directories(directory / "worst", code);
  if (code) return Error{(directory / "worst").string(), "", "cannot be made: " + code.message(), "give another --out"};
  std::size_t place = 0;
  for (const WorstPose& worst : worst_poses(study, most_worst_poses)) {
    files.worst.push_back(worst_file(directory, ++place));
    const std::string name = files.worst.back().string();
    if (auto error = write_file(files.worst.back(), worst_text(study, worst, name))) return error;
  }
  while (++place <= most_worst_poses) fs::remove(worst_file(directory, place), code);  // of an earlier study
  return std::nullopt;
}

/// Why a study cannot be merged with the first; nothing: it can.
std::optional<Error> unlike(const Study& study, const std::string& name, const Study& first,
                            const std::string& first_name) {
  StudySettings settings = study.settings;
  settings.checksum_a = first.settings.checksum_a;
  settings.checksum_b = first.settings.checksum_b;
  if (!(settings == first.settings) || study.shard.of != first.shard.of || study.version != first.version) {
    return Error{name, "", "is of another study than " + first_name,
                 "merge shards i/n of one n, with the same meshes, options and version"};
  }
  if (study.settings == first.settings) return std::nullopt;
  const bool is_a = study.settings.checksum_a != first.settings.checksum_a;
  return Error{name, "", "'" + (is_a ? settings.mesh_a : settings.mesh_b) + "' was another mesh than in " + first_name,
               "run all shards with the same files"};
}

Result<std::string> text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  if (file.bad() || !file.is_open()) {
    return Error{path.string(), "", "cannot be read", "give a folder as `odds accuracy --shard` wrote it"};
  }
  return text;
}

}  // namespace

fs::path worst_file(const fs::path& directory, std::size_t place) {
  return directory / "worst" / fmt::format("{:02}.csv", place);
}

std::string replay_command(const StudySettings& s, const Trial& trial, const std::string& file) {
  std::string text =
      fmt::format("odds query {} {} --poses {} --out - --bv {} --estimator {} --contacts {}", quoted(s.mesh_a),
                  quoted(s.mesh_b), quoted(file), s.bounding_volume, s.estimator, s.contacts);
  if (s.tau != query::ShapeOptions{}.tau) text += fmt::format(" --tau {}", s.tau);
  if (s.scale_a != 1.0) text += fmt::format(" --scale-a {}", s.scale_a);
  if (s.scale_b != 1.0) text += fmt::format(" --scale-b {}", s.scale_b);
  if (trial.kind == Trial::Kind::exact) return text + " --method exact";
  text += fmt::format(" {} {}", trial.kind == Trial::Kind::time ? "--budget-us" : "--work", trial.amount);
  if (s.calibration_poses > 0) text += fmt::format(" --calibrate {}", s.calibration_poses);
  if (trial.p_min < 1.0) text += fmt::format(" --p-min {} --k-min {}", trial.p_min, s.k_min);
  return text;
}

Result<AccuracyFiles> write_accuracy_report(const fs::path& directory, const Study& study,
                                            const std::vector<AccuracyRow>& rows) {
  std::error_code code;
  fs::create_directories(directory, code);
  if (code) return Error{directory.string(), "", "cannot be made: " + code.message(), "choose another directory"};
  AccuracyFiles files{directory / "accuracy.html", directory / "accuracy.csv", directory / "poses.csv",
                      directory / "answers.csv",   directory / "summary.json", {}};
  if (auto error = write_file(files.poses, poses_csv(study))) return *error;
  if (auto error = write_file(files.answers, answers_csv(study))) return *error;
  if (auto error = write_file(files.rows, rows_csv(study, rows))) return *error;
  if (auto error = write_worst(directory, study, files)) return *error;
  if (auto error = write_file(files.summary, study_json(study, rows))) return *error;
  if (auto error = write_file(files.page, accuracy_page(study, rows, directory))) return *error;
  return files;
}

Result<Study> read_study(const fs::path& directory) {
  const fs::path summary = directory / "summary.json";
  const Result<std::string> json = text_of(summary);
  if (!json.ok()) return json.error();
  Result<Study> study = read_study_json(summary.string(), json.value());
  if (!study.ok()) return study.error();
  const fs::path poses = directory / "poses.csv";
  const Result<std::string> poses_text = text_of(poses);
  if (!poses_text.ok()) return poses_text.error();
  if (auto error = read_poses_csv(poses.string(), poses_text.value(), study.value())) return *error;
  const fs::path answers = directory / "answers.csv";
  const Result<std::string> answers_text = text_of(answers);
  if (!answers_text.ok()) return answers_text.error();
  if (auto error = read_answers_csv(answers.string(), answers_text.value(), study.value())) return *error;
  return study;
}

Result<Study> merge_studies(std::vector<Study> studies, const std::vector<std::string>& names) {
  if (studies.empty()) return Error{"", "", "there is no study to merge", "name the folders of all shards"};
  const std::uint64_t shards = studies.front().shard.of;
  std::vector<std::size_t> place(shards, studies.size());
  for (std::size_t i = 0; i < studies.size(); ++i) {
    const Study& study = studies[i];
    if (auto error = unlike(study, names[i], studies.front(), names.front())) return *std::move(error);
    if (place[study.shard.number] != studies.size()) {
      return Error{
          names[i], "",
          fmt::format("is shard {}/{}, as is {}", study.shard.number, shards, names[place[study.shard.number]]),
          "name each shard once"};
    }
    place[study.shard.number] = i;
  }
  const auto missing = std::find(place.begin(), place.end(), studies.size());
  if (missing != place.end()) {
    return Error{"", "", fmt::format("shard {}/{} is missing", missing - place.begin(), shards),
                 "run it with --shard, then merge all"};
  }
  Study merged;
  merged.settings = studies.front().settings;
  merged.version = studies.front().version;
  merged.started_epoch_s = studies.front().started_epoch_s;
  merged.samples.resize(merged.settings.trials.size());
  for (const Study& study : studies) {
    merged.started_epoch_s = std::min(merged.started_epoch_s, study.started_epoch_s);
    // The note says why a machine is unfit: of the first such one, if there is any.
    if (merged.machine_note.empty() || (merged.machine_fit && !study.machine_fit)) {
      merged.machine_note = study.machine_note;
    }
    merged.machine_fit = merged.machine_fit && study.machine_fit;
  }
  for (std::uint64_t index = 0; index < merged.settings.pose_count(); ++index) {
    const Study& study = studies[place[index % shards]];
    const std::size_t row = index / shards;
    merged.poses.push_back(study.poses[row]);
    for (std::size_t t = 0; t < merged.samples.size(); ++t) merged.samples[t].push_back(study.samples[t][row]);
  }
  return merged;
}

}  // namespace odds::report
