// The rules about the text of what ships: sizes, first lines, words and addresses that must not stand in it.
#pragma once

#include <regex>
#include <string>
#include <utility>

#include "architecture/source_tree.hpp"

namespace odds::architecture {

inline constexpr std::size_t most_lines = 500;

inline Violations judge_size(const SourceFile& file) {
  const std::size_t count = lines(file.text).size();
  if (count <= most_lines) return {};
  return {file.path + ": " + std::to_string(count) + " lines; one noun per file, at most " + std::to_string(most_lines)};
}

/// A header begins by saying what it is for.
inline Violations judge_first_line(const SourceFile& file) {
  if (!has_extension(file.path, {".hpp", ".h"})) return {};
  if (file.text.starts_with("// ") || file.text.starts_with("/* ")) return {};
  return {file.path + ": the first line does not say what the file is for"};
}

/// A sentence for every line in which `pattern` is found.
inline Violations judge_lines(const SourceFile& file, const std::regex& pattern, const std::string& why) {
  Violations found;
  std::size_t number = 0;
  for (const std::string_view line : lines(file.text)) {
    ++number;
    if (std::regex_search(line.begin(), line.end(), pattern)) {
      found.push_back(file.path + ":" + std::to_string(number) + ": " + why + ": " + std::string(line.substr(0, 120)));
    }
  }
  return found;
}

// The patterns are put together from pieces so that this file does not contain what it forbids.
inline const std::regex& machine_path() {
  static const std::regex pattern(std::string("(^|[^A-Za-z0-9_.])/(wor") + "k|far" + "m|roo" + "t|hom" + "e/[a-z]+|Us" +
                                  "ers)/");
  return pattern;
}

inline const std::regex& registry_host() {
  static const std::regex pattern(std::string("(deb") + "ian|npm" + "js|py" + "pi|crat" + "es)\\.(org|com|io)");
  return pattern;
}

inline const std::regex& unfinished_word() {
  static const std::regex pattern(std::string("\\b(TO") + "DO|FIX" + "ME|XX" + "X|HA" + "CK|(not |un)imple" +
                                  "mented)\\b");
  return pattern;
}

inline Violations judge_words(const SourceFile& file) {
  if (file.text.find('\0') != std::string::npos) return {};  // not text
  Violations found = judge_lines(file, machine_path(), "a path of one machine");
  append(found, judge_lines(file, registry_host(), "the host of a package registry"));
  append(found, judge_lines(file, unfinished_word(), "says that it is unfinished"));
  return found;
}

}  // namespace odds::architecture
