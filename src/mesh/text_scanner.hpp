// Words and numbers, line by line, from text of any length in constant memory.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "mesh/input.hpp"

namespace odds::mesh {

/// Lines end with LF, CR LF or CR. Words are separated by blanks; control characters elsewhere are refused, since they
/// mean that the file is not text. A word is valid until the next call. Keeps input.line.
class TextScanner {
 public:
  struct Style {
    bool hash_comments = false;  ///< '#' at the beginning of a word starts a comment
    bool continuations = false;  ///< a backslash at the end joins the next line
  };
  TextScanner(Input& input, Style style) : input_(input), style_(style) {}

  /// The next word on this line; empty at its end.
  std::string_view word();
  /// The next word on this or a later line; empty at the end of the input.
  std::string_view word_on_any_line();
  /// Passes over the rest of this line. False if no line follows.
  bool next_line();

  /// A word as a number, rounded correctly; refuses words that are none, not finite or beyond doubles. `what` names
  /// it ("a coordinate"); an empty word is a missing number.
  double number(std::string_view word, const char* what);
  /// A word as a decimal integer.
  std::int64_t integer(std::string_view word, const char* what);
  /// Refuses if another word follows on this line.
  void expect_line_end(const char* after);
  /// Passes over the words to the end of the line, which must be numbers, and returns their count.
  std::size_t skip_numbers();

 private:
  bool skip_line_end();
  /// Some exporters write the terminating zero of a C string behind the last line.
  bool only_padding_follows();

  Input& input_;
  Style style_;
  bool in_comment_ = false;
};

/// A word of the file for a message: shortened, quoted, without unprintable characters.
std::string in_quotes(std::string_view word);

}  // namespace odds::mesh
