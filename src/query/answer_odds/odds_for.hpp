// Which of the tables of odds an answer's probability comes from.
#pragma once

#include "query/answer_odds/answer_odds_table.hpp"
#include "query/answer_odds/polygon_free_odds_table.hpp"

namespace odds::query {

/// `method` is the order that was followed; without polygons there is but one.
[[nodiscard]] constexpr const AnswerOdds& odds_for(volume::Kind volume, EstimatorKind estimator, Method method,
                                                   bool polygon_free) noexcept {
  if (polygon_free) return polygon_free_odds[polygon_free_odds_index(volume, estimator)];
  return answer_odds[odds_index(volume, estimator, method)];
}

}  // namespace odds::query
