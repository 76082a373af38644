// Several steps as one.
#include <algorithm>

#include "odds/ode/world.hpp"

namespace odds::ode {

void StepSummary::add(const StepSummary& next) noexcept {
  if (next.queries > 0) {
    verdict = queries == 0 ? next.verdict : std::max(verdict, next.verdict);
    basis = std::max(basis, next.basis);
    probability = std::max(probability, next.probability);
  }
  queries += next.queries;
  node_pairs += next.node_pairs;
  triangle_pairs += next.triangle_pairs;
  query_gross_us += next.query_gross_us;
  query_stall_us += next.query_stall_us;
  query_overshoot_us = std::max(query_overshoot_us, next.query_overshoot_us);
  query_net_overshoot_us = std::max(query_net_overshoot_us, next.query_net_overshoot_us);
  meetings += next.meetings;
  contacts = std::max(contacts, next.contacts);
  friction_rows += next.friction_rows;
  angular_rows += next.angular_rows;
  solver_calls += next.solver_calls;
  bodies_stepped += next.bodies_stepped;
  contact_work_j += next.contact_work_j;
  pairs_left_out += next.pairs_left_out;
  frame_overshoot_us = std::max(frame_overshoot_us, next.frame_overshoot_us);
  contacts_left_out += next.contacts_left_out;
  solver_messages += next.solver_messages;
  max_depth_m = std::max(max_depth_m, next.max_depth_m);
  collision_us += next.collision_us;
  step_us += next.step_us;
  bodies_slowed += next.bodies_slowed;
  bodies_recovered += next.bodies_recovered;
}

}  // namespace odds::ode
