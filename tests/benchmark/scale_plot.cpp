#include "benchmark/scale_plot.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace odds::benchmark {
namespace {

constexpr double width = 760.0;
constexpr double height = 460.0;
constexpr double left = 70.0;
constexpr double right = 150.0;
constexpr double top = 44.0;
constexpr double bottom = 54.0;

template <class... Values>
std::string text(const char* format, Values... values) {
  char buffer[512];
  std::snprintf(buffer, sizeof buffer, format, values...);
  return buffer;
}

/// One axis: whole decades that enclose the values.
struct Axis {
  int first;
  int last;
  double from;  ///< pixels
  double to;

  [[nodiscard]] double at(double value) const {
    return from + (to - from) * (std::log10(value) - first) / std::max(1, last - first);
  }
};

Axis axis_of(const ScalePlot& plot, double std::pair<double, double>::*coordinate, double from, double to) {
  double least = INFINITY;
  double greatest = 0.0;
  for (const ScaleLine& line : plot.lines) {
    for (const auto& point : line.points) {
      least = std::min(least, point.*coordinate);
      greatest = std::max(greatest, point.*coordinate);
    }
  }
  return {static_cast<int>(std::floor(std::log10(least))), static_cast<int>(std::ceil(std::log10(greatest))), from, to};
}

std::string decade(int exponent) {
  if (exponent >= 6) return text("%gM", std::pow(10.0, exponent - 6));
  if (exponent >= 3) return text("%gk", std::pow(10.0, exponent - 3));
  return text("%g", std::pow(10.0, exponent));
}

std::string grid(const Axis& x, const Axis& y) {
  std::string svg;
  for (int e = x.first; e <= x.last; ++e) {
    const double at = x.at(std::pow(10.0, e));
    svg += text("<path d='M%.1f %.1fV%.1f' class='grid'/>\n", at, y.from, y.to);
    svg += text("<text x='%.1f' y='%.1f' text-anchor='middle'>%s</text>\n", at, y.from + 18.0, decade(e).c_str());
  }
  for (int e = y.first; e <= y.last; ++e) {
    const double at = y.at(std::pow(10.0, e));
    svg += text("<path d='M%.1f %.1fH%.1f' class='grid'/>\n", x.from, at, x.to);
    svg += text("<text x='%.1f' y='%.1f' text-anchor='end'>%s</text>\n", x.from - 8.0, at + 4.0, decade(e).c_str());
  }
  return svg;
}

std::string curve(const ScaleLine& line, const Axis& x, const Axis& y, std::size_t number) {
  const char* const dash = line.dashed ? " stroke-dasharray='5 4'" : "";
  std::string svg = "<path d='";
  char command = 'M';
  for (const auto& [px, py] : line.points) {
    svg += text("%c%.1f %.1f", command, x.at(px), y.at(py));
    command = 'L';
  }
  svg += text("' fill='none' stroke='%s' stroke-width='2'%s/>\n", line.color.c_str(), dash);
  const double row = top + 18.0 * static_cast<double>(number) + 8.0;
  svg += text("<path d='M%.1f %.1fh26' stroke='%s' stroke-width='2'%s/>\n", x.to + 14.0, row, line.color.c_str(), dash);
  return svg + text("<text x='%.1f' y='%.1f'>%s</text>\n", x.to + 46.0, row + 4.0, line.label.c_str());
}

}  // namespace

std::string svg_of(const ScalePlot& plot) {
  const Axis x = axis_of(plot, &std::pair<double, double>::first, left, width - right);
  const Axis y = axis_of(plot, &std::pair<double, double>::second, height - bottom, top);
  std::string svg = text(
      "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 %g %g' font-family='sans-serif' "
      "font-size='12'>\n<style>.grid{stroke:#ddd}</style>\n<rect width='100%%' height='100%%' "
      "fill='white'/>\n",
      width, height);
  svg += text("<text x='%.1f' y='24' font-size='14'>%s</text>\n", left, plot.title.c_str());
  svg += grid(x, y);
  svg += text("<text x='%.1f' y='%.1f' text-anchor='middle'>%s</text>\n", 0.5 * (x.from + x.to), height - 12.0,
              plot.x_label.c_str());
  svg += text("<text transform='translate(18 %.1f) rotate(-90)' text-anchor='middle'>%s</text>\n",
              0.5 * (y.from + y.to), plot.y_label.c_str());
  for (std::size_t i = 0; i < plot.lines.size(); ++i) svg += curve(plot.lines[i], x, y, i);
  return svg + "</svg>\n";
}

}  // namespace odds::benchmark
