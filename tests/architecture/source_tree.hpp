// The project's own files as text, for the tests that judge the house rather than the code.
#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

namespace odds::architecture {

struct SourceFile {
  std::string path;  ///< relative to the top of the source tree, with slashes
  std::string text;
};

/// What a rule found wrong, one sentence each, beginning with the path.
using Violations = std::vector<std::string>;

inline SourceFile read_file(const std::filesystem::path& top, const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {path.lexically_relative(top).generic_string(), {std::istreambuf_iterator<char>(stream), {}}};
}

/// All regular files below the folders named (relative to `top`), sorted by path; a name may be a file.
inline std::vector<SourceFile> read_files(const std::filesystem::path& top, const std::vector<std::string>& names) {
  std::vector<SourceFile> files;
  for (const std::string& name : names) {
    if (std::filesystem::is_regular_file(top / name)) files.push_back(read_file(top, top / name));
    if (!std::filesystem::is_directory(top / name)) continue;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(top / name)) {
      if (entry.is_regular_file()) files.push_back(read_file(top, entry.path()));
    }
  }
  std::sort(files.begin(), files.end(), [](const auto& a, const auto& b) { return a.path < b.path; });
  return files;
}

/// The folders and files that ship; not what a build or an editor leaves behind.
inline std::vector<SourceFile> read_shipped_files() {
  return read_files(ODDS_SOURCE_DIR, {"include", "src", "demos", "tests", "docs", ".ci", "README.md", "CHANGELOG.md",
                                      "CONTRIBUTING.md", "LICENSE", "CMakeLists.txt", "CMakePresets.json",
                                      ".clang-format", ".clang-tidy", ".gitignore"});
}

inline std::vector<std::string_view> lines(std::string_view text) {
  std::vector<std::string_view> found;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    found.push_back(text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return found;
}

inline bool has_extension(std::string_view path, std::initializer_list<std::string_view> extensions) {
  return std::any_of(extensions.begin(), extensions.end(), [&](std::string_view e) { return path.ends_with(e); });
}

inline bool is_code(std::string_view path) { return has_extension(path, {".hpp", ".cpp", ".h", ".c"}); }

inline void append(Violations& violations, const Violations& more) {
  violations.insert(violations.end(), more.begin(), more.end());
}

inline std::string join(const Violations& violations) {
  std::string text;
  for (const std::string& violation : violations) text += "\n  " + violation;
  return text;
}

}  // namespace odds::architecture
