// The numbers behind the charts of a study's page.
#include <nlohmann/json.hpp>

#include "report/accuracy/study_files.hpp"

namespace odds::report {
namespace {

using Json = nlohmann::ordered_json;

Json interval_point(double x, std::uint64_t count, std::uint64_t total) {
  const Interval interval = wilson(count, total);
  return {{"x", x},
          {"y", total > 0 ? 100.0 * static_cast<double>(count) / static_cast<double>(total) : 0.0},
          {"low", 100.0 * interval.low},
          {"high", 100.0 * interval.high},
          {"n", total}};
}

Json reliability(const ForecastQuality& quality) {
  Json bins = Json::array();
  for (const ForecastBin& bin : quality.bins) {
    if (bin.count == 0) continue;
    Json point = interval_point(bin.mean_probability(), bin.happened, bin.count);
    bins.push_back(std::move(point));
  }
  return bins;
}

Json point_of(const AccuracyRow& row, double amount) {
  Json point{{"x", amount}};
  point["wrong"] = interval_point(amount, row.wrong(), row.poses);
  point["falseHits"] = interval_point(amount, row.false_hits, row.poses - row.hits);
  point["falseMisses"] = interval_point(amount, row.false_misses, row.hits);
  point["proved"] = interval_point(amount, row.proved, row.poses);
  point["wall"] = {row.wall_us.p50, row.wall_us.p99, row.wall_us.p999, row.wall_us.max};
  if (row.contact.count > 0) {
    point["contact"] = {{"n", row.contact.count},
                        {"position", 100.0 * row.contact.p50.position},
                        {"normal", row.contact.p50.normal_deg},
                        {"depth", 100.0 * row.contact.p50.depth}};
  }
  point["reliability"] = reliability(row.unproved);
  point["unproved"] = row.unproved.count;
  point["ece"] = row.unproved.calibration_error;
  return point;
}

/// The series that a row belongs to, made if it is new.
Json& series_of(Json& all, const Trial& trial, const AccuracyRow& row) {
  for (Json& series : all) {
    if (series["kind"] == name(trial.kind) && series["band"] == row.band && series["pMin"] == trial.p_min)
      return series;
  }
  all.push_back({{"kind", name(trial.kind)},
                 {"scope", row.scope},
                 {"band", row.band},
                 {"pMin", trial.p_min},
                 {"points", Json::array()}});
  return all.back();
}

}  // namespace

std::string accuracy_page_data(const Study& study, const std::vector<AccuracyRow>& rows) {
  Json series = Json::array();
  Json exact = Json::object();
  for (const AccuracyRow& row : rows) {
    const Trial& trial = study.settings.trials[row.trial];
    if (row.scope == "band") continue;  // in the table
    if (trial.kind == Trial::Kind::exact) {
      exact[row.band] = {row.wall_us.p50, row.wall_us.p99, row.wall_us.p999, row.wall_us.max};
    } else {
      series_of(series, trial, row)["points"].push_back(point_of(row, trial.amount));
    }
  }
  return Json{{"series", series}, {"exact", exact}}.dump();
}

}  // namespace odds::report
