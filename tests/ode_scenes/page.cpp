#include "ode_scenes/page.hpp"

#include <fmt/format.h>

#include "ode_scenes/script.hpp"
#include "report/base64.hpp"
#include "report/page_frame.hpp"
#include "report/text.hpp"

namespace odds::ode_scenes {
namespace {

using report::html_escaped;

std::string number(double value) {
  if (!std::isfinite(value)) return "∞";
  return value == 0.0 ? "0"
                      : fmt::format("{:.{}f}", value,
                                    std::clamp(2 - static_cast<int>(std::floor(std::log10(std::abs(value)))), 0, 6));
}

/// Figures that stand in a column of their own, in the order in which the section's runs have them.
std::vector<std::pair<std::string, std::string>> columns(const Section& section) {
  std::vector<std::pair<std::string, std::string>> names;
  for (const Run& run : section.runs) {
    for (const Figure& figure : run.figures) {
      const std::pair<std::string, std::string> name{figure.name, figure.unit};
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
  }
  return names;
}

const Figure* find(const Run& run, const std::string& name) {
  for (const Figure& figure : run.figures) {
    if (figure.name == name) return &figure;
  }
  return nullptr;
}

std::string row(const Run& run, const std::vector<std::pair<std::string, std::string>>& names, bool repeats) {
  std::string html = fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td>", repeats ? "" : html_escaped(run.variant),
                                 html_escaped(run.collider), html_escaped(run.note));
  for (const auto& [name, unit] : names) {
    const Figure* figure = find(run, name);
    if (figure == nullptr) {
      html += "<td></td>";
    } else if (!run.ours || !figure->bar) {
      html += fmt::format("<td>{}</td>", number(figure->value));
    } else {
      html += fmt::format("<td><span class=\"state {}\" title=\"at most {}\">{}</span></td>",
                          figure->meets() ? "met" : "missed", number(*figure->bar), number(figure->value));
    }
  }
  return html + "</tr>\n";
}

std::string table(const Section& section) {
  const auto names = columns(section);
  std::string html = "<div class=\"wide\"><table class=\"figures limits\"><tr><th>scene</th><th>collider</th><th></th>";
  for (const auto& [name, unit] : names) {
    html += fmt::format("<th>{}{}</th>", html_escaped(name), unit.empty() ? "" : ", " + unit);
  }
  html += "</tr>\n";
  const std::string* last = nullptr;
  for (const Run& run : section.runs) {
    html += row(run, names, last != nullptr && *last == run.variant);
    last = &run.variant;
  }
  return html + "</table></div>\n";
}

std::string pictures(const Section& section) {
  std::string html;
  for (const Run& run : section.runs) {
    if (run.picture.empty()) continue;
    html += fmt::format(
        "<figure><figcaption><h3>{}</h3>{}: {}</figcaption><img alt=\"{}\" "
        "src=\"data:image/png;base64,{}\"></figure>\n",
        html_escaped(run.collider), html_escaped(run.variant), html_escaped(run.note), html_escaped(run.note),
        report::base64_encode(run.picture));
  }
  return html.empty() ? "" : "<div class=\"pair\">\n" + html + "</div>\n";
}

bool has_traces(const Section& section) {
  return std::any_of(section.runs.begin(), section.runs.end(), [](const Run& run) { return !run.traces.empty(); });
}

std::string chart(const Section& section) {
  if (!has_traces(section) || report::chart_library_version().empty()) return "";
  return fmt::format(
      "<figure><figcaption><h3>{}</h3></figcaption><div class=\"plot tall\"><canvas id=\"chart-{}\" role=\"img\" "
      "aria-label=\"{}\"></canvas></div></figure>\n",
      html_escaped(section.y_title), section.id, html_escaped(section.y_title));
}

std::string json_text(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '<') {
      out += "\\u003c";  // nothing in the data may end its script element
      continue;
    }
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

std::string data_of(const std::vector<Section>& sections) {
  std::string json = "[";
  for (const Section& section : sections) {
    if (!has_traces(section)) continue;
    json += fmt::format("{}{{\"id\":{},\"x\":{},\"y\":{},\"logarithmic\":{},\"series\":[", json.size() > 1 ? "," : "",
                        json_text("chart-" + section.id), json_text(section.x_title), json_text(section.y_title),
                        section.logarithmic);
    bool first = true;
    for (const Run& run : section.runs) {
      for (const Trace& trace : run.traces) {
        json += fmt::format("{}{{\"name\":{},\"points\":[", first ? "" : ",", json_text(trace.name));
        first = false;
        for (std::size_t i = 0; i < trace.points.size(); ++i) {
          const auto& [x, y] = trace.points[i];
          if (!std::isfinite(y)) break;
          json += fmt::format("{}[{:.6g},{:.6g}]", i > 0 ? "," : "", x, y);
        }
        json += "]}";
      }
    }
    json += "]}";
  }
  return json + "]";
}

std::string quoted(const std::string& text) { return "\"" + text + "\""; }

}  // namespace

std::vector<std::string> misses(const std::vector<Section>& sections) {
  std::vector<std::string> list;
  for (const Section& section : sections) {
    for (const Run& run : section.runs) {
      for (const Figure& figure : run.figures) {
        if (!run.ours || figure.meets()) continue;
        list.push_back(fmt::format("{}, {}, {}: {} {} {}, bar {}", section.title, run.variant, run.collider,
                                   figure.name, number(figure.value), figure.unit, number(*figure.bar)));
      }
    }
  }
  return list;
}

std::string page_of(const std::vector<Section>& sections, double seconds_taken) {
  std::size_t judged = 0;
  for (const Section& section : sections) {
    for (const Run& run : section.runs) {
      judged += run.ours ? static_cast<std::size_t>(std::count_if(run.figures.begin(), run.figures.end(),
                                                                  [](const Figure& f) { return f.bar.has_value(); }))
                         : 0;
    }
  }
  const std::vector<std::string> missed = misses(sections);
  std::string html = report::page_begin("Scenes in ODE", chart_script());
  html += fmt::format(
      "<header>\n<h1>Scenes in ODE</h1>\n<p class=\"sub\">The same bodies at 1 kHz, collided by <code>odds</code> in "
      "place of ODE's dTriMesh (a takeover), by ODE itself, by ODE's primitives where there are any. {:.0f} s of "
      "work.</p>\n<nav>",
      seconds_taken);
  for (const Section& section : sections) {
    html += fmt::format("<a href=\"#{}\">{}</a>", section.id, html_escaped(section.title));
  }
  html += fmt::format(
      "</nav>\n<div class=\"verdict neutral\"><span class=\"lead\">{} of {} judged figures meet their "
      "bars.</span></div>\n"
      "</header>\n<main>\n",
      judged - missed.size(), judged);
  if (!missed.empty()) {
    html += "<details><summary>What misses its bar</summary><ul>\n";
    for (const std::string& miss : missed) html += "<li>" + html_escaped(miss) + "</li>\n";
    html += "</ul></details>\n";
  }
  for (const Section& section : sections) {
    html += fmt::format("<h2 id=\"{}\">{}</h2>\n{}\n{}{}{}", section.id, html_escaped(section.title), section.text,
                        pictures(section), chart(section), table(section));
  }
  html +=
      "<footer>Times are of the thread's processor. A collision is one dCollide that gave contacts; depths are those "
      "that the collider itself states; what is \"truly\" and \"true\" is looked at by a search without a limit. "
      "Colours judge odds "
      "only.</footer>\n</main>\n";
  return html + report::page_end(data_of(sections), chart_script());
}

std::string csv_of(const std::vector<Section>& sections) {
  std::string csv = "scene,variant,collider,figure,value,unit,bar,meets,note\n";
  for (const Section& section : sections) {
    for (const Run& run : section.runs) {
      for (const Figure& f : run.figures) {
        const bool judged = run.ours && f.bar.has_value();
        csv += fmt::format("{},{},{},{},{:.9g},{},{},{},{}\n", section.id, quoted(run.variant), quoted(run.collider),
                           quoted(f.name), f.value, f.unit, judged ? fmt::format("{:g}", *f.bar) : "",
                           judged ? (f.meets() ? "yes" : "no") : "", quoted(run.note));
      }
    }
  }
  return csv;
}

}  // namespace odds::ode_scenes
