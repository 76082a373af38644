// One page: the runs side by side, force over time, and the table.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "odds/report/force_comparison.hpp"
#include "report/page_assets.hpp"
#include "report/page_frame.hpp"
#include "report/text.hpp"
#include "report/write_file.hpp"

namespace odds::report {
namespace {

constexpr double width = 1040.0;
constexpr double height = 130.0;
constexpr std::size_t most_points = 1000;

struct Scale {
  double end_s = 1e-9;
  double most_n = 1e-9;
};

Scale scale_of(const Comparison& comparison) {
  Scale scale;
  for (const ComparedRun& run : comparison.runs) {
    for (const ForceSample& sample : run.samples) {
      scale.end_s = std::max(scale.end_s, sample.t_s);
      if (std::isfinite(sample.force_n.norm())) scale.most_n = std::max(scale.most_n, sample.force_n.norm());
    }
  }
  return scale;
}

// The greatest and the least value of each stretch, so that no knock and no gap is lost.
std::string line(const std::vector<ForceSample>& samples, const Scale& scale, const char* style) {
  const std::size_t stride = std::max<std::size_t>(1, 2 * samples.size() / most_points);
  std::string points;
  for (std::size_t i = 0; i < samples.size(); i += stride) {
    double least = samples[i].force_n.norm();
    double greatest = least;
    for (std::size_t k = i; k < std::min(samples.size(), i + stride); ++k) {
      least = std::min(least, samples[k].force_n.norm());
      greatest = std::max(greatest, samples[k].force_n.norm());
    }
    const double x = width * samples[i].t_s / scale.end_s;
    points += fmt::format("{:.1f},{:.1f} ", x, height * (1.0 - least / scale.most_n));
    if (greatest > least) points += fmt::format("{:.1f},{:.1f} ", x, height * (1.0 - greatest / scale.most_n));
  }
  return fmt::format("<polyline fill=\"none\" {} points=\"{}\"/>", style, points);
}

std::string picture(const Comparison& comparison, const ComparedRun& run, const Scale& scale) {
  std::string svg =
      fmt::format("<svg viewBox=\"0 -4 {} {}\" width=\"100%\" role=\"img\" aria-label=\"force over time, {}\">", width,
                  height + 20, html_escaped(run.name));
  if (&run != &comparison.runs.front()) {
    svg += line(comparison.runs.front().samples, scale, "stroke=\"#9aa5ad\" stroke-width=\"2.5\"");
  }
  svg += line(run.samples, scale, "stroke=\"#c2410c\" stroke-width=\"1\"");
  return svg + fmt::format(
                   "<text x=\"2\" y=\"8\" font-size=\"11\" fill=\"currentColor\">{:.3g} N</text><text x=\"{}\" "
                   "y=\"{}\" font-size=\"11\" fill=\"currentColor\">{:.2f} s</text></svg>",
                   scale.most_n, width - 44, height + 14, scale.end_s);
}

std::string onset(const ForceDifference& d) {
  const std::string missed = fmt::format("{} of {} missed", d.onsets_missed, d.onsets);
  return d.onset_p99_ticks ? fmt::format("{:.0f}, {}", *d.onset_p99_ticks, missed) : missed;
}

std::string cells(const ForceDifference& d) {
  if (d.ticks == 0) return "<td>–</td><td>–</td>";
  return fmt::format("<td>{:.2f} % / {:.2f} %</td><td>{:.2f}° / {:.2f}°</td>", 100.0 * d.error_p50, 100.0 * d.error_p95,
                     d.angle_p50_deg, d.angle_p95_deg);
}

std::string row_at_same_poses(const ComparedRun& run) {
  const ForceDifference& d = *run.at_same_poses;
  return fmt::format("<tr><th>{}</th>{}<td>{}</td><td>{}</td><td>{:.3g} N</td></tr>\n", html_escaped(run.name),
                     cells(d), onset(d), grouped(d.missed_in_row), d.largest_false_n);
}

std::string row(const ComparedRun& run, bool is_exact) {
  const ForceDifference& d = run.difference;
  return fmt::format(
      "<tr><th>{}</th><td>{}</td><td>{:.0f}</td>{}<td>{:.3f} %</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
      html_escaped(run.name), run.proved_share ? percent(*run.proved_share) : "–", run.units_per_query,
      is_exact ? "<td>–</td><td>–</td>" : cells(d), 100.0 * d.noise_share,
      is_exact || d.ticks == 0 ? "–" : fmt::format("{:.3f} %", 100.0 * d.added_noise_share), is_exact ? "–" : onset(d),
      is_exact ? "–" : fmt::format("{:.3g} N", d.largest_false_n));
}

// Both have the same exact run beside them, so that any of them says how it touches.
std::string at_same_poses(const Comparison& comparison) {
  std::string rows;
  const ForceDifference* any = nullptr;
  for (const ComparedRun& run : comparison.runs) {
    if (!run.at_same_poses) continue;
    any = &*run.at_same_poses;
    rows += row_at_same_poses(run);
  }
  if (any == nullptr) return "";
  return fmt::format(
      "<h2>At the poses of the exact run</h2>\n<p>The force of all contacts on the tool, tick by tick: the run without "
      "a "
      "limit, and what a query within the budget makes of the same tick, from the same poses and velocities. {} ticks "
      "in "
      "contact, mean force {:.3g} N. People notice a change of force from about 7 % on, of its direction from about "
      "18° "
      "on.</p>\n<table>\n<thead><tr><th>budget of a query</th><th>contact force off by p50 / p95</th><th>direction p50 "
      "/ "
      "p95</th><th>onset p99, ticks</th><th>ticks missed in a row</th><th>where nothing "
      "touches</th></tr></thead>\n<tbody>\n{}</tbody>\n</table>\n",
      grouped(any->ticks), any->mean_force_n, rows);
}

std::string page(const Comparison& comparison) {
  const Scale scale = scale_of(comparison);
  const ForceDifference& exact = comparison.runs.front().difference;
  std::string html = page_head("One scene, several budgets", {});
  html += fmt::format(
      "<header>\n<h1>One scene, several budgets</h1>\n<p class=\"sub\">{}, {:.0f} Hz; odds {}</p>\n</header>\n<main>\n",
      html_escaped(comparison.scene), comparison.rate_hz, html_escaped(comparison.version));
  if (const std::string sentence = kept_frame(comparison); !sentence.empty()) {
    html += fmt::format("<p class=\"note\">{}</p>\n", sentence);
  }
  html += at_same_poses(comparison);
  html += fmt::format(
      "<h2>Each on its own</h2>\n<p>Every run follows the same hand in simulated time, and differs only in the work "
      "that "
      "each query may do. The force on the hand is compared tick by tick with that of the run without a limit: {} "
      "ticks with a force of at least {:.3g} N, in free motion too, mean force {:.3g} N. After its first other contact "
      "a run goes its own way: how fast a scene parts from "
      "itself is shown by the run without a limit in which everything but the tool stands 1 nm aside. Where that "
      "one is far off, so is every other.</p>\n<table>\n<thead><tr><th>run</th><th>proved"
      "</th><th>units a query</th><th>force error p50 / p95</th><th>direction p50 / p95</th><th>noise {}</th>"
      "<th>thereof added</th><th>onset p99, ticks</th><th>where nothing touches</th></tr></thead>\n<tbody>\n",
      grouped(exact.ticks), comparison.touching_n, exact.mean_force_n, noise_band(comparison.rate_hz));
  for (const ComparedRun& run : comparison.runs) html += row(run, &run == &comparison.runs.front());
  html += "</tbody>\n</table>\n";
  for (const ComparedRun& run : comparison.runs) {
    html += fmt::format("<figure><figcaption><h3>{}</h3>{}</figcaption>{}</figure>\n", html_escaped(run.name),
                        &run == &comparison.runs.front() ? "Size of the force on the hand."
                                                         : "The same, over that without a limit in grey.",
                        picture(comparison, run, scale));
  }
  return html + "</main>\n</body>\n</html>\n";
}

std::string columns(const ForceDifference& d) {
  return fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{}", d.ticks, d.mean_force_n, d.error_p50, d.error_p95,
                     d.angle_p50_deg, d.angle_p95_deg, d.noise_share, d.added_noise_share, d.onsets, d.onsets_missed,
                     d.onset_p99_ticks ? fmt::format("{}", *d.onset_p99_ticks) : "", d.missed_in_row,
                     d.largest_false_n);
}

std::string csv(const Comparison& comparison) {
  std::string text =
      "run,poses,proved_share,units_per_query,ticks_compared,mean_force_n,force_error_p50,force_error_p95,"
      "angle_p50_deg,angle_p95_deg,noise_share,added_noise_share,onsets,onsets_missed,onset_p99_ticks,missed_in_row,"
      "largest_false_n\n";
  for (const ComparedRun& run : comparison.runs) {
    const std::string query =
        fmt::format("{},{}", run.proved_share ? fmt::format("{}", *run.proved_share) : "", run.units_per_query);
    text += fmt::format("{},own,{},{}\n", run.name, query, columns(run.difference));
    if (run.at_same_poses) text += fmt::format("{},exact,,,{}\n", run.name, columns(*run.at_same_poses));
  }
  return text;
}

}  // namespace

std::string kept_frame(const Comparison& comparison) {
  if (comparison.frame_work_units == std::numeric_limits<std::uint64_t>::max()) return "";
  return fmt::format(
      "The runs with a budget also keep the frame of the scene, {} for all queries of a step; those without a limit "
      "have none.",
      limit_text(std::numeric_limits<double>::infinity(), comparison.frame_work_units));
}

std::optional<Error> write_comparison(const std::filesystem::path& folder, const Comparison& comparison) {
  if (comparison.runs.empty()) return Error{folder.string(), "", "there is no run to compare", "give a budget"};
  if (auto error = write_file(folder / "comparison.html", page(comparison))) return error;
  return write_file(folder / "comparison.csv", csv(comparison));
}

}  // namespace odds::report
