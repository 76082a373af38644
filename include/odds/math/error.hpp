// The one way in which bad input is reported: a value that names the file, the place, what is wrong and what to do.
#pragma once

#include <string>
#include <utility>
#include <variant>

namespace odds {

/// Bad input, said so that the user can mend it. Never used for broken preconditions nor for undecided queries.
struct Error {
  std::string file;    ///< file or input name; may be empty
  std::string place;   ///< "12" (line), "12:5" (line:column), "byte 84", "row 3"; may be empty
  std::string what;    ///< what is wrong
  std::string remedy;  ///< what to do about it

  /// "FILE:PLACE: what; remedy", parts that are empty left out.
  [[nodiscard]] std::string message() const {
    std::string text;
    if (!file.empty()) text += file + ":";
    if (!place.empty()) text += place + ":";
    if (!text.empty()) text += " ";
    text += what;
    if (!remedy.empty()) text += "; " + remedy;
    return text;
  }
};

/// A value or an Error. Loading and building return it; queries never do.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}      // NOLINT: implicit on purpose
  Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}  // NOLINT: implicit on purpose

  [[nodiscard]] bool ok() const noexcept { return state_.index() == 0; }
  explicit operator bool() const noexcept { return ok(); }

  /// Precondition: ok(). Otherwise std::bad_variant_access is thrown.
  [[nodiscard]] T& value() & { return std::get<0>(state_); }
  [[nodiscard]] const T& value() const& { return std::get<0>(state_); }
  [[nodiscard]] T&& value() && { return std::get<0>(std::move(state_)); }
  /// Precondition: !ok().
  [[nodiscard]] const Error& error() const { return std::get<1>(state_); }

 private:
  std::variant<T, Error> state_;
};

}  // namespace odds
