// The scanner's loops over characters, and the words for what they refuse.
#include "mesh/text_scanner.hpp"

#include <array>
#include <charconv>
#include <cmath>

namespace odds::mesh {
namespace {

enum class Kind : std::uint8_t { word, blank, line_end, control };

constexpr std::array<Kind, 256> make_kinds() {
  std::array<Kind, 256> kinds{};
  for (std::size_t c = 0; c < 0x20; ++c) kinds[c] = Kind::control;
  for (const char c : {' ', '\t', '\v', '\f'}) kinds[static_cast<unsigned char>(c)] = Kind::blank;
  for (const char c : {'\n', '\r'}) kinds[static_cast<unsigned char>(c)] = Kind::line_end;
  return kinds;
}
constexpr std::array<Kind, 256> kinds = make_kinds();

Kind kind(char c) { return kinds[static_cast<unsigned char>(c)]; }

// No number or keyword is longer; file names in ignored statements are never longer on real systems.
constexpr std::size_t longest_word = 4096;
static_assert(longest_word + 2 <= Input::largest_fill);

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Tells overflow from underflow for a well-formed decimal number that from_chars found out of range.
bool is_tiny(std::string_view text) {
  const std::size_t mark = text.find_first_of("eE");
  const std::string_view mantissa = text.substr(0, mark);
  long exponent = 0;
  if (mark != std::string_view::npos) {
    std::string_view digits = text.substr(mark + 1);
    const bool negative = digits.front() == '-';
    if (digits.front() == '-' || digits.front() == '+') digits.remove_prefix(1);
    if (std::from_chars(digits.data(), digits.data() + digits.size(), exponent).ec != std::errc{}) return negative;
    if (negative) exponent = -exponent;
  }
  const std::size_t point = std::min(mantissa.find('.'), mantissa.size());
  const std::size_t leading = std::min(mantissa.find_first_of("123456789"), mantissa.size());
  return static_cast<double>(point) - static_cast<double>(leading) + static_cast<double>(exponent) < 0;
}

}  // namespace

std::string in_quotes(std::string_view word) {
  constexpr std::size_t longest = 32;
  std::string text = "'";
  for (const char c : word.substr(0, longest)) text += (c > ' ' && c < 0x7f) ? c : '?';
  if (word.size() > longest) text += "...";
  return text + "'";
}

std::string_view TextScanner::word() {
  for (;;) {
    input_.fill(longest_word + 2);
    const char* begin = input_.cursor();
    while (kind(*begin) == Kind::blank) ++begin;
    input_.move_to(begin);
    if (begin == input_.limit()) {
      if (!input_.fill(1)) return {};
      continue;
    }
    if (kind(*begin) == Kind::line_end) return {};
    if (*begin == '#' && style_.hash_comments) {
      in_comment_ = true;
      return {};
    }
    input_.fill(longest_word + 2);
    begin = input_.cursor();
    const char* end = begin;
    while (kind(*end) == Kind::word) ++end;
    const char character = *end;
    if (kind(character) == Kind::control && !(character == '\0' && end != begin)) {
      if (character == '\0' && only_padding_follows()) return {};
      input_.refuse("a control character (" + std::to_string(static_cast<int>(character)) + ") stands in the text",
                    "the file is damaged or not of this format: export it again");
    }
    std::string_view found(begin, static_cast<std::size_t>(end - begin));
    if (found.size() > longest_word) {
      input_.refuse("a word of more than 4096 characters", "the file is damaged or not of this format");
    }
    if (style_.continuations && found.back() == '\\' && end < input_.limit() && kind(*end) == Kind::line_end) {
      found.remove_suffix(1);
      if (found.empty()) {
        input_.move_to(end);
        skip_line_end();
        continue;
      }
      --end;
    }
    input_.move_to(end);
    return found;
  }
}

bool TextScanner::only_padding_follows() {
  while (input_.fill(1)) {
    const char* at = input_.cursor();
    while (at != input_.limit() && *at == '\0') ++at;
    input_.move_to(at);
    if (at != input_.limit()) return false;
  }
  return true;
}

std::string_view TextScanner::word_on_any_line() {
  do {
    if (const std::string_view found = word(); !found.empty()) return found;
  } while (next_line());
  return {};
}

bool TextScanner::skip_line_end() {
  const bool carriage_return = *input_.cursor() == '\r';
  input_.move_to(input_.cursor() + 1);
  if (carriage_return && input_.fill(1) && *input_.cursor() == '\n') input_.move_to(input_.cursor() + 1);
  if (!input_.fill(1)) return false;  // the last line keeps its number
  ++input_.line;
  return true;
}

bool TextScanner::next_line() {
  char last = ' ';
  for (;;) {
    const char* at = input_.cursor();
    const char* const limit = input_.limit();
    for (; at != limit && kind(*at) != Kind::line_end; last = *at++) {
      if (*at == '#' && style_.hash_comments && kind(last) == Kind::blank) in_comment_ = true;
    }
    input_.move_to(at);
    if (at == limit) {
      if (!input_.fill(1)) return false;
      continue;
    }
    if (!skip_line_end()) return false;
    if (style_.continuations && !in_comment_ && last == '\\') {
      last = ' ';
      continue;
    }
    in_comment_ = false;
    return true;
  }
}

double TextScanner::number(std::string_view word, const char* what) {
  if (word.empty()) {
    input_.refuse(std::string(what) + " is missing at the end of the line", "complete the line");
  }
  std::string_view text = word;
  if (text.size() > 1 && text[0] == '+' && (is_digit(text[1]) || text[1] == '.')) text.remove_prefix(1);
  double value = 0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (status == std::errc::invalid_argument || end != text.data() + text.size()) {
    const bool comma = text.find(',') != std::string_view::npos;
    input_.refuse(std::string(what) + " is " + in_quotes(word) + ", which is not a number",
                  comma ? "write decimal points, not commas" : "write a decimal number such as 0.25");
  }
  if (status == std::errc::result_out_of_range) {
    if (is_tiny(text)) return text[0] == '-' ? -0.0 : 0.0;  // what correct rounding gives
    input_.refuse(std::string(what) + " is " + in_quotes(word) + ", beyond the range of doubles", "correct the number");
  }
  if (!std::isfinite(value)) {
    input_.refuse(std::string(what) + " is " + in_quotes(word) + ", which is not finite",
                  "remove or correct the vertex where the file was made");
  }
  return value;
}

std::int64_t TextScanner::integer(std::string_view word, const char* what) {
  if (word.empty()) {
    input_.refuse(std::string(what) + " is missing at the end of the line", "complete the line");
  }
  std::int64_t value = 0;
  const auto [end, status] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (status == std::errc::result_out_of_range) {
    input_.refuse(std::string(what) + " is " + in_quotes(word) + ", beyond the range of integers",
                  "correct the number");
  }
  if (status != std::errc{} || end != word.data() + word.size()) {
    input_.refuse(std::string(what) + " is " + in_quotes(word) + ", which is not an integer", "write a whole number");
  }
  return value;
}

void TextScanner::expect_line_end(const char* after) {
  if (const std::string_view extra = word(); !extra.empty()) {
    input_.refuse(in_quotes(extra) + " follows " + after + " on the same line",
                  "put it on a line of its own or remove it");
  }
}

std::size_t TextScanner::skip_numbers() {
  std::size_t count = 0;
  for (std::string_view extra = word(); !extra.empty(); extra = word(), ++count) number(extra, "an extra value");
  return count;
}

}  // namespace odds::mesh
