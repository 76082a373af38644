// A window that slides over a source of bytes and knows its place (line or byte) for error messages.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "mesh/byte_source.hpp"

namespace odds::mesh {

/// Bytes between cursor() and limit() are there to be looked at; fill() brings more. One byte behind limit() can always
/// be read and is '\n', so that scanning loops need no bounds check.
class Input {
 public:
  Input(ByteSource& source, std::string name);

  [[nodiscard]] const char* cursor() const noexcept { return cursor_; }
  [[nodiscard]] const char* limit() const noexcept { return limit_; }
  [[nodiscard]] std::size_t available() const noexcept { return static_cast<std::size_t>(limit_ - cursor_); }
  void move_to(const char* cursor) noexcept { cursor_ = cursor; }

  /// Tries to have `count` bytes (at most largest_fill) in the window; false if the input ends before.
  bool fill(std::size_t count) { return available() >= count || refill(count); }
  static constexpr std::size_t largest_fill = std::size_t{1} << 14;

  /// Takes one binary record of `size` bytes (at most largest_fill); its first byte becomes the place of errors.
  const char* take(std::size_t size) {
    if (!fill(size)) refuse_end(size);
    record_offset_ = offset();
    const char* const record = cursor_;
    cursor_ += size;
    return record;
  }
  /// The same for a number in the byte order of the file.
  template <class T>
  T take_number(std::endian order) {
    return decode<T>(take(sizeof(T)), order);
  }
  /// Passes over `size` bytes; refuses if they are not there.
  void skip(std::uint64_t size);

  template <class T>
  static T decode(const char* bytes, std::endian order) {
    std::array<char, sizeof(T)> raw;
    std::memcpy(raw.data(), bytes, sizeof(T));
    if (order != std::endian::native) std::reverse(raw.begin(), raw.end());
    return std::bit_cast<T>(raw);
  }

  [[nodiscard]] std::uint64_t offset() const noexcept {
    return base_ + static_cast<std::uint64_t>(cursor_ - window_.data());
  }
  /// Bytes from the cursor to the end of the input. For packed input the first call costs a pass over it.
  [[nodiscard]] std::uint64_t remaining();
  [[nodiscard]] std::uint64_t size() { return source_.size(); }

  std::uint64_t line = 1;  ///< kept by the text scanner
  bool binary = false;     ///< places are bytes instead of lines
  /// Makes a byte the place of errors in binary data, as take() does.
  void place_at(std::uint64_t offset) noexcept { record_offset_ = offset; }
  [[nodiscard]] const std::string& name() const noexcept { return name_; }
  [[nodiscard]] std::string place() const;
  [[noreturn]] void refuse(std::string what, std::string remedy) const;
  [[noreturn]] void refuse_at(std::string place, std::string what, std::string remedy) const;

 private:
  bool refill(std::size_t count);
  [[noreturn]] void refuse_end(std::size_t size);

  ByteSource& source_;
  std::string name_;
  std::vector<char> window_;
  const char* cursor_;
  const char* limit_;
  std::uint64_t base_ = 0;  // offset of window_[0] in the input
  std::uint64_t record_offset_ = 0;
  bool at_end_ = false;
};

}  // namespace odds::mesh
