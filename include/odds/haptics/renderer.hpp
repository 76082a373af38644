// One tick of haptic rendering: from the device's state to the force on the hand.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include "odds/haptics/device.hpp"
#include "odds/haptics/effect_set.hpp"
#include "odds/haptics/passivity.hpp"
#include "odds/haptics/safety.hpp"
#include "odds/haptics/tick_record.hpp"
#include "odds/ode/world.hpp"

namespace odds::haptics {

/// What connects a hand with the world.
struct Hand {
  Device* device = nullptr;  ///< open; outlives the renderer
  ode::BodyId tool;          ///< the body that stands for what the hand holds
  SafetyLimits limits;
  DeviceScale scale;  ///< how the device stands to the scene
};

/// Steps of the world within one tick. A tick takes as many as the fastest body needs so that no point of it moves
/// farther than `way_m` in each, at most `most`; a body that creeps costs one.
struct SubSteps {
  double way_m = std::numeric_limits<double>::infinity();  ///< > 0; infinity: always one step
  std::uint32_t most = 1;                                  ///< >= 1
};

/// Counts allocations of the calling thread since it began; null: nobody counts.
using AllocationCount = std::uint64_t (*)() noexcept;

/// Read the device, let the effects act, collide and step the world, gather force and torque on the hand from the
/// effects, pass the safety stages, write the device, fill in the record. Works without a hand too: then it only steps,
/// and a step may come in parts, one in each tick (WorldOptions::parts).
class Renderer {
 public:
  /// World and effects outlive the renderer. It gives the tool its coupling, for which World::prepare() takes memory:
  /// make it before that. EffectSet::bind() comes after, for begin() does not connect the effects with the world.
  Renderer(ode::World& world, const std::optional<Hand>& hand, EffectSet& effects,
           AllocationCount allocations = nullptr);

  void set_substeps(const SubSteps& substeps) noexcept { substeps_ = substeps; }

  /// Puts the tool where the device is, at rest, as at time 0, and begins all counts anew. False if the device gives no
  /// state.
  bool begin() noexcept;

  /// Runs some ticks at time 0 and then puts every body back, so that the loop's first ticks find code and data in
  /// place. Call it in the loop's thread while the device's forces are off. False as begin().
  [[nodiscard]] bool warm_up(int ticks);

  /// `now_ns`: the tick's planned time since the start of the loop. Where it is more than a period after the last one,
  /// ticks were missed: the device held its command meanwhile, the world goes on by one period all the same, and the
  /// safety stages know how long it was (Safety::apply). A time that stands still or goes back counts as one period.
  /// Fills in all of `record` but the loop's own fields
  /// (tick, planned, woke, done, skipped) and the operating system's (faults, switches). noexcept; no allocation, lock,
  /// system call or output, provided that the device does none.
  void tick(std::int64_t now_ns, TickRecord& record) noexcept;

  /// One step from the world's present state for the time of a tick, without safety stages and without a word to the
  /// device, in nanoseconds: what the effects that are on cost. The caller puts bodies and effects back.
  [[nodiscard]] std::int64_t trial(std::int64_t now_ns) noexcept;

  /// What the world did in the last tick.
  [[nodiscard]] const ode::StepSummary& last_step() const noexcept { return last_step_; }
  /// The balance of energy at the hand, by the device's own way and force; means nothing without one.
  [[nodiscard]] const PassivityObserver& energy() const noexcept { return energy_; }
  /// Null without a hand.
  [[nodiscard]] const SafetyCounts* safety_counts() const noexcept { return safety_ ? &safety_->counts() : nullptr; }
  /// Reads of the device that failed or gave numbers that were not finite.
  [[nodiscard]] std::uint64_t failed_reads() const noexcept { return failed_reads_; }
  /// Largest distance of the handle from the centre of the device's workspace, by the device's own measure.
  [[nodiscard]] double farthest_m() const noexcept { return farthest_m_; }
  /// Steps in which the world had to put a body back or hold its speed.
  [[nodiscard]] std::uint64_t rescued_steps() const noexcept { return rescued_steps_; }
  [[nodiscard]] std::uint64_t contacts_left_out() const noexcept { return contacts_left_out_; }
  /// Pairs for which a frame had no time left, over all ticks.
  [[nodiscard]] std::uint64_t pairs_left_out() const noexcept { return pairs_left_out_; }
  /// Messages with which ODE's solver complained, over all ticks.
  [[nodiscard]] std::uint64_t solver_messages() const noexcept { return solver_messages_; }
  /// Largest time of a frame beyond its budget, microseconds.
  [[nodiscard]] double frame_overshoot_us() const noexcept { return frame_overshoot_us_; }

 private:
  /// Reads the device as at time 0 and puts the tool there, at rest. False if it gives no position.
  bool begin_at_device() noexcept;
  void count_time(std::int64_t now_ns) noexcept;
  /// What the device says, as far as it senses anything, and the same in the scene. False: nothing that can be used.
  [[nodiscard]] bool ask_device(std::int64_t now_ns, DeviceState& said, DeviceState& state) noexcept;
  void read_device(std::int64_t now_ns) noexcept;
  void write_device(std::int64_t now_ns, const ode::Wrench& on_hand, TickRecord& record) noexcept;
  [[nodiscard]] TickView view(std::int64_t now_ns) noexcept;
  [[nodiscard]] std::uint32_t steps_needed() const noexcept;
  void step_world(TickView& tick) noexcept;
  void step_part(TickView& tick) noexcept;

  ode::World* world_;
  std::optional<Hand> hand_;
  EffectSet* effects_;
  std::optional<Safety> safety_;
  PassivityObserver energy_;
  ode::StepSummary last_step_;
  ode::StepSummary parts_;        // of the step under way, together
  std::uint32_t parts_done_ = 0;  // of it
  SubSteps substeps_;
  DeviceState before_;  // at the last tick
  AllocationCount allocations_;
  double period_s_;
  DeviceState state_;
  DeviceState own_;  // the same in the device's own frame
  bool actuates_force_ = true;
  bool actuates_torque_ = true;
  double farthest_m_ = 0.0;
  std::int64_t period_ns_;
  std::int64_t served_ns_ = 0;  // when the last tick was
  bool served_ = false;         // a tick, since begin()
  double passed_s_;             // since the last tick that was served
  double silent_s_ = 0.0;       // since the last read that told anything new
  double moved_s_;              // from the last such read but one to the last
  std::int64_t age_ns_ = 0;     // of the state
  std::uint64_t failed_reads_ = 0;
  std::uint64_t rescued_steps_ = 0;
  std::uint64_t contacts_left_out_ = 0;
  std::uint64_t pairs_left_out_ = 0;
  std::uint64_t solver_messages_ = 0;
  double frame_overshoot_us_ = 0.0;
};

}  // namespace odds::haptics
