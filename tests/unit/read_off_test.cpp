// OFF and its relatives with colours, normals and comments.
#include <gtest/gtest.h>

#include "support/mesh_files.hpp"

namespace odds {
namespace {

using mesh::Triangle;
using mesh::TriangleMesh;

TriangleMesh read_off(const std::string& content, const std::string& name = "m.off") {
  auto mesh = test::read_content(content, name);
  EXPECT_TRUE(mesh.ok()) << mesh.error().message();
  return std::move(mesh).value();
}

TEST(ReadOff, ReadsPolygonsAndComments) {
  const TriangleMesh mesh = read_off(
      "# made\nOFF # kind\n4 2 5 # counts\n\n0 0 0\n1 0 0 # second\n1 1 0\n0 1 0\n# faces\n4 0 1 2 3 255 0 0\n3 0 1 2 "
      "0.1 0.2 0.3 "
      "1\n# end\n");
  ASSERT_EQ(mesh.triangles().size(), 3u);
  EXPECT_EQ(mesh.triangles()[1], (Triangle{0, 2, 3}));
}

TEST(ReadOff, ReadsItsRelatives) {
  EXPECT_EQ(read_off("COFF\n3 1 0\n0 0 0 255 0 0\n1 0 0 1 0 0 1\n0 1 0 7\n3 0 1 2\n").triangles().size(), 1u);
  EXPECT_EQ(read_off("NOFF\n3 1 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2\n").triangles().size(), 1u);
  EXPECT_EQ(
      read_off("STCNOFF 3 1 0\n0 0 0 0 0 1 1 1 1 1 0 0\n1 0 0 0 0 1 1 1 1 1 0 0\n0 1 0 0 0 1 1 1 1 1 0 0\n3 0 1 2\n")
          .triangles()
          .size(),
      1u);
  EXPECT_EQ(read_off("OFF\n3 1\n0 0 0 255 0 0\n1 0 0 0 0 0 1\n0 1 0\n3 0 1 2").triangles().size(), 1u);
}

TEST(ReadOff, ReadsCountsGluedToTheKeyword) {
  EXPECT_EQ(read_off("OFF3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n").triangles().size(), 1u);
}

}  // namespace
}  // namespace odds
