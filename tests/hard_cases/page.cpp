// Table and force traces as HTML with inline pictures.
#include "hard_cases/page.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "hard_cases/judgement.hpp"
#include "report/base64.hpp"

namespace odds::hard_cases {
namespace {

constexpr const char* colours[] = {"#222", "#0072b2", "#009e73", "#d55e00"};
constexpr double width = 900.0;
constexpr double height = 130.0;

// The force on the hand in N; where there is none, the deepest contact in mm.
double size_of(const Sample& s, bool has_hand) {
  return has_hand ? std::hypot(s.force_n[0], s.force_n[1], s.force_n[2]) : 1e3 * s.depth_m;
}

// Over time: the exact run dark, 50 us blue, 5 us green, the starved one orange.
std::string chart(const Outcome& outcome) {
  const bool has_hand = outcome.runs.front().has_hand;
  double most = 1e-9;
  double end_s = 1e-9;
  for (const Figures& run : outcome.runs) {
    for (const Sample& s : run.samples) {
      if (std::isfinite(size_of(s, has_hand))) most = std::max(most, size_of(s, has_hand));
      end_s = std::max(end_s, s.t_s);
    }
  }
  std::string svg = fmt::format("<svg viewBox=\"0 0 {} {}\" width=\"{}\" role=\"img\" aria-label=\"{} over time\">",
                                width, height + 12, width, has_hand ? "force" : "deepest contact");
  for (std::size_t r = outcome.runs.size(); r-- > 0;) {  // the exact one on top
    const auto& samples = outcome.runs[r].samples;
    const std::size_t stride = std::max<std::size_t>(1, samples.size() / 500);
    std::string points;
    for (std::size_t i = 0; i < samples.size(); i += stride) {
      const Sample* peak = &samples[i];
      for (std::size_t k = i; k < std::min(samples.size(), i + stride); ++k) {
        if (size_of(samples[k], has_hand) > size_of(*peak, has_hand)) peak = &samples[k];
      }
      points +=
          fmt::format("{:.1f},{:.1f} ", width * peak->t_s / end_s, height * (1.0 - size_of(*peak, has_hand) / most));
    }
    svg += fmt::format("<polyline fill=\"none\" stroke=\"{}\" stroke-width=\"1\" points=\"{}\"/>", colours[r], points);
  }
  return svg + fmt::format(
                   "<text x=\"2\" y=\"10\" font-size=\"9\">{:.3g} {}</text><text x=\"{}\" y=\"{}\" "
                   "font-size=\"9\">{:.2f} s</text></svg>",
                   most, has_hand ? "N" : "mm deep", width - 34, height + 10, end_s);
}

std::string or_dash(const std::optional<double>& number, double factor, const char* unit) {
  return number ? fmt::format("{:.2f}{}", factor * *number, unit) : std::string("–");
}

std::optional<double> at_poses(const Figures& f, double report::ForceDifference::*figure) {
  if (!f.at_same_poses || f.at_same_poses->ticks == 0) return std::nullopt;
  return (*f.at_same_poses).*figure;
}

const char* class_of(bool good, bool judged) { return good ? "good" : judged ? "bad" : "weak"; }

std::string safety_cell(const Figures& f) {
  return fmt::format("<td class=\"{}\">{}</td>", class_of(f.safe(), true),
                     f.safe()            ? "safe"
                     : f.harmful.empty() ? "misses"
                                         : "harm");
}

std::string feel_cell(const Figures& f) {
  if (!f.off.empty()) return fmt::format("<td class=\"{}\">different</td>", class_of(false, f.feel_is_judged()));
  return f.budget == "none" ? "<td>–</td>" : compared(f) ? "<td class=\"good\">the same</td>" : "<td>not compared</td>";
}

std::string row(const Figures& f) {
  return fmt::format(
      "<tr><td>{}</td><td>{}</td><td>{}</td><td>{:.3g}</td><td>{:.2g}</td><td>{} of "
      "{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td>"
      "<td>{}</td><td>{:.3g}</td><td>{}</td>{}{}</tr>\n",
      f.budget, f.ticks, f.not_finite, f.largest_force_n, f.given_j, f.missed_deep, f.deep,
      or_dash(at_poses(f, &report::ForceDifference::error_p95), 100.0, " %"),
      or_dash(at_poses(f, &report::ForceDifference::angle_p95_deg), 1.0, "°"), or_dash(f.force_error_p95, 100.0, " %"),
      or_dash(f.angle_error_p95_deg, 1.0, "°"), f.onset_ticks ? fmt::format("{:+d}", *f.onset_ticks) : "–",
      or_dash(f.noise_share, 100.0, " %"), f.most_contacts, 1e3 * f.deepest_m, f.safety_ticks, safety_cell(f),
      feel_cell(f));
}

// What was found, a line each.
std::string findings(const Figures& f) {
  std::string html;
  const auto add = [&](const std::vector<std::string>& list, bool judged) {
    for (const std::string& what : list) {
      html += fmt::format("<li class=\"{}\">{}: {}</li>\n", class_of(false, judged), f.budget, what);
    }
  };
  add(f.harmful, true);
  add(f.missed, true);
  add(f.off, f.feel_is_judged());
  return html;
}

// What the figures below do not say.
std::string limits_of(const std::vector<Outcome>& outcomes) {
  std::string handless;
  std::string uncompared;
  std::string never_deep;
  std::string parted;
  const auto add = [](std::string& list, const Outcome& outcome) {
    list += (list.empty() ? "" : ", ") + outcome.hard_case->name;
  };
  for (const Outcome& outcome : outcomes) {
    const bool has_hand = outcome.runs.front().has_hand;
    if (!has_hand) add(handless, outcome);
    if (has_hand && !outcome.hard_case->compares) add(uncompared, outcome);
    const auto goes_its_own_way = [](const Figures& f) { return f.feel_is_judged() && !stays_near(f); };
    if (std::any_of(outcome.runs.begin(), outcome.runs.end(), goes_its_own_way)) add(parted, outcome);
    const auto is_deep = [](const Figures& f) { return f.deep > 0; };
    if (has_hand && std::none_of(outcome.runs.begin(), outcome.runs.end(), is_deep)) add(never_deep, outcome);
  }
  const auto item = [](const std::string& list, const char* what) {
    return list.empty() ? std::string() : fmt::format("<li>{}: {}.</li>\n", what, list);
  };
  return "<p>What the figures do not say:</p>\n<ul>\n" +
         item(never_deep,
              "nothing is ever as deep there as the case calls deep, so that nothing deep can be missed (0 of 0)") +
         item(handless,
              "without a hand there is no force to compare, and no exact query beside the ticks; the curve is "
              "the deepest contact") +
         item(uncompared,
              "too lively, or too far from rest, for the hand's force to be compared tick by tick with the "
              "run without a budget; that of contacts at the same poses is") +
         item(parted, "left to itself the run with 50 µs goes another way than the one without a budget") + "</ul>\n";
}

std::string still_of(const Outcome& outcome) {
  return fmt::format("<img alt=\"{} where a contact was deepest\" src=\"data:image/png;base64,{}\">",
                     outcome.hard_case->name, report::base64_encode(outcome.runs.front().picture));
}

// Every case with every budget: where to look.
std::string index_of(const std::vector<Outcome>& outcomes) {
  if (outcomes.empty()) return {};
  std::string html = "<table><tr><th>case</th>";
  for (const Figures& f : outcomes.front().runs) {
    html += fmt::format("<th>{}</th>{}", f.budget, f.budget == "none" ? "" : "<th>feels</th>");
  }
  html += "</tr>\n";
  for (const Outcome& outcome : outcomes) {
    html += fmt::format("<tr><td><a href=\"#{0}\">{0}</a></td>", outcome.hard_case->name);
    for (const Figures& f : outcome.runs) html += safety_cell(f) + (f.budget == "none" ? "" : feel_cell(f));
    html += "</tr>\n";
  }
  return html + "</table>\n";
}

// How many runs hold, and what that means.
std::string counts(const std::vector<Tally>& tallies, double seconds_taken) {
  std::string html =
      "<table><tr><th>budget</th><th>no harm</th><th>and nothing deep missed: safe</th><th>feels as without a "
      "budget</th><th>each run on its own within 7 % and 18°</th><th>all their ticks, p95</th></tr>\n";
  for (const Tally& t : tallies) {
    html += fmt::format("<tr><td>{}</td><td>{} of {}</td><td>{} of {}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
                        t.budget, t.harmless, t.runs, t.safe, t.runs,
                        t.compared > 0 ? fmt::format("{} of {}", t.feels_right, t.compared) : std::string("–"),
                        t.compared > 0 ? fmt::format("{} of {}", t.runs_near, t.runs_compared) : std::string("–"),
                        t.compared > 0 ? fmt::format("{:.1f} %, {:.1f}° of {}", 100.0 * t.all_ticks.error_p95,
                                                     t.all_ticks.angle_p95_deg, t.all_ticks.ticks)
                                       : std::string("–"));
  }
  return html +
         fmt::format(
             "</table>\n<p><b>No harm</b>: every number finite, no force beyond the limit, no energy to the hand "
             "beyond the case's bound. <b>Safe</b>: besides, no deep contact missed in two ticks in a row, and "
             "nothing falls through. <b>Feel</b>: contact forces within 7 % and 18° at the 95th percentile of "
             "those without a budget, at the same poses, and of the hand where two runs can be compared; contact "
             "begins within a tick; at most 1 % of noise added. <b>Each run on its own</b>: the force on the hand, "
             "tick by "
             "tick against the run without a budget, also where the case is too lively for that, and all ticks of all "
             "cases together. A microsecond is 20 pairs of nodes. Brown is "
             "told, not judged: how the two shorter budgets feel.</p>\n<p>Force on the hand over time: <b>without a "
             "budget</b>, <b style=\"color:{}\">50 µs</b> (1000 work units), <b style=\"color:{}\">5 µs</b> "
             "(100), <b style=\"color:{}\">{}</b>. <i>Contacts</i>: the force of contacts on the tool, in each "
             "tick at the pose of the run "
             "without a budget; <i>hand</i>: the force on the hand, each run on its own. Simulated time, the "
             "same on every run; it took {:.0f} s.</p>\n",
             colours[1], colours[2], colours[3], tallies.empty() ? "" : tallies.back().budget, seconds_taken);
}

}  // namespace

std::string page_of(const std::vector<Outcome>& outcomes, double seconds_taken) {
  std::string html =
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Hard cases</title><style>"
      "body{font:14px/1.4 sans-serif;max-width:1100px;margin:1em auto;padding:0 "
      "1em}table{border-collapse:collapse;font-size:12px}"
      "td,th{border-bottom:1px solid #ccc;padding:2px "
      "6px;text-align:right}td:first-child,th:first-child,td:nth-last-child(-n+2),th:nth-last-child(-n+2){text-align:"
      "left}"
      "td{white-space:nowrap}.look{display:flex;align-items:center}svg{display:block;min-width:0;flex:1}ul{margin:.5em "
      "0;font-size:13px}"
      ".good{color:#060}.bad{color:#b00}.weak{color:#960}</style></head><body>\n<h1>Hard cases</h1>\n";
  html += counts(tally(outcomes), seconds_taken) + index_of(outcomes) + limits_of(outcomes);
  for (const Outcome& outcome : outcomes) {
    html += fmt::format(
        "<h2 id=\"{0}\">{0}</h2>\n<p>{1}</p>\n<div "
        "class=\"look\">{3}{2}</div>\n<table><tr><th>budget</th><th>ticks</th><th>not "
        "finite</th><th>largest "
        "N</th><th>given J</th>"
        "<th>deep missed</th><th>contacts p95</th><th>angle p95</th><th>hand p95</th><th>angle "
        "p95</th><th>onset</th><th>noise</th><th>contacts</th><th>deepest mm</th>"
        "<th>safety ticks</th><th>safety</th><th>feel</th></tr>\n",
        outcome.hard_case->name, outcome.hard_case->what, chart(outcome), still_of(outcome));
    std::string found;
    for (const Figures& f : outcome.runs) {
      html += row(f);
      found += findings(f);
    }
    html += "</table>\n" + (found.empty() ? "" : "<ul>\n" + found + "</ul>\n");
  }
  return html + "</body></html>\n";
}

}  // namespace odds::hard_cases
