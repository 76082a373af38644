// Putting a text into its file, whole or not at all.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "odds/math/error.hpp"

namespace odds::report {

/// Written beside its place and then put there: a full disk leaves no half file, and of two runs into one directory the
/// later wins whole.
[[nodiscard]] std::optional<Error> write_file(const std::filesystem::path& path, const std::string& text);

}  // namespace odds::report
