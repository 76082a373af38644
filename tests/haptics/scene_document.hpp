// Scenes as JSON documents: what a schema judges, written as TOML for the reader.
#pragma once

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>
#include <variant>

#include "odds/haptics/settings.hpp"

namespace odds::scene {

/// One value as TOML writes it on one line; tables become inline tables.
inline std::string to_toml(const nlohmann::ordered_json& value) {
  if (value.is_number_float()) return fmt::format("{:#.17g}", value.get<double>());
  if (!value.is_structured()) return value.dump();
  std::string text;
  for (const auto& [key, inner] : value.items()) {
    text += (text.empty() ? "" : ", ") + (value.is_object() ? "\"" + key + "\" = " : "") + to_toml(inner);
  }
  return value.is_object() ? "{" + text + "}" : "[" + text + "]";
}

/// A whole document: one line for each key of its top.
inline std::string toml_document(const nlohmann::ordered_json& document) {
  std::string text;
  for (const auto& [key, value] : document.items()) text += key + " = " + to_toml(value) + "\n";
  return text;
}

inline nlohmann::ordered_json to_json(const haptics::Settings& settings);

inline nlohmann::ordered_json to_json(const haptics::Value& value) {
  return std::visit(
      [](const auto& data) -> nlohmann::ordered_json {
        using Data = std::decay_t<decltype(data)>;
        if constexpr (std::is_same_v<Data, haptics::Settings>) {
          return to_json(data);
        } else if constexpr (std::is_same_v<Data, haptics::Value::List>) {
          nlohmann::ordered_json list = nlohmann::ordered_json::array();
          for (const haptics::Value& element : data) list.push_back(to_json(element));
          return list;
        } else {
          return data;
        }
      },
      value.data);
}

inline nlohmann::ordered_json to_json(const haptics::Settings& settings) {
  nlohmann::ordered_json object = nlohmann::ordered_json::object();
  for (const haptics::Setting& setting : settings.entries) object[setting.key] = to_json(setting.value);
  return object;
}

}  // namespace odds::scene
