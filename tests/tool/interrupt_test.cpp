// Ctrl-C: it ends what takes long, and a loop that runs it ends with its report.
#include <gtest/gtest.h>

#include <filesystem>

#include "support/run_tool.hpp"

namespace odds {
namespace {

using testing::contents_of;
using testing::TemporaryFolder;

std::string scene(const std::string& shape) {
  return "format = \"odds.scene/1\"\n[[mesh]]\nname = \"block\"\nfile = \"" + shape +
         "\"\n[[body]]\nname = \"block\"\nmesh = \"block\"\nmotion = \"dynamic\"\nmass_kg = 1\n";
}

/// Status of `odds run` that gets SIGINT after so many seconds, as a shell gives it, and SIGKILL if it goes on.
int interrupted(const TemporaryFolder& folder, int after_s, const std::string& arguments) {
  const std::string command = "cd '" + folder.path().string() + "' && timeout --preserve-status -s INT -k 120 " +
                              std::to_string(after_s) + " '" + ODDS_TOOL + "' run " + arguments +
                              " >stdout.txt 2>stderr.txt </dev/null";
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(Interrupt, EndsTheProgramWhileMeshesLoad) {
  const TemporaryFolder folder;
  folder.write("scene.toml", scene("made:terrain:cells=1400"));  // takes several seconds
  EXPECT_EQ(interrupted(folder, 1, "scene.toml --fast --seconds 0.01 --out out"), 130);
  EXPECT_FALSE(std::filesystem::exists(folder / "out/report.html"));
}

TEST(Interrupt, EndsALoopWithItsReport) {
  const TemporaryFolder folder;
  folder.write("scene.toml", scene("made:box"));
  EXPECT_EQ(interrupted(folder, 3, "scene.toml --seconds 600 --out out"), 0) << contents_of(folder / "stderr.txt");
  EXPECT_TRUE(std::filesystem::exists(folder / "out/report.html"));
  EXPECT_TRUE(std::filesystem::exists(folder / "out/replay/replay.json"));
}

}  // namespace
}  // namespace odds
