// Text from files and command lines, fit to be quoted in a message.
#pragma once

#include <string>
#include <string_view>

namespace odds::tool {

/// The text with every control character written out as \n, \t or \xNN: a message stays on its line, and what a
/// file holds cannot steer the terminal. Other bytes, UTF-8 or not, stay.
std::string on_one_line(std::string_view text);

/// The text in quotes, cut off after 40 bytes.
std::string quoted(std::string_view text);

}  // namespace odds::tool
