// Fenced blocks of Markdown pages, so that tests can hold documentation to what it shows.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "architecture/source_tree.hpp"

namespace odds::architecture {

struct FencedBlock {
  std::string language;  ///< first word after the fence
  std::string info;      ///< the rest of that line
  std::string text;      ///< lines between the fences
  std::size_t line = 0;  ///< of the opening fence, from 1
};

/// Blocks between lines that begin with three back-ticks, in order. A block left open ends with the page.
inline std::vector<FencedBlock> fenced_blocks(std::string_view page) {
  std::vector<FencedBlock> blocks;
  bool open = false;
  std::size_t number = 0;
  for (const std::string_view line : lines(page)) {
    ++number;
    if (!line.starts_with("```")) {
      if (open) blocks.back().text += std::string(line) + "\n";
      continue;
    }
    open = !open;
    if (!open) continue;
    const std::string_view header = line.substr(3);
    const std::size_t blank = header.find(' ');
    blocks.push_back({std::string(header.substr(0, blank)),
                      blank == std::string_view::npos ? std::string() : std::string(header.substr(blank + 1)), "", number});
  }
  return blocks;
}

/// All Markdown pages that ship.
inline std::vector<SourceFile> read_pages() {
  std::vector<SourceFile> pages = read_files(ODDS_SOURCE_DIR, {"README.md", "CONTRIBUTING.md", "CHANGELOG.md", "docs"});
  std::erase_if(pages, [](const SourceFile& file) { return !file.path.ends_with(".md"); });
  return pages;
}

}  // namespace odds::architecture
