#include "ode/world/meeting_answer.hpp"

#include <algorithm>

#include "odds/ode/odds_ode.h"

namespace odds::ode {

void note_answer(dGeomID a, dGeomID b, Meeting& meeting, StepSummary& summary) noexcept {
  oddsAnswer answer;
  if (oddsGetLastAnswer(a, b, &answer) == 0) return;
  const auto basis = answer.basis == ODDS_PROVED      ? query::Basis::proved
                     : answer.basis == ODDS_ESTIMATED ? query::Basis::estimated
                                                      : query::Basis::budget;
  if (answer.only_held == 0) ++summary.queries;
  meeting.verdict = answer.verdict == ODDS_HIT ? query::Verdict::hit : query::Verdict::clear;
  meeting.basis = basis;
  meeting.probability = answer.probability;
  if (answer.verdict == ODDS_HIT) summary.verdict = query::Verdict::hit;
  summary.basis = std::max(summary.basis, basis);
  summary.probability = std::max(summary.probability, answer.probability);
  summary.node_pairs += answer.node_pairs;
  summary.triangle_pairs += answer.triangle_pairs;
  summary.query_gross_us += answer.gross_us;
  summary.query_stall_us += answer.stall_us;
  summary.query_overshoot_us = std::max(summary.query_overshoot_us, answer.overshoot_us);
  summary.query_net_overshoot_us = std::max(summary.query_net_overshoot_us, answer.net_overshoot_us);
}

}  // namespace odds::ode
