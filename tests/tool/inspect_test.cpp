// The command `odds inspect`, run as a user runs it.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "support/run_tool.hpp"

namespace odds {
namespace {

using testing::Ran;
using testing::run_tool;
using testing::TemporaryFolder;

const std::string tetrahedron_obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";

TEST(Inspect, ShowsCountsFaultsAndHierarchy) {
  const TemporaryFolder folder;
  const Ran ran = run_tool(folder, "inspect made:box:cells=8 --bv aabb");
  EXPECT_EQ(ran.status, 0);
  EXPECT_EQ(ran.errors, "");
  for (const char* expected : {"triangles       768", "closed          yes", "volume          0.001 m3",
                               "hierarchy       aabb", "bytes a triangle", "boundary edges                 0"}) {
    EXPECT_NE(ran.output.find(expected), std::string::npos) << expected << "\n" << ran.output;
  }
}

TEST(Inspect, JsonHoldsTheSameFigures) {
  const TemporaryFolder folder;
  folder.write("broken.obj", tetrahedron_obj + "f 2 3 1\nf 1 1 2\nv 9 9 9\n");
  const Ran ran = run_tool(folder, "inspect broken.obj --json");
  ASSERT_EQ(ran.status, 0) << ran.errors;
  const auto json = nlohmann::json::parse(ran.output);
  EXPECT_EQ(json["triangles"], 6);
  EXPECT_EQ(json["closed"], true);
  EXPECT_EQ(json["manifold"], false);
  EXPECT_EQ(json["faults"]["duplicate_triangles"]["examples"], nlohmann::json::array({4}));
  EXPECT_EQ(json["faults"]["degenerate_triangles"]["examples"], nlohmann::json::array({5}));
  EXPECT_EQ(json["faults"]["unused_vertices"]["count"], 1);
  EXPECT_EQ(json["hierarchy"]["bounding_volume"], "wide");
  EXPECT_GT(json["hierarchy"]["nodes"], 0);
}

TEST(Inspect, RepairSaysWhatItDidAndWritesACleanMesh) {
  const TemporaryFolder folder;
  folder.write("broken.obj", tetrahedron_obj + "f 2 3 1\nf 1 1 2\n");
  const Ran ran = run_tool(folder, "inspect broken.obj --repair mended.ply");
  ASSERT_EQ(ran.status, 0) << ran.errors;
  EXPECT_NE(ran.output.find("1 degenerate triangles dropped"), std::string::npos) << ran.output;
  EXPECT_NE(ran.output.find("1 duplicate triangles dropped"), std::string::npos) << ran.output;
  const Ran again = run_tool(folder, "inspect mended.ply --json");
  ASSERT_EQ(again.status, 0) << again.errors;
  const auto json = nlohmann::json::parse(again.output);
  EXPECT_EQ(json["triangles"], 4);
  EXPECT_EQ(json["manifold"], true);
  EXPECT_DOUBLE_EQ(json["volume_m3"], 1.0 / 6.0);
}

TEST(Inspect, ScaleTurnsMillimetresIntoMetres) {
  const TemporaryFolder folder;
  folder.write("part.obj", "v 0 0 0\nv 100 0 0\nv 0 50 0\nf 1 2 3\n");
  EXPECT_NE(run_tool(folder, "inspect part.obj").output.find("millimetres"), std::string::npos);
  const Ran scaled = run_tool(folder, "inspect part.obj --scale 0.001");
  EXPECT_EQ(scaled.output.find("millimetres"), std::string::npos);
  EXPECT_NE(scaled.output.find("(0.1, 0.05, 0)"), std::string::npos) << scaled.output;
}

TEST(Inspect, BadInputIsOneLineWithPlaceAndRemedyAndStatusOne) {
  const TemporaryFolder folder;
  folder.write("bad.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n");
  const Ran bad = run_tool(folder, "inspect bad.obj");
  EXPECT_EQ(bad.status, 1);
  EXPECT_EQ(bad.output, "");
  EXPECT_TRUE(bad.errors.starts_with("error: bad.obj:4: ")) << bad.errors;
  EXPECT_NE(bad.errors.find("; "), std::string::npos) << bad.errors;
  const Ran missing = run_tool(folder, "inspect missing.obj");
  EXPECT_EQ(missing.status, 1);
  EXPECT_TRUE(missing.errors.starts_with("error: missing.obj: ")) << missing.errors;
  const Ran misspelt = run_tool(folder, "inspect made:gaer");
  EXPECT_EQ(misspelt.status, 1);
  EXPECT_NE(misspelt.errors.find("did you mean \"gear\"?"), std::string::npos) << misspelt.errors;
  const Ran unwritable = run_tool(folder, "inspect made:box --repair nowhere/x.obj");
  EXPECT_EQ(unwritable.status, 1);
  EXPECT_TRUE(unwritable.errors.starts_with("error: nowhere/x.obj: ")) << unwritable.errors;
}

TEST(Inspect, WrongUsageIsStatusTwo) {
  const TemporaryFolder folder;
  for (const char* arguments : {"", "inspect", "inspect made:box --bv cube", "inspect made:box --scale 0",
                                "inspect made:box --tau 2", "inspect made:box --what", "examine made:box"}) {
    const Ran ran = run_tool(folder, arguments);
    EXPECT_EQ(ran.status, 2) << arguments;
    EXPECT_NE(ran.errors, "") << arguments;
  }
  EXPECT_EQ(run_tool(folder, "inspect --help").status, 0);
}

}  // namespace
}  // namespace odds
