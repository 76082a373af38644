// Line charts as one SVG picture.
#pragma once

#include <string>
#include <vector>

namespace odds::figure {

struct Curve {
  std::string name;
  std::string color;  ///< as SVG takes it
  bool dashed = false;
  std::vector<double> x, y;  ///< as many; y > 0 on a logarithmic axis, others are left out
};

struct Panel {
  std::string title;
  std::string x_title, y_title;
  bool logarithmic = false;  ///< y
  std::vector<Curve> curves;
};

/// All panels side by side, with one legend of the first panel's curves below them.
[[nodiscard]] std::string chart_svg(const std::vector<Panel>& panels);

}  // namespace odds::figure
