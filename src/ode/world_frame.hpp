// The collisions of a world's step, within the budget of a frame if there is one.
#pragma once

#include <memory>

#include "odds/math/error.hpp"
#include "odds/ode/odds_frame.h"
#include "odds/ode/world.hpp"

namespace odds::ode {

struct FrameBudgetDeleter {
  void operator()(oddsFrameBudget* budget) const noexcept { oddsFrameBudgetDestroy(budget); }
};
using FrameBudget = std::unique_ptr<oddsFrameBudget, FrameBudgetDeleter>;

/// Null where the options ask for none.
[[nodiscard]] Result<FrameBudget> make_frame_budget(const WorldOptions& options, std::size_t bodies);

/// dSpaceCollide within the budget, if there is one; notes what it left out. What is near to the geom `attention`,
/// which may be null, matters most.
void collide_frame(dSpaceID space, void* data, dNearCallback* callback, oddsFrameBudget* budget, dGeomID attention,
                   StepSummary& summary) noexcept;

}  // namespace odds::ode
