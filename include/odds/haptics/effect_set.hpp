// The effects of one scene, called stage by stage, with their cost.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "odds/haptics/effect.hpp"

namespace odds::haptics {

/// What one effect took so far.
struct EffectCost {
  std::string name;
  Place place;                    ///< of the table that asked for it
  std::uint64_t ticks = 0;        ///< in which it was called
  std::uint64_t evaluations = 0;  ///< points, bodies or rows that it worked on
  std::int64_t total_ns = 0;      ///< in its own code; the rows that it adds cost the solver too
  std::int64_t longest_ns = 0;    ///< of one tick
};

/// Owns the effects that a scene asked for. What was not asked for is not in here: no object, no call, no branch.
class EffectSet {
 public:
  void add(std::string name, Place place, std::unique_ptr<Effect> effect);

  [[nodiscard]] std::size_t size() const noexcept { return entries_.size(); }
  [[nodiscard]] Effect& effect(std::size_t i) noexcept { return *entries_[i].effect; }
  [[nodiscard]] const EffectCost& cost(std::size_t i) const noexcept { return entries_[i].cost; }
  /// Union of Need bits.
  [[nodiscard]] std::uint32_t needs() const noexcept;
  /// Stiffness of the contacts of two bodies together, N/m, after all effects that change it; `law` is that of the
  /// world's law of contact.
  [[nodiscard]] double pair_stiffness_n_per_m(ode::BodyId a, ode::BodyId b, double law) const noexcept;
  /// Applies what the effects want of the world: forces, contact model, and how much the query has to find out.
  /// Effects that are switched off want nothing.
  void configure(ode::WorldOptions& options) const;
  /// The first refusal of these options by an effect, with its place.
  [[nodiscard]] std::optional<Error> check(const ode::WorldOptions& options) const;
  /// Connects with the world, which outlives the set, is prepared, and calls back at meetings from now on. Costs are
  /// by the world's clock. An effect's refusal, of check() too, names the place that asked for it.
  [[nodiscard]] std::optional<Error> bind(ode::World& world);
  /// At the start of a run; costs begin anew.
  void reset() noexcept;
  /// For trials: an effect that is off is not called, nor are those that rest on it. Configuration is the caller's
  /// part.
  void set_on(std::size_t i, bool on) noexcept;
  void keep() noexcept;
  void put_back() noexcept;

  // Within the tick, in this order; noexcept, no allocation.
  void before_step(TickView& tick) noexcept;
  /// In place of before_step(), in a tick that goes on with a step which another has begun.
  void go_on(const TickView& tick) noexcept { tick_ = &tick; }
  void after_step(const TickView& tick) noexcept;
  [[nodiscard]] ode::Wrench on_hand(const TickView& tick) noexcept;

  [[nodiscard]] std::vector<ContactEvent> events() const;
  [[nodiscard]] std::uint64_t events_lost() const noexcept;

 private:
  struct Entry {
    std::unique_ptr<Effect> effect;
    EffectCost cost;
    std::uint32_t stages = 0;
    bool on = true;    // asked for
    bool acts = true;  // and what it rests on acts too
    std::int64_t tick_ns = 0;
  };
  static void meet(void* self, ode::Meeting& meeting) noexcept;
  template <class Call>
  void run(std::uint32_t stage, Call call) noexcept;

  std::vector<Entry> entries_;
  std::uint32_t stages_ = 0;
  const TickView* tick_ = nullptr;  // the one under way
  realtime::Clock clock_ = realtime::fastest_clock();
};

}  // namespace odds::haptics
