// Settings written down in a test instead of a file.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "odds/haptics/settings.hpp"

namespace odds::test {

/// One value at the line given.
template <class T>
haptics::Setting setting(std::string key, T value, std::uint32_t line = 1) {
  return {std::move(key), {line, 1}, {std::move(value), {line, 10}}};
}

inline haptics::Value number(double value, std::uint32_t line = 1) { return {value, {line, 10}}; }

inline haptics::Setting vector(std::string key, double x, double y, double z, std::uint32_t line = 1) {
  return setting(std::move(key), haptics::Value::List{number(x), number(y), number(z)}, line);
}

inline haptics::Settings table(std::vector<haptics::Setting> entries) {
  return {"scene.toml", "[device.hand]", {1, 1}, std::move(entries)};
}

}  // namespace odds::test
