// The command `odds query`, run as a user runs it.
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <vector>

#include "odds/math/random.hpp"
#include "odds/volume/kind.hpp"
#include "support/run_tool.hpp"

namespace odds {
namespace {

using testing::contents_of;
using testing::Ran;
using testing::run_tool;
using testing::TemporaryFolder;

const std::string header = "x,y,z,qw,qx,qy,qz\n";
const std::string answers_header =
    "row,verdict,basis,probability,node_pairs,triangle_pairs,wall_us,stall_us,contacts,px,py,pz,nx,ny,nz,depth";

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == separator) {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

/// Rows of fields, header checked and left out.
std::vector<std::vector<std::string>> answers_in(const std::string& text) {
  std::vector<std::string> lines = split(text, '\n');
  EXPECT_EQ(lines.front(), answers_header);
  EXPECT_EQ(lines.back(), "");
  std::vector<std::vector<std::string>> rows;
  for (std::size_t i = 1; i + 1 < lines.size(); ++i) {
    rows.push_back(split(lines[i], ','));
    EXPECT_EQ(rows.back().size(), 16u) << lines[i];
    EXPECT_EQ(rows.back()[0], std::to_string(i - 1));
  }
  return rows;
}

std::string random_poses(std::size_t count, double reach) {
  math::Random random(5);
  std::ostringstream text;
  text.precision(17);
  text << header;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 p = reach * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    const Quat q = random.rotation();
    text << p.x() << ',' << p.y() << ',' << p.z() << ',' << q.w() << ',' << q.x() << ',' << q.y() << ',' << q.z()
         << '\n';
  }
  return text.str();
}

TEST(Query, AnswersEachPoseInOrder) {
  const TemporaryFolder folder;
  folder.write("poses.csv", header + "5,0,0,1,0,0,0\n0.09,0.01,0.02,1,0,0,0\n0,0.3,0,1,0,0,0\n");
  const Ran ran = run_tool(folder, "query made:box made:box --poses poses.csv --out answers.csv --method exact");
  ASSERT_EQ(ran.status, 0) << ran.errors;
  const auto rows = answers_in(contents_of(folder / "answers.csv"));
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0][1], "clear");
  EXPECT_EQ(rows[1][1], "hit");
  EXPECT_EQ(rows[2][1], "clear");
  for (const auto& row : rows) EXPECT_EQ(row[2], "proved");
  EXPECT_EQ(rows[0][3], "0");
  EXPECT_EQ(rows[1][3], "1");
  EXPECT_EQ(rows[0][8], "0");
  for (std::size_t k = 9; k < 16; ++k) EXPECT_EQ(rows[0][k], "");
  ASSERT_EQ(rows[1][8], "1");
  double normal_squared = 0.0;
  for (std::size_t k = 12; k < 15; ++k) normal_squared += std::pow(std::stod(rows[1][k]), 2);
  EXPECT_NEAR(normal_squared, 1.0, 1e-9);
  EXPECT_GE(std::stod(rows[1][15]), 0.0);
  EXPECT_NE(ran.output.find("(3 answers)"), std::string::npos) << ran.output;
}

TEST(Query, PosesMayComeInAnyOrderOfColumnsWithCommentsQuotesAndForeignLineEnds) {
  const TemporaryFolder folder;
  folder.write("poses.csv",
               "\xEF\xBB\xBF# a comment\r\n\r\nname,qz,qy,qx,qw,z,y,x\r\n\"a, b\",0,0,0,2,0,0,0.05\r\n# another\r\n"
               "c,0,0,0,-1e-200, 0 ,\"0\",0.25\r\n");
  const Ran ran = run_tool(folder, "query made:box made:box --poses poses.csv --out -");
  ASSERT_EQ(ran.status, 0) << ran.errors;
  const auto rows = answers_in(ran.output);
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0][1], "hit");
  EXPECT_EQ(rows[1][1], "clear");
  EXPECT_NE(ran.errors.find("(2 answers)"), std::string::npos);  // the table makes way for the answers
}

TEST(Query, AllMethodsAndVolumesProveTheSameVerdicts) {
  const TemporaryFolder folder;
  folder.write("poses.csv", random_poses(150, 0.12));
  std::vector<std::string> expected;
  std::size_t hits = 0;
  for (const std::string_view word : volume::kind_words) {
    const std::string volume(word);
    for (const std::string method : {"exact", "incremental", "time-critical"}) {
      const Ran ran =
          run_tool(folder, "query made:torus_knot:along=200,across=8 made:gear --poses poses.csv --out a.csv --bv " +
                               volume + " --method " + method);
      ASSERT_EQ(ran.status, 0) << ran.errors;
      std::vector<std::string> verdicts;
      for (const auto& row : answers_in(contents_of(folder / "a.csv"))) {
        EXPECT_EQ(row[2], "proved");
        verdicts.push_back(row[1]);
        if (expected.empty() && row[1] == "hit") ++hits;
      }
      if (expected.empty()) expected = verdicts;
      EXPECT_EQ(verdicts, expected) << volume << " " << method;
    }
  }
  EXPECT_GT(hits, 10u);
  EXPECT_LT(hits, 140u);
}

TEST(Query, WorkUnitsGiveTheSameBitsOnEveryRun) {
  const TemporaryFolder folder;
  folder.write("poses.csv", random_poses(60, 2.0));
  std::vector<std::vector<std::vector<std::string>>> runs;
  for (const std::string options : {"", "", " --repeat 3"}) {
    const Ran ran = run_tool(folder,
                             "query made:car_body:triangles=3000 made:car_body:triangles=3000 --poses poses.csv "
                             "--out a.csv --work 100" +
                                 options);
    ASSERT_EQ(ran.status, 0) << ran.errors;
    runs.push_back(answers_in(contents_of(folder / "a.csv")));
    for (auto& row : runs.back()) row[6] = row[7] = "";  // times
  }
  EXPECT_EQ(runs[0], runs[1]);
  EXPECT_EQ(runs[0], runs[2]);
  std::size_t undecided = 0;
  for (const auto& row : runs[0]) undecided += row[2] == "budget" ? 1 : 0;
  EXPECT_GT(undecided, 0u);  // otherwise the budget was never felt
}

TEST(Query, ABudgetOfMicrosecondsAnswersEveryPoseAndShowsTheOvershoot) {
  const TemporaryFolder folder;
  folder.write("poses.csv", random_poses(50, 2.0));
  const Ran ran = run_tool(
      folder, "query made:car_body:triangles=3000 made:bumpy_sphere --poses poses.csv --out a.csv --budget-us 5");
  ASSERT_EQ(ran.status, 0) << ran.errors;
  EXPECT_EQ(answers_in(contents_of(folder / "a.csv")).size(), 50u);
  EXPECT_NE(ran.output.find("over, net"), std::string::npos) << ran.output;
  EXPECT_NE(ran.output.find("         -"), std::string::npos) << "p99.9 of 50 answers cannot be known: " << ran.output;
}

TEST(Query, BadPosesNameFileAndLineAndLeaveNoAnswers) {
  const TemporaryFolder folder;
  const struct {
    std::string text;
    std::string place;
    std::string what;
  } cases[] = {
      {"", "poses.csv: ", "empty"},
      {header, "poses.csv: ", "no pose"},
      {"x,y,z,qw,qx,qy\n", "poses.csv:1: ", "lacks qz"},
      {"x,x,y,z,qw,qx,qy,qz\n", "poses.csv:1: ", "twice"},
      {header + "0,0,0,1,0,0\n", "poses.csv:2: ", "6 fields"},
      {header + "0,0,0,1,0,0,0,0\n", "poses.csv:2: ", "8 fields"},
      {header + "0,0,0,1,0,0,0\n# c\n0,0,0,0,0,0,0\n", "poses.csv:4: ", "quaternion is zero"},
      {header + "0,0,0,nan,0,0,0\n", "poses.csv:2: ", "qw = \"nan\""},
      {header + "0,inf,0,1,0,0,0\n", "poses.csv:2: ", "y = \"inf\""},
      {header + "0,0,1e16,1,0,0,0\n", "poses.csv:2: ", "z = \"1e16\""},
      {header + "1.0f,0,0,1,0,0,0\n", "poses.csv:2: ", "x = \"1.0f\""},
      {header + ",0,0,1,0,0,0\n", "poses.csv:2: ", "x = \"\""},
      {header + "0x1,0,0,1,0,0,0\n", "poses.csv:2: ", "x = \"0x1\""},
  };
  for (const auto& bad : cases) {
    folder.write("poses.csv", bad.text);
    const Ran ran = run_tool(folder, "query made:box made:box --poses poses.csv --out answers.csv");
    EXPECT_EQ(ran.status, 1) << bad.text;
    EXPECT_TRUE(ran.errors.starts_with("error: " + bad.place)) << ran.errors;
    EXPECT_NE(ran.errors.find(bad.what), std::string::npos) << ran.errors;
    EXPECT_NE(ran.errors.find("; "), std::string::npos) << ran.errors;
    EXPECT_FALSE(std::filesystem::exists(folder / "answers.csv")) << bad.text;
  }
}

TEST(Query, AFailureKeepsTheOldAnswersAndLeavesNoOtherFile) {
  const TemporaryFolder folder;
  folder.write("answers.csv", "old");
  folder.write("poses.csv", header + "0,0,0,1,0,0,0\n");
  const Ran ran = run_tool(folder, "query made:box missing.stl --poses poses.csv --out answers.csv");
  EXPECT_EQ(ran.status, 1);
  EXPECT_TRUE(ran.errors.starts_with("error: missing.stl: ")) << ran.errors;
  EXPECT_EQ(contents_of(folder / "answers.csv"), "old");
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& file : std::filesystem::directory_iterator(folder.path())) ++files;
  EXPECT_EQ(files, 4u);  // answers, poses, and what run_tool keeps of stdout and stderr
}

TEST(Query, OutputThatCannotBeWrittenIsAnError) {
  const TemporaryFolder folder;
  folder.write("poses.csv", header + "0,0,0,1,0,0,0\n");
  for (const std::string out : {"nowhere/answers.csv", ".", "/dev/full"}) {
    const Ran ran = run_tool(folder, "query made:box made:box --poses poses.csv --out " + out);
    EXPECT_EQ(ran.status, 1) << out;
    EXPECT_TRUE(ran.errors.starts_with("error: " + out + ": ")) << ran.errors;
  }
}

TEST(Query, AWholeNumberThatBeginsWithZeroIsRefused) {
  // CLI11 would read it in base eight.
  const TemporaryFolder folder;
  folder.write("poses.csv", header + "5,0,0,1,0,0,0\n");
  folder.write("scene.toml", "");
  for (const std::string option : {"--work", "--repeat", "--contacts", "--calibrate", "--p-min 0.9 --k-min"}) {
    const std::string query = "query made:box made:box --poses poses.csv --out answers.csv " + option;
    const Ran ran = run_tool(folder, query + " 07");
    EXPECT_EQ(ran.status, 2) << option;
    EXPECT_NE(ran.errors.find("07 begins with 0; write 7"), std::string::npos) << ran.errors;
    EXPECT_EQ(run_tool(folder, query + " 7").status, 0) << option;
  }
  const std::string study = "accuracy made:box made:box --work 64 --budgets-us none --out out --poses ";
  EXPECT_NE(run_tool(folder, study + "010").errors.find("010 begins with 0; write 10"), std::string::npos);
  EXPECT_NE(run_tool(folder, study + "1 --seed 00").errors.find("00 begins with 0; write 0"), std::string::npos);
  EXPECT_EQ(run_tool(folder, study + "1 --seed 0").status, 0);
  for (const auto& [samples, says] : {std::pair{"010", "010 begins with 0; write 10"},
                                      {"0x10", "is not a whole number from 1 to 1000000"},
                                      {"-3", "is not a whole number from 1 to 1000000"},
                                      {"0", "is not a whole number from 1 to 1000000"}}) {
    const Ran ran = run_tool(folder, std::string("explain scene.toml --samples ") + samples);
    EXPECT_EQ(ran.status, 2) << samples;
    EXPECT_NE(ran.errors.find(says), std::string::npos) << ran.errors;
  }
}

TEST(Query, CountsOfPairsAreRefusedWhereNoProbabilityCounts) {
  const TemporaryFolder folder;
  folder.write("poses.csv", header + "5,0,0,1,0,0,0\n");
  for (const std::string command : {"query made:box made:box --poses poses.csv --out answers.csv",
                                    "accuracy made:box made:box --work 64 --budgets-us none --poses 1 --out out"}) {
    const Ran ran = run_tool(folder, command + " --k-min 3");
    EXPECT_EQ(ran.status, 2) << command;
    EXPECT_NE(ran.errors.find("--k-min requires --p-min"), std::string::npos) << ran.errors;
    EXPECT_EQ(run_tool(folder, command + " --k-min 3 --p-min 0.9").status, 0) << command;
  }
}

TEST(Query, TheExactMethodTakesNoThreshold) {
  const TemporaryFolder folder;
  folder.write("poses.csv", header + "5,0,0,1,0,0,0\n");
  const std::string command = "query made:box made:box --poses poses.csv --out answers.csv --method exact --p-min ";
  const Ran ran = run_tool(folder, command + "0.9");
  EXPECT_EQ(ran.status, 1);
  EXPECT_NE(ran.errors.find("the exact method never ends on a probability"), std::string::npos) << ran.errors;
  EXPECT_FALSE(std::filesystem::exists(folder / "answers.csv"));
  EXPECT_EQ(run_tool(folder, command + "1").status, 0);
  EXPECT_EQ(run_tool(folder, command + "0.9 --polygon-free").status, 0) << "without polygons every method is one";
}

TEST(Query, WrongUsageIsStatusTwo) {
  const TemporaryFolder folder;
  folder.write("poses.csv", header + "0,0,0,1,0,0,0\n");
  for (const std::string options : {"--budget-us 0", "--budget-us -1", "--budget-us nan", "--budget-us inf",
                                    "--work 0",      "--work -3",      "--work 1.5",      "--budget-us 5 --work 5",
                                    "--p-min 0",     "--p-min 1.01",   "--k-min 0",       "--contacts 9",
                                    "--contacts -1", "--bv cube",      "--method guess",  "--estimator luck",
                                    "--repeat 0",    "--repeat -1",    "--scale-a 0",     "--bogus"}) {
    const Ran ran = run_tool(folder, "query made:box made:box --poses poses.csv --out a.csv " + options);
    EXPECT_EQ(ran.status, 2) << options;
    EXPECT_NE(ran.errors, "") << options;
    EXPECT_FALSE(std::filesystem::exists(folder / "a.csv"));
  }
  EXPECT_EQ(run_tool(folder, "query made:box made:box --out a.csv").status, 2);
  EXPECT_EQ(run_tool(folder, "query made:box --poses poses.csv --out a.csv").status, 2);
}

}  // namespace
}  // namespace odds
