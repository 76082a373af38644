// How a reader gives up: thrown inside src/mesh only, turned into odds::Error at the public border.
#pragma once

#include <utility>

#include "odds/math/error.hpp"

namespace odds::mesh {

/// Parsers are deep and every second line can fail; unwinding keeps them readable. Never leaves read().
struct Refusal {
  Error error;
};

}  // namespace odds::mesh
