// The page's own script (charts.js), taken in at build time.
#pragma once

#include "report/page_assets.hpp"

namespace odds::ode_scenes {

[[nodiscard]] report::PageScript chart_script() noexcept;

}  // namespace odds::ode_scenes
