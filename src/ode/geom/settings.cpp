// Setters and getters of the C interface.
#include <cmath>
#include <string>

#include "ode/geom/geom_data.hpp"
#include "ode/last_error.hpp"

namespace odds::ode {
namespace {

// Applies `change` if the geom is ours and `valid`; says which rule was broken otherwise.
template <class Change>
int set(dGeomID geom, const char* caller, bool valid, const char* rule, const Change& change) noexcept {
  GeomData* data = find_data(geom, caller);
  if (data == nullptr) return 0;
  if (!valid) {
    try {
      set_last_error(std::string(caller) + ": " + rule);
    } catch (...) {
      set_last_error(rule);
    }
    return 0;
  }
  change(data->settings);
  return 1;
}

template <class Value, class Read>
Value get(dGeomID geom, const char* caller, const Read& read) noexcept {
  const GeomData* data = find_data(geom, caller);
  return data != nullptr ? static_cast<Value>(read(data->settings)) : Value{0};
}

}  // namespace
}  // namespace odds::ode

using odds::ode::get;
using odds::ode::set;
using odds::ode::Settings;

int dGeomOddsMeshSetBudget(dGeomID geom, dReal microseconds) noexcept {
  return set(geom, __func__, microseconds > 0, "the budget must be > 0 microseconds (dInfinity: no limit)",
             [=](Settings& s) { s.budget_us = microseconds; });
}

dReal dGeomOddsMeshGetBudget(dGeomID geom) noexcept {
  return get<dReal>(geom, __func__, [](const Settings& s) { return s.budget_us; });
}

int dGeomOddsMeshSetWorkBudget(dGeomID geom, unsigned long units) noexcept {
  return set(geom, __func__, true, "", [=](Settings& s) { s.work_units = units; });
}

unsigned long dGeomOddsMeshGetWorkBudget(dGeomID geom) noexcept {
  return get<unsigned long>(geom, __func__, [](const Settings& s) { return s.work_units; });
}

int dGeomOddsMeshSetPMin(dGeomID geom, dReal p_min) noexcept {
  return set(geom, __func__, p_min > 0 && p_min <= 1, "p_min must be in (0, 1]; 1: never stop on probability",
             [=](Settings& s) { s.p_min = p_min; });
}

dReal dGeomOddsMeshGetPMin(dGeomID geom) noexcept {
  return get<dReal>(geom, __func__, [](const Settings& s) { return s.p_min; });
}

int dGeomOddsMeshSetKMin(dGeomID geom, int k_min) noexcept {
  return set(geom, __func__, k_min >= 1, "k_min must be at least 1",
             [=](Settings& s) { s.k_min = static_cast<std::uint32_t>(k_min); });
}

int dGeomOddsMeshGetKMin(dGeomID geom) noexcept {
  return get<int>(geom, __func__, [](const Settings& s) { return s.k_min; });
}

int dGeomOddsMeshSetMaxContacts(dGeomID geom, int count) noexcept {
  return set(geom, __func__, count >= 0 && count <= 8, "the number of contacts must be 0 .. 8",
             [=](Settings& s) { s.max_contacts = count; });
}

int dGeomOddsMeshGetMaxContacts(dGeomID geom) noexcept {
  return get<int>(geom, __func__, [](const Settings& s) { return s.max_contacts; });
}

int dGeomOddsMeshSetCarryMotion(dGeomID geom, dReal part) noexcept {
  return set(geom, __func__, part >= 0 && part <= 1, "the motion must be 0 .. 1 of the smaller body's size",
             [=](Settings& s) { s.carry_motion = part; });
}

dReal dGeomOddsMeshGetCarryMotion(dGeomID geom) noexcept {
  return get<dReal>(geom, __func__, [](const Settings& s) { return s.carry_motion; });
}

int dGeomOddsMeshSetLateContacts(dGeomID geom, int on) noexcept {
  return set(geom, __func__, on == 0 || on == 1, "it must be 0 or 1", [=](Settings& s) { s.late_contacts = on == 1; });
}

int dGeomOddsMeshGetLateContacts(dGeomID geom) noexcept {
  return get<int>(geom, __func__, [](const Settings& s) { return s.late_contacts ? 1 : 0; });
}

int dGeomOddsMeshSetMargin(dGeomID geom, dReal metres) noexcept {
  return set(geom, __func__, metres >= 0 && metres < dInfinity, "the margin must be >= 0 metres, and finite",
             [=](Settings& s) { s.margin_m = metres; });
}

dReal dGeomOddsMeshGetMargin(dGeomID geom) noexcept {
  return get<dReal>(geom, __func__, [](const Settings& s) { return s.margin_m; });
}

void oddsMakeSpeculative(dContact* contact, dReal step_s) noexcept {
  if (contact == nullptr || !(contact->geom.depth < 0) || !(step_s > 0)) return;
  const bool moves = (contact->surface.mode & dContactMotionN) != 0;
  contact->surface.motionN = (moves ? contact->surface.motionN : 0) + contact->geom.depth / step_s;
  contact->surface.mode |= dContactMotionN;
}

int dGeomOddsMeshSetMethod(dGeomID geom, int method) noexcept {
  return set(geom, __func__, method >= ODDS_METHOD_EXACT && method <= ODDS_METHOD_TIME_CRITICAL,
             "the method must be one of ODDS_METHOD_EXACT, _INCREMENTAL, _TIME_CRITICAL",
             [=](Settings& s) { s.method = static_cast<odds::query::Method>(method); });
}

int dGeomOddsMeshGetMethod(dGeomID geom) noexcept {
  return get<int>(geom, __func__, [](const Settings& s) { return s.method; });
}

int dGeomOddsMeshSetEstimator(dGeomID geom, int estimator) noexcept {
  return set(geom, __func__, estimator == ODDS_ESTIMATOR_CELLS || estimator == ODDS_ESTIMATOR_KINEMATIC,
             "the estimator must be ODDS_ESTIMATOR_CELLS or ODDS_ESTIMATOR_KINEMATIC",
             [=](Settings& s) { s.estimator = static_cast<odds::query::EstimatorKind>(estimator); });
}

int dGeomOddsMeshGetEstimator(dGeomID geom) noexcept {
  return get<int>(geom, __func__, [](const Settings& s) { return s.estimator; });
}

int dGeomOddsMeshSetUndecidedPolicy(dGeomID geom, int policy, dReal p) noexcept {
  const bool valid = (policy == ODDS_UNDECIDED_HIT || policy == ODDS_UNDECIDED_NO_CONTACT) && p >= 0 && p < 1;
  return set(geom, __func__, valid, "the policy must be ODDS_UNDECIDED_HIT or _NO_CONTACT, and 0 <= p < 1",
             [=](Settings& s) {
               s.undecided_policy = policy;
               s.undecided_probability = p;
             });
}

int dGeomOddsMeshGetUndecidedPolicy(dGeomID geom) noexcept {
  return get<int>(geom, __func__, [](const Settings& s) { return s.undecided_policy; });
}

dReal dGeomOddsMeshGetUndecidedProbability(dGeomID geom) noexcept {
  return get<dReal>(geom, __func__, [](const Settings& s) { return s.undecided_probability; });
}
