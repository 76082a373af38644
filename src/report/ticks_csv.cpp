// Every record as a line of CSV.
#include <fmt/format.h>

#include <iterator>

#include "report/run_files.hpp"

namespace odds::report {
namespace {

constexpr const char* heading =
    "tick,planned_ns,woke_ns,done_ns,skipped_before,queries,query_gross_us,query_stall_us,query_net_us,"
    "query_overshoot_us,query_net_overshoot_us,node_pairs,triangle_pairs,verdict,basis,probability,collision_us,step_"
    "us,"
    "contacts,max_depth_m,device_x_m,device_y_m,device_z_m,device_qw,device_qx,device_qy,device_qz,tool_x_m,tool_y_m,"
    "tool_z_m,tool_qw,tool_qx,tool_qy,tool_qz,force_x_n,force_y_n,force_z_n,torque_x_nm,torque_y_nm,torque_z_nm,safety,"
    "minor_faults,major_faults,voluntary_switches,involuntary_switches,allocations,observed_energy_j,contact_work_j,"
    "processor_us\n";

}  // namespace

void write_ticks_csv(mesh::OutputFile& file, std::span<const haptics::TickRecord> ticks) {
  constexpr std::size_t piece_bytes = std::size_t{1} << 20;
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "{}", heading);
  for (const haptics::TickRecord& t : ticks) {
    fmt::format_to(out, "{},{},{},{},{},{},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{},{},", t.tick, t.planned_ns, t.woke_ns,
                   t.done_ns, t.skipped_before, t.queries, t.query_gross_us, t.query_stall_us, t.query_net_us,
                   t.query_overshoot_us, t.query_net_overshoot_us, t.node_pairs, t.triangle_pairs);
    // Without a query there is no answer to speak of.
    if (t.queries > 0) {
      fmt::format_to(out, "{},{},{:.9g},", name(t.verdict), name(t.basis), t.probability);
    } else {
      fmt::format_to(out, ",,,");
    }
    fmt::format_to(out, "{:.3f},{:.3f},{},{:.9g}", t.collision_us, t.step_us, t.contacts, t.max_depth_m);
    for (const double number : t.device_position_m) fmt::format_to(out, ",{:.9g}", number);
    for (const double number : t.device_orientation_wxyz) fmt::format_to(out, ",{:.9g}", number);
    for (const double number : t.tool_position_m) fmt::format_to(out, ",{:.9g}", number);
    for (const double number : t.tool_orientation_wxyz) fmt::format_to(out, ",{:.9g}", number);
    for (const double number : t.force_n) fmt::format_to(out, ",{:.9g}", number);
    for (const double number : t.torque_nm) fmt::format_to(out, ",{:.9g}", number);
    fmt::format_to(out, ",{},{},{},{},{},", t.safety, t.minor_faults, t.major_faults, t.voluntary_switches,
                   t.involuntary_switches);
    if (t.allocations != haptics::not_measured) fmt::format_to(out, "{}", t.allocations);
    fmt::format_to(out, ",{:.9g},{:.9g},", t.observed_energy_j, t.contact_work_j);
    if (t.processor_us > 0.0) fmt::format_to(out, "{:.3f}", t.processor_us);
    text.push_back('\n');
    if (text.size() < piece_bytes) continue;
    file.write({text.data(), text.size()});
    text.clear();
  }
  file.write({text.data(), text.size()});
}

}  // namespace odds::report
