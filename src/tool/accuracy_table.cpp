#include "tool/accuracy_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "odds/report/accuracy/report.hpp"
#include "tool/one_line.hpp"

namespace odds::tool {
namespace {

using report::AccuracyRow;
using report::Trial;

/// In the order of the bands, each once; those of a group stand side by side.
std::vector<std::string_view> groups_of(const report::StudySettings& s) {
  std::vector<std::string_view> groups;
  for (const report::PoseBand& band : report::pose_bands(s.procedure)) {
    if (groups.empty() || groups.back() != band.group) groups.push_back(band.group);
  }
  return groups;
}

std::string head(const report::StudySettings& s) {
  std::string text =
      fmt::format("{:<22}{:>8}{:>8}{:>16}{:>7}{:>7}{:>7}{:>7}{:>8}{:>8}{:>8}", "limit", "proved", "wrong",
                  "95 % interval", "f.hit", "f.miss", "P said", "hits", "p50 us", "p99 us", "over");
  for (const std::string_view group : groups_of(s)) text += fmt::format("{:>9}", group);
  return text + "\n";
}

std::string line(const Trial& trial, const AccuracyRow& r) {
  const report::Interval interval = r.wrong_interval();
  std::string text = fmt::format(
      "{:<22}{:>7.2f}%{:>7.2f}%{:>16}{:>7}{:>7}", trial.label(), 100.0 * r.share_proved(), 100.0 * r.share_wrong(),
      fmt::format("{:.2f}..{:.2f}%", 100.0 * interval.low, 100.0 * interval.high), r.false_hits, r.false_misses);
  if (r.unproved.count > 0) {
    text += fmt::format("{:>7.3f}{:>7.3f}", r.unproved.mean_probability, r.unproved.observed());
  } else {
    text += fmt::format("{:>7}{:>7}", "-", "-");
  }
  text += fmt::format("{:>8.1f}{:>8.1f}", r.wall_us.p50, r.wall_us.p99);
  return text + (trial.kind == Trial::Kind::time ? fmt::format("{:>8.2f}", r.net_overshoot_us.p99)
                                                 : fmt::format("{:>8}", "-"));
}

/// A shard may have no pose of a group.
std::string shares_by_group(const report::StudySettings& s, const std::vector<AccuracyRow>& rows, std::size_t trial) {
  std::string text;
  for (const std::string_view group : groups_of(s)) {
    const auto row = std::find_if(rows.begin(), rows.end(), [&](const AccuracyRow& r) {
      return r.trial == trial && r.scope == "group" && r.band == group;
    });
    text += row != rows.end() ? fmt::format("{:>8.2f}%", 100.0 * row->share_wrong()) : fmt::format("{:>9}", "-");
  }
  return text;
}

/// Where contacts were said to be, of the proved and the unproved answers, in the band that forces are judged by.
std::string places(const report::Study& study, const std::vector<AccuracyRow>& rows) {
  constexpr std::string_view band = "shallow 1 %";
  std::string text;
  for (const AccuracyRow& r : rows) {
    if (r.scope != "band" || r.band != band || r.contact.count == 0) continue;
    if (text.empty())
      text = fmt::format("\nplaces of contact at {}, medians: off by, normal off by; without proof\n", band);
    text += fmt::format("{:<22}{:>8}{:>8.2f}%{:>7.1f} deg", study.settings.trials[r.trial].label(), r.contact.count,
                        100.0 * r.contact.p50.position, r.contact.p50.normal_deg);
    if (r.fallback.count > 0) {
      text += fmt::format("{:>8}{:>8.2f}%{:>7.1f} deg", r.fallback.count, 100.0 * r.fallback.p50.position,
                          r.fallback.p50.normal_deg);
    }
    text += "\n";
  }
  for (const report::PushSweep& s : push_sweeps(study)) {
    if (s.band != band) continue;
    text += fmt::format("way of the push over all {} to the truth, of its length: {:.2f} (p90 {:.2f}), {} poses\n",
                        s.kind == Trial::Kind::time ? "times" : "work units", s.p50, s.p90, s.count);
  }
  return text;
}

}  // namespace

std::string accuracy_table(const report::Study& study, const std::vector<AccuracyRow>& rows) {
  const report::StudySettings& s = study.settings;
  std::string text = fmt::format("{} ({} triangles) and {} ({} triangles), {} poses by {}, {}, {}\n",
                                 on_one_line(s.mesh_a), s.triangles_a, on_one_line(s.mesh_b), s.triangles_b,
                                 study.poses.size(), name(s.procedure), s.bounding_volume, s.estimator);
  text += report::headline(study, rows) + "\n\n" + head(s);
  for (const AccuracyRow& row : rows) {
    if (row.scope == "all") text += line(s.trials[row.trial], row) + shares_by_group(s, rows, row.trial) + "\n";
  }
  text += places(study, rows);
  text +=
      "wrong: verdicts against the truth, f.hit and f.miss their two kinds (counts); P said and hits: of the answers "
      "without proof;\nover: net overshoot in us, p99; last columns: share wrong by distance\n";
  if (!study.machine_fit) text += "times are inconclusive on this machine: " + on_one_line(study.machine_note) + "\n";
  if (study.shard.of > 1) {
    text +=
        fmt::format("shard {}/{}: merge all of them with odds accuracy --merge\n", study.shard.number, study.shard.of);
  }
  return text;
}

}  // namespace odds::tool
