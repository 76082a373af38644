// The sections of the page below its top.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "report/page_parts.hpp"
#include "report/text.hpp"

namespace odds::report {
namespace {

/// A chart with its heading, how to read it, and what it is for those who cannot see it.
std::string figure(const char* id, const char* title, const char* reading, const char* height = "",
                   bool time_line = false) {
  return fmt::format(
      "<figure{}><figcaption><h3>{}</h3>{}</figcaption><div class=\"plot {}\"><canvas id=\"{}\" role=\"img\" "
      "aria-label=\"{}\"></canvas></div></figure>\n",
      time_line ? " class=\"timeline\"" : "", title, reading, height, id, title);
}

std::string time_line(const char* id, const char* title, const char* reading, const char* height = "") {
  return figure(id, title, reading, height, true);
}

std::string percentile_row(const char* label, const Histogram& histogram) {
  std::string html = fmt::format("<tr><td>{}</td><td>{}</td>", label, grouped(histogram.count()));
  for (const double percentile : {50.0, 90.0, 99.0, 99.9, 99.99}) {
    const bool thin = static_cast<double>(histogram.count()) * (100.0 - percentile) < 999.5;  // < 10 samples beyond
    html += histogram.count() == 0
                ? "<td>–</td>"
                : fmt::format("<td{}>{}</td>", thin ? " class=\"thin\"" : "",
                              duration(static_cast<double>(histogram.value_at_percentile(percentile))));
  }
  return html + fmt::format("<td>{}</td></tr>\n",
                            histogram.count() == 0 ? "–" : duration(static_cast<double>(histogram.max())));
}

std::string percentile_table(const RunInfo& info, const RunSummary& s) {
  // In simulated time no stalls are measured: nothing is net of them.
  const bool net = !info.simulated_time;
  return "<div class=\"wide\"><table class=\"figures\"><tr><th></th><th>samples</th><th>50 %</th><th>90 %</th><th>99 "
         "%</th>"
         "<th>99.9 %</th><th>99.99 %</th><th>longest</th></tr>\n" +
         percentile_row("tick: planned start to force", s.tick) +
         percentile_row("wake-up: planned start to running", s.wake) +
         (net ? percentile_row("tick, net: its own work", s.tick_net) : "") +
         percentile_row("collision phase, gross", s.collision) + percentile_row("query, gross", s.query_gross) +
         (net ? percentile_row("query, net of stalls", s.query_net) +
                    percentile_row("query, net overshoot", s.query_overshoot)
              : "") +
         percentile_row("simulation step", s.step) + "</table></div>\n";
}

bool has_device(const RunInfo& info) { return !info.device.empty() && info.device != "none"; }

std::string contacts_of_a_pair(const RunInfo& info) {
  if (info.max_contacts == 0) return "none, verdict only";
  if (info.max_contacts == 1) return "one";
  return fmt::format("a patch of at most {}", info.max_contacts);
}

struct AnswerKind {
  const char* label;
  const char* colour;
  std::uint64_t ticks;
};

}  // namespace

std::string page_latency(const RunInfo& info, const RunSummary& s, bool charts) {
  std::string html =
      "<h2 id=\"latency\">Latency</h2>\n<p>Tick and wake-up count from the planned start. Every planned period is "
      "among the ticks, skipped ones too; wake-ups are of those that ran. The other rows are the durations of parts of "
      "a tick.</p>\n" +
      percentile_table(info, s);
  if (!charts) return html;
  html += "<div class=\"pair\">\n";
  html +=
      figure("chart-curve", "Percentiles",
             "Read: how long the given share of the samples took at most. A flat line is a steady loop; where it turns "
             "upwards the tail begins.",
             "tall");
  html += figure("chart-bars", "Distribution",
                 "How many samples fell into each bin; both axes are logarithmic, so that single "
                 "outliers stay visible.",
                 "tall");
  html +=
      "</div>\n<p class=\"quiet\">Time lines below: each point is the longest in its stretch, so that no peak is lost. "
      "Drag "
      "to look closer, in all of them at once; double-click for the whole run.</p>\n";
  html += time_line("chart-latency", "Tick and wake-up over time",
                    "Peaks in both at once come from the machine; peaks in the "
                    "tick alone from the work.");
  html += time_line("chart-query", "Query time over time",
                    info.simulated_time ? "What passed on the clock; stalls of the machine are in it."
                                        : "Gross is what passed on the clock, net leaves out the gaps in which the "
                                          "processor was elsewhere (marked as stalls).");
  if (s.late + s.skipped > 0) {
    html += time_line("chart-missed", "Missed periods",
                      "Late: the force came after the next tick was due. Skipped: the period "
                      "got no tick.",
                      "low");
  } else {
    html += "<p class=\"quiet\">No period was late or skipped.</p>\n";
  }
  return html;
}

std::string page_answers(const RunSummary& s, bool charts) {
  std::string html = "<h2 id=\"answers\">Answers</h2>\n";
  if (s.ticks_with_query == 0) {
    return html + "<p>The meshes never came near enough for a query.</p>\n";
  }
  const std::uint64_t without = s.ran - std::min(s.ran, s.ticks_with_query);
  const std::array<AnswerKind, 4> kinds{
      {{"proved", "green", s.by_basis[0]},
       {"estimated: the probability passed the scene's threshold", "sky", s.by_basis[1]},
       {"at the budget: the likelier verdict when time was up", "orange", s.by_basis[2]},
       {"no query needed", "rule", without}}};
  const double all = static_cast<double>(std::max<std::uint64_t>(s.ticks_with_query + without, 1));
  std::string bar = "<div class=\"share\" role=\"img\" aria-label=\"share of the answers by basis\">";
  std::string rows;
  for (const AnswerKind& kind : kinds) {
    const double share = static_cast<double>(kind.ticks) / all;
    bar += fmt::format("<i style=\"width:{:.3f}%;background:var(--{})\"></i>", 100.0 * share, kind.colour);
    rows +=
        fmt::format("<tr><td><i class=\"key\" style=\"background:var(--{})\"></i>{}</td><td>{}</td><td>{}</td></tr>\n",
                    kind.colour, kind.label, grouped(kind.ticks), percent(share));
  }
  html += fmt::format(
      "<p>On what each tick's verdict rests. {} of {} ticks with a query found a hit; {} pairs of bounding "
      "volumes and {} pairs of triangles were tested.</p>\n",
      grouped(s.hits), grouped(s.ticks_with_query), grouped(s.node_pairs), grouped(s.triangle_pairs));
  html += bar +
          "</div>\n<div class=\"wide\"><table class=\"figures\"><tr><th>basis of the "
          "answer</th><th>ticks</th><th>share</th>"
          "</tr>\n" +
          rows + "</table></div>\n";
  if (!charts) return html;
  html += time_line("chart-answers", "Basis over time",
                    "Green: proof. Where orange grows, the surfaces were too close for a "
                    "proof within the budget.",
                    "low");
  html += time_line("chart-doubt", "Doubt over time",
                    "For verdicts without proof: the probability that they are wrong, by their "
                    "own account (0.5 is a coin toss). The largest of each stretch.",
                    "low");
  return html;
}

std::string page_forces(const RunInfo& info, const RunSummary& s, bool charts) {
  const bool has_hand = has_device(info);
  std::string html = "<h2 id=\"forces\">Force and contact</h2>\n<p>";
  if (has_hand) {
    html += fmt::format(
        "Largest force {:.3g} N, largest torque {:.3g} N·m. Force and torque as sent to the device, in the world "
        "frame, "
        "on the hand. ",
        s.largest_force_n, s.largest_torque_nm);
  } else {
    html += "The scene has no device, so no force was sent to a hand. ";
  }
  html +=
      fmt::format("Deepest contact {:.3g} mm, at most {} contact points.</p>\n", s.deepest_m * 1e3, s.most_contacts);
  if (!charts) return html;
  if (has_hand) {
    html += time_line("chart-force", "Force",
                      "A jump from one tick to the next is felt as a knock, fast changes of sign as a buzz.");
    html += time_line("chart-torque", "Torque", "The same for the turning of the hand.", "low");
    html += time_line(
        "chart-energy", "Energy at the hand",
        "What the simulation has taken in since the start, the lowest of each stretch. It falls where the hand gets "
        "energy back; a fall without end, or below zero, is a loop that pushes by itself.",
        "low");
  }
  html += time_line("chart-contact", "Contact", "Depth of the deepest contact, and how many contact points there were.",
                    "low");
  return html;
}

std::string page_effects(const RunInfo& info, const RunSummary& s) {
  if (info.effect_costs.empty()) return "<h2 id=\"effects\">Effects</h2>\n<p>The scene asks for none.</p>\n";
  std::string html =
      "<h2 id=\"effects\">Effects</h2>\n<p>What the scene asked for, and what it took in its own code; the rows that "
      "an "
      "effect adds to the solver count with the simulation step, a query with the collision phase. Effects that are "
      "not "
      "in this table were not made.</p>\n<div class=\"wide\"><table class=\"figures\"><tr><th>effect</th><th>line</th>"
      "<th>evaluations a tick</th><th>mean a tick</th><th>longest</th></tr>\n";
  for (const RunEffect& effect : info.effect_costs) {
    const double ticks = static_cast<double>(std::max<std::uint64_t>(effect.ticks, 1));
    html += fmt::format("<tr><td>{}</td><td>{}</td><td>{:.3g}</td><td>{}</td><td>{}</td></tr>\n",
                        html_escaped(effect.name), effect.line, static_cast<double>(effect.evaluations) / ticks,
                        duration(static_cast<double>(effect.total_ns) / ticks),
                        duration(static_cast<double>(effect.longest_ns)));
  }
  html += "</table></div>\n";
  if (!has_device(info)) return html;
  return html +
         fmt::format("<p>Energy at the hand: {}. The balance of every tick is in ticks.csv.</p>\n",
                     s.least_energy_j < 0.0
                         ? fmt::format("at one time the simulation had given the hand {:.3g} J more than it had taken",
                                       -s.least_energy_j)
                         : std::string("the simulation never gave the hand more than it had taken"));
}

std::string page_machine(const RunInfo& info) {
  std::string html =
      "<h2 id=\"machine\">Machine</h2>\n<p>What the loop ran on. Timing figures mean little without it.</p>\n"
      "<div class=\"wide\"><table><tr><th>property</th><th>value</th><th>for steady timing</th><th>remark</th></tr>\n";
  for (const realtime::HostLine& line : info.host) {
    html += fmt::format(
        "<tr><td>{}</td><td>{}</td><td><span class=\"state {}\">{}</span></td><td class=\"quiet\">{}</td></tr>\n",
        html_escaped(line.name), html_escaped(line.value), name(line.readiness), name(line.readiness),
        html_escaped(line.remark));
  }
  html += "</table></div>\n";
  if (info.thread.empty()) return html + "<p>The loop's thread asked the system for nothing special.</p>\n";
  html +=
      "<p>What the loop's thread asked of the system:</p>\n<div "
      "class=\"wide\"><table><tr><th>asked</th><th>outcome</th>"
      "<th>detail</th></tr>\n";
  for (const realtime::SetupLine& line : info.thread) {
    const char* colour = line.outcome == realtime::SetupLine::Outcome::granted  ? "granted"
                         : line.outcome == realtime::SetupLine::Outcome::partly ? "partly"
                                                                                : "refused";
    html += fmt::format("<tr><td>{}</td><td><span class=\"state {}\">{}</span></td><td class=\"quiet\">{}</td></tr>\n",
                        html_escaped(line.asked), colour, name(line.outcome), html_escaped(line.detail));
  }
  return html + "</table></div>\n";
}

std::string page_run(const RunInfo& info) {
  std::string html = "<h2 id=\"run\">Run</h2>\n<div class=\"wide\"><table>\n";
  const auto row = [&html](const char* label, const std::string& value) {
    if (!value.empty()) html += fmt::format("<tr><th>{}</th><td>{}</td></tr>\n", label, html_escaped(value));
  };
  for (const RunMesh& mesh : info.meshes) {
    row("mesh", fmt::format("{}: {} triangles{}", mesh.name, grouped(mesh.triangles),
                            mesh.file.empty() ? "" : " (" + mesh.file + ")"));
  }
  row("bounding volume", info.bounding_volume);
  row("device", info.device);
  row("effects", info.effects.empty() ? "none" : fmt::format("{}", fmt::join(info.effects, ", ")));
  row("period", duration(static_cast<double>(info.period_ns)));
  row("budget of a query", limit_text(info.budget_us, info.work_units));
  row("budget of a step", limit_text(info.frame_us, info.frame_work_units));
  row("contacts of a pair", contacts_of_a_pair(info));
  if (info.max_contacts_per_step > 0) row("contacts of a step", fmt::format("at most {}", info.max_contacts_per_step));
  row("contacts of bodies at rest", info.carry_motion > 0.0 && info.max_contacts > 1
                                        ? fmt::format("carried along with the bodies, up to a motion of {:.3g} of "
                                                      "their size",
                                                      info.carry_motion)
                                        : std::string("made anew in every step"));
  row("version", info.version);
  return html + "</table></div>\n";
}

}  // namespace odds::report
