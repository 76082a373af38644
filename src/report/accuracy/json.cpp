// A study's settings and figures for programs.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "odds/report/accuracy/report.hpp"
#include "report/accuracy/study_files.hpp"
#include "report/text.hpp"

namespace odds::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* format = "odds accuracy summary 1";

Json settings_json(const StudySettings& s) {
  Json trials = Json::array();
  for (const Trial& trial : s.trials) {
    trials.push_back({{"limit", name(trial.kind)}, {"amount", trial.amount}, {"p_min", trial.p_min}});
  }
  return {{"mesh_a", s.mesh_a},
          {"mesh_b", s.mesh_b},
          {"scale_a", s.scale_a},
          {"scale_b", s.scale_b},
          {"triangles_a", s.triangles_a},
          {"triangles_b", s.triangles_b},
          {"checksum_a", s.checksum_a},
          {"checksum_b", s.checksum_b},
          {"size_m", s.size_m},
          {"bounding_volume", s.bounding_volume},
          {"tau", s.tau},
          {"estimator", s.estimator},
          {"k_min", s.k_min},
          {"contacts", s.contacts},
          {"procedure", name(s.procedure)},
          {"seed", s.seed},
          {"poses_per_band", s.poses_per_band},
          {"calibration_poses", s.calibration_poses},
          {"trials", trials}};
}

/// Whether `odds accuracy` could have been asked for this. What is counted from these numbers takes memory.
bool plausible(const Study& study) {
  const StudySettings& s = study.settings;
  const auto positive = [](double x) { return x > 0.0 && std::isfinite(x); };
  const bool trials = std::all_of(s.trials.begin(), s.trials.end(), [&](const Trial& t) {
    return (t.kind == Trial::Kind::exact ? t.amount == 0.0 : positive(t.amount)) && t.p_min > 0.0 && t.p_min <= 1.0;
  });
  return trials && !s.trials.empty() && positive(s.size_m) && positive(s.scale_a) && positive(s.scale_b) &&
         positive(s.tau) && s.contacts >= 0 && s.contacts <= 8 && s.poses_per_band >= 1 &&
         s.poses_per_band <= most_poses_per_band && study.shard.of >= 1 && study.shard.of <= most_shards &&
         study.shard.number < study.shard.of;
}

Trial::Kind kind_from(const std::string& limit) {
  for (const Trial::Kind kind : {Trial::Kind::time, Trial::Kind::work, Trial::Kind::exact}) {
    if (limit == name(kind)) return kind;
  }
  throw std::invalid_argument("limit");
}

Procedure procedure_from(const std::string& text) {
  for (const Procedure procedure : procedures) {
    if (text == name(procedure)) return procedure;
  }
  throw std::invalid_argument("procedure");
}

/// Throws nlohmann's and std's exceptions on anything unexpected; the caller turns them into an Error.
StudySettings settings_from(const Json& json) {
  StudySettings s;
  json.at("mesh_a").get_to(s.mesh_a);
  json.at("mesh_b").get_to(s.mesh_b);
  json.at("scale_a").get_to(s.scale_a);
  json.at("scale_b").get_to(s.scale_b);
  json.at("triangles_a").get_to(s.triangles_a);
  json.at("triangles_b").get_to(s.triangles_b);
  s.checksum_a = json.value("checksum_a", "");  // older studies have none
  s.checksum_b = json.value("checksum_b", "");
  json.at("size_m").get_to(s.size_m);
  json.at("bounding_volume").get_to(s.bounding_volume);
  json.at("tau").get_to(s.tau);
  json.at("estimator").get_to(s.estimator);
  json.at("k_min").get_to(s.k_min);
  json.at("contacts").get_to(s.contacts);
  s.procedure = procedure_from(json.at("procedure").get<std::string>());
  json.at("seed").get_to(s.seed);
  json.at("poses_per_band").get_to(s.poses_per_band);
  s.calibration_poses = json.value("calibration_poses", 0U);  // ... nor this
  for (const Json& trial : json.at("trials")) {
    s.trials.push_back({kind_from(trial.at("limit").get<std::string>()), trial.at("amount").get<double>(),
                        trial.at("p_min").get<double>()});
  }
  return s;
}

Json bounds(const Interval& interval) { return {interval.low, interval.high}; }

Json tail_json(const Tail& tail) {
  return {{"p50", tail.p50}, {"p99", tail.p99}, {"p99.9", tail.p999}, {"max", tail.max}};
}

Json contact_json(const ContactError& error) {
  return {{"position", error.position}, {"normal_deg", error.normal_deg}, {"depth", error.depth}};
}

Json quality_json(const ForecastQuality& q) {
  Json bins = Json::array();
  for (const ForecastBin& bin : q.bins) {
    bins.push_back({{"count", bin.count},
                    {"mean_probability", bin.mean_probability()},
                    {"observed", bin.observed()},
                    {"interval", bounds(wilson(bin.happened, bin.count))}});
  }
  return {{"count", q.count},
          {"mean_probability", q.mean_probability},
          {"observed", q.observed()},
          {"calibration_error", q.calibration_error},
          {"brier", q.brier},
          {"reliability", q.reliability},
          {"resolution", q.resolution},
          {"uncertainty", q.uncertainty},
          {"within_bins", q.within_bins},
          {"bins", bins}};
}

Json row_json(const Study& study, const AccuracyRow& r) {
  const Trial& trial = study.settings.trials[r.trial];
  return {{"limit", name(trial.kind)},
          {"amount", trial.amount},
          {"p_min", trial.p_min},
          {"scope", r.scope},
          {"band", r.band},
          {"poses", r.poses},
          {"hits", r.hits},
          {"proved", r.proved},
          {"estimated", r.estimated},
          {"at_budget", r.at_budget},
          {"wrong", r.wrong()},
          {"wrong_interval", bounds(r.wrong_interval())},
          {"false_hits", r.false_hits},
          {"false_hits_interval", bounds(r.false_hit_interval())},
          {"false_misses", r.false_misses},
          {"false_misses_interval", bounds(r.false_miss_interval())},
          {"unproved", quality_json(r.unproved)},
          {"brier_all", r.brier_all},
          {"contact_errors",
           {{"count", r.contact.count}, {"p50", contact_json(r.contact.p50)}, {"p90", contact_json(r.contact.p90)}}},
          {"fallback_errors",
           {{"count", r.fallback.count}, {"p50", contact_json(r.fallback.p50)}, {"p90", contact_json(r.fallback.p90)}}},
          {"wall_us", tail_json(r.wall_us)},
          {"net_overshoot_us", tail_json(r.net_overshoot_us)}};
}

}  // namespace

std::string study_json(const Study& study, const std::vector<AccuracyRow>& rows) {
  Json figures = Json::array();
  for (const AccuracyRow& row : rows) figures.push_back(row_json(study, row));
  Json sweeps = Json::array();
  for (const PushSweep& s : push_sweeps(study)) {
    sweeps.push_back({{"limit", name(s.kind)}, {"band", s.band}, {"count", s.count}, {"p50", s.p50}, {"p90", s.p90}});
  }
  const Json json{{"format", format},
                  {"headline", headline(study, rows)},
                  {"version", study.version},
                  {"started", utc_time(study.started_epoch_s)},
                  {"started_epoch_s", study.started_epoch_s},
                  {"settings", settings_json(study.settings)},
                  {"shard", {{"number", study.shard.number}, {"of", study.shard.of}}},
                  {"machine", {{"fit", study.machine_fit}, {"note", study.machine_note}}},
                  {"rows", figures},
                  {"push_sweeps", sweeps}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";  // a file's name may not be UTF-8
}

Result<Study> read_study_json(const std::string& file, const std::string& text) {
  const Error refusal{file, "", "is not the summary of a study of accuracy",
                      "give a folder that `odds accuracy` wrote"};
  try {
    const Json json = Json::parse(text);
    if (const auto found = json.at("format").get<std::string>(); found != format) {
      if (!found.starts_with("odds accuracy summary ")) return refusal;
      return Error{file, "", "has the format '" + found + "', and this odds reads '" + format + "'",
                   "use the version of odds that wrote it"};
    }
    Study study;
    json.at("version").get_to(study.version);
    json.at("started_epoch_s").get_to(study.started_epoch_s);
    study.settings = settings_from(json.at("settings"));
    json.at("shard").at("number").get_to(study.shard.number);
    json.at("shard").at("of").get_to(study.shard.of);
    json.at("machine").at("fit").get_to(study.machine_fit);
    json.at("machine").at("note").get_to(study.machine_note);
    if (!plausible(study)) return refusal;
    return study;
  } catch (const Json::exception&) {
    return refusal;
  } catch (const std::invalid_argument&) {
    return refusal;
  }
}

}  // namespace odds::report
