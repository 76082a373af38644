// The commands `odds run` and `odds explain`, run as a user runs them.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "support/run_tool.hpp"
#include "support/sanitizer.hpp"

namespace odds {
namespace {

using testing::contents_of;
using testing::Ran;
using testing::run_tool;
using testing::TemporaryFolder;

const std::string scene = R"(format = "odds.scene/1"
[loop]
seconds = 0.3
[query]
budget_us = 80
[[mesh]]
name = "block"
file = "made:box:cells=8"
[[body]]
name = "floor"
mesh = "block"
[[body]]
name = "tool"
mesh = "block"
motion = "dynamic"
mass_kg = 0.1
device = "hand"
[device.hand]
type = "scripted"
position_m = [0.01, 0.02, 0.11]
[[device.hand.motion]]
kind = "press"
duration_s = 0.3
depth_m = 0.015
[effects.contact]
[effects.virtual_coupling]
)";

// The columns of ticks.csv that do not depend on time.
std::string forces_of(const std::string& csv) {
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  std::vector<bool> wanted;
  std::istringstream names(line);
  for (std::string name; std::getline(names, name, ',');) {
    wanted.push_back(name.starts_with("force_") || name.starts_with("torque_") || name.starts_with("tool_") ||
                     name == "contacts" || name == "node_pairs");
  }
  std::string kept;
  while (std::getline(lines, line)) {
    std::istringstream cells(line);
    std::size_t column = 0;
    for (std::string cell; std::getline(cells, cell, ','); ++column) {
      if (column < wanted.size() && wanted[column]) kept += cell + ",";
    }
    kept += "\n";
  }
  return kept;
}

TEST(Run, WritesEveryFileAndTheTable) {
  const TemporaryFolder folder;
  folder.write("scene.toml", scene);
  const Ran ran = run_tool(folder, "run scene.toml --fast --out out");
  ASSERT_EQ(ran.status, 0) << ran.errors;
  for (const char* file : {"report.html", "latency.hgrm", "ticks.csv", "summary.json", "replay/device.csv",
                           "replay/poses.csv", "replay/replay.json"}) {
    EXPECT_GT(contents_of(folder / (std::string("out/") + file)).size(), 50U) << file;
  }
  for (const char* line : {"300 of 300 ran", "budget 1600 work units", "query, gross", "answers (ticks)", "force ",
                           "report: out/report.html"}) {
    EXPECT_NE(ran.output.find(line), std::string::npos) << line << "\n" << ran.output;
  }
  const auto side_car = nlohmann::json::parse(contents_of(folder / "out/replay/replay.json"));
  EXPECT_EQ(side_car["bodies"].size(), 2U);
  EXPECT_EQ(side_car["work_units"], 1600);
  EXPECT_TRUE(side_car["frame_work_units"].is_null());
  EXPECT_EQ(side_car["device"]["name"], "hand");
  EXPECT_EQ(side_car["device"]["track"], "device.csv");
  const auto summary = nlohmann::json::parse(contents_of(folder / "out/summary.json"));
  EXPECT_EQ(summary["run"]["work_units"], 1600);
  EXPECT_EQ(summary["query"]["stall_share"], nullptr);
}

TEST(Run, AllocatesNothingInATick) {
  if (support::under_sanitizer) GTEST_SKIP() << "a sanitizer owns the allocator";
  const TemporaryFolder folder;
  folder.write("scene.toml", scene);
  const Ran ran = run_tool(folder, "run scene.toml --fast --out out");
  ASSERT_EQ(ran.status, 0) << ran.errors;
  EXPECT_NE(ran.output.find("allocations in ticks   0\n"), std::string::npos) << ran.output;
}

TEST(Run, FastGivesTheSameForcesTwiceAndFromItsOwnReplay) {
  const TemporaryFolder folder;
  folder.write("scene.toml", scene);
  ASSERT_EQ(run_tool(folder, "run scene.toml --fast --out a").status, 0);
  ASSERT_EQ(run_tool(folder, "run scene.toml --fast --out b").status, 0);
  const std::size_t begin = scene.find("[device.hand]");
  const std::size_t end = scene.find("[effects.contact]");
  folder.write("replay.toml", scene.substr(0, begin) +
                                  "[device.hand]\ntype = \"replay\"\nfile = \"a/replay/device.csv\"\n" +
                                  scene.substr(end));
  const Ran replayed = run_tool(folder, "run replay.toml --fast --out c");
  ASSERT_EQ(replayed.status, 0) << replayed.errors;
  const std::string a = forces_of(contents_of(folder / "a/ticks.csv"));
  EXPECT_GT(a.size(), 300U * 20U);
  EXPECT_EQ(a, forces_of(contents_of(folder / "b/ticks.csv")));
  EXPECT_EQ(a, forces_of(contents_of(folder / "c/ticks.csv")));
}

std::string with(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

TEST(Run, WarnsOfASolverThatGivesUpOnTheConsoleAndInTheSummary) {
  const auto moving = [](const char* name, const char* mesh, const char* mass_kg, const char* position_m) {
    return std::string("[[body]]\nname = \"") + name + "\"\nmesh = \"" + mesh +
           "\"\nmotion = \"dynamic\"\nmass_kg = " + mass_kg + "\nposition_m = [" + position_m + "]\n";
  };
  const TemporaryFolder folder;
  for (const bool gives_up : {false, true}) {
    folder.write("scene.toml",
                 std::string("format = \"odds.scene/1\"\n[loop]\nseconds = 0.3\n[query]\nwork_units = 20000\n"
                             "[[mesh]]\nname = \"slab\"\nfile = \"made:box:x=4,y=1,z=0.1,cells=2\"\n"
                             "[[mesh]]\nname = \"cube\"\nfile = \"made:box:x=0.04,y=0.04,z=0.04\"\n"
                             "[[mesh]]\nname = \"bar\"\nfile = \"made:box:x=0.2,y=0.05,z=0.1\"\n"
                             "[[body]]\nname = \"floor\"\nmesh = \"slab\"\nposition_m = [0, 0, -0.05]\n") +
                     moving("a", "cube", gives_up ? "1e-5" : "5", "0.03, 0, 0.0249") +
                     moving("b", "bar", "50", "0, 0, 0.1098") + moving("c", "cube", "500", "0, 0, 0.1995") +
                     "[effects.gravity]\ng_m_per_s2 = [3, 0, -9.81]\n[effects.friction]\nmu = 1\n[effects.contact]\n" +
                     (gives_up ? "stiffness_n_per_m = 1e12\ndamping_ns_per_m = 1e12\n" : ""));
    const Ran ran = run_tool(folder, "run scene.toml --fast --out out");
    ASSERT_EQ(ran.status, 0) << ran.errors;
    EXPECT_EQ(ran.errors.find("warning: ODE's solver complained") != std::string::npos, gives_up) << ran.errors;
    const auto summary = nlohmann::json::parse(contents_of(folder / "out/summary.json"));
    ASSERT_EQ(summary["warnings"].size(), gives_up ? 1U : 0U) << summary["warnings"];
    if (!gives_up) continue;
    EXPECT_EQ(summary["warnings"][0].get<std::string>().find("ODE's solver complained"), 0U);
    EXPECT_NE(contents_of(folder / "out/report.html").find("s solver complained"), std::string::npos);
  }
}

// So many ticks a second that some are skipped on most machines; what was skipped must be skipped again.
TEST(Run, InRealTimeWithWorkUnitsIsReplayedBitForBit) {
  const TemporaryFolder folder;
  const std::string busy =
      with(with(scene, "seconds = 0.3", "seconds = 0.3\nrate_hz = 10000"), "budget_us = 80", "work_units = 1600");
  folder.write("scene.toml", busy);
  ASSERT_EQ(run_tool(folder, "run scene.toml --out timed").status, 0);
  const std::size_t begin = busy.find("[device.hand]");
  const std::string track = "[device.hand]\ntype = \"replay\"\nfile = \"timed/replay/device.csv\"\n";
  folder.write("replay.toml", busy.substr(0, begin) + track + busy.substr(busy.find("[effects.contact]")));
  const Ran replayed = run_tool(folder, "run replay.toml --fast --ticks-of timed/ticks.csv --out again");
  ASSERT_EQ(replayed.status, 0) << replayed.errors;
  const std::string timed = forces_of(contents_of(folder / "timed/ticks.csv"));
  EXPECT_GT(timed.size(), 100U * 20U);
  EXPECT_EQ(timed, forces_of(contents_of(folder / "again/ticks.csv")));
  EXPECT_EQ(contents_of(folder / "timed/replay/poses.csv"), contents_of(folder / "again/replay/poses.csv"));
}

TEST(Run, SkipsTheTicksThatAnotherRunSkipped) {
  const TemporaryFolder folder;
  folder.write("scene.toml", scene);
  folder.write("served.csv", "tick,more\n0,\n1,\n2,\n40,\n41,\n250,\n400,\n");
  const Ran ran = run_tool(folder, "run scene.toml --fast --ticks-of served.csv --out out");
  ASSERT_EQ(ran.status, 0) << ran.errors;
  EXPECT_NE(ran.output.find("6 of 300 ran, 0 late, 294 skipped"), std::string::npos) << ran.output;
  std::istringstream lines(contents_of(folder / "out/ticks.csv"));
  std::string ticks;
  for (std::string line; std::getline(lines, line);) ticks += line.substr(0, line.find(',')) + " ";
  EXPECT_EQ(ticks, "tick 0 1 2 40 41 250 ");
}

TEST(Run, TicksMayBeginWithAByteOrderMark) {
  const TemporaryFolder folder;
  folder.write("scene.toml", scene);
  folder.write("served.csv", "\xEF\xBB\xBFtick,more\n0,\n7,\n");
  const Ran ran = run_tool(folder, "run scene.toml --fast --ticks-of served.csv --out out");
  ASSERT_EQ(ran.status, 0) << ran.errors;
  EXPECT_NE(ran.output.find("2 of 300 ran"), std::string::npos) << ran.output;
}

/// A block that falls on another, with events, and no hand.
std::string dropped(const std::string& lower_name, const std::string& upper_name) {
  const auto body = [](const std::string& name, const std::string& more) {
    return "[[body]]\nname = " + name + "\nmesh = \"block\"\n" + more;
  };
  return "format = \"odds.scene/1\"\n[loop]\nseconds = 0.1\n[[mesh]]\nname = \"block\"\nfile = \"made:box\"\n" +
         body(lower_name, "") + body(upper_name, "motion = \"dynamic\"\nmass_kg = 1\nposition_m = [0, 0, 0.101]\n") +
         "[effects.contact]\n[effects.gravity]\n[effects.events]\n";
}

TEST(Run, NamesOfBodiesAreQuotedInTablesWhereTheyMustBe) {
  const TemporaryFolder folder;
  folder.write("scene.toml", dropped("\"the \\\"floor\\\", below\"", "\"two\\nlines, \\\"1\\\"\""));
  const Ran ran = run_tool(folder, "run scene.toml --fast --out out");
  ASSERT_EQ(ran.status, 0) << ran.errors;
  const std::string upper = "\"two\nlines, \"\"1\"\"\"";
  const std::string poses = contents_of(folder / "out/replay/poses.csv");
  EXPECT_EQ(poses.find("tick,t_ns,body,px_m,py_m,pz_m,qw,qx,qy,qz\n0,0," + upper + ",0,0,0.1"), 0U) << poses;
  const std::string events = contents_of(folder / "out/replay/events.csv");
  EXPECT_NE(events.find(",begin," + upper + ",\"the \"\"floor\"\", below\","), std::string::npos) << events;
  folder.write("plain.toml", dropped("\"the floor\"", "\"it's\""));
  ASSERT_EQ(run_tool(folder, "run plain.toml --fast --out plain").status, 0);
  const std::string plain = contents_of(folder / "plain/replay/events.csv");
  EXPECT_NE(plain.find(",begin,it's,the floor,"), std::string::npos) << plain;
}

TEST(Run, ReplacesWhatAnEarlierSceneLeftInTheReplay) {
  const TemporaryFolder folder;
  folder.write("hand.toml", scene);
  folder.write("events.toml", dropped("\"a\"", "\"b\""));
  const auto there = [&](const char* file) {
    return std::filesystem::exists(folder / ("out/replay/" + std::string(file)));
  };
  ASSERT_EQ(run_tool(folder, "run hand.toml --fast --out out").status, 0);
  EXPECT_TRUE(there("device.csv"));
  folder.write("out/replay/mine.txt", "kept");
  ASSERT_EQ(run_tool(folder, "run events.toml --fast --out out").status, 0);
  EXPECT_FALSE(there("device.csv")) << "this scene has no device";
  EXPECT_TRUE(there("events.csv"));
  ASSERT_EQ(run_tool(folder, "run hand.toml --fast --out out").status, 0);
  EXPECT_FALSE(there("events.csv")) << "this scene asks for no events";
  EXPECT_TRUE(there("device.csv"));
  EXPECT_TRUE(there("mine.txt"));
}

// A replay of less than the whole track, into the folder that both runs have by default, left that much of the track.
TEST(Run, RefusesToReplaceTheRecordingThatItRepeats) {
  const TemporaryFolder folder;
  folder.write("scene.toml", scene);
  ASSERT_EQ(run_tool(folder, "run scene.toml --fast").status, 0);
  const std::string track = contents_of(folder / "odds_run/replay/device.csv");
  const std::string ticks = contents_of(folder / "odds_run/ticks.csv");
  folder.write("replay.toml", scene.substr(0, scene.find("[device.hand]")) +
                                  "[device.hand]\ntype = \"replay\"\nfile = \"odds_run/replay/device.csv\"\n" +
                                  scene.substr(scene.find("[effects.contact]")));
  for (const char* command : {"run replay.toml --fast --seconds 0.1", "run replay.toml --fast --out ./odds_run",
                              "run scene.toml --fast --ticks-of odds_run/ticks.csv"}) {
    const Ran ran = run_tool(folder, command);
    EXPECT_EQ(ran.status, 1) << command;
    EXPECT_NE(ran.errors.find("is also an input, which would be overwritten; give another --out"), std::string::npos)
        << ran.errors;
  }
  EXPECT_EQ(contents_of(folder / "odds_run/replay/device.csv"), track);
  EXPECT_EQ(contents_of(folder / "odds_run/ticks.csv"), ticks);
  EXPECT_EQ(run_tool(folder, "run replay.toml --fast --seconds 0.1 --out other").status, 0);
}

TEST(Run, RefusesTicksThatAreNone) {
  const TemporaryFolder folder;
  folder.write("scene.toml", scene);
  const auto errors_of = [&](const std::string& text) {
    folder.write("served.csv", text);
    const Ran ran = run_tool(folder, "run scene.toml --fast --ticks-of served.csv --out out");
    EXPECT_NE(ran.status, 0) << text;
    return ran.errors;
  };
  EXPECT_NE(errors_of("time,more\n0,\n").find("served.csv:1: the first column is not 'tick'"), std::string::npos);
  EXPECT_NE(errors_of("tick,more\n0,\nx,\n").find("served.csv:3: \"x\" is not the number of a tick"),
            std::string::npos);
  EXPECT_NE(errors_of("tick,more\n1,\n1,\n").find("served.csv:3: ticks must ascend"), std::string::npos);
  EXPECT_NE(errors_of("tick,more\n").find("there is no tick in it"), std::string::npos);
  EXPECT_NE(errors_of("tick," + std::string(5000, 'x')).find("served.csv:1: the line is too long"), std::string::npos);
  const Ran slow = run_tool(folder, "run scene.toml --ticks-of served.csv --out out");
  EXPECT_NE(slow.status, 0);
  EXPECT_NE(slow.errors.find("--fast"), std::string::npos) << slow.errors;
}

TEST(Run, RunsInRealTimeForTheTimeAsked) {
  const TemporaryFolder folder;
  folder.write("scene.toml", scene);
  const Ran ran = run_tool(folder, "run scene.toml --seconds 0.1 --out out");
  ASSERT_EQ(ran.status, 0) << ran.errors;
  const auto summary = nlohmann::json::parse(contents_of(folder / "out/summary.json"));
  EXPECT_NE(ran.output.find("of 100 ran"), std::string::npos) << ran.output;
  EXPECT_TRUE(summary.is_object());
}

TEST(Run, RefusesABadSceneInOneLine) {
  const TemporaryFolder folder;
  folder.write("bad.toml", "format = \"odds.scene/1\"\n[loop]\nrate = 5\n");
  const Ran ran = run_tool(folder, "run bad.toml");
  EXPECT_EQ(ran.status, 1);
  EXPECT_EQ(ran.errors, "error: bad.toml:3:1: unknown key 'rate' in [loop]; did you mean 'rate_hz'?\n");
  EXPECT_EQ(run_tool(folder, "run missing.toml").status, 1);
  EXPECT_EQ(run_tool(folder, "run").status, 2);
  EXPECT_EQ(run_tool(folder, "run bad.toml --seconds -3").status, 2);
}

TEST(Run, SaysWhenTheFolderCannotBeWritten) {
  const TemporaryFolder folder;
  folder.write("scene.toml", scene);
  folder.write("out", "a file is in the way");
  const Ran ran = run_tool(folder, "run scene.toml --fast --out out");
  EXPECT_EQ(ran.status, 1);
  EXPECT_NE(ran.errors.find("error: "), std::string::npos) << ran.errors;
}

TEST(Run, DemoScenesThatNeedNoInstalledMeshesRun) {
  const TemporaryFolder folder;
  for (const char* name : {"peg_in_hole", "terrain"}) {
    const std::string path = std::string(ODDS_SOURCE_DIR) + "/demos/scenes/" + name + ".toml";
    const Ran ran = run_tool(folder, "run '" + path + "' --fast --seconds 1 --out " + name);
    EXPECT_EQ(ran.status, 0) << ran.errors;
    EXPECT_NE(ran.output.find("1000 of 1000 ran"), std::string::npos) << ran.output;
  }
}

TEST(Run, TheMainDemoTouchesTheMotorbike) {
  if (!std::filesystem::exists("/usr/share/doc/openfoam-examples/examples/resources/geometry/motorBike.obj.gz")) {
    GTEST_SKIP() << "the package openfoam-examples is not installed";
  }
  const TemporaryFolder folder;
  const std::string path = std::string(ODDS_SOURCE_DIR) + "/demos/scenes/motorbike_probe.toml";
  const Ran ran = run_tool(folder, "run '" + path + "' --fast --seconds 1.4 --out out");
  ASSERT_EQ(ran.status, 0) << ran.errors;
  EXPECT_NE(ran.output.find("1400 of 1400 ran"), std::string::npos) << ran.output;
  EXPECT_EQ(ran.output.find("; 0 hits"), std::string::npos) << ran.output;
  EXPECT_NE(ran.output.find("no tick changed"), std::string::npos) << "a safety stage had to act\n" << ran.output;
}

TEST(Explain, ListsEffectsWithTheLinesThatAsked) {
  const TemporaryFolder folder;
  folder.write("scene.toml", scene);
  const Ran ran = run_tool(folder, "explain scene.toml --samples 5");
  ASSERT_EQ(ran.status, 0) << ran.errors;
  for (const char* expected : {"2 of 19 effects are on", "on   virtual_coupling   line 26",
                               "on   contact            line 25", "off  friction", "no [effects.gravity]"}) {
    EXPECT_NE(ran.output.find(expected), std::string::npos) << expected << "\n" << ran.output;
  }
  folder.write("bad.toml", "format = 1\n");
  EXPECT_EQ(run_tool(folder, "explain bad.toml").status, 1);
}

}  // namespace
}  // namespace odds
