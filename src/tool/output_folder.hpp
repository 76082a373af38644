// A folder for results.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <optional>

#include "odds/math/error.hpp"

namespace odds::tool {

/// Makes the folder and those named inside it and tries whether files have a place there. Said before long work, not
/// after it.
[[nodiscard]] std::optional<Error> prepare_folder(const std::filesystem::path& folder,
                                                  std::initializer_list<const char*> inside);

}  // namespace odds::tool
