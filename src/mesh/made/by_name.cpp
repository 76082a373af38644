#include "odds/mesh/made/by_name.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <numeric>
#include <span>

#include "mesh/made/parameters.hpp"
#include "odds/mesh/made/bolt.hpp"
#include "odds/mesh/made/box.hpp"
#include "odds/mesh/made/bumpy_sphere.hpp"
#include "odds/mesh/made/car_body.hpp"
#include "odds/mesh/made/gear.hpp"
#include "odds/mesh/made/icosphere.hpp"
#include "odds/mesh/made/nested_shells.hpp"
#include "odds/mesh/made/nut.hpp"
#include "odds/mesh/made/peg.hpp"
#include "odds/mesh/made/plate_with_hole.hpp"
#include "odds/mesh/made/plates.hpp"
#include "odds/mesh/made/terrain.hpp"
#include "odds/mesh/made/torus.hpp"
#include "odds/mesh/made/torus_knot.hpp"
#include "odds/mesh/made/uv_sphere.hpp"

namespace odds::mesh::made {
namespace {

struct Entry {
  std::string_view name;
  Result<TriangleMesh> (*make)(std::string_view settings);
  std::string (*describe)();
};

/// Letters to insert, delete or replace to turn one word into the other (Levenshtein).
std::size_t edits_between(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, replaced});
    }
  }
  return row.back();
}

std::string nearest(std::string_view word, const std::vector<std::string_view>& words) {
  const auto closer = [&](std::string_view a, std::string_view b) {
    return edits_between(word, a) < edits_between(word, b);
  };
  return std::string(*std::min_element(words.begin(), words.end(), closer));
}

std::string listed(const std::vector<std::string_view>& words) {
  std::string text;
  for (const std::string_view word : words) text += (text.empty() ? "" : ", ") + std::string(word);
  return text;
}

template <class Number>
bool read_number(std::string_view text, Number& number) {
  const std::from_chars_result end = std::from_chars(text.data(), text.data() + text.size(), number);
  return end.ec == std::errc{} && end.ptr == text.data() + text.size() && !text.empty();
}

/// Sets one "key=value".
template <class Shape>
std::optional<Error> set_field(Shape& shape, std::string_view setting) {
  const std::size_t equals = setting.find('=');
  const std::string key(setting.substr(0, equals));
  if (equals == std::string_view::npos) {
    return refuse(shape, "\"" + key + "\" is not of the form key=value",
                  "write for example " + std::string(Shape::fields().front().name) + "=VALUE");
  }
  const std::string value(setting.substr(equals + 1));
  std::vector<std::string_view> keys;
  for (const Field<Shape>& field : Shape::fields()) {
    keys.push_back(field.name);
    if (field.name != key) continue;
    const bool read = std::visit([&](auto member) { return read_number(value, shape.*member); }, field.member);
    if (read) return std::nullopt;
    const bool whole = !std::holds_alternative<double Shape::*>(field.member);
    return refuse(shape, key + " = \"" + value + "\" is not a " + (whole ? "whole number" : "number"),
                  "give a value from " + number_text(field.least) + " to " + number_text(field.greatest));
  }
  return refuse(shape, "there is no parameter \"" + key + "\"",
                "did you mean \"" + nearest(key, keys) + "\"? parameters: " + listed(keys));
}

template <class Shape>
Result<TriangleMesh> make_from(std::string_view settings) {
  Shape shape;
  std::vector<std::string_view> given;
  while (!settings.empty()) {
    const std::size_t comma = settings.find(',');
    const std::string_view setting = settings.substr(0, comma);
    if (auto error = set_field(shape, setting)) return *std::move(error);
    const std::string_view key = setting.substr(0, setting.find('='));
    if (std::find(given.begin(), given.end(), key) != given.end()) {
      return refuse(shape, "\"" + std::string(key) + "\" is given twice", "keep one of the two values");
    }
    given.push_back(key);
    settings = comma == std::string_view::npos ? std::string_view{} : settings.substr(comma + 1);
  }
  return make(shape);
}

template <class Shape>
std::string describe() {
  static constexpr Shape defaults{};
  std::string text = std::string(Shape::name) + ": " + std::string(Shape::meaning) + "\n";
  for (const Field<Shape>& field : Shape::fields()) {
    const std::string value = std::visit([&](auto member) { return number_text(defaults.*member); }, field.member);
    text += "  " + std::string(field.name) + "=" + value + "  " + std::string(field.meaning) + " (" +
            number_text(field.least) + " .. " + number_text(field.greatest) + ")\n";
  }
  return text;
}

template <class Shape>
constexpr Entry entry() {
  return {Shape::name, &make_from<Shape>, &describe<Shape>};
}

/// A new shape is one header, one source file and one word here.
constexpr std::array entries = {entry<Bolt>(),     entry<Box>(),           entry<BumpySphere>(),  entry<CarBody>(),
                                entry<SpurGear>(), entry<Icosphere>(),     entry<NestedShells>(), entry<Nut>(),
                                entry<Peg>(),      entry<PlateWithHole>(), entry<Plates>(),       entry<Terrain>(),
                                entry<Torus>(),    entry<TorusKnot>(),     entry<UvSphere>()};

const Entry* find(std::string_view name) {
  const auto* found = std::find_if(entries.begin(), entries.end(), [&](const Entry& e) { return e.name == name; });
  return found == entries.end() ? nullptr : found;
}

}  // namespace

Result<TriangleMesh> make_shape(std::string_view text) {
  const std::string whole(text);
  if (text.substr(0, prefix.size()) == prefix) text.remove_prefix(prefix.size());
  const std::size_t colon = text.find(':');
  const std::string_view name = text.substr(0, colon);
  if (const Entry* found = find(name)) {
    return found->make(colon == std::string_view::npos ? std::string_view{} : text.substr(colon + 1));
  }
  const std::vector<std::string_view> names = shape_names();
  return Error{whole, "", "there is no made shape \"" + std::string(name) + "\"",
               "did you mean \"" + nearest(name, names) + "\"? shapes: " + listed(names)};
}

std::vector<std::string_view> shape_names() {
  std::vector<std::string_view> names;
  for (const Entry& e : entries) names.push_back(e.name);
  std::sort(names.begin(), names.end());
  return names;
}

std::string describe_shape(std::string_view name) {
  const Entry* found = find(name);
  return found != nullptr ? found->describe() : std::string{};
}

}  // namespace odds::mesh::made
