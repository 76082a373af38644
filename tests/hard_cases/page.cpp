// Table and force traces as HTML with inline pictures.
#include "hard_cases/page.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace odds::hard_cases {
namespace {

constexpr const char* colours[] = {"#222", "#0072b2", "#d55e00"};
constexpr double width = 420.0;
constexpr double height = 90.0;

double size_of(const Sample& s) { return std::hypot(s.force_n[0], s.force_n[1], s.force_n[2]); }

// The size of the force over time: the exact run dark, 50 us blue, 1 us orange.
std::string picture(const Outcome& outcome) {
  double most_n = 1e-9;
  double end_s = 1e-9;
  for (const Figures& run : outcome.runs) {
    for (const Sample& s : run.samples) {
      if (std::isfinite(size_of(s))) most_n = std::max(most_n, size_of(s));
      end_s = std::max(end_s, s.t_s);
    }
  }
  std::string svg = fmt::format("<svg viewBox=\"0 0 {} {}\" width=\"{}\" role=\"img\" aria-label=\"force over time\">",
                                width, height + 12, width);
  for (std::size_t r = outcome.runs.size(); r-- > 0;) {  // the exact one on top
    const auto& samples = outcome.runs[r].samples;
    const std::size_t stride = std::max<std::size_t>(1, samples.size() / 500);
    std::string points;
    for (std::size_t i = 0; i < samples.size(); i += stride) {
      const Sample* peak = &samples[i];
      for (std::size_t k = i; k < std::min(samples.size(), i + stride); ++k) {
        if (size_of(samples[k]) > size_of(*peak)) peak = &samples[k];
      }
      points += fmt::format("{:.1f},{:.1f} ", width * peak->t_s / end_s, height * (1.0 - size_of(*peak) / most_n));
    }
    svg += fmt::format("<polyline fill=\"none\" stroke=\"{}\" stroke-width=\"1\" points=\"{}\"/>", colours[r], points);
  }
  return svg + fmt::format(
                   "<text x=\"2\" y=\"10\" font-size=\"9\">{:.3g} N</text><text x=\"{}\" y=\"{}\" "
                   "font-size=\"9\">{:.2f} s</text></svg>",
                   most_n, width - 34, height + 10, end_s);
}

std::string or_dash(const std::optional<double>& number, double factor, const char* unit) {
  return number ? fmt::format("{:.2f}{}", factor * *number, unit) : std::string("–");
}

std::optional<double> at_poses(const Figures& f, double report::ForceDifference::*figure) {
  if (!f.at_same_poses || f.at_same_poses->ticks == 0) return std::nullopt;
  return (*f.at_same_poses).*figure;
}

std::string row(const Figures& f) {
  std::string broken;
  for (const std::string& what : f.broken) broken += what + "<br>";
  for (const std::string& what : f.weak) broken += "weak: " + what + "<br>";
  return fmt::format(
      "<tr><td>{}</td><td>{}</td><td>{}</td><td>{:.3g}</td><td>{:.2g}</td><td>{} of "
      "{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td>"
      "<td>{}</td><td>{:.3g}</td><td>{}</td><td class=\"{}\">{}</td></tr>\n",
      f.budget, f.ticks, f.not_finite, f.largest_force_n, f.given_j, f.missed_deep, f.deep,
      or_dash(at_poses(f, &report::ForceDifference::error_p95), 100.0, " %"),
      or_dash(at_poses(f, &report::ForceDifference::angle_p95_deg), 1.0, "°"), or_dash(f.force_error_p95, 100.0, " %"),
      or_dash(f.angle_error_p95_deg, 1.0, "°"), f.onset_ticks ? fmt::format("{:+d}", *f.onset_ticks) : "–",
      or_dash(f.noise_share, 100.0, " %"), f.most_contacts, 1e3 * f.deepest_m, f.safety_ticks,
      !f.broken.empty() ? "bad"
      : f.weak.empty()  ? "good"
                        : "weak",
      broken.empty() ? "holds" : broken);
}

}  // namespace

std::string page_of(const std::vector<Outcome>& outcomes, double seconds_taken) {
  std::size_t runs = 0;
  std::size_t good = 0;
  for (const Outcome& outcome : outcomes) {
    runs += outcome.runs.size();
    good += static_cast<std::size_t>(
        std::count_if(outcome.runs.begin(), outcome.runs.end(), [](const Figures& f) { return f.broken.empty(); }));
  }
  std::string html =
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Hard cases</title><style>"
      "body{font:14px/1.4 sans-serif;max-width:1100px;margin:1em auto;padding:0 "
      "1em}table{border-collapse:collapse;font-size:12px}"
      "td,th{border-bottom:1px solid #ccc;padding:2px "
      "6px;text-align:right}td:first-child,th:first-child,td:last-child,th:last-child{text-align:left}"
      ".good{color:#060}.bad{color:#b00}.weak{color:#960}</style></head><body>\n<h1>Hard cases</h1>\n";
  html += fmt::format(
      "<p>{} of {} runs are safe ({:.0f} s): every number finite, no force beyond the limit, no energy beyond the "
      "bound, and, down to 50 µs, no deep contact missed in two ticks in a row and forces as without a budget. Force "
      "on the hand over time: <b>without a budget</b>, <b style=\"color:{}\">50 "
      "µs</b> (1000 work "
      "units), <b style=\"color:{}\">1 µs</b> (20). <i>Contacts</i>: the force of contacts on the tool, in each tick "
      "at "
      "the pose of the run without a budget; <i>hand</i>: the force on the hand, each run on its own, where they can "
      "be "
      "compared tick by tick. Simulated time, the same on every run.</p>\n",
      good, runs, seconds_taken, colours[1], colours[2]);
  for (const Outcome& outcome : outcomes) {
    html += fmt::format(
        "<h2>{}</h2>\n<p>{}</p>\n{}\n<table><tr><th>budget</th><th>ticks</th><th>not finite</th><th>largest "
        "N</th><th>given J</th>"
        "<th>deep missed</th><th>contacts p95</th><th>angle p95</th><th>hand p95</th><th>angle "
        "p95</th><th>onset</th><th>noise</th><th>contacts</th><th>deepest mm</th>"
        "<th>safety ticks</th><th></th></tr>\n",
        outcome.hard_case->name, outcome.hard_case->what, picture(outcome));
    for (const Figures& f : outcome.runs) html += row(f);
    html += "</table>\n";
  }
  return html + "</body></html>\n";
}

}  // namespace odds::hard_cases
