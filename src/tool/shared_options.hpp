// What options of several sub-commands share: choices by name, checks of numbers.
#pragma once

#include <CLI/CLI.hpp>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace odds::tool {

/// Adds --calibrate: see query::PairOptions::calibration_poses.
void add_calibration_option(CLI::App& command, std::uint32_t& poses);

/// Accepts finite numbers > 0.
CLI::Validator positive_and_finite();
/// Accepts numbers in (0, 1].
CLI::Validator share_of_one();
/// Accepts plain digits of a number in [least, greatest]; CLI11 itself would wrap "-3" around, and read "010" as 8.
CLI::Validator whole_number(std::uint64_t least, std::uint64_t greatest);

/// An option whose value is one of the names; an unknown one is wrong usage and all names are listed.
template <class Target, class Value>
CLI::Option* add_choice(CLI::App& command, const std::string& option, Target& target,
                        const std::map<std::string, Value>& values, const std::string& meaning) {
  std::vector<std::string> names;
  for (const auto& [name, value] : values) names.push_back(name);
  return command
      .add_option_function<std::string>(
          option, [&target, values](const std::string& name) { target = values.at(name); }, meaning)
      ->check(CLI::IsMember(names).description(""));
}

}  // namespace odds::tool
