// The collisions of a world's step, within the budget of a frame if there is one.
#pragma once

#include <cstdint>
#include <memory>

#include "odds/math/error.hpp"
#include "odds/ode/odds_frame.h"
#include "odds/ode/world.hpp"

namespace odds::ode {

struct FrameBudgetDeleter {
  void operator()(oddsFrameBudget* budget) const noexcept { oddsFrameBudgetDestroy(budget); }
};
using FrameBudget = std::unique_ptr<oddsFrameBudget, FrameBudgetDeleter>;

/// Calls of a step that collide: all but the last, which solves, or its only one.
[[nodiscard]] inline int frame_parts(const WorldOptions& options) noexcept {
  return options.parts == 1 ? 1 : static_cast<int>(options.parts) - 1;
}

/// Null where the options ask for none.
[[nodiscard]] Result<FrameBudget> make_frame_budget(const WorldOptions& options, std::size_t bodies);

/// dSpaceCollide within the budget, if there is one, or the next part of it; notes what all parts have left out with
/// the last. What is near to the geom `attention`, which may be null, matters most; `number` counts the calls from 1
/// on.
void collide_frame(dSpaceID space, void* data, dNearCallback* callback, oddsFrameBudget* budget, dGeomID attention,
                   bool is_last_part, std::uint64_t number, StepSummary& summary) noexcept;

/// Whether the frame that was collided last had no time for this pair.
[[nodiscard]] bool had_no_turn(const oddsFrameBudget& budget, dGeomID a, dGeomID b) noexcept;

}  // namespace odds::ode
