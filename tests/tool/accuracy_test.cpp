// The command `odds accuracy`, run as a user runs it.
#include <gtest/gtest.h>

#include <filesystem>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "support/run_tool.hpp"

namespace odds {
namespace {

using testing::contents_of;
using testing::Ran;
using testing::run_tool;
using testing::TemporaryFolder;

const std::string meshes = "accuracy made:torus_knot:along=60,across=8 made:gear ";
const std::string repeatable = meshes + "--budgets-us none --work 64,256 --poses 4 ";

/// A table without the columns that hold times.
std::string without_times(const std::string& csv) {
  std::istringstream lines(csv);
  std::string line;
  std::vector<bool> kept;
  std::string text;
  while (std::getline(lines, line)) {
    std::istringstream cells(line);
    std::size_t column = 0;
    for (std::string cell; std::getline(cells, cell, ','); ++column) {
      if (text.find('\n') == std::string::npos) kept.push_back(cell.find("_us") == std::string::npos);
      if (kept.at(column)) text += cell + ",";
    }
    text += "\n";
  }
  return text;
}

std::string file_in(const TemporaryFolder& folder, const std::string& name) { return contents_of(folder / name); }

TEST(Accuracy, WritesEveryFileAndTheTable) {
  const TemporaryFolder folder;
  const Ran ran = run_tool(folder, meshes + "--out out --poses 3 --budgets-us 1,50 --work 64 --p-min 1,0.9");
  ASSERT_EQ(ran.status, 0) << ran.errors;
  for (const char* file :
       {"accuracy.html", "accuracy.csv", "poses.csv", "answers.csv", "summary.json", "worst/01.csv"}) {
    EXPECT_GT(file_in(folder, std::string("out/") + file).size(), 100U) << file;
  }
  for (const char* text : {"50 us", "64 units, p >= 0.9", "exact", "page: out/accuracy.html"}) {
    EXPECT_NE(ran.output.find(text), std::string::npos) << text << "\n" << ran.output;
  }
  const auto summary = nlohmann::json::parse(file_in(folder, "out/summary.json"));
  EXPECT_EQ(summary["settings"]["poses_per_band"], 3);
  EXPECT_EQ(summary["rows"].size(), 7U * (1 + 4 + 12)) << "limits by all, groups, bands";
  const auto& exact = summary["rows"][6 * 17];
  EXPECT_EQ(exact["limit"], "exact");
  EXPECT_EQ(exact["proved"], 36);
  EXPECT_EQ(exact["wrong"], 0);
}

TEST(Accuracy, ShardsMergeToTheFiguresOfOneRun) {
  const TemporaryFolder folder;
  ASSERT_EQ(run_tool(folder, repeatable + "--out whole").status, 0);
  for (const char* i : {"0", "1", "2"}) {
    const Ran ran = run_tool(folder, repeatable + "--shard " + i + "/3 --out shard" + i);
    ASSERT_EQ(ran.status, 0) << ran.errors;
  }
  const Ran merged = run_tool(folder, "accuracy --merge shard2 shard0 shard1 --out merged");
  ASSERT_EQ(merged.status, 0) << merged.errors;
  EXPECT_EQ(file_in(folder, "merged/poses.csv"), file_in(folder, "whole/poses.csv"));
  for (const char* file : {"accuracy.csv", "answers.csv"}) {
    const std::string whole = without_times(file_in(folder, std::string("whole/") + file));
    EXPECT_GT(whole.size(), 1000U);
    EXPECT_EQ(without_times(file_in(folder, std::string("merged/") + file)), whole) << file;
  }
  std::string worst = file_in(folder, "merged/worst/01.csv");
  worst.replace(worst.find(" merged/"), 8, " whole/");
  EXPECT_EQ(worst, file_in(folder, "whole/worst/01.csv"));
}

TEST(Accuracy, WorkUnitsGiveTheSameBitsTwice) {
  const TemporaryFolder folder;
  for (const char* volume : {"wide", "obb"}) {
    const std::string options = repeatable + "--procedure tumbling --p-min 0.9 --k-min 2 --bv " + volume;
    ASSERT_EQ(run_tool(folder, options + " --out a").status, 0);
    ASSERT_EQ(run_tool(folder, options + " --out b").status, 0);
    EXPECT_EQ(without_times(file_in(folder, "a/answers.csv")), without_times(file_in(folder, "b/answers.csv")));
    EXPECT_EQ(without_times(file_in(folder, "a/accuracy.csv")), without_times(file_in(folder, "b/accuracy.csv")));
  }
}

TEST(Accuracy, TheWorstPosesReplay) {
  const TemporaryFolder folder;
  ASSERT_EQ(run_tool(folder, repeatable + "--out out").status, 0);
  const std::string worst = file_in(folder, "out/worst/01.csv");
  const std::size_t command = worst.find("# odds query ");
  ASSERT_NE(command, std::string::npos) << worst;
  std::string line = worst.substr(command + 7, worst.find('\n', command) - command - 7);
  const Ran ran = run_tool(folder, line);
  ASSERT_EQ(ran.status, 0) << ran.errors;
  const std::string said = worst.substr(worst.find(": ", worst.find("# at ")) + 2);
  const std::string verdict = said.substr(0, said.find(' '));
  const std::string probability = said.substr(said.find("P = ") + 4, said.find('\n') - said.find("P = ") - 4);
  EXPECT_NE(ran.output.find("0," + verdict + ",budget," + probability + ","), std::string::npos) << worst << ran.output;
}

TEST(Accuracy, TheCommandOfAWorstPoseRunsWhereTheStudyWasRun) {
  const TemporaryFolder folder;
  ASSERT_EQ(run_tool(folder, "build made:torus_knot:along=60,across=8 -o ./-a.odds").status, 0);
  ASSERT_EQ(run_tool(folder, "build made:gear -o b.odds").status, 0);
  const Ran study =
      run_tool(folder, "accuracy --budgets-us none --work 64 --poses 2 --out './the pages' -- -a.odds b.odds");
  ASSERT_EQ(study.status, 0) << study.errors;
  const std::string worst = file_in(folder, "the pages/worst/01.csv");
  EXPECT_NE(worst.find("# to answer it again, where the study was run:\n# odds query "), std::string::npos) << worst;
  const std::size_t command = worst.find("# odds query ") + 7;
  const Ran ran = run_tool(folder, worst.substr(command, worst.find('\n', command) - command));
  EXPECT_EQ(ran.status, 0) << worst << ran.errors;
  const std::string page = file_in(folder, "the pages/accuracy.html");
  EXPECT_NE(page.find("odds query ./-a.odds b.odds --poses &#39;./the pages/worst/01.csv&#39;"), std::string::npos);
  EXPECT_NE(page.find("run that where the study was run"), std::string::npos);
}

TEST(Accuracy, TheTableKeepsItsColumnsWhereAShardHasNoRowOfAGroup) {
  const TemporaryFolder folder;
  // Poses 0, 1, 2 ... are of bands 0, 1, 2 ... of twelve: this shard has one pose, of the last band.
  const Ran ran = run_tool(folder, meshes + "--budgets-us none --work 64 --poses 1 --shard 11/12 --out out");
  ASSERT_EQ(ran.status, 0) << ran.errors;
  std::istringstream lines(ran.output);
  std::string head;
  std::string row;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("limit ")) head = line;
    if (line.starts_with("exact ")) row = line;
  }
  const std::size_t groups = head.find("over") + 4;
  ASSERT_EQ(row.size(), head.size()) << head << "\n" << row;
  std::istringstream cells(row.substr(groups));
  std::vector<std::string> shares{std::istream_iterator<std::string>(cells), {}};
  EXPECT_EQ(shares, (std::vector<std::string>{"-", "-", "-", "0.00%"})) << head << "\n" << row;
}

TEST(Accuracy, AnEarlierStudyIsReplacedWhole) {
  const TemporaryFolder folder;
  ASSERT_EQ(run_tool(folder, repeatable + "--out out").status, 0);
  EXPECT_TRUE(std::filesystem::exists(folder / "out/worst/02.csv"));
  ASSERT_EQ(run_tool(folder, meshes + "--out out --poses 1 --budgets-us none --work 1000000").status, 0);
  EXPECT_FALSE(std::filesystem::exists(folder / "out/worst/01.csv")) << "nothing was wrong";
}

TEST(Accuracy, RefusesBadInputInOneLine) {
  const TemporaryFolder folder;
  folder.write("file", "in the way");
  const auto refused = [&](const std::string& arguments, int status, const std::string& text) {
    const Ran ran = run_tool(folder, arguments);
    EXPECT_EQ(ran.status, status) << arguments << "\n" << ran.errors;
    EXPECT_NE(ran.errors.find(text), std::string::npos) << arguments << "\n" << ran.errors;
  };
  refused("accuracy missing.obj made:gear --out out", 1, "error: missing.obj");
  refused(repeatable + "--out file", 1, "error: file");
  refused("accuracy --merge nowhere --out out", 1, "summary.json");
  refused("accuracy made:gear --out out", 2, "A and B");
  refused("accuracy made:gear made:gear", 2, "--out");
  refused("accuracy made:gear made:gear --merge x --out out", 2, "--merge");
  refused("accuracy --merge x --seed 1 --out out", 2, "--seed changes nothing");
  refused("accuracy --bv obb --merge x --out out", 2, "--bv changes nothing");
  refused(meshes + "--out out --budgets-us none --work none", 2, "no limit");
  for (const char* bad : {"--budgets-us 1,,2", "--budgets-us 1,x", "--budgets-us 0", "--budgets-us 1,1", "--work 1.5",
                          "--p-min 1.5", "--p-min none", "--shard 3/3", "--shard 1", "--poses 0", "--bv cube"}) {
    refused(meshes + "--out out " + bad, 2, std::string(bad).substr(0, std::string(bad).find(' ')));
  }
}

TEST(Accuracy, RefusesToMergeWhatDoesNotBelongTogether) {
  const TemporaryFolder folder;
  const std::string one = meshes + "--budgets-us none --work 64 --poses 1 ";
  ASSERT_EQ(run_tool(folder, one + "--shard 0/2 --out a").status, 0);
  ASSERT_EQ(run_tool(folder, one + "--shard 1/2 --seed 9 --out other").status, 0);
  const auto refused = [&](const std::string& folders, const std::string& text) {
    const Ran ran = run_tool(folder, "accuracy --merge " + folders);
    EXPECT_EQ(ran.status, 1) << folders;
    EXPECT_NE(ran.errors.find(text), std::string::npos) << ran.errors;
  };
  refused("a other --out m", "another study");
  refused("a --out m", "shard 1/2 is missing");
  refused("a a --out m", "as is a");
  refused("a --out a", "overwritten");
  std::string poses = file_in(folder, "a/poses.csv");
  folder.write("a/poses.csv", poses.substr(0, poses.size() / 2));
  refused("a --out m", "a/poses.csv");
}

// As many triangles, and the smaller body, to which all figures refer, is the other one.
TEST(Accuracy, RefusesToMergeShardsBetweenWhichAMeshWasChanged) {
  const TemporaryFolder folder;
  const std::string one = "accuracy body.obj made:gear --budgets-us none --work 64 --poses 1 ";
  const auto write_body = [&](const char* height) {
    folder.write("body.obj",
                 std::string("v 0 0 0\nv 9 0 0\nv 0 9 0\nv 1 1 ") + height + "\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
  };
  write_body("5");
  ASSERT_EQ(run_tool(folder, one + "--shard 0/2 --out a").status, 0);
  ASSERT_EQ(run_tool(folder, one + "--shard 1/2 --out b").status, 0);
  EXPECT_EQ(run_tool(folder, "accuracy --merge a b --out whole").status, 0);
  write_body("6");
  ASSERT_EQ(run_tool(folder, one + "--shard 1/2 --out b").status, 0);
  const Ran ran = run_tool(folder, "accuracy --merge a b --out m");
  EXPECT_EQ(ran.status, 1);
  EXPECT_NE(ran.errors.find("error: b: 'body.obj' was another mesh than in a; "), std::string::npos) << ran.errors;
}

TEST(Accuracy, RefusesToMergeDamagedFiles) {
  const TemporaryFolder folder;
  ASSERT_EQ(run_tool(folder, meshes + "--budgets-us none --work 64 --poses 1 --out a").status, 0);
  const auto refused_with = [&](const std::string& name, const std::string& from, const std::string& to) {
    const std::string whole = file_in(folder, name);
    const std::size_t at = whole.find(from);
    ASSERT_NE(at, std::string::npos) << name << " has no " << from;
    folder.write(name, whole.substr(0, at) + to + whole.substr(at + from.size()));
    const Ran ran = run_tool(folder, "accuracy --merge a --out m");
    EXPECT_EQ(ran.status, 1) << from << " -> " << to;
    EXPECT_NE(ran.errors.find(name), std::string::npos) << ran.errors;
    folder.write(name, whole);
  };
  for (const auto& [from, to] : {std::pair{"\"poses_per_band\": 1", "\"poses_per_band\": 99999999999999"},
                                 {"\"of\": 1", "\"of\": 0"},
                                 {"\"limit\": \"work\"", "\"limit\": \"wrok\""},
                                 {"\"amount\": 64.0", "\"amount\": -64.0"},
                                 {"\"procedure\": \"distance\"", "\"procedure\": \"far\""}}) {
    refused_with("a/summary.json", from, to);
  }
  const std::string summary = file_in(folder, "a/summary.json");
  folder.write("a/summary.json", "{\"format\": \"odds accuracy summary 2\"}");
  EXPECT_NE(run_tool(folder, "accuracy --merge a --out m").errors.find("has the format 'odds accuracy summary 2'"),
            std::string::npos);
  folder.write("a/summary.json", summary);
  const std::string poses = file_in(folder, "a/poses.csv");
  const std::string first = poses.substr(poses.find('\n') + 1);
  const std::string line = first.substr(0, first.find('\n'));
  refused_with("a/poses.csv", line, line + ",7");
  refused_with("a/poses.csv", line, "nan" + line.substr(line.find(',')));
  const std::string answers = file_in(folder, "a/answers.csv");
  refused_with("a/answers.csv", ",budget,", ",guess,");
  refused_with("a/answers.csv", ",work,64,1,", ",us,64,1,");
  refused_with("a/answers.csv", ",work,64,1,", ",work,64,0.5,");
  EXPECT_EQ(run_tool(folder, "accuracy --merge a --out m").status, 0) << "the undamaged study";
}

}  // namespace
}  // namespace odds
