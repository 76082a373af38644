// Puts the report page of a run together.
#include <fmt/format.h>

#include "report/page_assets.hpp"
#include "report/page_frame.hpp"
#include "report/page_parts.hpp"
#include "report/run_files.hpp"
#include "report/text.hpp"

namespace odds::report {

std::string page(const RunInfo& info, const RunSummary& summary, std::span<const haptics::TickRecord> ticks,
                 const RunReplay* replay) {
  const bool charts = !chart_library_version().empty();
  const bool shows = replay != nullptr && !replay->frames.empty() && !replay_library_version().empty();
  std::vector<PageScript> chart_scripts;
  std::vector<PageScript> replay_scripts;
  if (charts) chart_scripts = {chart_library(), page_script()};
  if (shows) replay_scripts = {replay_library(), replay_script()};
  std::vector<PageScript> scripts = chart_scripts;
  scripts.insert(scripts.end(), replay_scripts.begin(), replay_scripts.end());
  std::string html = page_head(info.scene + " · odds run report", scripts);
  html += page_head_line(info, summary);
  html += "<main>\n";
  if (!charts) {
    html +=
        "<p class=\"note\">This program was built without a chart library, so this page has tables only. All numbers "
        "are in ticks.csv and summary.json; with Debian's libjs-chart.js at build time there are charts here.</p>\n";
  } else {
    html +=
        "<noscript><p class=\"note\">The charts need JavaScript, which is off. Every figure is in the tables too.</p>"
        "</noscript>\n";
  }
  for (const std::string& warning : info.warnings) {
    html += "<p class=\"note\"><b>Warning:</b> " + html_escaped(warning) + "</p>\n";
  }
  if (shows) html += page_replay(*replay);
  html += page_latency(info, summary, charts);
  html += page_answers(summary, charts);
  html += page_forces(info, summary, charts);
  html += page_effects(info, summary);
  html += page_machine(info);
  html += page_run(info);
  html += page_glossary();
  html += fmt::format(
      "<footer>Written by odds {}. Beside this page: <code>summary.json</code> (these figures, for "
      "programs), <code>ticks.csv</code> (every tick), <code>latency.hgrm</code>, <code>wake.hgrm</code>, "
      "<code>query.hgrm</code> and <code>latency.hlog</code> (HdrHistogram's formats).{}</footer>\n</main>\n",
      html_escaped(info.version),
      (charts ? fmt::format(" Charts: Chart.js {}, MIT licence.", chart_library_version()) : "") +
          (shows ? fmt::format(" Replay: three.js r{}, MIT licence.", replay_library_version()) : ""));
  if (charts) html += script_elements("data", page_data(info, summary, ticks), chart_scripts);
  if (shows) html += script_elements("replay-data", replay_data(info, *replay, ticks), replay_scripts);
  return html + "</body>\n</html>\n";
}

}  // namespace odds::report
