// A scene run for a long simulated time, as fast as it goes.
#pragma once

#include <cstdint>
#include <string>

#include "odds/math/error.hpp"

namespace odds::hard_cases {

/// What a soak left; no record is kept, so that its length costs no memory.
struct Soak {
  std::uint64_t ticks = 0;
  std::uint64_t not_finite = 0;    ///< ticks with a number that is not, at the hand or of any body
  std::uint64_t beyond_limit = 0;  ///< ticks with a force above the device's limit
  std::uint64_t faulted = 0;       ///< ticks with a latched fault
  std::uint64_t rescued = 0;       ///< steps that held a body's speed or put it back
  std::uint64_t allocations = 0;   ///< within ticks; 0 where they are not counted (a sanitizer's build)
  double fastest_m_per_s = 0.0;    ///< of any body
  std::uint64_t rounds = 0;        ///< times that the scene was run
  std::uint64_t fallen = 0;        ///< bodies, summed over the rounds, that were below all that is fixed in the end
  std::size_t effects = 0;         ///< that the scene asks for
  std::string idle;                ///< those of them that were never evaluated
  double largest_force_n = 0.0;
  double least_energy_j = 0.0;  ///< lowest balance at the hand
  double wall_s = 0.0;
  [[nodiscard]] bool holds() const { return not_finite == 0 && beyond_limit == 0 && faulted == 0 && allocations == 0; }
};

/// Runs the scene again and again, from its start each time the scene's own seconds are over, bodies and device put
/// back.
Result<Soak> soak(const std::string& scene_file, double seconds);

}  // namespace odds::hard_cases
