// OBJ: what is read, what is passed over, how numbers and indices are understood.
#include <gtest/gtest.h>

#include "support/mesh_files.hpp"

namespace odds {
namespace {

using mesh::Triangle;
using mesh::TriangleMesh;
using test::read_content;

const std::string corner = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";

TriangleMesh read_obj(const std::string& text) {
  auto mesh = read_content(text, "m.obj");
  EXPECT_TRUE(mesh.ok()) << mesh.error().message();
  return std::move(mesh).value();
}

TEST(ReadObj, KeepsTheIndexingOfTheFile) {
  const TriangleMesh mesh = read_obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 0\nf 1 2 3\nf 4 3 2\n");
  EXPECT_EQ(mesh.vertices().size(), 4u) << "equal positions must not be welded";
  EXPECT_EQ(mesh.triangles()[1], (Triangle{3, 2, 1}));
}

TEST(ReadObj, FansPolygonsFromTheirFirstCorner) {
  const TriangleMesh mesh = read_obj(corner + "f 2 3 4 1\n");
  ASSERT_EQ(mesh.triangles().size(), 2u);
  EXPECT_EQ(mesh.triangles()[0], (Triangle{1, 2, 3}));
  EXPECT_EQ(mesh.triangles()[1], (Triangle{1, 3, 0}));
}

TEST(ReadObj, TakesTheFirstIndexOfEveryKindOfCorner) {
  const TriangleMesh mesh = read_obj(corner + "f 1/7 2/8 3/9\nf 1//1 2//-2 3//3\nf 1/1/1 2/2/2 4/-4/4\nf 1// 2/ 3//\n");
  ASSERT_EQ(mesh.triangles().size(), 4u);
  EXPECT_EQ(mesh.triangles()[2], (Triangle{0, 1, 3}));
}

TEST(ReadObj, CountsNegativeIndicesBackFromTheirLine) {
  const TriangleMesh mesh = read_obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 0 0 1\nf -1 -2/5 -3//4\n");
  EXPECT_EQ(mesh.triangles()[0], (Triangle{0, 1, 2}));
  EXPECT_EQ(mesh.triangles()[1], (Triangle{3, 2, 1}));
}

TEST(ReadObj, AllowsFacesBeforeTheirVertices) {
  EXPECT_EQ(read_obj("f 1 2 3\n" + corner).triangles()[0], (Triangle{0, 1, 2}));
}

TEST(ReadObj, ACommentBehindAnIgnoredStatementEndsWithItsLine) {
  const TriangleMesh mesh =
      read_obj("o part # in C:\\tmp\\\n" + corner + "usemtl a # from C:\\x\\\nf 1 2 4\ng b#1 \\\n c\nf 1 2 3\n");
  EXPECT_EQ(mesh.vertices().size(), 4U);
  EXPECT_EQ(mesh.triangles().size(), 2U);
}

TEST(ReadObj, JoinsContinuedLines) {
  const TriangleMesh mesh =
      read_obj("v 0 \\\n0 0\nv 1 0 0\\\r\n\nv 0 1 0\n# no continuation \\\nf 1 2\\\n 3\ng a \\\nb\nf 3 2 1");
  EXPECT_EQ(mesh.vertices().size(), 3u);
  EXPECT_EQ(mesh.triangles().size(), 2u);
}

TEST(ReadObj, UnderstandsEveryLineEnd) {
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    const TriangleMesh mesh = read_obj("v 0 0 0" + end + "v 1 0 0" + end + end + "v 0 1 0" + end + "f 1 2 3" + end);
    EXPECT_EQ(mesh.triangles().size(), 1u);
  }
}

TEST(ReadObj, PassesOverWhatCarriesNoSurface) {
  const TriangleMesh mesh = read_obj(
      "6540 2180\n# comment \xff\xfe\nmtllib a b.mtl\no part\ng 1 2\ns off\nusemtl C:\\dir\nvt 0 0\nvn 0 0 1\nvp 1\n\t "
      "v 0 0 0 "
      "1.0\nv 1 0 0 0.5 0.5 0.5\nv 0 1 0 # end\nl 1 2\np 1\nmg 1\nlod 2\nf 1 2 3\n\n");
  EXPECT_EQ(mesh.vertices().size(), 3u);
  EXPECT_EQ(mesh.triangles().size(), 1u);
}

TEST(ReadObj, AcceptsZeroBytesBehindTheLastLine) {
  EXPECT_EQ(read_obj(corner + "f 1 2 3\n" + std::string(3, '\0')).triangles().size(), 1u);
  EXPECT_EQ(read_obj(corner + "f 1 2 3" + std::string(1, '\0')).triangles().size(), 1u);
}

TEST(ReadObj, RoundsNumbersCorrectly) {
  const TriangleMesh mesh = read_obj(
      "v 0.1 +.5 -1.e-3\nv 90071992547409.93 1e-400 -1e-400\nv 2.2250738585072011e-308 123456789012345678e-20 "
      "4.9e-324\n"
      "f 1 2 3\n");
  EXPECT_EQ(mesh.vertices()[0], Vec3(0.1, 0.5, -0.001));
  EXPECT_EQ(mesh.vertices()[2].x(), 2.2250738585072011e-308);
  EXPECT_EQ(mesh.vertices()[2].y(), 0.00123456789012345678);
  EXPECT_EQ(mesh.vertices()[2].z(), 4.9e-324);
  EXPECT_EQ(mesh.vertices()[1], Vec3(90071992547409.93, 0.0, 0.0));
}

}  // namespace
}  // namespace odds
