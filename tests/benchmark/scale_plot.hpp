// A drawing of costs against sizes, both on logarithmic axes.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace odds::benchmark {

struct ScaleLine {
  std::string label;
  std::string color;
  bool dashed = false;
  std::vector<std::pair<double, double>> points;  ///< (x, y), both > 0
};

struct ScalePlot {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::vector<ScaleLine> lines;
};

/// The plot as an SVG file's text, decades marked on both axes. Needs a point at least.
[[nodiscard]] std::string svg_of(const ScalePlot& plot);

}  // namespace odds::benchmark
