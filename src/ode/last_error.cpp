// Thread-local error text of the C interface.
#include "ode/last_error.hpp"

#include <algorithm>
#include <array>

#include "odds/ode/odds_ode.h"

namespace odds::ode {
namespace {

thread_local std::array<char, 1024> buffer = {};

}  // namespace

void set_last_error(std::string_view text) noexcept {
  const std::size_t length = std::min(text.size(), buffer.size() - 1);
  std::copy_n(text.data(), length, buffer.data());
  buffer[length] = '\0';
}

void set_last_error(const Error& error) noexcept {
  try {
    set_last_error(std::string_view(error.message()));
  } catch (...) {
    set_last_error(std::string_view(error.what));
  }
}

}  // namespace odds::ode

const char* oddsGetLastError(void) noexcept { return odds::ode::buffer.data(); }
