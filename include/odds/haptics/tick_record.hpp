// What the haptic loop writes down about each tick: the one thing that reports and replays read.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "odds/query/answer.hpp"

namespace odds::haptics {

/// Bits of TickRecord::safety: which stages changed the force of this tick before it went to the device.
enum SafetyFlag : std::uint32_t {
  safety_not_finite = 1U << 0,      ///< a force or torque was not finite and was replaced by zero
  safety_force_rise = 1U << 1,      ///< still within the gentle rise after start
  safety_force_clamped = 1U << 2,   ///< force magnitude cut to the device's limit, direction kept
  safety_torque_clamped = 1U << 3,  ///< the same for the torque
  safety_force_slewed = 1U << 4,    ///< change per second cut to the limit
  safety_torque_slewed = 1U << 5,   ///< the same for the torque
  safety_stale = 1U << 6,           ///< the device state was too old; the force decays to zero
  safety_faulted = 1U << 7,         ///< a fault is latched: zero force until reset
  safety_scaled = 1U << 8,          ///< force and torque multiplied by the device's force scale
  safety_restarted = 1U << 9,       ///< ticks were missed for so long that the gentle rise began again
};
inline constexpr std::size_t safety_flag_count = 10;

/// Value of a counter that nobody counted, so that "zero" is always a measurement.
inline constexpr std::uint32_t not_measured = 0xFFFFFFFFU;

/// One tick of the loop. Times by the loop's clock (nanoseconds, arbitrary origin); everything else SI as named.
/// Vectors are in the world frame, x y z; quaternions w x y z. Trivially copyable, fixed size, no pointers: it is
/// copied through the recorder's ring.
struct TickRecord {
  std::uint64_t tick = 0;            ///< number of the planned tick since the start; skipped ticks keep their numbers
  std::int64_t planned_ns = 0;       ///< when the tick was due
  std::int64_t woke_ns = 0;          ///< when the loop's thread ran again
  std::int64_t done_ns = 0;          ///< when force and torque were handed to the device
  std::uint64_t skipped_before = 0;  ///< whole periods left out immediately before this tick

  std::uint32_t queries = 0;        ///< mesh queries answered in this tick; 0 where the broad phase excluded all pairs
  double query_gross_us = 0.0;      ///< sum over the queries, from call to return
  double query_stall_us = 0.0;      ///< thereof in gaps too long to be the query's own work
  double query_net_us = 0.0;        ///< gross - stall
  double query_overshoot_us = 0.0;  ///< largest gross time beyond a query's budget, >= 0
  double query_net_overshoot_us = 0.0;             ///< the same without stalls, >= 0
  std::uint64_t node_pairs = 0;                    ///< pairs of bounding volumes tested
  std::uint64_t triangle_pairs = 0;                ///< pairs of triangles tested
  query::Verdict verdict = query::Verdict::clear;  ///< hit if any query said so
  query::Basis basis = query::Basis::proved;       ///< the weakest among the queries: proved < estimated < budget
  double probability = 0.0;                        ///< of a hit, in [0, 1]; the largest among the queries

  double collision_us = 0.0;  ///< gross time of the whole collision phase: broad phase, queries, contact joints
  double step_us = 0.0;       ///< gross time of ODE's world step; 0 where nothing moves

  std::uint32_t contacts = 0;  ///< contact points used
  double max_depth_m = 0.0;    ///< deepest contact, >= 0

  std::array<double, 3> device_position_m{};  ///< of the handle in the scene, its workspace scale applied
  std::array<double, 4> device_orientation_wxyz{1.0, 0.0, 0.0, 0.0};
  std::array<double, 3> tool_position_m{};
  std::array<double, 4> tool_orientation_wxyz{1.0, 0.0, 0.0, 0.0};
  std::array<double, 3> force_n{};    ///< on the hand, newton, as sent to the device
  std::array<double, 3> torque_nm{};  ///< on the hand, newton metre, as sent to the device

  /// Energy that the simulation has taken in at the hand since the start; below zero it has given some (passivity.hpp).
  double observed_energy_j = 0.0;
  double contact_work_j = 0.0;  ///< what contacts did to the bodies' kinetic energy in this tick; 0 unless asked for

  std::uint32_t safety = 0;              ///< SafetyFlag bits
  std::uint32_t minor_faults = 0;        ///< page faults without I/O of the loop's thread during this tick
  std::uint32_t major_faults = 0;        ///< page faults with I/O
  std::uint32_t voluntary_switches = 0;  ///< within the tick's work, not counting the sleep before it
  std::uint32_t involuntary_switches = 0;
  /// Time in which the loop's thread ran within the tick's work; 0 where nobody measured it.
  double processor_us = 0.0;
  /// Calls of malloc, operator new and their kin by the loop's thread within the tick's work; `not_measured` where the
  /// program has no counter (the command `odds` has one).
  std::uint32_t allocations = not_measured;
};

static_assert(std::is_trivially_copyable_v<TickRecord>);

}  // namespace odds::haptics
