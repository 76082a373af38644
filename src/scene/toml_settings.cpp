// TOML text as settings; the only place that sees the TOML library.
#include "scene/toml_settings.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <sstream>

namespace odds::scene {
namespace {

using haptics::Place;
using haptics::Setting;
using haptics::Settings;
using haptics::Value;

Place place_of(const toml::source_region& region) { return {region.begin.line, region.begin.column}; }

struct Converter {
  std::string file;
  std::optional<Error> error;  // the first value of a type that scenes do not have

  Value value(const toml::node& node, const std::string& path, bool in_list) {
    Value result{false, place_of(node.source())};
    if (const auto* boolean = node.as_boolean()) {
      result.data = boolean->get();
    } else if (const auto* integer = node.as_integer()) {
      result.data = integer->get();
    } else if (const auto* floating = node.as_floating_point()) {
      result.data = floating->get();
    } else if (const auto* text = node.as_string()) {
      result.data = text->get();
    } else if (const auto* array = node.as_array()) {
      Value::List list;
      for (const toml::node& element : *array) list.push_back(value(element, path, true));
      result.data = std::move(list);
    } else if (const auto* inner = node.as_table()) {
      result.data = table(*inner, path, in_list);
    } else if (!error) {
      error = Error{file, result.place.text(), "dates and times mean nothing in a scene", "give a number or text"};
    }
    return result;
  }

  Settings table(const toml::table& source, const std::string& path, bool in_list) {
    Settings result;
    result.file = file;
    result.title = path.empty() ? "the scene" : in_list ? "[[" + path + "]]" : "[" + path + "]";
    result.place = place_of(source.source());
    if (result.place.line == 0) result.place = {1, 1};
    for (const auto& [key, node] : source) {
      const std::string name(key.str());
      result.entries.push_back(
          {name, place_of(key.source()), value(node, path.empty() ? name : path + "." + name, false)});
    }
    std::sort(result.entries.begin(), result.entries.end(), [](const Setting& a, const Setting& b) {
      return a.place.line != b.place.line ? a.place.line < b.place.line : a.place.column < b.place.column;
    });
    return result;
  }
};

// Each dot of a key opens a table inside a table, and reading tables recurses, in the library and here; the library
// bounds the depth of values only. Found before it reads: a line that could go deeper than any stack is sure to hold.
std::optional<Place> line_with_too_many_dots(std::string_view text) {
  constexpr std::size_t most_dots = 250;
  std::uint32_t line = 1;
  std::size_t dots = 0;
  for (const char c : text) {
    if (c == '\n') {
      ++line;
      dots = 0;
    } else if (c == '.' && ++dots > most_dots) {
      return Place{line, 1};
    }
  }
  return std::nullopt;
}

}  // namespace

Result<Settings> parse_toml(std::string_view text, const std::string& name) {
  if (const auto place = line_with_too_many_dots(text)) {
    return Error{name, place->text(), "more than 250 dots stand on one line",
                 "this is no scene, or its keys nest too deeply; write it on several lines"};
  }
  try {
    const toml::table document = toml::parse(text, name);
    Converter converter{name, std::nullopt};
    Settings settings = converter.table(document, "", false);
    settings.place = {1, 1};
    if (converter.error) return *converter.error;
    return settings;
  } catch (const toml::parse_error& failure) {
    return Error{name, place_of(failure.source()).text(), "not valid TOML: " + std::string(failure.description()),
                 "correct the syntax at this place"};
  }
}

}  // namespace odds::scene
