// The C interface of frame budgets.
#include <cmath>
#include <new>

#include "ode/frame/frame_budget.hpp"
#include "ode/frame/frame_share.hpp"
#include "ode/last_error.hpp"

namespace {

int refuse(const char* rule) noexcept {
  odds::ode::set_last_error(rule);
  return 0;
}

// Keeps the budget's settings as `change` leaves them.
template <class Change>
int change_settings(oddsFrameBudgetID budget, const Change& change) noexcept {
  odds::ode::FrameSettings settings = budget->settings();
  change(settings);
  budget->set(settings);
  return 1;
}

}  // namespace

oddsFrameBudgetID oddsFrameBudgetCreate(int most_pairs) noexcept {
  if (most_pairs < 1 || most_pairs > 1048576) {
    odds::ode::set_last_error("oddsFrameBudgetCreate: the number of pairs must be 1 .. 1048576");
    return nullptr;
  }
  try {
    return new oddsFrameBudget(static_cast<std::size_t>(most_pairs));
  } catch (const std::bad_alloc&) {
    odds::ode::set_last_error("oddsFrameBudgetCreate: out of memory");
    return nullptr;
  }
}

void oddsFrameBudgetDestroy(oddsFrameBudgetID budget) noexcept { delete budget; }

int oddsFrameBudgetSetTime(oddsFrameBudgetID budget, dReal microseconds) noexcept {
  if (budget == nullptr || !(microseconds > 0)) {
    return refuse("oddsFrameBudgetSetTime: needs a budget, and a time > 0 microseconds (dInfinity: no limit)");
  }
  return change_settings(budget, [&](auto& settings) { settings.time_us = microseconds; });
}

int oddsFrameBudgetSetWork(oddsFrameBudgetID budget, unsigned long units) noexcept {
  if (budget == nullptr) return refuse("oddsFrameBudgetSetWork: the budget is null");
  return change_settings(budget, [&](auto& settings) { settings.work_units = units; });
}

int oddsFrameBudgetSetAttention(oddsFrameBudgetID budget, const dReal* position, dReal radius) noexcept {
  if (budget == nullptr) return refuse("oddsFrameBudgetSetAttention: the budget is null");
  if (position == nullptr) return change_settings(budget, [](auto& settings) { settings.attends = false; });
  const odds::Vec3 place(position[0], position[1], position[2]);
  if (!place.allFinite() || !(radius > 0) || !std::isfinite(radius)) {
    return refuse("oddsFrameBudgetSetAttention: needs a finite place, and a radius > 0 metres");
  }
  return change_settings(budget, [&](auto& settings) {
    settings.attends = true;
    settings.attention = place;
    settings.attention_radius = radius;
  });
}

int oddsFrameBudgetSetSharing(oddsFrameBudgetID budget, int sharing) noexcept {
  if (budget == nullptr || (sharing != ODDS_SHARE_BY_IMPORTANCE && sharing != ODDS_SHARE_EQUALLY)) {
    return refuse("oddsFrameBudgetSetSharing: needs a budget, and ODDS_SHARE_BY_IMPORTANCE or ODDS_SHARE_EQUALLY");
  }
  return change_settings(budget, [&](auto& settings) { settings.sharing = sharing; });
}

int oddsFrameBudgetSetParts(oddsFrameBudgetID budget, int parts) noexcept {
  if (budget == nullptr || parts < 1 || parts > 1024) {
    return refuse("oddsFrameBudgetSetParts: needs a budget, and 1 .. 1024 parts");
  }
  budget->begin_anew();
  return change_settings(budget, [&](auto& settings) { settings.parts = parts; });
}

int oddsFrameBudgetGetSummary(oddsFrameBudgetID budget, oddsFrameSummary* summary) noexcept {
  if (budget == nullptr || summary == nullptr) {
    return refuse("oddsFrameBudgetGetSummary: the budget or the place for the summary is null");
  }
  *summary = budget->summary();
  return 1;
}

int oddsSpaceCollide(dSpaceID space, void* data, dNearCallback* callback, oddsFrameBudgetID budget) noexcept {
  if (space == nullptr || dGeomIsSpace(reinterpret_cast<dGeomID>(space)) == 0 || callback == nullptr ||
      budget == nullptr) {
    return refuse("oddsSpaceCollide: needs a space, a callback and a frame budget");
  }
  if (odds::ode::current_share != nullptr) {
    return refuse("oddsSpaceCollide: called from within the callback of another");
  }
  budget->run(space, data, callback);
  return 1;
}
