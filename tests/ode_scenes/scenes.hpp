// The scenes, one file each.
#pragma once

#include <cstdint>

#include "ode_scenes/arena.hpp"
#include "ode_scenes/figures.hpp"

namespace odds::ode_scenes {

/// How much is run.
struct Plan {
  double seconds = 60.0;  ///< of each stack
  std::vector<double> gaps_mm = {0.0, 0.1, 0.5, 1.0};
  std::vector<int> bricks = {2, 5, 10};
  bool others = true;                                         ///< also the colliders that ours is compared with
  bool gimpact = false;                                       ///< among them Bullet's
  bool in_work = false;                                       ///< ours in work units
  std::uint64_t seed = 7;                                     ///< of how bodies are placed in the crowd
  long look_ns = 0;                                           ///< of ours, see Collider
  std::vector<double> budgets_us = {100.0, 5.0, 10.0, 20.0};  ///< the usual one, and starved ones
};

[[nodiscard]] Section stacks(const Plan& plan);
[[nodiscard]] Section peg_in_hole(const Plan& plan);
[[nodiscard]] Section gears(const Plan& plan);
[[nodiscard]] Section bolt_and_nut(const Plan& plan);
[[nodiscard]] Section drag(const Plan& plan);
[[nodiscard]] Section crowd(const Plan& plan);
[[nodiscard]] Section wall(const Plan& plan);
[[nodiscard]] Section partners(const Plan& plan);
[[nodiscard]] Section behaviours(const Plan& plan);
/// A stack for ten minutes: does it drift on?
[[nodiscard]] Section soak(double seconds);

/// The budgets of ours, longest first, then the others by `plan`; `primitive` where a scene has one.
[[nodiscard]] std::vector<Collider> colliders(const Plan& plan, bool primitive);

/// Time of collisions and of whole steps, contacts: what every run tells.
void add_common(Run& run, Arena& arena);

}  // namespace odds::ode_scenes
