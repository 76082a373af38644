// From answers to figures.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "odds/report/accuracy/study.hpp"

namespace odds::report {
namespace {

/// Nearest rank; `values` ascending and not empty.
double at_share(std::span<const double> values, double share) {
  const double rank = std::ceil(share * static_cast<double>(values.size()) - 1e-9);
  return values[std::min(values.size() - 1, static_cast<std::size_t>(std::max(1.0, rank)) - 1)];
}

Tail tail_of(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  return {values.size(), at_share(values, 0.5), at_share(values, 0.99), at_share(values, 0.999), values.back()};
}

ContactFigures figures_of(const std::vector<ContactError>& errors) {
  ContactFigures figures;
  figures.count = errors.size();
  if (errors.empty()) return figures;
  for (double ContactError::*part : {&ContactError::position, &ContactError::normal_deg, &ContactError::depth}) {
    std::vector<double> values;
    for (const ContactError& error : errors) values.push_back(error.*part);
    std::sort(values.begin(), values.end());
    figures.p50.*part = at_share(values, 0.5);
    figures.p90.*part = at_share(values, 0.9);
  }
  return figures;
}

/// Length of the way that a pose's push takes from nothing over all limits of one kind to the truth.
double way_of_push(const Study& study, Trial::Kind kind, std::size_t pose) {
  Vec3 last = Vec3::Zero();
  double way = 0.0;
  for (std::size_t t = 0; t < study.settings.trials.size(); ++t) {
    const Trial& trial = study.settings.trials[t];
    if (trial.kind != kind || trial.p_min < 1.0) continue;
    way += (study.samples[t][pose].push - last).norm();
    last = study.samples[t][pose].push;
  }
  const query::Contact& truth = study.poses[pose].deepest_contact;
  return way + (truth.depth * truth.normal - last).norm();
}

template <class Chosen>
AccuracyRow row_of(const Study& study, std::size_t trial, const Chosen& chosen) {
  AccuracyRow row;
  row.trial = trial;
  std::vector<Forecast> unproved;
  std::vector<double> wall;
  std::vector<double> overshoot;
  std::vector<ContactError> contacts;
  std::vector<ContactError> fallbacks;
  double squares = 0.0;
  for (std::size_t i = 0; i < study.poses.size(); ++i) {
    if (!chosen(study.poses[i].pose.band)) continue;
    const bool truth = study.poses[i].hit;
    const Sample& sample = study.samples[trial][i];
    const bool said = sample.verdict == query::Verdict::hit;
    ++row.poses;
    row.hits += truth ? 1 : 0;
    row.false_hits += said && !truth ? 1 : 0;
    row.false_misses += !said && truth ? 1 : 0;
    row.proved += sample.basis == query::Basis::proved ? 1 : 0;
    row.estimated += sample.basis == query::Basis::estimated ? 1 : 0;
    row.at_budget += sample.basis == query::Basis::budget ? 1 : 0;
    const double off = sample.probability - (truth ? 1.0 : 0.0);
    squares += off * off;
    if (sample.basis != query::Basis::proved) unproved.push_back({sample.probability, truth});
    wall.push_back(sample.wall_us);
    overshoot.push_back(sample.net_overshoot_us);
    if (!sample.contact) continue;
    contacts.push_back(*sample.contact);
    if (sample.basis != query::Basis::proved) fallbacks.push_back(*sample.contact);
  }
  row.unproved = judge_forecasts(unproved);
  if (row.poses > 0) row.brier_all = squares / static_cast<double>(row.poses);
  row.wall_us = tail_of(std::move(wall));
  if (study.settings.trials[trial].kind == Trial::Kind::time) row.net_overshoot_us = tail_of(std::move(overshoot));
  row.contact = figures_of(contacts);
  row.fallback = figures_of(fallbacks);
  return row;
}

void add_row(std::vector<AccuracyRow>& rows, AccuracyRow row, std::string scope, std::string band) {
  if (row.poses == 0) return;
  row.scope = std::move(scope);
  row.band = std::move(band);
  rows.push_back(std::move(row));
}

}  // namespace

std::string Trial::label() const {
  if (kind == Kind::exact) return "exact";
  std::string text = fmt::format("{} {}", amount, kind == Kind::time ? "us" : "units");
  if (p_min < 1.0) text += fmt::format(", p >= {}", p_min);
  return text;
}

std::vector<AccuracyRow> accuracy_rows(const Study& study) {
  const auto bands = pose_bands(study.settings.procedure);
  std::vector<AccuracyRow> rows;
  for (std::size_t trial = 0; trial < study.settings.trials.size(); ++trial) {
    add_row(rows, row_of(study, trial, [](std::uint32_t) { return true; }), "all", "all");
    for (std::size_t k = 0; k < bands.size(); ++k) {
      if (k > 0 && bands[k].group == bands[k - 1].group) continue;  // bands of a group stand side by side
      const std::string_view group = bands[k].group;
      add_row(rows, row_of(study, trial, [&](std::uint32_t band) { return bands[band].group == group; }), "group",
              std::string(group));
    }
    for (std::uint32_t k = 0; k < bands.size(); ++k) {
      add_row(rows, row_of(study, trial, [&](std::uint32_t band) { return band == k; }), "band",
              std::string(bands[k].name));
    }
  }
  return rows;
}

std::vector<PushSweep> push_sweeps(const Study& study) {
  const auto bands = pose_bands(study.settings.procedure);
  std::vector<PushSweep> sweeps;
  for (const Trial::Kind kind : {Trial::Kind::time, Trial::Kind::work}) {
    const auto& trials = study.settings.trials;
    if (std::none_of(trials.begin(), trials.end(), [&](const Trial& one) { return one.kind == kind; })) continue;
    for (std::uint32_t band = 0; band < bands.size(); ++band) {
      std::vector<double> sums;
      for (std::size_t i = 0; i < study.poses.size(); ++i) {
        const PoseTruth& truth = study.poses[i];
        const double length = truth.contacts > 0 ? truth.deepest_contact.depth : 0.0;
        if (truth.pose.band == band && length > 0.0) sums.push_back(way_of_push(study, kind, i) / length);
      }
      if (sums.empty()) continue;
      std::sort(sums.begin(), sums.end());
      sweeps.push_back({kind, std::string(bands[band].name), sums.size(), at_share(sums, 0.5), at_share(sums, 0.9)});
    }
  }
  return sweeps;
}

ContactError contact_error(const query::Contact& given, std::span<const query::Contact> found,
                           const ContactRegion& region, double size) {
  const auto nearest = std::min_element(found.begin(), found.end(), [&](const auto& x, const auto& y) {
    return (x.position - given.position).squaredNorm() < (y.position - given.position).squaredNorm();
  });
  ContactError error;
  error.position = region.distance(given.position) / size;
  error.normal_deg = std::atan2(nearest->normal.cross(given.normal).norm(), nearest->normal.dot(given.normal)) * 180.0 /
                     std::numbers::pi;
  error.depth = std::abs(nearest->depth - given.depth) / size;
  return error;
}

std::vector<WorstPose> worst_poses(const Study& study, std::size_t most) {
  std::vector<WorstPose> worst;
  for (std::size_t i = 0; i < study.poses.size(); ++i) {
    WorstPose pose{i, 0.0, 0};
    double greatest = 0.0;
    for (std::size_t trial = 0; trial < study.samples.size(); ++trial) {
      const double off = study.samples[trial][i].probability - (study.poses[i].hit ? 1.0 : 0.0);
      pose.error += off * off;
      if (off * off > 0.0 && off * off >= greatest) {
        greatest = off * off;
        pose.trial = trial;
      }
    }
    if (pose.error > 0.0) worst.push_back(pose);
  }
  std::stable_sort(worst.begin(), worst.end(), [](const auto& x, const auto& y) { return x.error > y.error; });
  if (worst.size() > most) worst.resize(most);
  return worst;
}

}  // namespace odds::report
