// The top of the page: what the run was, whether the promises were kept, the figures that matter most.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/page_parts.hpp"
#include "report/text.hpp"

namespace odds::report {
namespace {

using State = Check::State;

std::string state_class(State state) { return state == State::not_measured ? "not-measured" : name(state); }

/// A sign beside each word, so that nothing hangs on colour alone.
const char* sign(State state) {
  switch (state) {
    case State::met:
      return "✔";
    case State::missed:
      return "✖";
    case State::inconclusive:
      return "?";
    case State::not_measured:
      break;
  }
  return "–";
}

std::size_t count(const RunSummary& summary, State state) {
  return static_cast<std::size_t>(std::count_if(summary.checks.begin(), summary.checks.end(),
                                                [state](const Check& check) { return check.state == state; }));
}

double ns_at(const Histogram& histogram, double percentile) {
  return static_cast<double>(histogram.value_at_percentile(percentile));
}

std::string verdict(const RunInfo& info, const RunSummary& s) {
  const std::size_t missed = count(s, State::missed);
  const std::size_t open = count(s, State::inconclusive);
  const char* colour = missed > 0 ? "missed" : open > 0 ? "inconclusive" : "met";
  std::string words = "✔ Every promise that was measured was kept";
  if (missed > 0) {
    words = fmt::format("✖ {} of {} promises missed{}", missed, s.checks.size(),
                        open > 0 ? fmt::format(", {} inconclusive", open) : "");
  } else if (open > 0) {
    words = "? Inconclusive: the machine was too restless to judge times";
  }
  std::string text;
  // In simulated time they all come at once, which says nothing.
  if (!info.simulated_time)
    text = fmt::format(
        "Half of the forces were out within {} of their tick's planned start, 99.9 % within {}, the slowest after {}. ",
        duration(ns_at(s.tick, 50.0)), duration(ns_at(s.tick, 99.9)), duration(static_cast<double>(s.tick.max())));
  if (s.ticks_with_query > 0) {
    const auto of = static_cast<double>(s.ticks_with_query);
    text += fmt::format("{} of the ticks with a query were proved{}. Queries took {} at the 99.9th percentile, {}.",
                        percent(static_cast<double>(s.by_basis[0]) / of),
                        s.by_basis[0] < s.ticks_with_query
                            ? "; in the others the answer is the likelier one, with its probability"
                            : "",
                        duration(ns_at(info.simulated_time ? s.query_gross : s.query_net, 99.9)),
                        info.simulated_time ? "with the machine's stalls" : "net of stalls");
  }
  return fmt::format("<div class=\"verdict {}\"><strong>{}</strong><span>{}</span></div>\n", colour, words, text);
}

std::string promises(const RunSummary& summary) {
  std::string html =
      "<div class=\"wide\"><table id=\"promises\"><tr><th>promise</th><th>result</th><th>what was found</th></tr>\n";
  for (const Check& check : summary.checks) {
    html += fmt::format("<tr><td>{}</td><td><span class=\"state {}\">{} {}</span></td><td>{}</td></tr>\n",
                        html_escaped(check.question), state_class(check.state), sign(check.state), name(check.state),
                        html_escaped(check.finding));
  }
  return html + "</table></div>\n";
}

std::string card(const std::string& figure, const std::string& meaning) {
  return fmt::format("<div class=\"card\"><b>{}</b><span>{}</span></div>\n", figure, meaning);
}

std::string cards(const RunInfo& info, const RunSummary& s) {
  std::string html = "<div class=\"cards\">\n";
  if (!info.simulated_time) {
    html += card(duration(ns_at(s.tick, 99.9)),
                 "tick latency, 99.9 % within (period " + duration(static_cast<double>(info.period_ns)) + ")");
  }
  html += card(duration(ns_at(info.simulated_time ? s.query_gross : s.query_net, 99.9)),
               fmt::format("query, {}, 99.9 % within (budget: {})", info.simulated_time ? "gross" : "net",
                           limit_text(info.budget_us, info.work_units)));
  if (!info.simulated_time) html += card(duration(ns_at(s.wake, 99.9)), "wake-up, 99.9 % within: the machine's share");
  html += card(grouped(s.late + s.skipped), fmt::format("periods missed of {}", grouped(s.planned)));
  html += card(s.ticks_with_query > 0
                   ? percent(static_cast<double>(s.by_basis[0]) / static_cast<double>(s.ticks_with_query))
                   : std::string("–"),
               "of the ticks with a query proved");
  return html + "</div>\n";
}

std::string intro(const RunInfo& info, const RunSummary& s) {
  std::uint64_t triangles = 0;
  for (const RunMesh& mesh : info.meshes) triangles += mesh.triangles;
  const double seconds = static_cast<double>(s.planned) * static_cast<double>(info.period_ns) * 1e-9;
  std::string text = fmt::format(
      "{} of a loop at {:.6g} Hz{}, {} mesh{} with {} triangles. {}", duration(seconds * 1e9),
      1e9 / static_cast<double>(info.period_ns), info.simulated_time ? " in simulated time" : "", info.meshes.size(),
      info.meshes.size() == 1 ? "" : "es", grouped(triangles), utc_time(info.started_epoch_s));
  if (info.loop.stopped) text += " Ended before its planned end.";
  return text;
}

}  // namespace

std::string page_head_line(const RunInfo& info, const RunSummary& summary) {
  std::string html = fmt::format("<header>\n<h1>{}</h1>\n<p class=\"sub\">{}</p>\n", html_escaped(info.scene),
                                 html_escaped(intro(info, summary)));
  html +=
      "<nav><a href=\"#latency\">Latency</a><a href=\"#answers\">Answers</a><a href=\"#forces\">Force and contact</a>"
      "<a href=\"#effects\">Effects</a><a href=\"#machine\">Machine</a><a href=\"#run\">Run</a><a "
      "href=\"#words\">Words used here</a></nav>\n";
  html += verdict(info, summary);
  if (info.simulated_time) {
    html +=
        "<p class=\"note\">Simulated time: wake-up and tick latencies are those of a virtual clock. Query times are "
        "real, with the machine's stalls in them.</p>\n";
  }
  return html + promises(summary) + cards(info, summary) + "</header>\n";
}

}  // namespace odds::report
