// What a frame leaves to the collision under way: read by every collider, set by the frame for its own thread.
#pragma once

#include <algorithm>
#include <limits>

#include "ode/geom_data.hpp"

namespace odds::ode {

/// A bound in addition to the geoms' own budgets.
struct FrameShare {
  double us = std::numeric_limits<double>::infinity();
  unsigned long work_units = 0;  ///< 0: no limit
  unsigned long spent = 0;       ///< work units that collisions between meshes have reported
};

/// The calling thread's; null outside of a frame.
inline thread_local FrameShare* current_share = nullptr;

/// A geom's or a pair's settings, within the share.
[[nodiscard]] inline Settings within_share(Settings settings) noexcept {
  const FrameShare* share = current_share;
  if (share == nullptr) return settings;
  settings.budget_us = std::min(settings.budget_us, share->us);
  if (share->work_units > 0) {
    settings.work_units =
        settings.work_units > 0 ? std::min(settings.work_units, share->work_units) : share->work_units;
  }
  return settings;
}

}  // namespace odds::ode
