// What every report page begins and ends with: one file, no outside reference, scripts allowed by digest only.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "report/page_assets.hpp"

namespace odds::report {

/// From the document type to the opened body of a page that runs `scripts` and no others. `title` is escaped here.
[[nodiscard]] std::string page_head(const std::string& title, const std::vector<PageScript>& scripts);

/// The elements of `scripts`, in order, and before them one with the given id that holds `data` for them: JSON that is
/// safe inside a script element.
[[nodiscard]] std::string script_elements(std::string_view id, const std::string& data,
                                          const std::vector<PageScript>& scripts);

/// Beginning of a page of charts: the chart library and the `script` that draws them. Without a library there are no
/// scripts.
[[nodiscard]] std::string page_begin(const std::string& title, const PageScript& script);

/// Their elements, and the end of the document.
[[nodiscard]] std::string page_end(const std::string& data, const PageScript& script);

}  // namespace odds::report
