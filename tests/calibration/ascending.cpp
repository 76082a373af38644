#include "calibration/ascending.hpp"

#include <algorithm>

namespace odds::calibration {
namespace {

struct Sums {
  double said = 0.0;
  double seen = 0.0;
  double weight = 0.0;
};

}  // namespace

std::vector<Level> ascending_levels(std::vector<Case> cases, int most) {
  std::sort(cases.begin(), cases.end(), [](const Case& a, const Case& b) { return a.x[0] < b.x[0]; });
  double total = 0.0;
  for (const Case& one : cases) total += one.weight;
  std::vector<Sums> groups;
  Sums group;
  const auto close = [&] {
    groups.push_back(group);
    group = {};
    while (groups.size() > 1) {  // pool with the one before while that is not lower
      Sums& last = groups.back();
      Sums& before = groups[groups.size() - 2];
      if (before.seen * last.weight < last.seen * before.weight) break;
      before = {before.said + last.said, before.seen + last.seen, before.weight + last.weight};
      groups.pop_back();
    }
  };
  for (const Case& one : cases) {
    group.said += one.weight * one.x[0];
    group.seen += one.happened ? one.weight : 0.0;
    group.weight += one.weight;
    if (group.weight >= total / most) close();
  }
  if (group.weight > 0.0) close();
  std::vector<Level> levels;
  for (const Sums& sums : groups) levels.push_back({sums.said / sums.weight, sums.seen / sums.weight});
  return levels;
}

double level_at(const std::vector<Level>& levels, double said) noexcept {
  if (said <= levels.front().said) return levels.front().seen;
  for (std::size_t i = 1; i < levels.size(); ++i) {
    const Level& low = levels[i - 1];
    const Level& high = levels[i];
    if (said <= high.said) return low.seen + (high.seen - low.seen) * (said - low.said) / (high.said - low.said);
  }
  return levels.back().seen;
}

}  // namespace odds::calibration
