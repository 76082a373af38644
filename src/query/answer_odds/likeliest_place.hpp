// Where the surfaces most probably meet, from the pairs of nodes that a search left undecided.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "odds/math/elementary.hpp"
#include "odds/query/answer.hpp"
#include "query/answer_odds/way_apart.hpp"
#include "query/node_odds/met_place.hpp"
#include "query/search/shortlist.hpp"

namespace odds::query {

/// The mean over the shortlist in A's tree frame, each pair weighted by how deep it overlaps for its thickness and how
/// small it is; the normal also by how flat both patches are and, of solids, how much they face each other, for at an
/// edge those beside the ones that meet are as near. Two patches that nobody has looked into cannot be told to overlap
/// deeper than the thinner of them is thick, and they may not meet at all: the depth is the expected one, for
/// `probability` of a hit, so that a force made of it grows with what is known. `apart()`: the way that solids come
/// apart by all that is known of them without the list, into A; it decides where no patch faces another, and has a say
/// of its worth elsewhere. Precondition: the list is not empty.
template <class Met, class Apart>
[[nodiscard]] Contact likeliest_place(const Met& met, const Shortlist& list, double probability, bool both_solid,
                                      const Apart& apart) noexcept {
  constexpr double unopposed = 0.01;         // of what is flat: less, and all that is known lies beside what meets
  constexpr double least_opposition = 0.01;  // so that patches of which none faces another have a direction, too
  static_assert(Shortlist::capacity <= Four::count);
  std::array<MetPlace, Shortlist::capacity> places;
  std::array<PatchPair, Shortlist::capacity> patches;
  for (std::size_t i = 0; i < list.size(); ++i) patches[i] = met.patches(list.begin()[i]);
  find_met_places(std::span(patches).first(list.size()), met.pose(), places);
  std::array<double, Shortlist::capacity> weights;
  Contact mean;
  Vec3 position = Vec3::Zero();
  Vec3 facing = Vec3::Zero();
  double sum = 0.0;
  double opposed = 0.0;
  double flat = 0.0;
  std::size_t count = 0;
  for (const NodePair& pair : list) {
    const MetPlace& place = places[count];
    if (count == 0) mean.position = place.position;
    const double weight =
        static_cast<double>(math::rough_exp2(std::clamp(pair.rank, -20.0F, 4.0F) + place.log_likelihood)) *
        place.inverse_size;
    weights[count++] = weight;
    position += weight * place.position;
    facing += weight * (both_solid ? least_opposition + place.opposition : 1.0) * place.direction;
    sum += weight;
    opposed += weight * place.opposition;
    flat += weight * place.flatness;
  }
  if (both_solid) {
    constexpr double most_said = 2.0;  // as much as patches that face each other
    const WayApart way = apart();
    facing = opposed < unopposed * flat ? way.direction : Vec3(facing + most_said * way.worth * sum * way.direction);
  }
  const double length = facing.norm();
  if (!(sum > 0.0) || !std::isfinite(sum) || !(length > 0.0) || !std::isfinite(length)) return mean;
  mean.position = position / sum;
  mean.normal = facing / length;
  double depth = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const double passed = mean.normal.dot(places[i].beyond);
    depth += weights[i] * places[i].flatness * std::clamp(passed, 0.0, places[i].thickness);
  }
  mean.depth = probability * depth / sum;
  return mean;
}

}  // namespace odds::query
