// Where the surfaces most probably meet, from the pairs of nodes that a search left undecided.
#pragma once

#include <algorithm>
#include <cmath>

#include "odds/query/answer.hpp"
#include "query/shortlist.hpp"

namespace odds::query {

/// The mean over the shortlist, each pair weighted by how deep it overlaps for its thickness and how small it is.
/// `probability` is that of a hit at all: the depth is the expected one, so that a force made of it grows with what is
/// known. Precondition: the list is not empty.
template <class Met>
[[nodiscard]] Contact likeliest_place(const Met& met, const Shortlist& list, double probability) noexcept {
  Contact mean;
  mean.position.setZero();
  mean.normal.setZero();
  double sum = 0.0;
  for (const NodePair& pair : list) {
    const double size = std::max(met.size(pair.a, pair.b), 1e-300);
    const double weight = static_cast<double>(std::exp2(std::clamp(pair.rank, -20.0F, 4.0F))) / size;
    const Contact contact = met.cell_contact(pair.a, pair.b, probability);
    mean.position += weight * contact.position;
    mean.normal += weight * contact.normal;
    mean.depth += weight * contact.depth;
    sum += weight;
  }
  const double length = mean.normal.norm();
  if (!(sum > 0.0) || !std::isfinite(sum) || !(length > 1e-6 * sum)) {
    return met.cell_contact(list.highest().a, list.highest().b, probability);
  }
  mean.position /= sum;
  mean.depth /= sum;
  mean.normal /= length;
  return mean;
}

}  // namespace odds::query
