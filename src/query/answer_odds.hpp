// The probability that an answer states when its search ended without a proof.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "odds/math/elementary.hpp"
#include "odds/query/request.hpp"
#include "odds/volume/kind.hpp"
#include "query/remains.hpp"

namespace odds::query {

/// Twelve numbers in, a probability out: a logistic regression, and a monotone line that bends what it says to what was
/// seen.
struct AnswerOdds {
  static constexpr std::size_t count = 12;
  static constexpr std::size_t most_pieces = 20;
  std::array<float, count> weights{};
  /// Shares of hits where the regression says 0, 1 / pieces, ... 1; ascending. What follows is not used.
  std::array<float, most_pieces + 1> seen{};
  std::size_t pieces = 10;  ///< of the line, all of one length
};

/// Of the wide engine a finer line, and how thin surfaces are, make odds truer on meshes that they were not fitted on;
/// of kdop18 they did not, and of the other volumes nobody tried.
[[nodiscard]] constexpr std::size_t pieces_of(volume::Kind kind) noexcept {
  return kind == volume::Kind::wide ? AnswerOdds::most_pieces : 10;
}
/// Where a search goes depth-first, what it leaves open is any pair, and how thin that is says nothing.
[[nodiscard]] constexpr bool counts_thin(volume::Kind kind, Method method) noexcept {
  return kind == volume::Kind::wide && method == Method::time_critical;
}

/// Surfaces that face the same way, as of nested shells, follow a law of their own: all numbers count once as they are
/// and once times `facing`.
[[nodiscard]] constexpr std::array<float, AnswerOdds::count> numbers_of(const Remains& r) noexcept {
  const float f = r.facing;
  return {1.0F,        r.spent,    r.open,      r.logit,    r.rank, f,
          f * r.spent, f * r.open, f * r.logit, f * r.rank, r.thin, f * r.thin};
}

/// What the regression says, in [0, 1].
[[nodiscard]] inline float regression(const AnswerOdds& odds, const Remains& remains) noexcept {
  const auto numbers = numbers_of(remains);
  float z = 0.0F;
  for (std::size_t i = 0; i < AnswerOdds::count; ++i) z += odds.weights[i] * numbers[i];
  const float upper = 1.0F / (2.0F - math::probability_of_rate(z < 0.0F ? -z : z));  // 1 / (1 + exp(-|z|))
  return z < 0.0F ? 1.0F - upper : upper;
}

inline constexpr std::size_t odds_tables = 4 * volume::kind_names.size();

/// Which table an answer's odds come from. Incremental searches are like exact ones.
[[nodiscard]] constexpr std::size_t odds_index(volume::Kind volume, EstimatorKind estimator, Method method) noexcept {
  return 4 * static_cast<std::size_t>(volume) + (estimator == EstimatorKind::kinematic ? 2U : 0U) +
         (method == Method::time_critical ? 1U : 0U);
}

/// Probability of a hit, in (0, 1): among searches that left this undecided, such a share met a hit.
[[nodiscard]] inline double probability_of_hit(const AnswerOdds& odds, const Remains& remains) noexcept {
  const float at = static_cast<float>(odds.pieces) * std::clamp(regression(odds, remains), 0.0F, 1.0F);
  const auto knot = std::min(static_cast<std::size_t>(at), odds.pieces - 1);
  const float part = at - static_cast<float>(knot);
  return static_cast<double>(odds.seen[knot] + part * (odds.seen[knot + 1] - odds.seen[knot]));
}

}  // namespace odds::query
