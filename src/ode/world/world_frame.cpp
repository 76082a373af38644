// Frames of a world.
#include "ode/world/world_frame.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "odds/ode/odds_ode.h"
#include "ode/frame/frame_budget.hpp"
#include "ode/geom/broad_phase.hpp"

namespace odds::ode {

Result<FrameBudget> make_frame_budget(const WorldOptions& options, std::size_t bodies) {
  constexpr std::uint64_t no_limit = std::numeric_limits<std::uint64_t>::max();
  constexpr std::size_t most_pairs = std::size_t{1} << 16;
  const bool timed = std::isfinite(options.frame_us);
  if (!timed && options.frame_work_units == no_limit) return FrameBudget();
  const std::size_t pairs = std::clamp<std::size_t>(bodies * bodies / 2, 1, most_pairs);
  FrameBudget budget(oddsFrameBudgetCreate(static_cast<int>(pairs)));
  const bool made =
      budget != nullptr && (!timed || oddsFrameBudgetSetTime(budget.get(), options.frame_us) != 0) &&
      (options.frame_work_units == no_limit || oddsFrameBudgetSetWork(budget.get(), options.frame_work_units) != 0) &&
      oddsFrameBudgetSetParts(budget.get(), frame_parts(options)) != 0;
  if (!made)
    return Error{"", "", std::string("no budget for a frame: ") + oddsGetLastError(), "correct the frame's limits"};
  return budget;
}

void collide_frame(dSpaceID space, void* data, dNearCallback* callback, oddsFrameBudget* budget, dGeomID attention,
                   bool is_last_part, std::uint64_t number, StepSummary& summary) noexcept {
  if (budget == nullptr) {
    const BroadPhaseScope scope(number);
    dSpaceCollide(space, data, callback);
    note_places(space, number);
    return;
  }
  if (attention != nullptr) {
    dReal box[6];
    dGeomGetAABB(attention, box);
    const dReal middle[3] = {(box[0] + box[1]) / 2, (box[2] + box[3]) / 2, (box[4] + box[5]) / 2};
    const double size = std::hypot(box[1] - box[0], box[3] - box[2], box[5] - box[4]);
    oddsFrameBudgetSetAttention(budget, middle, std::max(size, 1e-9));
  }
  oddsSpaceCollide(space, data, callback, budget);
  oddsFrameSummary frame;
  oddsFrameBudgetGetSummary(budget, &frame);
  if (is_last_part) summary.pairs_left_out += static_cast<std::uint32_t>(frame.pairs - frame.served);
  summary.frame_overshoot_us = std::max(summary.frame_overshoot_us, frame.overshoot_us);
}

bool had_no_turn(const oddsFrameBudget& budget, dGeomID a, dGeomID b) noexcept { return budget.waits(a, b); }

}  // namespace odds::ode
