// How far are two shapes apart, and where are they nearest?
#pragma once

#include <limits>

#include "odds/query/answer.hpp"
#include "odds/query/budget.hpp"

namespace odds::query {

/// One question to Pair::distance. The defaults ask for the exact distance, however far.
struct DistanceRequest {
  /// Metres, >= 0: whether the shapes come within this margin, and where; what is farther is not searched for.
  double within = std::numeric_limits<double>::infinity();
  Budget budget = {};
};

/// True whatever the budget: the distance is at least `lower` and at most `upper`.
struct DistanceAnswer {
  double lower = 0.0;                                      ///< metres
  double upper = std::numeric_limits<double>::infinity();  ///< metres; infinite if no two points were found
  /// Nothing was left open: lower = upper, or nothing lies within the margin asked for (upper infinite, lower =
  /// within).
  bool proved = false;
  Vec3 on_a =
      Vec3::Zero();  ///< A's mesh frame: the nearest points found, if `upper` is finite; one point where they meet
  Vec3 on_b = Vec3::Zero();
  std::uint32_t triangle_a = no_feature;  ///< that they lie on
  std::uint32_t triangle_b = no_feature;
  Cost cost;
};

}  // namespace odds::query
