// Puts the report page together: one file, no outside reference, scripts allowed by digest only.
#include <fmt/format.h>

#include "report/base64.hpp"
#include "report/page_assets.hpp"
#include "report/page_parts.hpp"
#include "report/run_files.hpp"
#include "report/text.hpp"

namespace odds::report {
namespace {

std::string bytes_of_hex(std::string_view hex) {
  const auto digit = [](char c) { return c <= '9' ? c - '0' : c - 'a' + 10; };
  std::string bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2) {
    bytes.push_back(static_cast<char>(digit(hex[i]) * 16 + digit(hex[i + 1])));
  }
  return bytes;
}

std::string digest(const PageScript& script) {
  return "'sha256-" + base64_encode(bytes_of_hex(script.sha256_hex)) + "'";
}

std::string head(const RunInfo& info, bool charts, bool replay) {
  // No script but ours runs, and nothing is fetched, even if some text slipped through the escaping.
  std::string scripts;
  if (charts) scripts = fmt::format("{} {}", digest(chart_library()), digest(page_script()));
  if (replay) scripts += fmt::format(" {} {}", digest(replay_library()), digest(replay_script()));
  if (scripts.empty()) scripts = "'none'";
  return fmt::format(
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; script-src {}; style-src "
      "'unsafe-inline'; img-src data:; base-uri 'none'; form-action 'none'\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"color-scheme\" content=\"light dark\">\n<title>{} · odds run report</title>\n<style>\n{}</style>\n"
      "</head>\n<body>\n",
      scripts, html_escaped(info.scene), page_style());
}

std::string scripts(const std::string& data) {
  // The text between the tags must be the digest's text to the byte.
  return fmt::format(
      "<script id=\"data\" type=\"application/json\">{}</script>\n<script>{}</script>\n<script>{}</script>\n", data,
      chart_library().text, page_script().text);
}

}  // namespace

std::string page(const RunInfo& info, const RunSummary& summary, std::span<const haptics::TickRecord> ticks,
                 const RunReplay* replay) {
  const bool charts = !chart_library_version().empty();
  const bool shows = replay != nullptr && !replay->frames.empty() && !replay_library_version().empty();
  std::string html = head(info, charts, shows);
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
  if (shows) html += page_replay(*replay);
  html += page_latency(summary, charts);
  html += page_answers(summary, charts);
  html += page_forces(summary, charts);
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
  if (charts) html += scripts(page_data(info, summary, ticks));
  if (shows) {
    html += fmt::format(
        "<script id=\"replay-data\" type=\"application/json\">{}</script>\n<script>{}</script>\n<script>{}</script>\n",
        replay_data(info, *replay, ticks), replay_library().text, replay_script().text);
  }
  return html + "</body>\n</html>\n";
}

}  // namespace odds::report
