// The command `odds compare`, run as a user runs it.
#include <gtest/gtest.h>

#include <sstream>

#include "support/ball_on_terrain.hpp"
#include "support/run_tool.hpp"

namespace odds {
namespace {

using testing::contents_of;
using testing::Ran;
using testing::run_tool;
using testing::TemporaryFolder;

/// A ball that a hand presses onto a terrain; `query` and `loop` are keys of these sections.
std::string scene(const std::string& query, const std::string& loop = "") {
  return "format = \"odds.scene/1\"\n[loop]\nseconds = 0.3\n" + loop + "[query]\n" + query + "\n" +
         testing::ball_on_terrain + testing::hand_onto_terrain() + "[effects.contact]\n[effects.virtual_coupling]\n";
}

/// The line of a table that begins so.
std::string line_of(const std::string& table, const std::string& begin) {
  std::istringstream lines(table);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(begin)) return line;
  }
  return "";
}

TEST(Compare, RunsWithoutALimitHaveNoFrameEither) {
  const TemporaryFolder folder;
  folder.write("framed.toml", scene("frame_work_units = 2"));
  folder.write("free.toml", scene(""));
  const Ran framed = run_tool(folder, "compare framed.toml --budgets-us 1000 --out framed");
  ASSERT_EQ(framed.status, 0) << framed.errors;
  const Ran free = run_tool(folder, "compare free.toml --budgets-us 1000 --out free");
  ASSERT_EQ(free.status, 0) << free.errors;
  const std::string with_frame = contents_of(folder / "framed/comparison.csv");
  const std::string without = contents_of(folder / "free/comparison.csv");
  for (const char* run : {"no limit,own", "1 nm aside,own"}) {
    EXPECT_NE(line_of(without, run), "");
    EXPECT_EQ(line_of(with_frame, run), line_of(without, run));
  }
  EXPECT_NE(line_of(with_frame, "1000 us,own"), line_of(without, "1000 us,own")) << "these keep the scene's frame";
  const std::string sentence = "2 work units for all queries of a step";
  EXPECT_NE(contents_of(folder / "framed/comparison.html").find(sentence), std::string::npos);
  EXPECT_NE(framed.output.find(sentence), std::string::npos) << framed.output;
  EXPECT_EQ(contents_of(folder / "free/comparison.html").find("for all queries of a step"), std::string::npos);
}

/// What a comparison of scene.toml prints, in which nobody sets a limit.
std::string printed_by(const std::string& arguments) {
  const TemporaryFolder folder;
  folder.write("scene.toml", scene(""));
  const Ran ran = run_tool(folder, "compare --out out " + arguments);
  EXPECT_EQ(ran.status, 0) << ran.errors;
  return ran.output;
}

TEST(Compare, ABudgetOfMoreThanCanBeCountedIsNone) {
  const std::string printed = printed_by("scene.toml --budgets-us 1e300");
  EXPECT_NE(printed.find("1e+300 us: force off by 0.00 % (p95 0.00 %)"), std::string::npos) << printed;
}

// It was taken for another budget.
TEST(Compare, TakesTheSceneBehindItsBudgets) {
  const std::string printed = printed_by("--budgets-us 5,20 scene.toml --seconds 0.01");
  EXPECT_NE(printed.find("20 us: "), std::string::npos) << printed;
}

TEST(Compare, NamesTheBandOfNoiseThatItsRateHas) {
  const TemporaryFolder folder;
  for (const auto& [rate, band] : {std::pair{"500", "50-250 Hz"}, {"1000", "50-500 Hz"}, {"80", "39.2-40 Hz"}}) {
    folder.write("scene.toml", scene("", std::string("rate_hz = ") + rate + "\n"));
    const Ran ran = run_tool(folder, "compare scene.toml --budgets-us 20 --out out");
    ASSERT_EQ(ran.status, 0) << ran.errors;
    EXPECT_NE(ran.output.find(band), std::string::npos) << ran.output;
    EXPECT_NE(contents_of(folder / "out/comparison.html").find(std::string("noise ") + band), std::string::npos);
  }
}

}  // namespace
}  // namespace odds
