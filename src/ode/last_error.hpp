// The sentence behind oddsGetLastError(): a fixed buffer per thread.
#pragma once

#include <string_view>

#include "odds/math/error.hpp"

namespace odds::ode {

/// Keeps `text` (cut at the buffer's end) for this thread. Never allocates.
void set_last_error(std::string_view text) noexcept;
/// The same for an Error; at worst (no memory for its text) its `what` alone.
void set_last_error(const Error& error) noexcept;

}  // namespace odds::ode
