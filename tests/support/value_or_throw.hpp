// What a program by hand does with an error: it ends with its message.
#pragma once

#include <stdexcept>
#include <utility>

#include "odds/math/error.hpp"

namespace odds::testing {

template <class T>
[[nodiscard]] T value_or_throw(Result<T> result) {
  if (!result.ok()) throw std::runtime_error(result.error().message());
  return std::move(result).value();
}

}  // namespace odds::testing
