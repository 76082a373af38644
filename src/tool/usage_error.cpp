#include "tool/usage_error.hpp"

#include <fmt/core.h>

#include <string_view>
#include <vector>

#include "odds/haptics/settings.hpp"
#include "tool/one_line.hpp"

namespace odds::tool {

std::string unknown_word(const CLI::App& app) {
  const std::vector<CLI::App*> named = app.get_subcommands();
  const CLI::App& asked = named.empty() ? app : *named.front();
  const std::vector<std::string> rest = asked.remaining();
  if (rest.empty()) return "";
  std::vector<std::string> known;
  for (const CLI::App* command : asked.get_subcommands([](const CLI::App*) { return true; })) {
    known.push_back(command->get_name());
  }
  for (const CLI::Option* option : asked.get_options()) {
    for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
  }
  const std::vector<std::string_view> views(known.begin(), known.end());
  const std::string near = haptics::nearest_name(rest.front(), views);
  const std::string what = named.empty() ? "no command of odds" : "no argument of odds " + asked.get_name();
  return on_one_line(fmt::format("'{}' is {}", rest.front(), what) +
                     (near.empty() ? "" : fmt::format("; did you mean '{}'?", near)));
}

}  // namespace odds::tool
