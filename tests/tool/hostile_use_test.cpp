// The command `odds` in careless and hostile hands: one line of error, the right status, nothing lost or overwritten.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "support/run_tool.hpp"
#include "support/sanitizer.hpp"

namespace odds {
namespace {

using testing::contents_of;
using testing::Ran;
using testing::run_tool;
using testing::TemporaryFolder;

const std::string poses = "x,y,z,qw,qx,qy,qz\n0.05,0.01,0,1,0,0,0\n";
const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

class HostileUse : public ::testing::Test {
 protected:
  void SetUp() override {
    folder.write("poses.csv", poses);
    folder.write("triangle.obj", triangle);
  }
  Ran query(const std::string& arguments) const { return run_tool(folder, "query triangle.obj made:box " + arguments); }
  std::size_t files() const {
    const std::filesystem::directory_iterator all(folder.path());
    return static_cast<std::size_t>(std::distance(begin(all), end(all)));
  }

  TemporaryFolder folder;
};

void expect_one_line_with(const Ran& ran, const std::string& text) {
  EXPECT_EQ(ran.status, 1) << ran.errors;
  EXPECT_TRUE(ran.errors.starts_with("error: ")) << ran.errors;
  EXPECT_EQ(ran.errors.find('\n') + 1, ran.errors.size()) << ran.errors;
  EXPECT_NE(ran.errors.find(text), std::string::npos) << ran.errors;
  EXPECT_LT(ran.errors.size(), 2000u);
}

TEST_F(HostileUse, AnInputIsNeverOverwrittenByWhateverName) {
  std::filesystem::create_symlink("poses.csv", folder / "link.csv");
  std::filesystem::create_hard_link(folder / "triangle.obj", folder / "twin.obj");
  for (const char* out : {"poses.csv", "./poses.csv", "link.csv", "triangle.obj", "twin.obj"}) {
    expect_one_line_with(query(std::string("--poses poses.csv --out ") + out), "is also an input");
  }
  expect_one_line_with(run_tool(folder, "inspect triangle.obj --repair twin.obj"), "is also an input");
  EXPECT_EQ(contents_of(folder / "poses.csv"), poses);
  EXPECT_EQ(contents_of(folder / "triangle.obj"), triangle);
}

TEST_F(HostileUse, ALinkGivenAsOutputStaysALink) {
  folder.write("real.csv", "old");
  std::filesystem::create_symlink("real.csv", folder / "link.csv");
  const Ran ran = query("--poses poses.csv --out link.csv");
  ASSERT_EQ(ran.status, 0) << ran.errors;
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.csv"));
  EXPECT_TRUE(contents_of(folder / "real.csv").starts_with("row,verdict"));
  ASSERT_EQ(run_tool(folder, "build made:box -o link.csv").status, 0);
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.csv"));
  EXPECT_NE(contents_of(folder / "real.csv").find("ODDS"), std::string::npos);
}

TEST_F(HostileUse, AnEmptyNameOfAnOutputIsRefusedAndLeavesNothing) {
  (void)query("--poses poses.csv --out answers.csv");
  const std::size_t before = files();
  expect_one_line_with(query("--poses poses.csv --out ''"), "empty");
  EXPECT_EQ(files(), before);
  folder.write("r.urdf",
               "<robot name=\"r\"><link name=\"l\"><collision><geometry><sphere radius=\"1\"/></geometry>"
               "</collision></link></robot>");
  expect_one_line_with(run_tool(folder, "import r.urdf --out ''"), "the name of the output folder is empty");
  EXPECT_EQ(files(), before + 1);
}

TEST_F(HostileUse, AMistypedCommandOrOptionIsNamedWithTheNearest) {
  const std::vector<std::pair<std::string, std::string>> mistyped = {
      {"inspekt made:box", "'inspekt' is no command of odds; did you mean 'inspect'?"},
      {"--verson", "'--verson' is no command of odds; did you mean '--version'?"},
      {"xyzzyxyzzy", "'xyzzyxyzzy' is no command of odds\n"},
      {"inspect made:box --jsn", "'--jsn' is no argument of odds inspect; did you mean '--json'?"},
      {"inspect made:box made:gear", "'made:gear' is no argument of odds inspect\n"}};
  for (const auto& [line, sentence] : mistyped) {
    const Ran ran = run_tool(folder, line);
    EXPECT_EQ(ran.status, 2) << line;
    EXPECT_TRUE(ran.errors.starts_with(sentence)) << ran.errors;
  }
  const Ran nothing = run_tool(folder, "");
  EXPECT_EQ(nothing.status, 2);
  EXPECT_NE(nothing.errors.find("A subcommand is required"), std::string::npos) << nothing.errors;
  const Ran version = run_tool(folder, "--version");
  EXPECT_EQ(version.status, 0);
  EXPECT_TRUE(version.output.starts_with("odds 0.")) << version.output;
}

TEST_F(HostileUse, AFullOrClosedStandardOutputIsAnError) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full";
  // The tool's own redirections come before those that the test appends, so that each stands in a shell of its own.
  const std::string tool = std::string("\"") + ODDS_TOOL + "\" ";
  for (const char* command : {"inspect triangle.obj", "inspect triangle.obj --json", "--help",
                              "query triangle.obj made:box --poses poses.csv --out answers.csv"}) {
    for (const char* where : {" >/dev/full", " >&-"}) {
      const Ran ran = run_tool(folder, "--help >/dev/null && (" + tool + command + where + ")");
      expect_one_line_with(ran, "standard output: cannot be written");
    }
  }
}

TEST_F(HostileUse, StandardOutputByItsNameIsWrittenOn) {
  if (!std::filesystem::exists("/dev/stdout")) GTEST_SKIP() << "there is no /dev/stdout";
  folder.write("log.txt", "old\n");
  const std::string tool = std::string("\"") + ODDS_TOOL + "\" ";
  const Ran ran = run_tool(folder, "--help >/dev/null && (" + tool +
                                       "query triangle.obj made:box --poses poses.csv --out /dev/stdout >>log.txt)");
  EXPECT_EQ(ran.status, 0) << ran.errors;
  const std::string log = contents_of(folder / "log.txt");
  EXPECT_TRUE(log.starts_with("old\nrow,verdict")) << log;
  EXPECT_EQ(std::count(log.begin(), log.end(), '\n'), 3) << log;
  EXPECT_NE(ran.errors.find("microseconds"), std::string::npos) << "the table beside it";
}

// The system's way is to end the program without a word; its temporary files stayed.
TEST_F(HostileUse, ALimitOnTheSizeOfFilesIsAnError) {
  const Ran ran = run_tool(
      folder, std::string("--help >/dev/null && ulimit -f 8 && \"") + ODDS_TOOL + "\" build made:gear -o gear.odds");
  expect_one_line_with(ran, "gear.odds: cannot be written: File too large");
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    EXPECT_NE(entry.path().extension(), ".part") << entry.path();
  }
}

TEST_F(HostileUse, MessagesNeverGetIntoAnOutputFileForWantOfStandardStreams) {
  const std::string tool = std::string("\"") + ODDS_TOOL + "\" ";
  (void)run_tool(folder, "--help >/dev/null && (" + tool +
                             "query triangle.obj made:box --poses poses.csv --out answers.csv <&- >&- 2>&-)");
  const std::string answers = contents_of(folder / "answers.csv");
  EXPECT_TRUE(answers.starts_with("row,verdict")) << answers;
  EXPECT_EQ(std::count(answers.begin(), answers.end(), '\n'), 2) << answers;
}

TEST_F(HostileUse, WhatIsQuotedStaysOnOneLineAndCannotSteerTheTerminal) {
  const std::string header = poses.substr(0, poses.find('\n') + 1);
  folder.write("escape.csv", header + "\x1b[31m\x07,0,0,1,0,0,0\n");
  const Ran ran = query("--poses escape.csv --out answers.csv");
  expect_one_line_with(ran, "escape.csv:2: ");
  EXPECT_EQ(ran.errors.find('\x1b'), std::string::npos);
  expect_one_line_with(run_tool(folder, "inspect 'miss\ning.obj'"), "miss\\ning.obj");
  folder.write("r.urdf",
               "<robot name=\"r\"><link name=\"l\x1b[31m\"><collision><geometry><sphere radius=\"1\"/></geometry>"
               "</collision></link></robot>");
  const Ran imported = run_tool(folder, "import r.urdf --out out");
  ASSERT_EQ(imported.status, 0) << imported.errors;
  EXPECT_EQ(imported.output.find('\x1b'), std::string::npos) << imported.output;
  EXPECT_NE(imported.output.find("'r::l\\x1b[31m' has no mass"), std::string::npos) << imported.output;
  folder.write("scene.toml",
               "format = \"odds.scene/1\"\n[[mesh]]\nname = \"t\"\nfile = \"triangle.obj\"\n[[body]]\nmesh = \"t\"\n"
               "name = \"b\\u001b[31m\\nerror: c\"\nmotion = \"dynamic\"\nmass_kg = 1\n[effects.gravity]\n");
  for (const char* command : {"run scene.toml --fast --seconds 0.01 --out run", "explain scene.toml --samples 1"}) {
    const Ran warned = run_tool(folder, command);
    ASSERT_EQ(warned.status, 0) << warned.errors;
    EXPECT_NE((warned.output + warned.errors).find("mesh of 'b\\x1b[31m\\nerror: c' encloses no"), std::string::npos)
        << warned.output << warned.errors;
  }
}

TEST_F(HostileUse, ADescriptionBehindItsPackagesIsNotTakenForAnother) {
  folder.write("r.urdf",
               "<robot name=\"r\"><link name=\"l\"><collision><geometry><mesh filename=\"package://p/triangle.obj\"/>"
               "</geometry></collision></link></robot>");
  const Ran ran = run_tool(folder, "import --package o=. --package p=. r.urdf --out out");
  EXPECT_EQ(ran.status, 0) << ran.errors;
}

TEST_F(HostileUse, AnEndlessOrVeryLongLineOfPosesEndsInAShortError) {
  expect_one_line_with(query("--poses /dev/zero --out answers.csv"), "/dev/zero:1: the line is longer than");
  const std::string header = poses.substr(0, poses.find('\n') + 1);
  folder.write("long.csv", header + std::string(900'000, '1') + ",0,0,1,0,0,0\n");
  expect_one_line_with(query("--poses long.csv --out answers.csv"), "long.csv:2: x = ");
  folder.write("ends.csv", poses.substr(0, poses.size() - 1));
  EXPECT_EQ(query("--poses ends.csv --out answers.csv").status, 0) << "a last line without its end";
}

TEST_F(HostileUse, APointHasNoHintAboutItsDistance) {
  folder.write("point.obj", "v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n");
  const Ran ran = run_tool(folder, "inspect point.obj");
  EXPECT_EQ(ran.status, 0) << ran.errors;
  EXPECT_EQ(ran.output.find("inf"), std::string::npos) << ran.output;
}

const std::string scene = R"(format = "odds.scene/1"
[[mesh]]
name = "block"
file = "made:box"
[[body]]
name = "floor"
mesh = "block"
[[body]]
name = "tool"
mesh = "block"
motion = "dynamic"
mass_kg = 0.1
position_m = [0.0, 0.0, 0.11]
[effects.contact]
stiffness_n_per_m = 1000.0
damping_ns_per_m = 10.0
)";

std::string with(const std::string& old_text, const std::string& new_text) {
  std::string text = scene;
  return text.replace(text.find(old_text), old_text.size(), new_text);
}

TEST_F(HostileUse, ARunSaysBeforeItBeginsThatItsFolderCannotBeWritten) {
  folder.write("scene.toml", scene);
  for (const char* out : {"triangle.obj", "triangle.obj/inside", "''", "/dev/null", "/proc/no_such_folder"}) {
    const Ran ran = run_tool(folder, std::string("run --fast --seconds 0.01 scene.toml --out ") + out);
    EXPECT_EQ(ran.status, 1) << out;
    EXPECT_EQ(ran.errors.find("warning"), std::string::npos) << "the scene was already set up: " << ran.errors;
    expect_one_line_with(ran, "error: ");
  }
  for (const char* seconds : {"0", "-1", "nan", "inf", "1e400"}) {
    EXPECT_EQ(run_tool(folder, std::string("run scene.toml --seconds ") + seconds).status, 2) << seconds;
  }
}

TEST_F(HostileUse, ScenesOfAbsurdSizesAreRefusedWhereOdeWouldEndTheProgram) {
  folder.write("huge.obj", "v 0 0 0\nv 1e15 0 0\nv 0 1e15 0\nv 0 0 1e15\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  for (const std::string& text :
       {with("mass_kg = 0.1", "density_kg_per_m3 = 1e-308"), with("mass_kg = 0.1", "mass_kg = 1e-300"),
        with("mass_kg = 0.1", "mass_kg = 1e308"), with("made:box", "huge.obj"),
        with("0.0, 0.0, 0.11", "0.0, 0.0, 1e30"), with("0.0, 0.0, 0.11", "0.0, 0.0, 1e7"), with("= 1000.0", "= 1e300"),
        with("= 10.0", "= 1e300")}) {
    folder.write("scene.toml", text);
    expect_one_line_with(run_tool(folder, "run --fast --seconds 0.05 scene.toml --out out"), "scene.toml:");
  }
}

TEST_F(HostileUse, ASceneWithMorePairsThanMemoryHoldsAsksForMemory) {
  if (support::under_sanitizer) GTEST_SKIP() << "a sanitizer needs all addresses";
  std::string crowd = "format = \"odds.scene/1\"\n[[mesh]]\nname = \"box\"\nfile = \"made:box\"\n";
  for (int i = 0; i < 1000; ++i) {  // half a million pairs, each of more than a kilobyte
    crowd += "[[body]]\nname = \"" + std::to_string(i) + "\"\nmesh = \"box\"\nmotion = \"dynamic\"\nmass_kg = 1\n" +
             "position_m = [" + std::to_string(i) + ", 0, 0]\n";
  }
  folder.write("scene.toml", crowd);
  const Ran ran = run_tool(folder, std::string("--help >/dev/null && (ulimit -v 180000; '") + ODDS_TOOL +
                                       "' run scene.toml --fast --seconds 0.01 --out out)");
  expect_one_line_with(ran, "cannot be collided");
  EXPECT_NE(ran.errors.find("; free memory, or use fewer bodies\n"), std::string::npos) << ran.errors;
}

// The histograms of every second of it stood in memory at once, 0.8 MB for each, and its table as text, when it was
// over.
TEST_F(HostileUse, TheReportOfALongRunTakesNoMoreMemoryThanItsRecords) {
  if (support::under_sanitizer) GTEST_SKIP() << "a sanitizer needs all addresses";
  const auto run_for = [&](const std::string& seconds, const std::string& rate_hz) {
    folder.write("scene.toml",
                 "format = \"odds.scene/1\"\n[loop]\nrate_hz = " + rate_hz +
                     "\n[[mesh]]\nname = \"t\"\nfile = \"triangle.obj\"\n[[body]]\nmesh = \"t\"\nname = \"b\"\n");
    return run_tool(folder, std::string("--help >/dev/null && (ulimit -v 600000; '") + ODDS_TOOL +
                                "' run scene.toml --fast --out out --seconds " + seconds + ")");
  };
  const Ran long_run = run_for("2000", "1");
  EXPECT_EQ(long_run.status, 0) << long_run.errors;
  expect_one_line_with(run_for("3000", "20000"), "more memory than there is; run for fewer seconds");
}

TEST_F(HostileUse, ASceneWithKeysNestedWithoutEndIsRefused) {
  std::string deep = "[a";
  for (int i = 0; i < 100'000; ++i) deep += ".a";
  folder.write("scene.toml", deep + "]\n");
  for (const char* command : {"run scene.toml --out out", "explain scene.toml"}) {
    expect_one_line_with(run_tool(folder, command), "scene.toml:1:1: ");
  }
}

}  // namespace
}  // namespace odds
