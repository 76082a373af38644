// Which effects a scene has switched on, who asked for them, and what each costs per tick.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "odds/math/error.hpp"
#include "odds/scene/scene.hpp"

namespace odds::scene {

/// One effect that this library knows.
struct EffectLine {
  std::string name;
  bool on = false;
  haptics::Place place;       ///< of its table; {0, 0} if off
  std::string needs;          ///< what it makes the tick compute; empty if off
  std::string work;           ///< what it adds to a tick, counted over the trial; empty if off
  double cost_us = 0.0;       ///< median over the trial's pairs of steps, with and without it, at the same states
  double cost_p90_us = 0.0;   ///< 90th percentile
  std::uint64_t samples = 0;  ///< pairs of steps
};

struct Explanation {
  std::vector<EffectLine> effects;  ///< all that are known, in the order of a tick
  std::uint64_t ticks = 0;          ///< of the trial, simulated time
  double step_us = 0.0;             ///< median of a whole step, collision included
  std::string device;               ///< a line on the device and its scales; empty without one
  std::vector<std::string> warnings;
};

/// Loads the scene and runs it (at most 60,000 ticks) in simulated time and work units. At some `samples` >= 1 of its
/// ticks it takes the step twice from the same state, with an effect and without it, for each effect that is on; the
/// cost is the difference in time. The costs of effects do not add up to the step: an effect also changes what others
/// have to do.
Result<Explanation> explain(const Scene& scene, std::uint64_t samples = 500,
                            const std::function<void(std::string_view what, double share)>& progress = {});

}  // namespace odds::scene
