// A recording as a real run leaves it, made from formulas and a fixed seed: approach, press, slide, tap, retreat.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "odds/haptics/tick_record.hpp"
#include "odds/report/run_info.hpp"

namespace odds::report {

struct MadeRecording {
  RunInfo info;
  std::vector<haptics::TickRecord> ticks;
};

/// Uniform in [0, 1), from a counter.
inline double made_uniform(std::uint64_t counter) {
  std::uint64_t x = counter * 0x9E3779B97F4A7C15ULL + 0x1234567;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ULL;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBULL;
  return static_cast<double>((x ^ (x >> 31)) >> 11) * 0x1p-53;
}

/// Long-tailed delay in microseconds, as a desktop system shows it.
inline double made_delay_us(std::uint64_t counter) {
  const double u = made_uniform(counter);
  return 45.0 + 8.0 * made_uniform(counter + 1) + 6.0 / std::pow(1.0 - u, 0.45);
}

inline void make_contact(haptics::TickRecord& t, double seconds, std::uint64_t noise) {
  const double press = std::clamp(std::sin(2.0 * 3.14159265358979 * (seconds / 5.0 - 0.18)), -1.0, 1.0);
  const double gap_mm = -6.0 * press + 0.8 * std::sin(23.0 * seconds);
  t.device_position_m = {0.04 * std::sin(0.9 * seconds), 0.01, gap_mm * 1e-3};
  t.tool_position_m = {t.device_position_m[0], 0.01, std::max(gap_mm, -0.3) * 1e-3};
  if (gap_mm > 8.0) return;  // the broad phase excludes the pair
  t.queries = 1;
  const double closeness = std::exp(-0.35 * std::abs(gap_mm));
  const double wanted_us = 6.0 + 120.0 * closeness * (0.6 + 0.8 * made_uniform(noise + 2));
  const double net_us = std::min(wanted_us, 100.0 + 0.6 * made_uniform(noise + 3));
  const bool stalled = made_uniform(noise + 4) > 0.9985;
  t.query_net_us = net_us;
  t.query_stall_us = stalled ? 20.0 + 300.0 * made_uniform(noise + 5) : 0.0;
  t.query_gross_us = net_us + t.query_stall_us;
  t.query_net_overshoot_us = std::max(0.0, net_us - 100.0);
  t.query_overshoot_us = std::max(0.0, t.query_gross_us - 100.0);
  t.node_pairs = static_cast<std::uint64_t>(net_us * 4.0);
  t.triangle_pairs = static_cast<std::uint64_t>(net_us * 0.9);
  const bool hit = gap_mm < 0.0;
  t.verdict = hit ? query::Verdict::hit : query::Verdict::clear;
  t.basis = wanted_us > 100.0                ? query::Basis::budget
            : made_uniform(noise + 6) > 0.97 ? query::Basis::estimated
                                             : query::Basis::proved;
  t.probability = t.basis == query::Basis::proved ? (hit ? 1.0 : 0.0)
                  : hit                           ? 0.62 + 0.3 * made_uniform(noise + 7)
                                                  : 0.3 * made_uniform(noise + 7);
  if (!hit) return;
  t.contacts = 1 + static_cast<std::uint32_t>(6.0 * made_uniform(noise + 8));
  t.max_depth_m = -gap_mm * 1e-4;
  const double force = 0.7 * -gap_mm * (1.0 + 0.04 * (made_uniform(noise + 9) - 0.5));
  t.force_n = {-0.3 * force * std::cos(0.9 * seconds), 0.05 * force, force};
  t.torque_nm = {0.002 * force, 0.004 * force * std::sin(4.0 * seconds), -0.0015 * force};
  if (force > 3.9) t.safety |= haptics::safety_force_clamped;
}

/// `seconds` of a 1 kHz loop with a budget of 100 us, late wake-ups, two skips, some stalls.
inline MadeRecording made_recording(double seconds = 10.0) {
  MadeRecording made;
  const auto periods = static_cast<std::uint64_t>(seconds * 1e3);
  std::uint64_t tick = 0;
  std::uint64_t skipped_before = 0;
  while (tick < periods) {
    haptics::TickRecord t;
    const std::uint64_t noise = tick * 16;
    t.tick = tick;
    t.planned_ns = 5'000'000'000 + static_cast<std::int64_t>(tick) * 1'000'000;
    t.skipped_before = skipped_before;
    make_contact(t, static_cast<double>(tick) * 1e-3, noise);
    t.collision_us = t.queries > 0 ? t.query_gross_us + 4.0 : 1.1;
    t.step_us = 18.0 + 3.0 * made_uniform(noise + 10) + 6.0 * t.contacts;
    const bool outage = tick == 3'141 || tick == 7'777;
    const double wake_us = outage ? 3'420.0 : made_delay_us(noise + 11);
    t.woke_ns = t.planned_ns + static_cast<std::int64_t>(wake_us * 1e3);
    t.done_ns = t.woke_ns + static_cast<std::int64_t>((t.collision_us + t.step_us + 9.0) * 1e3);
    t.involuntary_switches = t.query_stall_us > 0.0 ? 1 : 0;
    t.allocations = 0;
    if (tick < 400) t.safety |= haptics::safety_force_rise;
    made.ticks.push_back(t);
    skipped_before = std::min<std::uint64_t>(periods - tick - 1, outage ? 2 : 0);
    made.info.loop.skipped += skipped_before;
    ++made.info.loop.ran;
    tick += 1 + skipped_before;
  }
  made.info.scene = "bolt into nut (press, slide, tap)";
  made.info.version = "0.1.0";
  made.info.started_epoch_s = 1'780'000'000.0;
  made.info.meshes = {{"bolt", "meshes/bolt.obj", 61'440}, {"motorbike", "motorBike.obj.gz", 331'653}};
  made.info.bounding_volume = "obb";
  made.info.device = "scripted: press, slide, tap";
  made.info.effects = {"virtual coupling", "friction"};
  made.info.budget_us = 100.0;
  using Outcome = realtime::SetupLine::Outcome;
  made.info.thread = {
      {"real-time priority SCHED_FIFO 50", Outcome::granted, ""},
      {"memory locked", Outcome::partly, "present pages only, because the limit memlock is 8388608 bytes"},
      {"pinned to processor 1", Outcome::refused, "Operation not permitted"}};
  made.info.host = realtime::describe_host();
  made.info.fitness =
      realtime::Fitness{true, 0.004, 310'000, 12, 3, "fit: in 200 ms the processor was away for 0.40 % of the time"};
  return made;
}

}  // namespace odds::report
