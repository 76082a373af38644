// A query for contacts within microseconds of a clock that a test turns.
#pragma once

#include "odds/query/pair.hpp"

namespace odds::testing {

inline query::Request short_request(realtime::ManualClock& clock, double microseconds = 5.0) {
  query::Request request;
  request.method = query::Method::incremental;
  request.max_contacts = 4;
  request.budget = query::Budget::time(microseconds);
  request.budget.clock = clock.clock();
  return request;
}

}  // namespace odds::testing
