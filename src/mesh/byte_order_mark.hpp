// The mark that some editors write at the beginning of UTF-8 text.
#pragma once

#include <string_view>

namespace odds::mesh {

inline constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";

/// The beginning of a text, without one.
[[nodiscard]] constexpr std::string_view without_byte_order_mark(std::string_view text) noexcept {
  return text.starts_with(byte_order_mark) ? text.substr(byte_order_mark.size()) : text;
}

}  // namespace odds::mesh
