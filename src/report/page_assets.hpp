// The files of the report page that are embedded at build time (src/report/page, src/cmake/page.cmake).
#pragma once

#include <string_view>

namespace odds::report {

struct PageScript {
  std::string_view text;
  std::string_view sha256_hex;  ///< digest of the text, for the page's content security policy
};

/// Empty where no chart library was found.
[[nodiscard]] std::string_view chart_library_version() noexcept;
[[nodiscard]] PageScript chart_library() noexcept;
[[nodiscard]] PageScript page_script() noexcept;      ///< charts of a run
[[nodiscard]] PageScript accuracy_script() noexcept;  ///< charts of a study of accuracy
/// Empty where no library for three dimensions was found.
[[nodiscard]] std::string_view replay_library_version() noexcept;
[[nodiscard]] PageScript replay_library() noexcept;
[[nodiscard]] PageScript replay_script() noexcept;
[[nodiscard]] std::string_view page_style() noexcept;
[[nodiscard]] std::string_view page_glossary() noexcept;

}  // namespace odds::report
