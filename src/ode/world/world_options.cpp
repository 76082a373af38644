// Ranges of a world's options, and what they mean to ODE.
#include "ode/world/world_options.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "odds/ode/odds_ode.h"

namespace odds::ode {

std::optional<Fault> fault_of(const ContactModel& c) noexcept {
  if (!(c.stiffness_n_per_m > 0.0) || !(c.damping_ns_per_m >= 0.0) ||
      !std::isfinite(c.stiffness_n_per_m + c.damping_ns_per_m)) {
    return Fault{"the contact's stiffness or damping is out of range",
                 "give a stiffness above zero, a damping of at least zero, both finite"};
  }
  if (!(c.error_reduction > 0.0 && c.error_reduction <= 1.0)) {
    return Fault{"the share of an overlap that a step takes away is out of range", "give more than 0, at most 1"};
  }
  if (!(c.friction >= 0.0)) return Fault{"the friction coefficient is negative", "give at least zero"};
  if (!std::isfinite(c.friction)) {
    return Fault{"the friction coefficient is not finite", "give a finite one; 1000 lets nothing slide"};
  }
  if (!(c.max_correcting_velocity_m_per_s > 0.0)) {
    return Fault{"the greatest correcting velocity is not positive", "give metres per second above zero"};
  }
  return std::nullopt;
}

bool is_in_range(const Damping& damping) noexcept {
  return damping.linear_per_s >= 0.0 && damping.angular_per_s >= 0.0 &&
         std::isfinite(damping.linear_per_s + damping.angular_per_s);
}

std::optional<Error> check(const WorldOptions& o) {
  const auto bad = [](const char* what, const char* remedy) { return Error{"world", "", what, remedy}; };
  if (!(o.step_s > 0.0) || !std::isfinite(o.step_s))
    return bad("the step is not a positive time", "give seconds above zero");
  if (!o.gravity_m_per_s2.allFinite()) return bad("gravity is not finite", "give three finite numbers");
  if (const auto fault = fault_of(o.contact)) return bad(fault->what, fault->remedy);
  if (!is_in_range(o.damping)) return bad("the damping is out of range", "give at least zero, finite");
  if (!(o.max_speed_m_per_s > 0.0) || !(o.max_spin_rad_per_s > 0.0)) {
    return bad("the greatest speed or spin is not positive", "give numbers above zero");
  }
  if (o.query.max_contacts < 0 || o.query.max_contacts > most_contacts_per_pair) {
    return bad("the contacts of a pair are out of range", "give 0 to 8");
  }
  if (!(o.frame_us > 0.0) || o.frame_work_units < 1) {
    return bad("the frame's budget is not positive", "give microseconds above zero, at least one work unit");
  }
  if (o.parts < 1 || o.parts > 64) return bad("the parts of a step are out of range", "give 1 to 64");
  constexpr std::uint64_t no_limit = std::numeric_limits<std::uint64_t>::max();
  if (o.parts > 1 && !std::isfinite(o.frame_us) && o.frame_work_units == no_limit) {
    return bad("a step in parts has no frame's budget", "limit the frame, or do steps in one part");
  }
  if (o.max_contacts_per_step < 1 || o.max_contacts_per_step > 1024) {
    return bad("the contacts of a step are out of range", "give 1 to 1024");
  }
  return std::nullopt;
}

bool configure(dGeomID geom, const query::Request& q) noexcept {
  constexpr std::uint64_t no_limit = std::numeric_limits<std::uint64_t>::max();
  const bool timed = std::isfinite(q.budget.microseconds);
  const auto units = static_cast<unsigned long>(q.budget.work_units == no_limit ? 0 : q.budget.work_units);
  const int method = q.method == query::Method::exact         ? ODDS_METHOD_EXACT
                     : q.method == query::Method::incremental ? ODDS_METHOD_INCREMENTAL
                                                              : ODDS_METHOD_TIME_CRITICAL;
  const int estimator = q.estimator == query::EstimatorKind::cells ? ODDS_ESTIMATOR_CELLS : ODDS_ESTIMATOR_KINEMATIC;
  return dGeomOddsMeshSetBudget(geom, timed ? q.budget.microseconds : dInfinity) != 0 &&
         dGeomOddsMeshSetWorkBudget(geom, units) != 0 && dGeomOddsMeshSetPMin(geom, q.p_min) != 0 &&
         dGeomOddsMeshSetKMin(geom, static_cast<int>(q.k_min)) != 0 &&
         dGeomOddsMeshSetMaxContacts(geom, q.max_contacts) != 0 && dGeomOddsMeshSetMethod(geom, method) != 0 &&
         dGeomOddsMeshSetEstimator(geom, estimator) != 0 && dGeomOddsMeshSetCarryMotion(geom, q.carry_motion) != 0 &&
         dGeomOddsMeshSetLateContacts(geom, 0) != 0;  // its contacts are springs: what is not deep has no force
}

void reserve_solver(dWorldID world, const WorldOptions& options, std::uint32_t dynamic_bodies) noexcept {
  const std::uint32_t rows = (options.angular_friction ? 6 : 3) * options.max_contacts_per_step + 6 * dynamic_bodies;
  dWorldStepReserveInfo reserve{};
  reserve.struct_size = sizeof(reserve);
  reserve.reserve_factor = 1.2F;
  reserve.reserve_minimum =
      static_cast<unsigned>(std::max<std::size_t>(std::size_t{4} << 20U, std::size_t{24} * rows * rows));
  dWorldSetStepMemoryReservationPolicy(world, &reserve);
}

}  // namespace odds::ode
