// What every report page begins and ends with: one file, no outside reference, scripts allowed by digest only.
#pragma once

#include <string>

#include "report/page_assets.hpp"

namespace odds::report {

/// From the document type to the opened body. `title` is escaped here.
[[nodiscard]] std::string page_begin(const std::string& title, const PageScript& script);

/// The scripts, with `data` (JSON that is safe inside a script element) for them, and the end of the document. Without
/// a chart library there are no scripts.
[[nodiscard]] std::string page_end(const std::string& data, const PageScript& script);

}  // namespace odds::report
