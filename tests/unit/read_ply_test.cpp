// PLY: headers of many kinds, three encodings, what is passed over.
#include <gtest/gtest.h>

#include "support/mesh_files.hpp"

namespace odds {
namespace {

using mesh::Triangle;
using mesh::TriangleMesh;
using test::bytes_of;
using test::read_content;

TriangleMesh read_ply(const std::string& content, const std::string& name = "m.ply") {
  auto mesh = read_content(content, name);
  EXPECT_TRUE(mesh.ok()) << mesh.error().message();
  return std::move(mesh).value();
}

const std::string xyz = "property float x\nproperty float y\nproperty float z\n";

TEST(ReadPly, ReadsAsciiWithPolygonsCommentsAndExtras) {
  const TriangleMesh mesh = read_ply(
      "ply\nformat ascii 1.0\ncomment hello\nobj_info x\nelement vertex 4\nproperty int8 tag\n" + xyz +
      "property list uchar float weights\nelement edge 1\nproperty int a\nproperty int b\nelement face 2\nproperty "
      "uchar c\n"
      "property list uchar int vertex_index\nend_header\n1 0 0 0 0\n1 1 0 0 2 .5 .5\n\n1 1 1 0 0\n1 0 1 0 1 9\n0 1\n"
      "255 4 0 1 2 3\n255 3 0 1 2\n\n");
  EXPECT_EQ(mesh.vertices().size(), 4u);
  ASSERT_EQ(mesh.triangles().size(), 3u);
  EXPECT_EQ(mesh.triangles()[1], (Triangle{0, 2, 3}));
}

TEST(ReadPly, KeepsTheDigitsOfAsciiFloats) {
  const TriangleMesh mesh =
      read_ply("ply\nformat ascii 1.0\nelement vertex 3\n" + xyz +
               "element face 1\nproperty list uchar int vertex_indices\nend_header\n0.1 0 0\n1 0 0\n0 1 0\n"
               "3 0 1 2\n");
  EXPECT_EQ(mesh.vertices()[0].x(), 0.1);
}

TEST(ReadPly, ReadsFacesInFrontOfVertices) {
  const TriangleMesh mesh =
      read_ply("ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_indices\nelement vertex 3\n" +
               xyz + "end_header\n3 2 1 0\n0 0 0\n1 0 0\n0 1 0\n");
  EXPECT_EQ(mesh.triangles()[0], (Triangle{2, 1, 0}));
}

/// Binary with every scalar type in front of the coordinates, which are of integer types.
std::string mixed_types(bool big, const std::string& line_end) {
  std::string header =
      std::string("ply\nformat ") + (big ? "binary_big_endian" : "binary_little_endian") +
      " 1.0\nelement vertex 3\nproperty double d\nproperty char x\nproperty ushort s\nproperty short y\n"
      "property list int uint l\nproperty uint z\nelement face 1\nproperty list ushort uchar vertex_indices\n"
      "end_header\n";
  std::string file;
  for (const char c : header) file += c == '\n' ? line_end : std::string(1, c);
  for (int i = 0; i < 3; ++i) {
    file += bytes_of(0.5, big) + bytes_of(static_cast<std::int8_t>(-i)) + bytes_of(std::uint16_t{9}, big);
    file += bytes_of(static_cast<std::int16_t>(300 * i * i), big) + bytes_of(std::int32_t{i}, big);
    for (int k = 0; k < i; ++k) file += bytes_of(std::uint32_t{77}, big);
    file += bytes_of(std::uint32_t{4000000000u}, big);
  }
  return file + bytes_of(std::uint16_t{3}, big) + std::string{0, 1, 2};
}

TEST(ReadPly, ReadsEveryScalarTypeInBothByteOrders) {
  for (const bool big : {false, true}) {
    const TriangleMesh mesh = read_ply(mixed_types(big, "\n"));
    EXPECT_EQ(mesh.vertices()[2], Vec3(-2, 1200, 4e9));
    EXPECT_EQ(mesh.triangles()[0], (Triangle{0, 1, 2}));
  }
}

TEST(ReadPly, FindsTheFirstByteBehindHeadersWithAnyLineEnd) {
  for (const std::string end : {"\n", "\r\n", "\r"}) EXPECT_EQ(read_ply(mixed_types(true, end)).triangles().size(), 1u);
  // With lone returns the data may begin with the byte of a line feed.
  std::string header =
      "ply\rformat binary_little_endian 1.0\relement vertex 3\rproperty uchar x\rproperty uchar y\r"
      "property uchar z\relement face 1\rproperty list uchar uchar vertex_indices\rend_header\r";
  const TriangleMesh mesh = read_ply(header + std::string{10, 10, 10, 1, 2, 3, 4, 5, 6, 3, 0, 1, 2});
  EXPECT_EQ(mesh.vertices()[0], Vec3(10, 10, 10));
}

}  // namespace
}  // namespace odds
