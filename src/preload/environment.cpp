// Reading the environment variables, with a sentence for each mistake.
#include "preload/environment.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <type_traits>

namespace odds::preload {
namespace {

struct PartnerName {
  std::string_view name;
  unsigned bit;
};

constexpr std::array<PartnerName, 9> partner_names = {{{"all", ODDS_TAKE_ALL},
                                                       {"trimesh", ODDS_TAKE_TRIMESH},
                                                       {"sphere", ODDS_TAKE_SPHERE},
                                                       {"box", ODDS_TAKE_BOX},
                                                       {"capsule", ODDS_TAKE_CAPSULE},
                                                       {"cylinder", ODDS_TAKE_CYLINDER},
                                                       {"plane", ODDS_TAKE_PLANE},
                                                       {"ray", ODDS_TAKE_RAY},
                                                       {"convex", ODDS_TAKE_CONVEX}}};

// A number in [least, most] into `value`; otherwise it stays, and the mistake is noted. Not by strtod: the program may
// have set a locale whose numbers have commas.
template <class Number>
void read_number(const char* name, double least, double most, Number& value, std::vector<std::string>& mistakes) {
  const char* given = std::getenv(name);
  if (given == nullptr || *given == '\0') return;
  const std::string text = given;
  double number = 0.0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool read = code == std::errc{} && end == text.data() + text.size();
  const bool whole = std::is_floating_point_v<Number> || number == std::floor(number);
  if (read && number >= least && number <= most && whole) {
    value = static_cast<Number>(number);
    return;
  }
  mistakes.push_back(std::string(name) + "=" + text + " is not a" + (std::is_floating_point_v<Number> ? "" : " whole") +
                     " number in range; the default is used");
}

std::string_view trimmed(std::string_view word) {
  while (word.starts_with(' ')) word.remove_prefix(1);
  while (word.ends_with(' ')) word.remove_suffix(1);
  return word;
}

unsigned read_partners(const char* text, std::vector<std::string>& mistakes) {
  unsigned bits = 0;
  std::string_view rest = text;
  while (!rest.empty()) {
    const std::size_t comma = rest.find(',');
    const std::string_view word = trimmed(rest.substr(0, comma));
    rest = comma == std::string_view::npos ? std::string_view() : rest.substr(comma + 1);
    unsigned found = 0;
    for (const PartnerName& partner : partner_names) found |= partner.name == word ? partner.bit : 0u;
    if (found == 0) {
      mistakes.push_back("ODDS_PARTNERS: \"" + std::string(word) +
                         "\" is unknown and left out; use all, or trimesh, sphere, box, capsule, cylinder, plane, ray, "
                         "convex with commas");
    }
    bits |= found;
  }
  if (bits != 0) return bits;
  if (*text != '\0') mistakes.emplace_back("ODDS_PARTNERS: no known partner is left; all are taken over");
  return ODDS_TAKE_ALL;
}

// A program may go elsewhere before it ends, games to their data often before they initialise ODE: a file without a
// folder is one where the program was started. Known from when this library is loaded.
std::string place_of_report() {
  const char* given = std::getenv("ODDS_REPORT");
  const std::string report = given != nullptr && *given != '\0' ? given : "-";
  if (report == "-" || report == "off") return report;
  std::error_code unknown;  // then it stays what it is
  const std::filesystem::path place = std::filesystem::absolute(report, unknown);
  return unknown ? report : place.string();
}
const std::string report = place_of_report();

}  // namespace

Environment read_environment() {
  Environment environment;
  oddsTakeOverParamsInit(&environment.takeover);
  if (const char* partners = std::getenv("ODDS_PARTNERS")) {
    environment.takeover.partners = read_partners(partners, environment.mistakes);
  }
  read_number("ODDS_BUDGET_US", 1e-3, 1e12, environment.takeover.budget_us, environment.mistakes);
  read_number("ODDS_WORK_UNITS", 0, 1e15, environment.takeover.work_units, environment.mistakes);
  read_number("ODDS_MAX_CONTACTS", 0, 8, environment.takeover.max_contacts, environment.mistakes);
  environment.report = report;
  return environment;
}

}  // namespace odds::preload
