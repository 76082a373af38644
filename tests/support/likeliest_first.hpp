// The order of searches that count likely pairs, where no count ends one: by a queue, on every bounding volume.
#pragma once

#include <limits>

#include "odds/query/request.hpp"

namespace odds::testing {

[[nodiscard]] constexpr query::Request likeliest_first(query::Request request = {}) noexcept {
  request.method = query::Method::time_critical;
  request.p_min = 1.0 - 1e-9;
  request.k_min = std::numeric_limits<std::uint32_t>::max();
  return request;
}

}  // namespace odds::testing
