// The command `odds distance`, run as a user runs it.
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <vector>

#include "support/run_tool.hpp"

namespace odds {
namespace {

using testing::contents_of;
using testing::Ran;
using testing::run_tool;
using testing::TemporaryFolder;

TEST(DistanceCommand, MeasuresBoxesFaceToFace) {
  const TemporaryFolder folder;
  folder.write("poses.csv", "x,y,z,qw,qx,qy,qz\n1,0,0,1,0,0,0\n0.5,0,0,1,0,0,0\n");
  const Ran ran = run_tool(
      folder, "distance made:box:x=1,y=1,z=1 made:box:x=0.5,y=0.5,z=0.5 --poses poses.csv --out distances.csv");
  ASSERT_EQ(ran.status, 0) << ran.errors;
  const std::string text = contents_of(folder.path() / "distances.csv");
  EXPECT_NE(text.find("row,lower,upper,proved,ax,ay,az,bx,by,bz,triangle_a,triangle_b"), std::string::npos);
  EXPECT_NE(text.find("\n0,0.25,0.25,1,0.5,"), std::string::npos) << text;
  EXPECT_NE(text.find("\n1,0,0,1,"), std::string::npos) << text;
  EXPECT_NE(ran.errors.find("2 poses: 2 proved, 2 with nearest points"), std::string::npos) << ran.errors;
}

TEST(DistanceCommand, LeavesOutWhatIsBeyondTheMargin) {
  const TemporaryFolder folder;
  folder.write("poses.csv", "x,y,z,qw,qx,qy,qz\n1.25,0,0,1,0,0,0\n");
  const Ran ran = run_tool(folder, "distance made:box made:box --poses poses.csv --out - --within 0.125");
  ASSERT_EQ(ran.status, 0) << ran.errors;
  EXPECT_NE(ran.output.find("\n0,0.125,,1,,,,,,,,,"), std::string::npos) << ran.output;
}

TEST(DistanceCommand, ThePercentilesAreThoseOfTheRowsByNearestRank) {
  const testing::TemporaryFolder folder;
  std::string poses = "x,y,z,qw,qx,qy,qz\n";
  for (int i = 0; i < 100; ++i) poses += std::to_string(0.5 + 0.01 * i) + ",0,0,1,0,0,0\n";
  folder.write("poses.csv", poses);
  const Ran ran = run_tool(folder, "distance made:torus_knot made:gear --poses poses.csv --out distances.csv");
  ASSERT_EQ(ran.status, 0) << ran.errors;
  std::istringstream lines(testing::contents_of(folder / "distances.csv"));
  std::string line;
  std::getline(lines, line);
  std::vector<std::string> times;
  while (std::getline(lines, line)) times.push_back(line.substr(line.rfind(',') + 1));
  ASSERT_EQ(times.size(), 100U);
  std::sort(times.begin(), times.end(),
            [](const std::string& a, const std::string& b) { return std::stod(a) < std::stod(b); });
  const auto said = [&](const std::string& name) {
    const std::size_t at = ran.errors.find(name + " ") + name.size() + 1;
    return std::stod(ran.errors.substr(at));
  };
  EXPECT_NEAR(said("p50"), std::stod(times[49]), 0.0051);
  EXPECT_NEAR(said("p99"), std::stod(times[98]), 0.0051) << "the 99th of 100, not the longest";
  EXPECT_NEAR(said("max"), std::stod(times[99]), 0.0051);
}

TEST(DistanceCommand, RefusesNonsense) {
  const TemporaryFolder folder;
  folder.write("poses.csv", "x,y,z,qw,qx,qy,qz\n1.25,0,0,1,0,0,0\n");
  EXPECT_EQ(run_tool(folder, "distance made:box made:box --poses poses.csv --out - --within -1").status, 2);
  EXPECT_EQ(run_tool(folder, "distance made:box none.obj --poses poses.csv --out -").status, 1);
  EXPECT_EQ(run_tool(folder, "distance made:box made:box --poses none.csv --out -").status, 1);
}

}  // namespace
}  // namespace odds
