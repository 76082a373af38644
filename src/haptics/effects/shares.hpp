// How contacts share what belongs to a whole pair of bodies.
#pragma once

#include "odds/ode/meeting.hpp"

namespace odds::haptics::effects {

/// N/m, > 0. The points of a pair are springs side by side; a point's part of this is its share of the pair.
inline double stiffness_of_all(const ode::Meeting& meeting) noexcept {
  double sum = 0.0;
  for (const ode::ContactPoint& point : meeting.contacts) sum += point.surface.stiffness_n_per_m;
  return sum;
}

}  // namespace odds::haptics::effects
