// Sizes, first lines, and words that do not belong in what ships.
#include <gtest/gtest.h>

#include "architecture/text_rules.hpp"

namespace odds::architecture {
namespace {

std::string many_lines(std::size_t count) {
  std::string text;
  for (std::size_t i = 0; i < count; ++i) text += "x\n";
  return text;
}

TEST(TextRules, RefuseAFileOfMoreThan500Lines) {
  EXPECT_EQ(judge_size({"a.cpp", many_lines(500)}), Violations{});
  EXPECT_EQ(judge_size({"a.cpp", many_lines(501)}).size(), 1u);
}

TEST(TextRules, RefuseAHeaderThatDoesNotSayWhatItIsFor) {
  EXPECT_EQ(judge_first_line({"a.hpp", "// Poses.\n#pragma once\n"}), Violations{});
  EXPECT_EQ(judge_first_line({"a.hpp", "#pragma once\n"}).size(), 1u);
  EXPECT_EQ(judge_first_line({"a.hpp", ""}).size(), 1u);
  EXPECT_EQ(judge_first_line({"a.cpp", "#include \"a.hpp\"\n"}), Violations{});
}

TEST(TextRules, RefusePathsOfAMachine) {
  const std::string slash = "/";
  EXPECT_EQ(judge_words({"a.md", "fine\nsee " + slash + "work" + slash + "x\n"}).size(), 1u);
  EXPECT_EQ(judge_words({"a.md", "\"" + slash + "home" + slash + "jane" + slash + "x\"\n"}).size(), 1u);
  EXPECT_EQ(judge_words({"a.md", "net" + slash + "work" + slash + "x, /usr/share/x, /tmp/x\n"}), Violations{});
}

TEST(TextRules, RefuseRegistryHostsAndUnfinishedWords) {
  EXPECT_EQ(judge_words({"a.md", std::string("deb.deb") + "ian.org\n"}).size(), 1u);
  EXPECT_EQ(judge_words({"a.cpp", std::string("// TO") + "DO: later\n"}).size(), 1u);
  EXPECT_EQ(judge_words({"a.cpp", "// Debian 12 has it\n"}), Violations{});
}

enum class Which { code, everything };

Violations judge_shipped(Violations (*rule)(const SourceFile&), Which which) {
  Violations found;
  for (const SourceFile& file : read_shipped_files()) {
    if (which == Which::everything || is_code(file.path)) append(found, rule(file));
  }
  return found;
}

TEST(TheHouse, TheTopHoldsWhatThePlanNames) {
  const std::vector<std::string> planned = {"CMakeLists.txt", "CMakePresets.json", "CHANGELOG.md", "CONTRIBUTING.md",
                                            "LICENSE",        "README.md",         "demos",        "docs",
                                            "include",        "src",               "tests"};
  const std::vector<std::string> left_behind = {"build", "out", "compile_commands.json", "CMakeUserPresets.json"};
  for (const auto& entry : std::filesystem::directory_iterator(ODDS_SOURCE_DIR)) {
    const std::string name = entry.path().filename().string();
    const auto among = [&](const auto& names) { return std::find(names.begin(), names.end(), name) != names.end(); };
    EXPECT_TRUE(name.starts_with('.') || among(planned) || among(left_behind)) << name << " is in no plan of the tree";
  }
}

TEST(TheHouse, FilesAreShort) {
  const Violations found = judge_shipped(&judge_size, Which::code);
  EXPECT_TRUE(found.empty()) << join(found);
}

TEST(TheHouse, HeadersSayWhatTheyAreFor) {
  const Violations found = judge_shipped(&judge_first_line, Which::code);
  EXPECT_TRUE(found.empty()) << join(found);
}

TEST(TheHouse, ShipsNoMachinePathsHostsOrUnfinishedWords) {
  const Violations found = judge_shipped(&judge_words, Which::everything);
  EXPECT_TRUE(found.empty()) << join(found);
}

}  // namespace
}  // namespace odds::architecture
