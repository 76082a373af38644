// One tick of haptic rendering: from the device's state to the force on the hand.
#pragma once

#include <cstdint>
#include <optional>

#include "odds/haptics/device.hpp"
#include "odds/haptics/safety.hpp"
#include "odds/haptics/tick_record.hpp"
#include "odds/haptics/virtual_coupling.hpp"
#include "odds/ode/world.hpp"

namespace odds::haptics {

/// What connects a hand with the world.
struct Hand {
  Device* device = nullptr;  ///< open; outlives the renderer
  ode::BodyId tool;          ///< the body that stands for what the hand holds
  VirtualCoupling coupling;
  SafetyLimits limits;
};

/// Counts allocations of the calling thread since it began; null: nobody counts.
using AllocationCount = std::uint64_t (*)() noexcept;

/// Read the device, pull the tool towards it, collide and step the world, turn the pull into force and torque on the
/// hand, pass the safety stages, write the device, fill in the record. Works without a hand too: then it only steps.
class Renderer {
 public:
  /// `world` is prepared and outlives the renderer.
  Renderer(ode::World& world, const std::optional<Hand>& hand, AllocationCount allocations = nullptr);

  /// Puts the tool where the device is, at rest, as at time 0, and begins all counts anew. False if the device gives no
  /// state.
  bool begin() noexcept;

  /// Runs some ticks at time 0 and then puts every body back, so that the loop's first ticks find code and data in
  /// place. Call it in the loop's thread while the device's forces are off. False as begin().
  bool warm_up(int ticks);

  /// `now_ns`: the tick's planned time since the start of the loop. Fills in all of `record` but the loop's own fields
  /// (tick, planned, woke, done, skipped) and the operating system's (faults, switches). noexcept; no allocation, lock,
  /// system call or output, provided that the device does none.
  void tick(std::int64_t now_ns, TickRecord& record) noexcept;

  /// Null without a hand.
  [[nodiscard]] const SafetyCounts* safety_counts() const noexcept { return safety_ ? &safety_->counts() : nullptr; }
  /// Reads of the device that failed or gave numbers that were not finite.
  [[nodiscard]] std::uint64_t failed_reads() const noexcept { return failed_reads_; }
  /// Steps in which the world had to put a body back or hold its speed.
  [[nodiscard]] std::uint64_t rescued_steps() const noexcept { return rescued_steps_; }
  [[nodiscard]] std::uint64_t contacts_left_out() const noexcept { return contacts_left_out_; }

 private:
  void read_device(std::int64_t now_ns) noexcept;
  void write_device(std::int64_t now_ns, const ode::BodyState& tool, TickRecord& record) noexcept;

  ode::World* world_;
  std::optional<Hand> hand_;
  std::optional<Safety> safety_;
  AllocationCount allocations_;
  DeviceState state_;
  std::int64_t fresh_ns_ = 0;  // when the state was last fresh
  std::uint64_t failed_reads_ = 0;
  std::uint64_t rescued_steps_ = 0;
  std::uint64_t contacts_left_out_ = 0;
};

}  // namespace odds::haptics
