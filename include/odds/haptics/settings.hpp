// Settings as a user wrote them: tables of named values that know the line they stand on, and how to read them
// strictly.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "odds/math/error.hpp"
#include "odds/math/types.hpp"

namespace odds::haptics {

/// Where something stands in a text file; both count from 1. {0, 0}: nowhere (made by a program).
struct Place {
  std::uint32_t line = 0;
  std::uint32_t column = 0;
  [[nodiscard]] std::string text() const;
};

struct Setting;

/// A table of settings, whatever file format it came from. Keys are unique, in the order of the file.
struct Settings {
  std::string file;   ///< for error messages
  std::string title;  ///< "[device.hand]" or the like, for error messages
  Place place;
  std::vector<Setting> entries;

  [[nodiscard]] const Setting* find(std::string_view key) const;
};

/// One value: boolean, integer, real number, text, list, or a table of its own.
struct Value {
  using List = std::vector<Value>;
  std::variant<bool, std::int64_t, double, std::string, List, Settings> data;
  Place place;
};

struct Setting {
  std::string key;
  Place place;
  Value value;
};

/// Which numbers are allowed.
struct Range {
  double least = -std::numeric_limits<double>::infinity();
  double greatest = std::numeric_limits<double>::infinity();
  bool least_excluded = false;  ///< true: must be greater than `least`
  [[nodiscard]] bool holds(double value) const noexcept;
  [[nodiscard]] std::string text() const;

  [[nodiscard]] static Range any() { return {}; }
  [[nodiscard]] static Range positive() { return {0.0, std::numeric_limits<double>::infinity(), true}; }
  [[nodiscard]] static Range not_negative() { return {0.0, std::numeric_limits<double>::infinity(), false}; }
  [[nodiscard]] static Range between(double least, double greatest) { return {least, greatest, false}; }
};

/// The candidate with the smallest edit distance to `name`; empty if none is near enough to be meant.
[[nodiscard]] std::string nearest_name(std::string_view name, std::span<const std::string_view> candidates);

/// "A, B or C".
[[nodiscard]] std::string list_names(std::span<const std::string_view> names);

/// Reads one table strictly. Each call names a key, so that the reader knows what was allowed: finish() reports keys
/// that nobody asked for, with the nearest one that was. A value of a wrong type, out of range, not finite or
/// of a magnitude beyond 1e12 is an error. All calls go on after an error (and leave `target` alone); the error that
/// stands first in the file is kept.
///
///     SettingsReader reader(table);
///     reader.number("mu", Range::not_negative(), friction.mu);
///     if (auto error = reader.finish()) return *error;
class SettingsReader {
 public:
  /// `settings` must outlive the reader.
  explicit SettingsReader(const Settings& settings) : settings_(&settings) {}

  // Each returns true if the key was there and good, and then sets `target`.
  bool flag(std::string_view key, bool& target);
  bool number(std::string_view key, const Range& range, double& target);
  bool integer(std::string_view key, std::int64_t least, std::int64_t greatest, std::int64_t& target);
  bool text(std::string_view key, std::string& target);
  bool texts(std::string_view key, std::vector<std::string>& target);
  bool vector(std::string_view key, Vec3& target);
  /// Like vector, of any length but zero; made unit.
  bool direction(std::string_view key, Vec3& target);
  /// Four numbers w, x, y, z of unit length within 1e-3; made unit.
  bool quaternion_wxyz(std::string_view key, Quat& target);
  /// One of `names`; sets the index.
  bool choice(std::string_view key, std::span<const std::string_view> names, std::size_t& target);

  /// A sub-table, or null if absent (or no table: an error).
  [[nodiscard]] const Settings* table(std::string_view key);
  /// An array of tables; empty if absent.
  [[nodiscard]] std::vector<const Settings*> tables(std::string_view key);

  /// Reports an error if the key is missing.
  void require(std::string_view key);
  /// Reports an error of the caller's own at a key (or at the table, if the key is absent).
  void reject(std::string_view key, const std::string& what, const std::string& remedy);
  void reject(Place place, const std::string& what, const std::string& remedy);

  /// Keys that somebody else reads: finish() does not call them unknown. The names must outlive the reader.
  void allow(std::span<const std::string_view> keys);
  [[nodiscard]] bool has(std::string_view key);
  [[nodiscard]] Place place_of(std::string_view key) const;
  [[nodiscard]] const Settings& settings() const noexcept { return *settings_; }

  /// The first error, unknown keys included; nothing if all is well.
  [[nodiscard]] std::optional<Error> finish();

 private:
  const Setting* ask(std::string_view key);
  void wrong_type(const Setting& setting, std::string_view wanted);
  bool numbers(const Setting& setting, std::size_t count, std::string_view wanted, double* target);
  bool real(std::string_view key, const Value& value, double& target);

  const Settings* settings_;
  std::vector<std::string_view> asked_;
  std::optional<std::pair<Place, Error>> first_;
};

}  // namespace odds::haptics
