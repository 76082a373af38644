// The figures of a run for programs.
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "report/run_files.hpp"
#include "report/text.hpp"

namespace odds::report {
namespace {

using Json = nlohmann::ordered_json;

/// JSON knows no infinity: a limit that is not set is null.
Json number_or_null(double number) { return std::isfinite(number) ? Json(number) : Json(nullptr); }

/// The same of a limit in work units.
Json units_or_null(std::uint64_t units) {
  return units == std::numeric_limits<std::uint64_t>::max() ? Json(nullptr) : Json(units);
}

Json figures(const Histogram& histogram) {
  const auto us = [](std::int64_t ns) { return static_cast<double>(ns) * 1e-3; };
  return {{"samples", histogram.count()},
          {"mean_us", histogram.mean() * 1e-3},
          {"p50_us", us(histogram.value_at_percentile(50.0))},
          {"p90_us", us(histogram.value_at_percentile(90.0))},
          {"p99_us", us(histogram.value_at_percentile(99.0))},
          {"p99.9_us", us(histogram.value_at_percentile(99.9))},
          {"p99.99_us", us(histogram.value_at_percentile(99.99))},
          {"max_us", us(histogram.max())}};
}

/// Null in simulated time, where no stalls are measured: nothing is net of them.
Json net(const RunInfo& info, const Histogram& histogram) {
  return info.simulated_time ? Json(nullptr) : figures(histogram);
}

Json run(const RunInfo& info) {
  Json meshes = Json::array();
  for (const RunMesh& mesh : info.meshes) {
    meshes.push_back({{"name", mesh.name}, {"file", mesh.file}, {"triangles", mesh.triangles}});
  }
  return {{"scene", info.scene},
          {"version", info.version},
          {"started", utc_time(info.started_epoch_s)},
          {"meshes", meshes},
          {"bounding_volume", info.bounding_volume},
          {"device", info.device},
          {"effects", info.effects},
          {"period_us", static_cast<double>(info.period_ns) * 1e-3},
          {"budget_us", number_or_null(info.budget_us)},
          {"work_units", units_or_null(info.work_units)},
          {"frame_us", number_or_null(info.frame_us)},
          {"frame_work_units", units_or_null(info.frame_work_units)},
          {"max_contacts", info.max_contacts},
          {"max_contacts_per_step", info.max_contacts_per_step},
          {"carry_motion", info.carry_motion},
          {"allowed_overshoot_us", number_or_null(info.allowed_overshoot_us)},
          {"simulated_time", info.simulated_time},
          {"stopped_early", info.loop.stopped}};
}

Json counts(const RunInfo& info, const RunSummary& s) {
  return {{"planned", s.planned},
          {"ran", s.ran},
          {"skipped", s.skipped},
          {"late", s.late},
          {"longest_run_of_misses", s.longest_miss_run},
          {"records_lost", s.records_lost},
          {"queries", s.queries},
          {"ticks_with_query", s.ticks_with_query},
          {"pairs_left_out", info.pairs_left_out},
          {"hits", s.hits},
          {"proved", s.by_basis[0]},
          {"estimated", s.by_basis[1]},
          {"budget", s.by_basis[2]},
          {"node_pairs", s.node_pairs},
          {"triangle_pairs", s.triangle_pairs},
          {"allocations", s.allocations ? Json(*s.allocations) : Json(nullptr)},
          {"minor_faults", s.minor_faults},
          {"major_faults", s.major_faults},
          {"voluntary_switches", s.voluntary_switches},
          {"involuntary_switches", s.involuntary_switches},
          {"not_finite", s.not_finite}};
}

Json safety(const RunSummary& s) {
  return {{"not_finite", s.safety[0]},     {"force_rise", s.safety[1]},   {"force_clamped", s.safety[2]},
          {"torque_clamped", s.safety[3]}, {"force_slewed", s.safety[4]}, {"torque_slewed", s.safety[5]},
          {"stale", s.safety[6]},          {"faulted", s.safety[7]},      {"scaled", s.safety[8]},
          {"restarted", s.safety[9]}};
}

Json effects(const RunInfo& info) {
  Json block = Json::array();
  for (const RunEffect& effect : info.effect_costs) {
    block.push_back({{"name", effect.name},
                     {"line", effect.line},
                     {"ticks", effect.ticks},
                     {"evaluations", effect.evaluations},
                     {"total_us", static_cast<double>(effect.total_ns) * 1e-3},
                     {"longest_us", static_cast<double>(effect.longest_ns) * 1e-3}});
  }
  return block;
}

Json machine(const RunInfo& info) {
  Json host = Json::array();
  for (const realtime::HostLine& line : info.host) {
    host.push_back(
        {{"name", line.name}, {"value", line.value}, {"readiness", name(line.readiness)}, {"remark", line.remark}});
  }
  Json thread = Json::array();
  for (const realtime::SetupLine& line : info.thread) {
    thread.push_back({{"asked", line.asked}, {"outcome", name(line.outcome)}, {"detail", line.detail}});
  }
  Json block{{"host", host}, {"thread", thread}};
  if (info.fitness) {
    block["fitness"] = {{"fit", info.fitness->fit},
                        {"stall_share", number_or_null(info.fitness->stall_share)},
                        {"longest_gap_us", static_cast<double>(info.fitness->longest_gap_ns) * 1e-3},
                        {"reason", info.fitness->reason}};
  }
  return block;
}

}  // namespace

std::string summary_json(const RunInfo& info, const RunSummary& s) {
  Json checks = Json::array();
  for (const Check& check : s.checks) {
    checks.push_back({{"key", check.key}, {"state", name(check.state)}, {"finding", check.finding}});
  }
  const Json json{
      {"format", "odds run summary 1"},
      {"run", run(info)},
      {"checks", checks},
      {"warnings", info.warnings},
      {"latency", {{"wake", figures(s.wake)}, {"tick", figures(s.tick)}, {"tick_net", net(info, s.tick_net)}}},
      {"query",
       {{"gross", figures(s.query_gross)},
        {"net", net(info, s.query_net)},
        {"net_overshoot", net(info, s.query_overshoot)},
        {"longest_gross_overshoot_us", s.longest_overshoot_us},
        {"frame_overshoot_us", info.frame_overshoot_us},
        {"stall_share", info.simulated_time ? Json(nullptr) : Json(s.stall_share)}}},
      {"phases", {{"collision", figures(s.collision)}, {"step", figures(s.step)}}},
      {"counts", counts(info, s)},
      {"contact",
       {{"most_contacts", s.most_contacts},
        {"deepest_m", number_or_null(s.deepest_m)},
        {"largest_force_n", number_or_null(s.largest_force_n)},
        {"largest_torque_nm", number_or_null(s.largest_torque_nm)}}},
      {"safety_ticks", safety(s)},
      {"effects", effects(info)},
      {"energy", {{"least_at_hand_j", number_or_null(s.least_energy_j)}}},
      {"machine", machine(info)}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";  // a scene's text may not be UTF-8
}

}  // namespace odds::report
