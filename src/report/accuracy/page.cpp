// The page of a study of accuracy.
#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "odds/report/accuracy/report.hpp"
#include "report/accuracy/study_files.hpp"
#include "report/page_assets.hpp"
#include "report/page_frame.hpp"
#include "report/text.hpp"

namespace odds::report {
namespace {

bool has_kind(const Study& study, Trial::Kind kind) {
  return std::any_of(study.settings.trials.begin(), study.settings.trials.end(),
                     [kind](const Trial& trial) { return trial.kind == kind; });
}

std::string label(const Trial& trial) {
  if (trial.kind == Trial::Kind::exact) return "exact, no limit";
  std::string text =
      trial.kind == Trial::Kind::time ? fmt::format("{} µs", trial.amount) : fmt::format("{} units", trial.amount);
  if (trial.p_min < 1.0) text += fmt::format(", p ≥ {}", trial.p_min);
  return text;
}

std::string card(const std::string& number, const std::string& meaning) {
  return fmt::format("<div class=\"card\"><b>{}</b><span>{}</span></div>\n", number, meaning);
}

std::string figure(const char* id, const char* title, const char* reading, const char* height = "") {
  return fmt::format(
      "<figure><figcaption><h3>{}</h3>{}</figcaption><div class=\"plot {}\"><canvas id=\"{}\" role=\"img\" "
      "aria-label=\"{}\"></canvas></div></figure>\n",
      title, reading, height, id, title);
}

std::string top(const Study& study, const std::vector<AccuracyRow>& rows) {
  const StudySettings& s = study.settings;
  std::string html = fmt::format(
      "<header>\n<h1>What accuracy costs in time</h1>\n<p class=\"sub\">{} ({} triangles) and {} ({} triangles), "
      "{} poses, {}</p>\n",
      html_escaped(s.mesh_a), grouped(s.triangles_a), html_escaped(s.mesh_b), grouped(s.triangles_b),
      grouped(study.poses.size()), utc_time(study.started_epoch_s));
  html +=
      "<nav><a href=\"#error\">Error</a><a href=\"#odds\">Are the odds true?</a><a href=\"#time\">Time</a><a "
      "href=\"#contacts\">Contacts</a><a href=\"#bands\">Distances</a><a href=\"#worst\">Worst poses</a><a "
      "href=\"#study\">This study</a></nav>\n";
  html += fmt::format("<div class=\"verdict neutral\"><span class=\"lead\">{}</span></div>\n",
                      html_escaped(headline(study, rows)));
  if (!study.machine_fit) {
    html += fmt::format(
        "<p class=\"note\">Times are <b>inconclusive</b>: this machine was too restless to measure on ({}). Work units "
        "do not depend on it.</p>\n",
        html_escaped(study.machine_note));
  }
  if (study.shard.of > 1) {
    html += fmt::format("<p class=\"note\">This is shard {}/{} of a study. Merge all of them for the whole.</p>\n",
                        study.shard.number, study.shard.of);
  }
  return html;
}

/// One line for each limit; `cells` writes those after the first.
template <class Cells>
std::string limits_table(const Study& study, const std::vector<AccuracyRow>& rows, const char* heading,
                         const Cells& cells) {
  std::string html =
      fmt::format("<div class=\"wide\"><table class=\"figures limits\"><tr><th>limit</th>{}</tr>\n", heading);
  for (const AccuracyRow& row : rows) {
    if (row.scope != "all") continue;
    const Trial& trial = study.settings.trials[row.trial];
    html += fmt::format("<tr><td>{}</td>{}</tr>\n", label(trial), cells(trial, row));
  }
  return html + "</table></div>\n";
}

std::string verdicts_table(const Study& study, const std::vector<AccuracyRow>& rows) {
  return limits_table(
      study, rows,
      "<th>proved</th><th>wrong</th><th>95 %</th><th>false hits</th><th>of clear</th><th>false misses</th><th>of "
      "hits</th>",
      [](const Trial&, const AccuracyRow& r) {
        const auto range = [](const Interval& i) { return percent(i.low) + " – " + percent(i.high); };
        return fmt::format(
            "<td>{}</td><td>{}</td><td class=\"thin\">{}</td><td>{}</td><td class=\"thin\">{}</td><td>{}</td><td "
            "class=\"thin\">{}</td>",
            percent(r.share_proved()), percent(r.share_wrong()), range(r.wrong_interval()), r.false_hits,
            range(r.false_hit_interval()), r.false_misses, range(r.false_miss_interval()));
      });
}

std::string odds_table(const Study& study, const std::vector<AccuracyRow>& rows) {
  return limits_table(study, rows,
                      "<th>without proof</th><th>stated P, mean</th><th>were hits</th><th>calibration error</th><th>"
                      "Brier</th><th>reliability</th><th>resolution</th><th>uncertainty</th>",
                      [](const Trial&, const AccuracyRow& r) {
                        const ForecastQuality& q = r.unproved;
                        if (q.count == 0)
                          return std::string("<td>0</td>") + "<td>–</td><td>–</td><td>–</td><td>–</td>" +
                                 "<td>–</td><td>–</td><td>–</td>";
                        return fmt::format(
                            "<td>{}</td><td>{:.3f}</td><td>{:.3f}</td><td>{:.3f}</td><td>{:.3f}</td><td>{:.3f}</td>"
                            "<td>{:.3f}</td><td>{:.3f}</td>",
                            grouped(q.count), q.mean_probability, q.observed(), q.calibration_error, q.brier,
                            q.reliability, q.resolution, q.uncertainty);
                      });
}

std::string times_table(const Study& study, const std::vector<AccuracyRow>& rows) {
  return limits_table(
      study, rows,
      "<th>50 %</th><th>99 %</th><th>99.9 %</th><th>longest</th><th>overshoot, net: 99 %</th><th>99.9 %</th>",
      [](const Trial& trial, const AccuracyRow& r) {
        const auto time = [&](double us, double beyond) {  // italics: fewer than ten samples beyond
          const bool thin = static_cast<double>(r.wall_us.count) * beyond < 9.995;
          return fmt::format("<td{}>{}</td>", thin ? " class=\"thin\"" : "", duration(us * 1e3));
        };
        std::string cells =
            time(r.wall_us.p50, 0.5) + time(r.wall_us.p99, 0.01) + time(r.wall_us.p999, 0.001) + time(r.wall_us.max, 1);
        if (trial.kind != Trial::Kind::time) return cells + "<td>–</td><td>–</td>";
        return cells + time(r.net_overshoot_us.p99, 0.01) + time(r.net_overshoot_us.p999, 0.001);
      });
}

/// Share of wrong verdicts, band by limit.
std::string bands_table(const Study& study, const std::vector<AccuracyRow>& rows) {
  const auto& trials = study.settings.trials;
  std::string html = "<div class=\"wide\"><table class=\"figures limits\"><tr><th>distance</th>";
  for (const Trial& trial : trials) html += fmt::format("<th>{}</th>", label(trial));
  html += "</tr>\n";
  for (const PoseBand& band : pose_bands(study.settings.procedure)) {
    html += fmt::format("<tr><td>{}</td>", band.name);
    for (std::size_t t = 0; t < trials.size(); ++t) {
      const auto row = std::find_if(rows.begin(), rows.end(), [&](const AccuracyRow& r) {
        return r.trial == t && r.scope == "band" && r.band == band.name;
      });
      html += row == rows.end() ? std::string("<td>–</td>")
                                : fmt::format("<td title=\"{} of {} wrong, {} proved\">{}</td>", row->wrong(),
                                              row->poses, row->proved, percent(row->share_wrong()));
    }
    html += "</tr>\n";
  }
  return html + "</table></div>\n";
}

std::string worst_table(const Study& study, const std::filesystem::path& directory) {
  const auto worst = worst_poses(study, most_worst_poses);
  if (worst.empty()) return "<p>No pose was answered other than by a correct proof.</p>\n";
  std::string html =
      "<p>Each stands in a file of its own, which says in its first lines how to answer it again; run that where the "
      "study was run, "
      "with its files still there. Ranked by the squared error of the probability, added over all limits.</p>\n<div "
      "class=\"wide\">"
      "<table class=\"figures\"><tr><th>file</th><th>pose</th><th>distance</th><th>truth</th><th>worst limit</th><th>"
      "answer</th><th>P</th></tr>\n";
  std::size_t place = 0;
  for (const WorstPose& w : worst) {
    const PoseTruth& truth = study.poses[w.pose];
    const Sample& sample = study.samples[w.trial][w.pose];
    html += fmt::format(
        "<tr><td><code>worst/{:02}.csv</code></td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{:.4f}"
        "</td></tr>\n",
        ++place, truth.pose.index, pose_bands(study.settings.procedure)[truth.pose.band].name,
        truth.hit ? "hit" : "clear", label(study.settings.trials[w.trial]), name(sample.verdict), sample.probability);
  }
  html += "</table></div>\n<p>For example: <code>" +
          html_escaped(replay_command(study.settings, study.settings.trials[worst.front().trial],
                                      worst_file(directory, 1).string())) +
          "</code></p>\n";
  return html;
}

std::string charts_of_error(const Study& study) {
  std::string html = "<div class=\"pair\">\n";
  if (has_kind(study, Trial::Kind::time)) {
    html += figure("error-us", "Wrong verdicts against time",
                   "Lower is better. Bars: 95 % intervals; points at the bottom: none was wrong.");
    html += figure("proved-us", "Proved answers against time", "The rest are probabilities, and say so.");
  }
  if (has_kind(study, Trial::Kind::work)) {
    html += figure("error-work", "Wrong verdicts against work units", "The same on every machine, bit for bit.");
    html += figure("proved-work", "Proved answers against work units", "A unit is a pair of boxes or of triangles.");
  }
  const auto& trials = study.settings.trials;
  const bool thresholds = std::any_of(trials.begin(), trials.end(), [&](const Trial& trial) {
    return trial.kind != Trial::Kind::exact && trial.p_min != trials.front().p_min;
  });
  if (thresholds) {
    html += figure("error-p", "Wrong verdicts by threshold", "All poses; one line for each --p-min.");
    html += figure("time-p", "Median time by threshold", "What stopping on probability saves.");
  }
  return html + "</div>\n";
}

const char* how_posed(Procedure procedure) {
  switch (procedure) {
    case Procedure::distance:
      return "B comes towards A with a random rotation from a random direction until they touch (found with the exact "
             "search), then stands off until the surfaces are the stated distance apart, or moves on by the stated "
             "way.";
    case Procedure::tumbling:
      return "A stands still, B is turned about z at random and comes along x; distances are ways from the first "
             "contact.";
    case Procedure::nested:
      break;
  }
  return "B stands inside A, both centres in one place, turned by up to 0.2 degrees, and moves out in a random "
         "direction until they touch (found with the exact search); then it stands off until the surfaces are the "
         "stated distance apart, or moves on by the stated way.";
}

std::string study_section(const Study& study) {
  const StudySettings& s = study.settings;
  return fmt::format(
      "<h2 id=\"study\">This study</h2>\n<p>{} Distances are parts of the smaller body's size ({:.6g} m, diagonal of "
      "its bounding box). What is true in a pose was proved by the exact search of the wide engine without a limit. "
      "Procedure {}, seed {}, {} poses for each distance; bounding volume {}, estimator {}, k_min {}, up to {} "
      "contact{}. Each query stands alone: nothing is remembered of the one before.</p>\n",
      how_posed(s.procedure), s.size_m, name(s.procedure), s.seed, grouped(s.poses_per_band), s.bounding_volume,
      s.estimator, s.k_min, s.contacts, s.contacts == 1 ? "" : "s");
}

std::string cards(const Study& study, const std::vector<AccuracyRow>& rows) {
  std::string html = "<div class=\"cards\">\n";
  for (const AccuracyRow& r : rows) {
    const Trial& trial = study.settings.trials[r.trial];
    if (r.scope != "all" || trial.kind != Trial::Kind::time || trial.p_min != study.settings.trials.front().p_min)
      continue;
    html += card(percent(r.share_wrong()),
                 fmt::format("wrong within {} µs; {} proved", trial.amount, percent(r.share_proved())));
  }
  return html + "</div>\n";
}

std::string odds_section(const Study& study, const std::vector<AccuracyRow>& rows, bool charts) {
  std::string html =
      "<h2 id=\"odds\">Are the odds true?</h2>\n<p>Of the answers that are no proofs: among those that state a "
      "probability p of a hit, a share p should be hits. The calibration error is the mean distance from that (10 "
      "bins). The Brier score is reliability less resolution plus uncertainty, and what the bins leave over.</p>\n";
  if (charts) {
    html += "<div class=\"pair\">\n" +
            figure("reliability", "Reliability",
                   "On the diagonal: what is stated is what happens. Bars: 95 % intervals; bins of fewer than ten "
                   "answers are left out.",
                   "tall") +
            figure("kinds", "False hits and false misses",
                   "Of all clear poses, and of all poses with a hit. Both matter: one is a ghost, the other a hole.",
                   "tall") +
            "</div>\n";
  }
  return html + odds_table(study, rows);
}

std::string time_section(const Study& study, const std::vector<AccuracyRow>& rows, bool charts) {
  std::string html = "<h2 id=\"time\">Time</h2>\n";
  if (charts) {
    html += figure("tail", "Time of a query against its limit",
                   "All poses. The dashed diagonal is the limit itself; the horizontal lines are the exact search.");
  }
  return html + times_table(study, rows) +
         "<p class=\"quiet\">Wall time. In italics: fewer than ten samples beyond, little more than an anecdote. Net: "
         "without the stalls in which the processor did something else.</p>\n";
}

std::string contacts_section(bool charts) {
  std::string html =
      "<h2 id=\"contacts\">Contacts</h2>\n<p>What a force would be made of: the first contact of an answer, or, "
      "without "
      "a proof, the place where the surfaces most probably meet, against the exact region of contact; direction and "
      "depth against the nearest of the exact set. "
      "Medians; "
      "90th percentiles are in accuracy.csv.</p>\n";
  if (!charts) return html;
  return html + "<div class=\"pair\">\n" +
         figure("position", "Error of the place", "Part of the size. Torque is force times this lever.") +
         figure("normal", "Error of the direction", "A force points along the normal.") + "</div>\n";
}

std::string footer(const Study& study, bool charts) {
  return fmt::format(
      "<footer>Written by odds {}. Beside this page: <code>accuracy.csv</code> (every figure, one line for each limit "
      "and distance), <code>poses.csv</code> (all poses with what is true in them; <code>odds query</code> reads it), "
      "<code>answers.csv</code> (every answer), <code>summary.json</code>, <code>worst/</code>.{}</footer>\n</main>\n",
      html_escaped(study.version),
      charts ? fmt::format(" Charts: Chart.js {}, MIT licence.", chart_library_version()) : "");
}

}  // namespace

std::string accuracy_page(const Study& study, const std::vector<AccuracyRow>& rows,
                          const std::filesystem::path& directory) {
  const bool charts = !chart_library_version().empty();
  const std::string title = study.settings.mesh_a + " and " + study.settings.mesh_b + " · odds accuracy";
  std::string html = page_begin(title, accuracy_script()) + top(study, rows) + cards(study, rows) +
                     "</header>\n<main>\n<h2 id=\"error\">Error against time</h2>\n";
  if (!charts) {
    html +=
        "<p class=\"note\">This program was built without a chart library, so this page has tables only; with Debian's "
        "libjs-chart.js at build time there are charts here.</p>\n";
  }
  if (charts) html += charts_of_error(study);
  html += verdicts_table(study, rows) + odds_section(study, rows, charts) + time_section(study, rows, charts);
  html += contacts_section(charts);
  html += "<h2 id=\"bands\">Wrong verdicts by distance</h2>\n" + bands_table(study, rows);
  html += "<h2 id=\"worst\">The worst poses</h2>\n" + worst_table(study, directory) + study_section(study) +
          footer(study, charts);
  return html + page_end(charts ? accuracy_page_data(study, rows) : "", accuracy_script());
}

}  // namespace odds::report
