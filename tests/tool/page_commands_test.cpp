// Commands that the pages show run as shown: every block fenced as "sh run", in a fresh folder, with the command in the PATH.
#include <gtest/gtest.h>

#include <cstdlib>

#include "architecture/markdown.hpp"

namespace odds::architecture {
namespace {

struct Outcome {
  int status = 0;
  std::string output;
};

/// Runs a script by bash, which stops at the first command that fails, inside `folder`.
Outcome run_script(const std::filesystem::path& folder, const std::string& script) {
  std::ofstream(folder / "script.sh") << script;
  const std::string tool_folder = std::filesystem::path(ODDS_TOOL).parent_path().string();
  const std::string command = "cd '" + folder.string() + "' && PATH='" + tool_folder +
                              "':\"$PATH\" bash -euo pipefail script.sh >output.txt 2>&1 </dev/null";
  Outcome outcome;
  outcome.status = std::system(command.c_str());
  outcome.output = read_file(folder, folder / "output.txt").text;
  return outcome;
}

/// A folder that looks like the top of the tree to whoever reads, removed at the end. Results land in it, not in the tree.
class Scratch {
 public:
  Scratch() {
    std::string name = (std::filesystem::temp_directory_path() / "odds-pages-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = name;
    for (const char* shared : {"demos", "docs", "README.md"}) {
      std::filesystem::create_symlink(std::filesystem::path(ODDS_SOURCE_DIR) / shared, path_ / shared);
    }
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  ~Scratch() { std::filesystem::remove_all(path_); }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

TEST(PageCommands, AScriptThatFailsIsNoticed) {
  const Scratch scratch;
  EXPECT_EQ(run_script(scratch.path(), "test -e README.md\n").status, 0);
  EXPECT_NE(run_script(scratch.path(), "false\ntrue\n").status, 0);
  EXPECT_NE(run_script(scratch.path(), "odds no-such-command\n").status, 0);
}

TEST(PageCommands, RunAsShown) {
  int blocks_run = 0;
  for (const SourceFile& page : read_pages()) {
    const Scratch scratch;  // one per page: later blocks may use what earlier ones wrote
    for (const FencedBlock& block : fenced_blocks(page.text)) {
      if (block.language != "sh" || block.info != "run") continue;
      ++blocks_run;
      const Outcome outcome = run_script(scratch.path(), block.text);
      EXPECT_EQ(outcome.status, 0) << page.path << ":" << block.line << "\n" << block.text << "\n" << outcome.output;
    }
  }
  EXPECT_GT(blocks_run, 0);
}

}  // namespace
}  // namespace odds::architecture
