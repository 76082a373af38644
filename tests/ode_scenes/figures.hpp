// What a run of a scene leaves: figures with their bars, traces for charts, a picture.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace odds::ode_scenes {

/// One number. `bar`: the most it may be; none: told, not judged.
struct Figure {
  std::string name;
  double value = 0.0;
  std::string unit;
  std::optional<double> bar = {};

  [[nodiscard]] bool meets() const { return !bar || value <= *bar; }
};

/// One line of a chart: x, y.
struct Trace {
  std::string name;
  std::vector<std::pair<double, double>> points;
};

/// One scene with one collider. Bars stand in runs of ours; others are there to be compared with.
struct Run {
  std::string variant;   ///< of the scene: "5 bricks of 768 triangles on a plane"
  std::string collider;  ///< "odds, 100 us"
  std::vector<Figure> figures;
  std::vector<Trace> traces;
  std::string picture;  ///< PNG, or empty
  std::string note;     ///< what happened: "falls after 4.1 s"
  bool ours = false;
};

/// A part of the report.
struct Section {
  std::string id;
  std::string title;
  std::string text;  ///< HTML: what is simulated
  std::string x_title;
  std::string y_title;
  bool logarithmic = false;  ///< whether the chart's y axis is
  std::vector<Run> runs;
};

/// Nearest-rank percentile; 0 if there are no samples. Sorts them.
inline double percentile(std::vector<double>& samples, double share) {
  if (samples.empty()) return 0.0;
  std::sort(samples.begin(), samples.end());
  const double rank = std::ceil(share * static_cast<double>(samples.size())) - 1.0;
  return samples[static_cast<std::size_t>(std::clamp(rank, 0.0, static_cast<double>(samples.size() - 1)))];
}

}  // namespace odds::ode_scenes
