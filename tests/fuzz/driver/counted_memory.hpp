// Counts the bytes that operator new has handed out and not got back, in the program that links this.
#pragma once

#include <cstddef>

namespace odds::fuzz {

/// Forgets the peak; counting goes on from what is held now.
void restart_peak() noexcept;
/// Greatest number of bytes held at a time since restart_peak(), beyond those held then.
[[nodiscard]] std::size_t peak_bytes() noexcept;
/// Number of allocations since the program began.
[[nodiscard]] std::size_t allocation_count() noexcept;

}  // namespace odds::fuzz
