// Reads a study's tables back.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <type_traits>
#include <utility>

#include "report/accuracy/study_files.hpp"

namespace odds::report {
namespace {

constexpr const char* remedy = "give a folder as `odds accuracy --shard` wrote it";

/// Goes through the lines after the heading and takes their fields one after another; remembers the first fault.
class Fields {
 public:
  Fields(const std::string& file, const std::string& text) : file_(file), rest_(text) { (void)next_line(); }

  [[nodiscard]] bool next_line() {
    if (error_ || rest_.empty()) return false;
    ++number_;
    const std::size_t end = rest_.find('\n');
    if (end == std::string_view::npos) {
      fail("the line is cut off");
      return false;
    }
    line_ = rest_.substr(0, end);
    rest_.remove_prefix(end + 1);
    return true;
  }

  [[nodiscard]] std::string_view word() {
    const std::size_t comma = line_.find(',');
    const std::string_view field = line_.substr(0, comma);
    line_.remove_prefix(comma == std::string_view::npos ? line_.size() : comma + 1);
    return field;
  }

  template <class Number>
  [[nodiscard]] Number number() {
    const std::string_view field = word();
    Number value{};
    const auto end = std::from_chars(field.data(), field.data() + field.size(), value);
    bool good = end.ec == std::errc{} && end.ptr == field.data() + field.size();
    if constexpr (std::is_floating_point_v<Number>) good = good && std::isfinite(value);
    if (!good) fail_on(field, "is not a number that can be used");
    return value;
  }
  [[nodiscard]] Vec3 vector() {
    const double x = number<double>();
    const double y = number<double>();
    return {x, y, number<double>()};
  }
  [[nodiscard]] bool next_is_empty() const { return line_.empty() || line_.front() == ','; }
  /// Nothing but empty fields may be left of the line.
  void finish_line() {
    if (line_.find_first_not_of(',') != std::string_view::npos) fail_on(line_, "is more than the columns hold");
  }

  void fail(std::string what) {
    if (!error_) error_ = Error{file_, std::to_string(number_), std::move(what), remedy};
  }
  void fail_on(std::string_view field, std::string_view what) {
    std::string text("'");
    text.append(field).append("' ").append(what);
    fail(std::move(text));
  }
  [[nodiscard]] const std::optional<Error>& error() const { return error_; }

 private:
  const std::string& file_;
  std::string_view rest_;
  std::string_view line_;
  std::size_t number_ = 0;
  std::optional<Error> error_;
};

std::optional<query::Basis> basis_of(std::string_view word) {
  for (const query::Basis basis : {query::Basis::proved, query::Basis::estimated, query::Basis::budget}) {
    if (word == name(basis)) return basis;
  }
  return std::nullopt;
}

PoseTruth read_pose(Fields& fields, Procedure procedure) {
  PoseTruth truth;
  truth.pose.index = fields.number<std::uint64_t>();
  const auto bands = pose_bands(procedure);
  const std::string_view name = fields.word();
  const auto band = std::find_if(bands.begin(), bands.end(), [&](const PoseBand& b) { return b.name == name; });
  if (band == bands.end()) fields.fail_on(name, "is no band of this procedure");
  truth.pose.band = band == bands.end() ? 0 : static_cast<std::uint32_t>(band - bands.begin());
  truth.pose.offset = fields.number<double>();
  truth.pose.translation = fields.vector();
  truth.pose.rotation.w() = fields.number<double>();
  truth.pose.rotation.vec() = fields.vector();
  if (!(std::abs(truth.pose.rotation.coeffs().stableNorm() - 1.0) <= 1e-3))
    fields.fail("the quaternion is no rotation");
  const int hit = fields.number<int>();
  if (hit != 0 && hit != 1) fields.fail("'hit' is neither 0 nor 1");
  truth.hit = hit == 1;
  truth.contacts = fields.number<std::uint32_t>();
  if (truth.contacts == 0) return truth;
  truth.deepest_contact.position = fields.vector();
  truth.deepest_contact.normal = fields.vector();
  truth.deepest_contact.depth = fields.number<double>();
  return truth;
}

Sample read_sample(Fields& fields) {
  Sample sample;
  const std::string_view verdict = fields.word();
  sample.verdict = verdict == name(query::Verdict::hit) ? query::Verdict::hit : query::Verdict::clear;
  if (verdict != name(sample.verdict)) fields.fail_on(verdict, "is no verdict");
  const std::optional<query::Basis> basis = basis_of(fields.word());
  if (!basis) fields.fail("the basis is neither proved nor estimated nor budget");
  sample.basis = basis.value_or(query::Basis::budget);
  sample.probability = fields.number<double>();
  if (!(sample.probability >= 0.0 && sample.probability <= 1.0)) fields.fail("the probability is not in [0, 1]");
  sample.node_pairs = fields.number<std::uint64_t>();
  sample.triangle_pairs = fields.number<std::uint64_t>();
  sample.wall_us = fields.number<double>();
  sample.stall_us = fields.number<double>();
  sample.net_overshoot_us = fields.number<double>();
  if (fields.next_is_empty()) {
    for (int i = 0; i < 3; ++i) (void)fields.word();
  } else {
    sample.contact.emplace();
    sample.contact->position = fields.number<double>();
    sample.contact->normal_deg = fields.number<double>();
    sample.contact->depth = fields.number<double>();
  }
  sample.push = fields.vector();
  return sample;
}

}  // namespace

std::optional<Error> read_poses_csv(const std::string& file, const std::string& text, Study& study) {
  Fields fields(file, text);
  while (fields.next_line()) {
    const std::uint64_t expected = study.shard.number + study.poses.size() * study.shard.of;
    study.poses.push_back(read_pose(fields, study.settings.procedure));
    fields.finish_line();
    if (study.poses.back().pose.index != expected) fields.fail_on(std::to_string(expected), "is the pose due here");
  }
  if (fields.error()) return fields.error();
  const std::uint64_t all = study.settings.pose_count();
  const std::uint64_t due = (all - std::min(all, study.shard.number) + study.shard.of - 1) / study.shard.of;
  if (study.poses.size() == due) return std::nullopt;
  return Error{file, "", std::to_string(study.poses.size()) + " poses instead of " + std::to_string(due), remedy};
}

std::optional<Error> read_answers_csv(const std::string& file, const std::string& text, Study& study) {
  Fields fields(file, text);
  study.samples.assign(study.settings.trials.size(), {});
  std::size_t trial = 0;
  while (fields.next_line()) {
    while (trial < study.samples.size() && study.samples[trial].size() == study.poses.size()) ++trial;
    if (trial == study.samples.size()) {
      fields.fail("there are more answers than poses and limits");
      break;
    }
    auto& samples = study.samples[trial];
    if (fields.number<std::uint64_t>() != study.poses[samples.size()].pose.index) fields.fail("another pose is due");
    const Trial& due = study.settings.trials[trial];
    const bool is_due = fields.word() == name(due.kind) && fields.number<double>() == due.amount &&
                        fields.number<double>() == due.p_min;
    if (!is_due) fields.fail("another limit is due");
    samples.push_back(read_sample(fields));
    fields.finish_line();
  }
  if (fields.error()) return fields.error();
  for (const auto& samples : study.samples) {
    if (samples.size() != study.poses.size()) return Error{file, "", "answers are missing", remedy};
  }
  return std::nullopt;
}

}  // namespace odds::report
