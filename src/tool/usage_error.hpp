// What is wrong with a command line, in one sentence.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace odds::tool {

/// The first word that no command, or the command that was named, knows, and the nearest one that it does know. Empty
/// if there is none: then CLI11's own message says what is missing or out of range.
[[nodiscard]] std::string unknown_word(const CLI::App& app);

}  // namespace odds::tool
