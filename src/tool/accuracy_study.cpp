// Poses, truth, answers.
#include "tool/accuracy_study.hpp"

#include <optional>
#include <utility>
#include <vector>

#include "odds/realtime/clock.hpp"
#include "odds/report/accuracy/contact_region.hpp"
#include "tool/progress_line.hpp"

namespace odds::tool {
namespace {

using query::Contact;
using query::Verdict;
using report::PoseTruth;
using report::Sample;
using report::Study;
using report::Trial;

constexpr int most_true_contacts = 8;

/// What a caller would push with, if the answer has it: of trial t and pose i at [t][i].
using GivenContacts = std::vector<std::vector<std::optional<Contact>>>;

std::optional<Error> make_poses(const StudyShapes& shapes, Study& study) {
  auto maker = report::PoseMaker::make(shapes.wide_a, shapes.wide_b, study.settings.procedure, study.settings.seed);
  if (!maker.ok()) return maker.error();
  study.settings.size_m = maker.value().size();
  const std::uint64_t count = study.settings.pose_count();
  ProgressLine progress("making poses");
  for (std::uint64_t index = study.shard.number; index < count; index += study.shard.of) {
    const auto made = maker.value().pose(index);
    if (!made.ok()) return made.error();
    PoseTruth truth;
    truth.pose = made.value();
    study.poses.push_back(truth);
    progress.show(static_cast<double>(index) / static_cast<double>(count));
  }
  return std::nullopt;
}

query::Request request_of(const Trial& trial, const report::StudySettings& settings, query::EstimatorKind estimator) {
  query::Request request;
  request.estimator = estimator;
  request.max_contacts = settings.contacts;
  request.p_min = trial.p_min;
  request.k_min = settings.k_min;
  if (trial.kind == Trial::Kind::exact) request.method = query::Method::exact;
  if (trial.kind == Trial::Kind::time) request.budget.microseconds = trial.amount;
  if (trial.kind == Trial::Kind::work) request.budget.work_units = static_cast<std::uint64_t>(trial.amount);
  return request;
}

/// What a caller would push with: the first contact, or the place where the surfaces most probably meet, whose depth is
/// an expectation, so that the verdict does not matter.
std::optional<Contact> contact_of(const query::Answer& answer) {
  if (!answer.contacts.empty()) return answer.contacts.front();
  if (answer.has_cell_pair) return answer.cell_pair;
  return std::nullopt;
}

Sample sample_of(const query::Answer& answer, double wall_us) {
  Sample sample;
  sample.verdict = answer.verdict;
  sample.basis = answer.basis;
  sample.probability = answer.probability;
  sample.node_pairs = answer.cost.node_pairs;
  sample.triangle_pairs = answer.cost.triangle_pairs;
  sample.wall_us = wall_us;
  sample.stall_us = answer.cost.stall_us;
  sample.net_overshoot_us = answer.cost.net_overshoot_us;
  if (const auto given = contact_of(answer)) sample.push = given->depth * given->normal;
  return sample;
}

/// Once through all poses within the first limit, and nothing is noted: it would else be the only one to find caches
/// empty and a pair that has yet to learn how long its endings take, and look worse than those after it.
void warm_up(const query::Request& first, const Study& study, query::Pair& pair) {
  for (const PoseTruth& truth : study.poses) {
    pair.reset();
    (void)pair.run(truth.pose.pose(), first);
  }
}

/// Answers every pose under every limit.
std::optional<Error> answer_all(const StudyShapes& shapes, query::EstimatorKind estimator, Study& study,
                                GivenContacts& given) {
  query::PairOptions pair_options;
  pair_options.calibration_poses = study.settings.calibration_poses;
  auto made = query::Pair::make(shapes.a, shapes.b, pair_options);
  if (!made.ok()) return made.error();
  query::Pair& pair = made.value();
  const realtime::Clock clock = realtime::fastest_clock();
  ProgressLine progress("answering");
  const std::size_t trials = study.settings.trials.size();
  study.samples.resize(trials);
  given.resize(trials);
  for (std::size_t t = 0; t < trials; ++t) {
    const query::Request request = request_of(study.settings.trials[t], study.settings, estimator);
    if (t == 0) warm_up(request, study, pair);
    for (std::size_t i = 0; i < study.poses.size(); ++i) {
      const math::Pose pose = study.poses[i].pose.pose();
      if (i == 0) (void)pair.run(pose, request);  // touches this limit's code once
      pair.reset();                               // each query stands alone
      const std::int64_t begin = clock();
      const query::Answer& answer = pair.run(pose, request);
      const std::int64_t end = clock();
      study.samples[t].push_back(sample_of(answer, 1e-3 * static_cast<double>(end - begin)));
      given[t].push_back(contact_of(answer));
      if (i % 64 == 0) {
        progress.show((static_cast<double>(t) + static_cast<double>(i) / static_cast<double>(study.poses.size())) /
                      static_cast<double>(trials));
      }
    }
  }
  return std::nullopt;
}

/// Proves what is true in each pose, and judges all contacts that were given there by it.
std::optional<Error> find_truth(const StudyShapes& shapes, const GivenContacts& given, Study& study) {
  query::PairOptions options;
  options.hit_capacity = 65536;
  auto pair = query::Pair::make(shapes.wide_a, shapes.wide_b, options);
  if (!pair.ok()) return pair.error();
  query::Request request;
  request.method = query::Method::exact;
  request.max_contacts = most_true_contacts;
  ProgressLine progress("finding the truth");
  for (std::size_t i = 0; i < study.poses.size(); ++i) {
    PoseTruth& truth = study.poses[i];
    const math::Pose pose = truth.pose.pose();
    pair.value().reset();
    const query::Answer& answer = pair.value().run(pose, request);
    truth.hit = answer.verdict == Verdict::hit;
    truth.contacts = static_cast<std::uint32_t>(answer.contacts.size());
    if (truth.contacts > 0) {
      truth.deepest_contact = answer.contacts.front();
      const report::ContactRegion region(*shapes.wide_a, *shapes.wide_b, pose, pair.value().crossings());
      for (std::size_t t = 0; t < given.size(); ++t) {
        if (!given[t][i]) continue;
        study.samples[t][i].contact =
            report::contact_error(*given[t][i], answer.contacts, region, study.settings.size_m);
      }
    }
    progress.show(static_cast<double>(i + 1) / static_cast<double>(study.poses.size()));
  }
  return std::nullopt;
}

}  // namespace

std::optional<Error> carry_out(const StudyShapes& shapes, query::EstimatorKind estimator, Study& study) {
  GivenContacts given;
  if (auto error = make_poses(shapes, study)) return error;
  if (auto error = answer_all(shapes, estimator, study, given)) return error;
  return find_truth(shapes, given, study);
}

}  // namespace odds::tool
