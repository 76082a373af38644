// TOML text as settings.
#pragma once

#include <string>
#include <string_view>

#include "odds/haptics/settings.hpp"
#include "odds/math/error.hpp"

namespace odds::scene {

/// The whole document as one table, keys in the order of the file. Syntax errors name line and column.
Result<haptics::Settings> parse_toml(std::string_view text, const std::string& name);

}  // namespace odds::scene
