// Ctrl-C: it ends what takes long, and a loop that runs it ends with its report.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "support/run_tool.hpp"

namespace odds {
namespace {

using testing::contents_of;
using testing::TemporaryFolder;

std::string scene(const std::string& shape) {
  return "format = \"odds.scene/1\"\n[[mesh]]\nname = \"block\"\nfile = \"" + shape +
         "\"\n[[body]]\nname = \"block\"\nmesh = \"block\"\nmotion = \"dynamic\"\nmass_kg = 1\n";
}

/// Whether the program's first thread leaves SIGINT to another one, as it does while a loop runs.
bool leaves_interrupts(pid_t program) {
  std::ifstream status("/proc/" + std::to_string(program) + "/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("SigBlk:")) return (std::stoull(line.substr(7), nullptr, 16) >> (SIGINT - 1) & 1U) != 0;
  }
  return false;
}

/// What a program has taken so far, without what the system did for it.
double seconds_of_a_processor(pid_t program) {
  std::ifstream stat("/proc/" + std::to_string(program) + "/stat");
  std::string field;
  while (std::getline(stat, field, ')') && stat.peek() != ' ') {
  }
  constexpr int after_the_name = 12;  // the 14th in all
  for (int i = 0; i < after_the_name; ++i) stat >> field;
  return stat ? std::stod(field) / static_cast<double>(sysconf(_SC_CLK_TCK)) : 0.0;
}

/// Status of `odds` with these words that gets the signal as soon as `now(its number)`; 128 and more: the signal that
/// ended it.
int ended_by(int signal, const TemporaryFolder& folder, std::vector<std::string> words,
             const std::function<bool(pid_t)>& now) {
  words.insert(words.begin(), "odds");
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const pid_t program = fork();
  if (program == 0) {
    const int nothing = open("/dev/null", O_RDWR);
    for (int stream = 0; stream < 3; ++stream) dup2(nothing, stream);
    if (chdir(folder.path().c_str()) == 0) execv(ODDS_TOOL, arguments.data());
    _exit(127);
  }
  constexpr std::chrono::milliseconds pause{5};
  int status = 0;
  for (int i = 0; i < 60'000 && !now(program) && waitpid(program, &status, WNOHANG) == 0; ++i) {
    std::this_thread::sleep_for(pause);
  }
  kill(program, signal);
  for (int i = 0; i < 24'000 && waitpid(program, &status, WNOHANG) == 0; ++i) std::this_thread::sleep_for(pause);
  if (waitpid(program, &status, WNOHANG) == 0) {
    kill(program, SIGKILL);
    waitpid(program, &status, 0);
  }
  return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}

/// The same of `odds run scene.toml`, by Ctrl-C.
int interrupted(const TemporaryFolder& folder, const std::string& seconds, const std::function<bool(pid_t)>& now) {
  return ended_by(SIGINT, folder, {"run", "scene.toml", "--seconds", seconds, "--out", "out"}, now);
}

TEST(Interrupt, LeavesNoUnfinishedFile) {
  const TemporaryFolder folder;
  folder.write("poses.csv", "x,y,z,qw,qx,qy,qz\n0.3,0.1,0,1,0,0,0\n");
  const auto files = [&] {
    return std::distance(std::filesystem::directory_iterator(folder.path()), std::filesystem::directory_iterator());
  };
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const std::string shape = "made:torus_knot:along=2000,across=100";  // with these volumes it takes seconds
    const int status = ended_by(signal, folder,
                                {"query", shape, shape, "--bv", "hull", "--poses", "poses.csv", "--out", "answers.csv"},
                                [&](pid_t program) { return files() > 1 && seconds_of_a_processor(program) > 0.1; });
    EXPECT_EQ(status, 128 + signal);
    EXPECT_EQ(files(), 1) << "but poses.csv";
  }
}

TEST(Interrupt, EndsTheProgramWhileMeshesLoad) {
  const TemporaryFolder folder;
  folder.write("scene.toml", scene("made:terrain:cells=1400"));  // takes several seconds
  const auto has_begun = [](pid_t program) { return seconds_of_a_processor(program) > 0.2; };
  EXPECT_EQ(interrupted(folder, "0.01", has_begun), 128 + SIGINT);
  EXPECT_FALSE(std::filesystem::exists(folder / "out/report.html"));
}

TEST(Interrupt, EndsALoopWithItsReport) {
  const TemporaryFolder folder;
  folder.write("scene.toml", scene("made:box"));
  EXPECT_EQ(interrupted(folder, "60", leaves_interrupts), 0);
  EXPECT_TRUE(std::filesystem::exists(folder / "out/report.html"));
  EXPECT_TRUE(std::filesystem::exists(folder / "out/replay/replay.json"));
}

}  // namespace
}  // namespace odds
