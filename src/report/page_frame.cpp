// Beginning and end of a report page.
#include "report/page_frame.hpp"

#include <fmt/format.h>

#include "report/base64.hpp"
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

/// The library and what draws with it; nothing where there is no library.
std::vector<PageScript> charts_by(const PageScript& script) {
  if (chart_library_version().empty()) return {};
  return {chart_library(), script};
}

}  // namespace

std::string page_head(const std::string& title, const std::vector<PageScript>& scripts) {
  // No script but ours runs, and nothing is fetched, even if some text slipped through the escaping.
  std::string digests;
  for (const PageScript& script : scripts) {
    if (!digests.empty()) digests += ' ';
    digests += digest(script);
  }
  return fmt::format(
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; script-src {}; style-src "
      "'unsafe-inline'; img-src data:; base-uri 'none'; form-action 'none'\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"color-scheme\" content=\"light dark\">\n<title>{}</title>\n<style>\n{}</style>\n"
      "</head>\n<body>\n",
      digests.empty() ? "'none'" : digests, html_escaped(title), page_style());
}

std::string script_elements(std::string_view id, const std::string& data, const std::vector<PageScript>& scripts) {
  std::string elements = fmt::format("<script id=\"{}\" type=\"application/json\">{}</script>\n", id, data);
  // The text between the tags must be the digest's text to the byte.
  for (const PageScript& script : scripts) elements += fmt::format("<script>{}</script>\n", script.text);
  return elements;
}

std::string page_begin(const std::string& title, const PageScript& script) {
  return page_head(title, charts_by(script));
}

std::string page_end(const std::string& data, const PageScript& script) {
  const std::vector<PageScript> scripts = charts_by(script);
  const std::string end = "</body>\n</html>\n";
  return scripts.empty() ? end : script_elements("data", data, scripts) + end;
}

}  // namespace odds::report
