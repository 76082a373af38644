// The pages tell the truth: files that they name exist, code that they show is the code that is compiled.
#include <gtest/gtest.h>

#include <cctype>
#include <regex>
#include <set>

#include "architecture/markdown.hpp"

namespace odds::architecture {
namespace {

/// A block whose header says file=PATH shows that file, or a part of it, word for word.
Violations judge_shown_files(const SourceFile& page, const std::filesystem::path& top) {
  Violations found;
  for (const FencedBlock& block : fenced_blocks(page.text)) {
    const std::size_t at = block.info.find("file=");
    if (at == std::string::npos) continue;
    const std::string name = block.info.substr(at + 5, block.info.find(' ', at) - (at + 5));
    const std::string place = page.path + ":" + std::to_string(block.line);
    const auto files = read_files(top, {name});
    if (files.size() != 1) {
      found.push_back(place + ": shows " + name + ", which does not exist");
    } else if (block.text.empty() || files[0].text.find(block.text) == std::string::npos) {
      found.push_back(place + ": is not what stands in " + name);
    }
  }
  return found;
}

/// Links to other files of the tree lead somewhere.
Violations judge_links(const SourceFile& page, const std::filesystem::path& top) {
  static const std::regex link(R"(\]\(([^)#:]+)(#[^)]*)?\))");
  Violations found;
  const auto folder = (top / page.path).parent_path();
  for (auto at = std::sregex_iterator(page.text.begin(), page.text.end(), link); at != std::sregex_iterator(); ++at) {
    const std::string target = (*at)[1].str();
    if (!std::filesystem::exists(folder / target)) found.push_back(page.path + ": links to " + target + ", not there");
  }
  return found;
}

/// All words of a text that could be names.
std::set<std::string, std::less<>> words_of(std::string_view text) {
  std::set<std::string, std::less<>> words;
  const auto in_word = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
  for (auto at = text.begin(); at != text.end();) {
    const auto begin = std::find_if(at, text.end(), in_word);
    at = std::find_if_not(begin, text.end(), in_word);
    words.emplace(begin, at);
  }
  return words;
}

/// Names of the code in back-ticks, `query::Pair::run` or `tree::Hierarchy<V>`, stand in a public header.
Violations judge_names(const SourceFile& page, const std::string& public_headers) {
  const auto known = words_of(public_headers);
  static const std::regex quoted("`((?:[A-Za-z_]+(?:<[^`>]*>)?::)+)([A-Za-z_]+)[^`]*`");
  Violations found;
  for (auto at = std::sregex_iterator(page.text.begin(), page.text.end(), quoted); at != std::sregex_iterator(); ++at) {
    const std::string name = (*at)[2].str();
    if ((*at)[1].str().starts_with("std::")) continue;
    if (!known.contains(name)) {
      found.push_back(page.path + ": names " + (*at)[0].str() + ", which no public header has");
    }
  }
  return found;
}

TEST(Markdown, FindsFencedBlocks) {
  const auto blocks = fenced_blocks("text\n```sh run\nls\n```\n\n```cpp file=a.cpp\nint a;\nint b;\n```\n");
  ASSERT_EQ(blocks.size(), 2u);
  EXPECT_EQ(blocks[0].language, "sh");
  EXPECT_EQ(blocks[0].info, "run");
  EXPECT_EQ(blocks[0].text, "ls\n");
  EXPECT_EQ(blocks[1].line, 6u);
  EXPECT_EQ(blocks[1].text, "int a;\nint b;\n");
}

TEST(PageRules, RefuseCodeThatIsNotInTheFileShown) {
  const std::string good = "```cpp file=tests/architecture/markdown.hpp\n#pragma once\n```\n";
  const std::string stale = "```cpp file=tests/architecture/markdown.hpp\n#pragma twice\n```\n";
  const std::string gone = "```cpp file=tests/architecture/gone.hpp\n#pragma once\n```\n";
  EXPECT_EQ(judge_shown_files({"a.md", good}, ODDS_SOURCE_DIR), Violations{});
  EXPECT_EQ(judge_shown_files({"a.md", stale}, ODDS_SOURCE_DIR).size(), 1u);
  EXPECT_EQ(judge_shown_files({"a.md", gone}, ODDS_SOURCE_DIR).size(), 1u);
}

TEST(PageRules, RefuseDeadLinks) {
  EXPECT_EQ(judge_links({"docs/a.md", "[x](theory.md) [y](theory.md#sources) [z](https://example.org/q)"}, ODDS_SOURCE_DIR),
            Violations{});
  EXPECT_EQ(judge_links({"docs/a.md", "[x](no_such_page.md)"}, ODDS_SOURCE_DIR).size(), 1u);
}

TEST(PageRules, RefuseNamesThatNoHeaderHas) {
  const std::string headers = "class Pair { void run(); };";
  EXPECT_EQ(judge_names({"a.md", "`query::Pair::run` and `std::vector` and `plain`"}, headers), Violations{});
  EXPECT_EQ(judge_names({"a.md", "`query::Pair::walk`"}, headers).size(), 1u);
}

TEST(Pages, NameWhatExists) {
  std::string headers;
  for (const SourceFile& file : read_files(ODDS_SOURCE_DIR, {"include"})) headers += file.text;
  Violations found;
  for (const SourceFile& page : read_pages()) append(found, judge_names(page, headers));
  EXPECT_TRUE(found.empty()) << join(found);
}

TEST(Pages, ShowTheCodeThatIsCompiled) {
  Violations found;
  for (const SourceFile& page : read_pages()) append(found, judge_shown_files(page, ODDS_SOURCE_DIR));
  EXPECT_TRUE(found.empty()) << join(found);
}

TEST(Pages, LinkToWhatExists) {
  Violations found;
  for (const SourceFile& page : read_pages()) append(found, judge_links(page, ODDS_SOURCE_DIR));
  EXPECT_TRUE(found.empty()) << join(found);
}

TEST(Readme, BeginsWithTheTwoCommandsAndTheyExist) {
  const auto pages = read_files(ODDS_SOURCE_DIR, {"README.md"});
  ASSERT_EQ(pages.size(), 1u);
  const auto blocks = fenced_blocks(pages[0].text);
  ASSERT_FALSE(blocks.empty());
  EXPECT_LT(blocks[0].line, 12u);
  for (const char* command : {"demos/run", "tests/run"}) {
    EXPECT_NE(blocks[0].text.find(command), std::string::npos) << command;
    const auto permissions = std::filesystem::status(std::filesystem::path(ODDS_SOURCE_DIR) / command).permissions();
    EXPECT_NE(permissions & std::filesystem::perms::owner_exec, std::filesystem::perms::none) << command;
  }
}

}  // namespace
}  // namespace odds::architecture
