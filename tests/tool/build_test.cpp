// The command `odds build`, and its files in the place of meshes, as a user has them.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "support/run_tool.hpp"

namespace odds {
namespace {

using testing::contents_of;
using testing::Ran;
using testing::run_tool;
using testing::TemporaryFolder;

const std::string poses =
    "x,y,z,qw,qx,qy,qz\n0.20,0,0,1,0,0,0\n0.10,0.05,0.02,1,0,0,0\n0,0,0.05,1,0,0,0\n0.05,0,0,1,1,0,0\n";

/// Of ANSWERS.csv or DISTANCES.csv, what does not depend on the clock.
std::string without_times(const std::string& csv) {
  std::istringstream lines(csv);
  std::string kept;
  std::vector<std::string> names;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream fields(line);
    std::size_t column = 0;
    const bool heading = names.empty();
    for (std::string field; std::getline(fields, field, ','); ++column) {
      if (heading) names.push_back(field);
      if (!names[column].ends_with("_us")) kept += field + ",";
    }
    kept += '\n';
  }
  return kept;
}

class Build : public ::testing::Test {
 protected:
  Build() { folder_.write("poses.csv", poses); }

  Ran run(const std::string& arguments) { return run_tool(folder_, arguments); }
  void build(const std::string& arguments) {
    const Ran ran = run("build " + arguments);
    ASSERT_EQ(ran.status, 0) << ran.errors;
  }
  std::string answers(const std::string& arguments) {
    const Ran ran = run(arguments + " --poses poses.csv --out out.csv");
    EXPECT_EQ(ran.status, 0) << ran.errors;
    return without_times(contents_of(folder_ / "out.csv"));
  }
  /// One line that names the file and says `words`.
  void expect_refused(const std::string& arguments, const std::string& file, const std::string& words) {
    const Ran ran = run(arguments);
    EXPECT_EQ(ran.status, 1) << arguments;
    EXPECT_TRUE(ran.errors.starts_with("error: " + file + ":")) << ran.errors;
    EXPECT_NE(ran.errors.find(words), std::string::npos) << ran.errors;
    EXPECT_EQ(std::count(ran.errors.begin(), ran.errors.end(), '\n'), 1) << ran.errors;
  }

  TemporaryFolder folder_;
};

TEST_F(Build, ItsFileAnswersAsTheMeshDoes) {
  build("made:torus_knot -o knot.odds");
  build("made:gear --out gear.file");
  EXPECT_EQ(answers("query knot.odds gear.file"), answers("query made:torus_knot made:gear"));
  EXPECT_EQ(answers("query knot.odds made:gear --method exact"),
            answers("query made:torus_knot made:gear --method exact"));
  EXPECT_EQ(answers("distance knot.odds gear.file"), answers("distance made:torus_knot made:gear"));
}

TEST_F(Build, ItsFileDecidesTheVolumeUnlessAnotherIsAskedFor) {
  build("made:gear --bv obb --tau 0.5 -o gear.odds");
  EXPECT_EQ(answers("query gear.odds gear.odds"), answers("query made:gear made:gear --bv obb --tau 0.5"));
  EXPECT_EQ(answers("query gear.odds made:gear --bv obb --tau 0.5"),
            answers("query made:gear made:gear --bv obb --tau 0.5"));
  const std::string query = "query gear.odds gear.odds --poses poses.csv --out out.csv";
  expect_refused(query + " --bv wide", "gear.odds", "its bounding volume is obb, not wide");
  expect_refused(query + " --tau 0.25", "gear.odds", "tau");
  expect_refused(query + " --scale-a 2", "gear.odds", "a scale does not apply");
  expect_refused("query gear.odds made:gear --poses poses.csv --out out.csv", "made:gear", "same volume");
}

TEST_F(Build, InspectSaysWhatAFileHolds) {
  build("made:box:cells=8 --bv kdop18 -o box.odds");
  const Ran ran = run("inspect box.odds");
  ASSERT_EQ(ran.status, 0) << ran.errors;
  for (const char* expected : {"mesh            made:box:cells=8", "triangles       768", "closed          yes",
                               "hierarchy       kdop18", "without polygons", "checked and loaded in"}) {
    EXPECT_NE(ran.output.find(expected), std::string::npos) << expected << "\n" << ran.output;
  }
  const auto json = nlohmann::json::parse(run("inspect box.odds --json").output);
  const auto of_mesh = nlohmann::json::parse(run("inspect made:box:cells=8 --bv kdop18 --json").output);
  for (const char* key : {"bytes_per_triangle", "bytes_per_triangle_polygon_free", "nodes", "leaves", "levels"}) {
    EXPECT_EQ(json["hierarchy"][key], of_mesh["hierarchy"][key]) << key;
  }
  EXPECT_EQ(json["faults"], of_mesh["faults"]);
  EXPECT_GT(json["hierarchy"]["load_ms"], 0.0);
}

TEST_F(Build, WithoutPolygonsAnswersAreEstimates) {
  build("made:torus_knot --polygon-free -o free.odds");
  EXPECT_EQ(answers("query free.odds free.odds"), answers("query made:torus_knot made:torus_knot --polygon-free"));
  const auto json = nlohmann::json::parse(run("inspect free.odds --json").output);
  EXPECT_EQ(json["hierarchy"]["polygons"], false);
  EXPECT_EQ(json["hierarchy"]["bytes_per_triangle"], json["hierarchy"]["bytes_per_triangle_polygon_free"]);
  EXPECT_EQ(json["vertices"], nullptr);
  EXPECT_EQ(run("inspect free.odds").status, 0);
  expect_refused("distance free.odds free.odds --poses poses.csv --out out.csv", "free.odds", "polygons were dropped");
  expect_refused("accuracy free.odds free.odds --out accuracy", "free.odds", "polygons were dropped");
  expect_refused("inspect free.odds --repair mended.obj", "free.odds", "polygons were dropped");
  folder_.write("scene.toml",
                "format = \"odds.scene/1\"\n[[mesh]]\nname = \"m\"\nfile = \"free.odds\"\n[[body]]\n"
                "name = \"b\"\nmesh = \"m\"\n");
  expect_refused("explain scene.toml", "scene.toml", "polygons were dropped");
}

TEST_F(Build, AccuracyAndScenesTakeAFile) {
  build("made:icosphere:frequency=4 -o ball.odds");
  build("made:icosphere:frequency=4 --bv aabb -o boxes.odds");
  for (const char* meshes : {"ball.odds ball.odds", "boxes.odds boxes.odds"}) {
    const Ran ran = run(std::string("accuracy ") + meshes + " --poses 3 --budgets-us none --work 64 --out accuracy");
    EXPECT_EQ(ran.status, 0) << ran.errors;
  }
  const std::string body = "[[body]]\nname = \"b\"\nmesh = \"m\"\n";
  folder_.write("scene.toml", "format = \"odds.scene/1\"\n[[mesh]]\nname = \"m\"\nfile = \"ball.odds\"\n" + body);
  EXPECT_EQ(run("run --fast --seconds 0.01 scene.toml --out out").status, 0);
  folder_.write("scene.toml", "format = \"odds.scene/1\"\n[[mesh]]\nname = \"m\"\nfile = \"boxes.odds\"\n" + body);
  expect_refused("run --fast --seconds 0.01 scene.toml --out out", "scene.toml", "bounding volume");
}

TEST_F(Build, DamagedFilesAndBadUsageAreSaidToBeSo) {
  build("made:box -o box.odds");
  const std::string whole = contents_of(folder_ / "box.odds");
  folder_.write("short.odds", whole.substr(0, whole.size() / 2));
  expect_refused("inspect short.odds", "short.odds:byte " + std::to_string(whole.size() / 2), "cut off");
  std::string altered = whole;
  altered[2000] = static_cast<char>(altered[2000] ^ 1);
  folder_.write("altered.odds", altered);
  expect_refused("inspect altered.odds", "altered.odds:byte 576", "altered");
  expect_refused("build box.odds -o box.odds", "box.odds", "overwritten");
  expect_refused("build made:box -o no/such/folder.odds", "no/such/folder.odds", "cannot be written");
  EXPECT_EQ(run("build made:box").status, 2);
  EXPECT_EQ(contents_of(folder_ / "box.odds"), whole);
}

TEST_F(Build, ScenesNameTheLineThatAsksForABadFile) {
  build("made:box -o box.odds");
  folder_.write("short.odds", contents_of(folder_ / "box.odds").substr(0, 1000));
  folder_.write("bad.obj", "v 0 0 0\nf 1 2 3\n");
  for (const std::string file : {"short.odds", "bad.obj"}) {
    folder_.write("scene.toml", "format = \"odds.scene/1\"\n[[mesh]]\nname = \"m\"\nfile = \"" + file +
                                    "\"\n[[body]]\nname = \"b\"\nmesh = \"m\"\n");
    expect_refused("explain scene.toml", "scene.toml:2", file + ":");
  }
}

TEST_F(Build, LeavesCanGoUntested) {
  const std::string plain = answers("query made:gear made:gear --bv aabb --method exact --contacts 0");
  const std::string untested =
      answers("query made:gear made:gear --bv aabb --method exact --contacts 0 --no-leaf-test");
  EXPECT_NE(untested, plain);  // other work
  EXPECT_EQ(untested.substr(0, untested.find("proved")), plain.substr(0, plain.find("proved")));
  expect_refused("query made:gear made:gear --no-leaf-test --poses poses.csv --out out.csv", "made:gear", "--bv");
}

}  // namespace
}  // namespace odds
