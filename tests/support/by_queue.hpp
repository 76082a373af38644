// A search by a priority queue on every bounding volume: one that counts likely pairs, of which no count ends it.
#pragma once

#include <limits>

#include "odds/query/request.hpp"

namespace odds::testing {

[[nodiscard]] constexpr query::Request by_queue(query::Request request = {}) noexcept {
  request.method = query::Method::time_critical;
  request.p_min = 1.0 - 1e-9;
  request.k_min = std::numeric_limits<std::uint32_t>::max();
  return request;
}

}  // namespace odds::testing
