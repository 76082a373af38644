// The probability that an answer states when its search ended without a proof.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "odds/math/elementary.hpp"
#include "odds/query/request.hpp"
#include "odds/volume/kind.hpp"
#include "query/answer_odds/remains.hpp"

namespace odds::query {

/// Numbers in, a probability out: a logistic regression, and monotone lines that bend what it says to what was seen.
struct AnswerOdds {
  static constexpr std::size_t straight = 19;  ///< numbers that count once
  static constexpr std::size_t again = 5;      ///< numbers that count again from each of some places on: numbers_of
  static constexpr std::array<float, 4> places = {-1.2F, -0.4F, 0.4F, 1.2F};  ///< in their usual spreads
  static constexpr std::size_t count = straight + places.size() * again;
  static constexpr std::size_t pieces = 20;  ///< of the line, all of one length
  std::array<float, count> weights{};
  using Line = std::array<float, pieces + 1>;  ///< shares of hits where the regression says 0, 1/20, ... 1; ascending
  Line seen{};                                 ///< of surfaces that face each other or cross
  Line seen_of_shells{};                       ///< of those that face the same way
};

/// Surfaces that face the same way, as of nested shells, follow a law of their own: what is known counts once times how
/// much they do, and once times how little. That several numbers are high at once says more than each alone, and what
/// a number says changes along its range: five of them count again from each of four places on. Of shells, neither says
/// anything that would hold for others.
[[nodiscard]] constexpr std::array<float, AnswerOdds::count> numbers_of(const Remains& r) noexcept {
  const float f = r.facing;
  const float g = 1.0F - f;
  constexpr float to_order_of_ten = 0.1F;
  const float h = to_order_of_ten * g;
  std::array<float, AnswerOdds::count> numbers = {1.0F,
                                                  f,
                                                  g * r.spent,
                                                  f * r.spent,
                                                  g * r.tested,
                                                  f * r.tested,
                                                  g * r.open,
                                                  f * r.open,
                                                  g * r.logit,
                                                  f * r.logit,
                                                  g * r.rank,
                                                  f * r.rank,
                                                  g * r.thin,
                                                  f * r.thin,
                                                  g * r.small,
                                                  f * r.small,
                                                  h * r.rank * r.open,
                                                  h * r.spent * r.spent,
                                                  h * r.spent * r.small};
  // In parts of its usual spread, from its usual value: rounded from the searches of the fit. Neither what was looked
  // at in vain nor how thin surfaces are: beyond what the fit saw, hits would become likelier with the former; the
  // latter gained nothing.
  const std::array<float, AnswerOdds::again> spread = {(r.spent - 7.0F) / 2.0F, (r.open - 3.0F) / 1.5F,
                                                       (r.logit + 1.0F) / 2.0F, r.rank / 2.0F, (r.small + 3.0F) / 1.5F};
  std::size_t next = AnswerOdds::straight;
  for (const float place : AnswerOdds::places) {
    for (const float number : spread) numbers[next++] = g * std::max(number - place, 0.0F);
  }
  return numbers;
}

/// Whether such a number speaks of surfaces that face the same way. Those of one pair of shells tell little of another,
/// so their weights are held small when they are fitted.
[[nodiscard]] constexpr bool is_of_shells(std::size_t number) noexcept {
  return number % 2 == 1 && number > 1 && number < 16;
}

/// Whether such a number is one that counts again. Many of them say nearly the same, so their weights are held smaller
/// than others when they are fitted.
[[nodiscard]] constexpr bool counts_again(std::size_t number) noexcept { return number >= AnswerOdds::straight; }

/// What the regression says, in [0, 1].
[[nodiscard]] inline float regression(const AnswerOdds& odds, const Remains& remains) noexcept {
  const auto numbers = numbers_of(remains);
  std::array<float, 8> sums{};  // side by side, in one order on all machines
  for (std::size_t i = 0; i < AnswerOdds::count; ++i) sums[i % 8] += odds.weights[i] * numbers[i];
  const float z = ((sums[0] + sums[4]) + (sums[1] + sums[5])) + ((sums[2] + sums[6]) + (sums[3] + sums[7]));
  const float upper = 1.0F / (2.0F - math::probability_of_rate(z < 0.0F ? -z : z));  // 1 / (1 + exp(-|z|))
  return z < 0.0F ? 1.0F - upper : upper;
}

inline constexpr std::size_t odds_tables = 4 * volume::kind_names.size();

/// Which table an answer's odds come from. Incremental searches are like exact ones.
[[nodiscard]] constexpr std::size_t odds_index(volume::Kind volume, EstimatorKind estimator, Method method) noexcept {
  return 4 * static_cast<std::size_t>(volume) + (estimator == EstimatorKind::kinematic ? 2U : 0U) +
         (method == Method::time_critical ? 1U : 0U);
}

/// Which table of polygon_free_odds_table.hpp.
[[nodiscard]] constexpr std::size_t polygon_free_odds_index(volume::Kind volume, EstimatorKind estimator) noexcept {
  return 2 * static_cast<std::size_t>(volume) + (estimator == EstimatorKind::kinematic ? 1U : 0U);
}

/// Probability of a hit, in (0, 1): among searches that left this undecided, such a share met a hit.
[[nodiscard]] inline double probability_of_hit(const AnswerOdds& odds, const Remains& remains) noexcept {
  constexpr std::size_t pieces = AnswerOdds::pieces;
  const float at = static_cast<float>(pieces) * std::clamp(regression(odds, remains), 0.0F, 1.0F);
  const auto knot = std::min(static_cast<std::size_t>(at), pieces - 1);
  const float part = at - static_cast<float>(knot);
  const auto bent = [&](const AnswerOdds::Line& line) noexcept {
    return line[knot] + part * (line[knot + 1] - line[knot]);
  };
  const float apart = bent(odds.seen);
  return static_cast<double>(apart + remains.facing * (bent(odds.seen_of_shells) - apart));
}

}  // namespace odds::query
