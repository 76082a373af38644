// Strict reading of settings: every refusal names the place, the value and what would be right.
#include "odds/haptics/settings.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace odds::haptics {
namespace {

std::string type_name(const Value& value) {
  static constexpr std::array<const char*, 6> names = {"a boolean", "an integer", "a number",
                                                       "text",      "a list",     "a table"};
  return names[value.data.index()];
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t above = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, diagonal + (a[i - 1] == b[j - 1] ? 0U : 1U)});
      diagonal = above;
    }
  }
  return row[b.size()];
}

constexpr double greatest_number = 1e12;  // no quantity of a scene needs more; squares of more overflow in the solver

bool before(Place a, Place b) { return a.line != b.line ? a.line < b.line : a.column < b.column; }

}  // namespace

std::string Place::text() const { return line == 0 ? std::string() : fmt::format("{}:{}", line, column); }

const Setting* Settings::find(std::string_view key) const {
  const auto found = std::find_if(entries.begin(), entries.end(), [&](const Setting& s) { return s.key == key; });
  return found == entries.end() ? nullptr : &*found;
}

bool Range::holds(double value) const noexcept {
  return (least_excluded ? value > least : value >= least) && value <= greatest;
}

std::string Range::text() const {
  const bool bounded_below = std::isfinite(least);
  const bool bounded_above = std::isfinite(greatest);
  if (bounded_below && bounded_above)
    return fmt::format("{}{} and at most {}", least_excluded ? "greater than " : "at least ", least, greatest);
  if (bounded_below) return fmt::format("{}{}", least_excluded ? "greater than " : "at least ", least);
  if (bounded_above) return fmt::format("at most {}", greatest);
  return "any finite number";
}

std::string nearest_name(std::string_view name, std::span<const std::string_view> candidates) {
  // A name cut short, often by its unit, comes before a slip of the pen.
  for (const std::string_view candidate : candidates) {
    if (name.size() >= 2 && candidate.substr(0, name.size()) == name) return std::string(candidate);
  }
  std::string_view best;
  std::size_t best_distance = std::max<std::size_t>(2, name.size() / 2) + 1;  // farther than that is another word
  for (const std::string_view candidate : candidates) {
    const std::size_t distance = edit_distance(name, candidate);
    if (distance >= best_distance) continue;
    best = candidate;
    best_distance = distance;
  }
  return std::string(best);
}

std::string list_names(std::span<const std::string_view> names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) text += i + 1 == names.size() ? " or " : ", ";
    text += names[i];
  }
  return text;
}

const Setting* SettingsReader::ask(std::string_view key) {
  if (std::find(asked_.begin(), asked_.end(), key) == asked_.end()) asked_.push_back(key);
  return settings_->find(key);
}

void SettingsReader::allow(std::span<const std::string_view> keys) {
  for (const std::string_view key : keys) (void)ask(key);
}

bool SettingsReader::has(std::string_view key) { return ask(key) != nullptr; }

Place SettingsReader::place_of(std::string_view key) const {
  const Setting* setting = settings_->find(key);
  return setting != nullptr ? setting->place : settings_->place;
}

void SettingsReader::reject(Place place, const std::string& what, const std::string& remedy) {
  if (first_ && !before(place, first_->first)) return;
  first_ = {place, Error{settings_->file, place.text(), what, remedy}};
}

void SettingsReader::reject(std::string_view key, const std::string& what, const std::string& remedy) {
  reject(place_of(key), what, remedy);
}

void SettingsReader::require(std::string_view key) {
  if (ask(key) == nullptr) {
    reject(settings_->place, fmt::format("{} lacks the key '{}'", settings_->title, key),
           fmt::format("add '{} = ...'", key));
  }
}

void SettingsReader::wrong_type(const Setting& setting, std::string_view wanted) {
  reject(setting.value.place, fmt::format("'{}' is {}, not {}", setting.key, type_name(setting.value), wanted),
         fmt::format("give {}", wanted));
}

bool SettingsReader::flag(std::string_view key, bool& target) {
  const Setting* setting = ask(key);
  if (setting == nullptr) return false;
  const bool* value = std::get_if<bool>(&setting->value.data);
  if (value == nullptr) {
    wrong_type(*setting, "true or false");
    return false;
  }
  target = *value;
  return true;
}

// One real number out of a value: integers are numbers too; NaN and infinity are not.
bool SettingsReader::real(std::string_view key, const Value& value, double& target) {
  double number = 0.0;
  if (const auto* integer = std::get_if<std::int64_t>(&value.data)) {
    number = static_cast<double>(*integer);
  } else if (const auto* floating = std::get_if<double>(&value.data)) {
    number = *floating;
  } else {
    reject(value.place, fmt::format("'{}' is {}, not a number", key, type_name(value)), "give a number");
    return false;
  }
  if (!std::isfinite(number)) {
    reject(value.place, fmt::format("'{}' is {}, which is not a finite number", key, number), "give a finite number");
    return false;
  }
  if (std::abs(number) > greatest_number) {
    reject(value.place, fmt::format("'{}' is {}, beyond 1e12", key, number),
           "give a smaller number, in the unit named");
    return false;
  }
  target = number;
  return true;
}

bool SettingsReader::number(std::string_view key, const Range& range, double& target) {
  const Setting* setting = ask(key);
  double value = 0.0;
  if (setting == nullptr || !real(key, setting->value, value)) return false;
  if (!range.holds(value)) {
    reject(setting->value.place, fmt::format("'{}' is {}, out of range", key, value),
           fmt::format("give a number {}", range.text()));
    return false;
  }
  target = value;
  return true;
}

bool SettingsReader::integer(std::string_view key, std::int64_t least, std::int64_t greatest, std::int64_t& target) {
  const Setting* setting = ask(key);
  if (setting == nullptr) return false;
  const auto* value = std::get_if<std::int64_t>(&setting->value.data);
  if (value == nullptr) {
    wrong_type(*setting, "an integer");
    return false;
  }
  if (*value < least || *value > greatest) {
    reject(setting->value.place, fmt::format("'{}' is {}, out of range", key, *value),
           fmt::format("give an integer from {} to {}", least, greatest));
    return false;
  }
  target = *value;
  return true;
}

bool SettingsReader::text(std::string_view key, std::string& target) {
  const Setting* setting = ask(key);
  if (setting == nullptr) return false;
  const auto* value = std::get_if<std::string>(&setting->value.data);
  if (value == nullptr) {
    wrong_type(*setting, "text in quotes");
    return false;
  }
  if (value->empty()) {
    reject(setting->value.place, fmt::format("'{}' is empty", key), "give some text, or leave the key out");
    return false;
  }
  target = *value;
  return true;
}

bool SettingsReader::texts(std::string_view key, std::vector<std::string>& target) {
  const Setting* setting = ask(key);
  if (setting == nullptr) return false;
  const auto* list = std::get_if<Value::List>(&setting->value.data);
  std::vector<std::string> found;
  if (list != nullptr) {
    for (const Value& value : *list) {
      if (const auto* text = std::get_if<std::string>(&value.data)) found.push_back(*text);
    }
  }
  if (list == nullptr || found.size() != list->size()) {
    wrong_type(*setting, "a list of texts");
    return false;
  }
  target = std::move(found);
  return true;
}

bool SettingsReader::numbers(const Setting& setting, std::size_t count, std::string_view wanted, double* target) {
  const auto* list = std::get_if<Value::List>(&setting.value.data);
  if (list == nullptr) {
    wrong_type(setting, wanted);
    return false;
  }
  if (list->size() != count) {
    reject(setting.value.place, fmt::format("'{}' has {} numbers, not {}", setting.key, list->size(), count),
           fmt::format("give {}", wanted));
    return false;
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (!real(setting.key, (*list)[i], target[i])) return false;
  }
  return true;
}

bool SettingsReader::vector(std::string_view key, Vec3& target) {
  const Setting* setting = ask(key);
  return setting != nullptr && numbers(*setting, 3, "a list of three numbers [x, y, z]", target.data());
}

bool SettingsReader::direction(std::string_view key, Vec3& target) {
  Vec3 value;
  if (!vector(key, value)) return false;
  const double length = value.stableNorm();
  if (!(length > 0.0)) {
    reject(key, fmt::format("'{}' has no direction", key), "give a vector that is not zero");
    return false;
  }
  target = value / length;
  return true;
}

bool SettingsReader::quaternion_wxyz(std::string_view key, Quat& target) {
  const Setting* setting = ask(key);
  std::array<double, 4> wxyz{};
  if (setting == nullptr || !numbers(*setting, 4, "a list of four numbers [w, x, y, z]", wxyz.data())) return false;
  const Quat value(wxyz[0], wxyz[1], wxyz[2], wxyz[3]);
  const double length = value.coeffs().stableNorm();
  if (!(std::abs(length - 1.0) <= 1e-3)) {
    reject(setting->value.place, fmt::format("'{}' has length {:.6g}, so it is not a rotation", key, length),
           "give a unit quaternion, w first");
    return false;
  }
  target = value.normalized();
  return true;
}

bool SettingsReader::choice(std::string_view key, std::span<const std::string_view> names, std::size_t& target) {
  std::string value;
  if (!text(key, value)) return false;
  const auto found = std::find(names.begin(), names.end(), value);
  if (found == names.end()) {
    const std::string near = nearest_name(value, names);
    reject(settings_->find(key)->value.place, fmt::format("'{}' cannot be '{}'", key, value),
           near.empty() ? "give " + list_names(names)
                        : fmt::format("did you mean '{}'? (valid: {})", near, list_names(names)));
    return false;
  }
  target = static_cast<std::size_t>(found - names.begin());
  return true;
}

const Settings* SettingsReader::table(std::string_view key) {
  const Setting* setting = ask(key);
  if (setting == nullptr) return nullptr;
  const auto* value = std::get_if<Settings>(&setting->value.data);
  if (value == nullptr) wrong_type(*setting, fmt::format("a table [{}]", key));
  return value;
}

std::vector<const Settings*> SettingsReader::tables(std::string_view key) {
  const Setting* setting = ask(key);
  std::vector<const Settings*> found;
  if (setting == nullptr) return found;
  const auto* list = std::get_if<Value::List>(&setting->value.data);
  if (list != nullptr) {
    for (const Value& value : *list) {
      if (const auto* table = std::get_if<Settings>(&value.data)) found.push_back(table);
    }
  }
  if (list == nullptr || found.size() != list->size()) {
    wrong_type(*setting, fmt::format("tables that each begin with [[{}]]", key));
    found.clear();
  }
  return found;
}

std::optional<Error> SettingsReader::finish() {
  for (const Setting& setting : settings_->entries) {
    if (std::find(asked_.begin(), asked_.end(), setting.key) != asked_.end()) continue;
    const std::string near = nearest_name(setting.key, asked_);
    reject(setting.place, fmt::format("unknown key '{}' in {}", setting.key, settings_->title),
           near.empty() ? "valid are " + list_names(asked_) : fmt::format("did you mean '{}'?", near));
  }
  if (!first_) return std::nullopt;
  return first_->second;
}

}  // namespace odds::haptics
