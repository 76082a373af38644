// Numbers as the shortest text that reads back to the same value, independent of the locale. Private to mesh/made.
#pragma once

#include <array>
#include <charconv>
#include <string>

namespace odds::mesh::made {

template <class Number>
std::string number_text(Number value) {
  std::array<char, 40> text{};
  const std::to_chars_result end = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), end.ptr};
}

}  // namespace odds::mesh::made
