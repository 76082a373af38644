#include "figure/chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace odds::figure {
namespace {

constexpr double width = 460.0;
constexpr double height = 300.0;
constexpr double left = 62.0;
constexpr double top = 34.0;
constexpr double right = 14.0;
constexpr double bottom = 46.0;
constexpr double legend_line = 17.0;

struct Range {
  double low = 0.0;
  double high = 1.0;
};

/// A panel's scales, in pixels of the picture.
struct Scales {
  Range x, y;
  bool logarithmic = false;
  double origin_x = 0.0;
  [[nodiscard]] double at_x(double value) const {
    return origin_x + left + (value - x.low) / (x.high - x.low) * (width - left - right);
  }
  [[nodiscard]] double at_y(double value) const {
    const double v = logarithmic ? std::log10(value) : value;
    return top + (y.high - v) / (y.high - y.low) * (height - top - bottom);
  }
};

/// 1, 2 or 5 times a power of ten that parts a range in some five.
double step_of(const Range& range) {
  const double rough = (range.high - range.low) / 5.0;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= rough) return factor * power;
  }
  return 10.0 * power;
}

Scales scales_of(const Panel& panel, double origin_x) {
  Scales scales;
  scales.logarithmic = panel.logarithmic;
  scales.origin_x = origin_x;
  scales.x = {1e300, -1e300};
  scales.y = panel.logarithmic ? Range{1e300, -1e300} : Range{0.0, 1e-9};
  for (const Curve& curve : panel.curves) {
    for (std::size_t i = 0; i < curve.x.size(); ++i) {
      scales.x = {std::min(scales.x.low, curve.x[i]), std::max(scales.x.high, curve.x[i])};
      if (panel.logarithmic && !(curve.y[i] > 0.0)) continue;
      const double y = panel.logarithmic ? std::log10(curve.y[i]) : curve.y[i];
      scales.y = {std::min(scales.y.low, y), std::max(scales.y.high, y)};
    }
  }
  if (!(scales.x.high > scales.x.low)) scales.x = {0.0, 1.0};
  if (!(scales.y.high > scales.y.low)) scales.y = {scales.y.low < 1e299 ? scales.y.low : 0.0, scales.y.low + 1.0};
  if (panel.logarithmic) scales.y = {std::floor(scales.y.low), std::ceil(scales.y.high)};
  return scales;
}

std::string text(double x, double y, const char* anchor, const std::string& what) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", x, y, anchor, what);
}

std::string line(double x1, double y1, double x2, double y2, const char* color) {
  return fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\"/>\n", x1, y1, x2, y2,
                     color);
}

std::string axes(const Panel& panel, const Scales& s) {
  std::string svg;
  const double x0 = s.at_x(s.x.low);
  const double x1 = s.at_x(s.x.high);
  const double floor = height - bottom;
  const double step_y = s.logarithmic ? 1.0 : step_of(s.y);
  for (double y = std::ceil(s.y.low / step_y - 1e-9) * step_y; y <= s.y.high + 1e-9 * step_y; y += step_y) {
    const double value = s.logarithmic ? std::pow(10.0, y) : y;
    svg += line(x0, s.at_y(value), x1, s.at_y(value), "#ddd") +
           text(x0 - 5.0, s.at_y(value) + 4.0, "end", fmt::format("{:.4g}", value + 0.0));  // no minus before a zero
  }
  const double step_x = step_of(s.x);
  for (double x = std::ceil(s.x.low / step_x - 1e-9) * step_x; x <= s.x.high + 1e-9 * step_x; x += step_x) {
    svg += line(s.at_x(x), floor, s.at_x(x), floor + 4.0, "#333");
    svg += text(s.at_x(x), floor + 16.0, "middle", fmt::format("{:.3g}", std::abs(x) < 1e-9 * step_x ? 0.0 : x));
  }
  svg += line(x0, floor, x1, floor, "#333") + line(x0, top, x0, floor, "#333");
  svg += text(0.5 * (x0 + x1), top - 14.0, "middle", panel.title);
  svg += text(0.5 * (x0 + x1), floor + 34.0, "middle", panel.x_title);
  svg += fmt::format("<text transform=\"translate({:.1f} {:.1f}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n",
                     s.origin_x + 14.0, 0.5 * (top + floor), panel.y_title);
  return svg;
}

std::string stroke(const Curve& curve) {
  return fmt::format("stroke=\"{}\" stroke-width=\"1.8\" fill=\"none\"{}", curve.color,
                     curve.dashed ? " stroke-dasharray=\"5 3\"" : "");
}

std::string curve_path(const Curve& curve, const Scales& s) {
  std::string path;
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    if (s.logarithmic && !(curve.y[i] > 0.0)) continue;
    path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : " L", s.at_x(curve.x[i]), s.at_y(curve.y[i]));
  }
  return path.empty() ? path : fmt::format("<path d=\"{}\" {}/>\n", path, stroke(curve));
}

}  // namespace

std::string chart_svg(const std::vector<Panel>& panels) {
  std::string svg;
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const Scales scales = scales_of(panels[i], width * static_cast<double>(i));
    svg += axes(panels[i], scales);
    for (const Curve& curve : panels[i].curves) svg += curve_path(curve, scales);
  }
  double y = height + 8.0;
  for (const Curve& curve : panels.front().curves) {
    svg += fmt::format("<path d=\"M{:.1f} {:.1f} h28\" {}/>\n", left, y, stroke(curve));
    svg += text(left + 36.0, y + 4.0, "start", curve.name);
    y += legend_line;
  }
  const double all = width * static_cast<double>(panels.size());
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} {1:.0f}\" "
      "font-family=\"sans-serif\" font-size=\"12\" fill=\"#222\">\n<rect width=\"100%\" height=\"100%\" "
      "fill=\"white\"/>\n{2}</svg>\n",
      all, y + 6.0, svg);
}

}  // namespace odds::figure
