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

bool charts() { return !chart_library_version().empty(); }

}  // namespace

std::string page_begin(const std::string& title, const PageScript& script) {
  // No script but ours runs, and nothing is fetched, even if some text slipped through the escaping.
  const std::string scripts = charts() ? digest(chart_library()) + " " + digest(script) : "'none'";
  return fmt::format(
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; script-src {}; style-src "
      "'unsafe-inline'; img-src data:; base-uri 'none'; form-action 'none'\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"color-scheme\" content=\"light dark\">\n<title>{}</title>\n<style>\n{}</style>\n"
      "</head>\n<body>\n",
      scripts, html_escaped(title), page_style());
}

std::string page_end(const std::string& data, const PageScript& script) {
  if (!charts()) return "</body>\n</html>\n";
  // The text between the tags must be the digest's text to the byte.
  return fmt::format(
      "<script id=\"data\" type=\"application/json\">{}</script>\n<script>{}</script>\n<script>{}</script>\n</body>\n"
      "</html>\n",
      data, chart_library().text, script.text);
}

}  // namespace odds::report
