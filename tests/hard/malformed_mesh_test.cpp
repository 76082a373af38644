// The table of malformed mesh files: each is refused at the right place with the right words, plain and packed.
#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "support/mesh_files.hpp"

namespace odds {
namespace {

using test::bytes_of;
using test::packed;
using test::read_content;
using test::stl_claiming;

struct Malformed {
  const char* title;
  std::string file;  ///< its extension chooses the reader
  std::string content;
  std::string place;
  std::string word;  ///< of the message
};

const std::string corner = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";  // three lines

std::vector<Malformed> obj_table() {
  const std::string file = "bad.obj";
  return {
      {"no face", file, corner, "3", "no face"},
      {"only lines", file, corner + "l 1 2 3\n", "4", "line elements"},
      {"only comments", file, "# nothing\n", "1", "no face"},
      {"only blank lines", file, "\n\n\n", "3", "no face"},
      {"two coordinates", file, "v 0 0\n", "1", "coordinate z is missing"},
      {"no coordinate", file, corner + "v\n", "4", "coordinate x is missing"},
      {"letters for a number", file, "v 0 zero 0\n", "1", "'zero', which is not a number"},
      {"decimal comma", file, "v 0,5 0 0\n", "1", "points, not commas"},
      {"letters behind a number", file, "v 0 0 1.5f\n", "1", "not a number"},
      {"two signs", file, "v 0 0 +-1\n", "1", "not a number"},
      {"hexadecimal", file, "v 0 0 0x10\n", "1", "not a number"},
      {"not a number", file, "v 0 0 nan\n", "1", "not finite"},
      {"infinite", file, corner + "\n# x\nv -inf 0 0\n", "6", "not finite"},
      {"beyond doubles", file, "v 0 1e999 0\n", "1", "beyond the range"},
      {"beyond doubles by digits", file, "v 0 0 1" + std::string(400, '0') + "e1\n", "1", "beyond the range"},
      {"too far away", file, "v 0 2e15 0\n", "1", "exceeds 1e15"},
      {"too many numbers", file, "v 0 0 0 1 1 1 1 1\n", "1", "more than 7"},
      {"word behind coordinates", file, "v 0 0 0 red\n", "1", "'red'"},
      {"word glued to a number", file, "v0 0 0\n", "1", "'v0'"},
      {"capital V", file, "V 0 0 0\n", "1", "'V'"},
      {"glued face", file, corner + "f1 2 3\n", "4", "'f1'"},
      {"lost keyword", file, corner + "0 0 1\nf 1 2 3\n", "4", "'0' does not begin"},
      {"index 0", file, corner + "f 0 1 2\n", "4", "vertex 0"},
      {"index too large", file, corner + "f 1 2 4\n", "4", "'4' is out of range"},
      {"index far too large", file, corner + "f 1 2 99999999999999999999\n", "4", "out of range"},
      {"index beyond 32 bits", file, corner + "f 1 2 4294967299\n", "4", "out of range"},
      {"forward index that never comes", file, "f 1 2 9\n" + corner, "1", "out of range"},
      {"negative index too far back", file, corner + "f -1 -2 -4\n", "4", "'-4' is out of range"},
      {"negative index before vertices", file, "f -1 -2 -3\n" + corner, "1", "(there are 0 vertices before it)"},
      {"least integer as index", file, corner + "f -9223372036854775808 1 2\n", "4", "out of range"},
      {"below integers as index", file, corner + "f -9223372036854775809 1 2\n", "4", "out of range"},
      {"fraction as index", file, corner + "f 1.5 2 3\n", "4", "'1.5'"},
      {"letters as index", file, corner + "f a b c\n", "4", "'a'"},
      {"three slashes", file, corner + "f 1/1/1/1 2 3\n", "4", "'1/1/1/1'"},
      {"slash in front", file, corner + "f /1 2 3\n", "4", "'/1'"},
      {"letters as texture index", file, corner + "f 1/x 2 3\n", "4", "'1/x'"},
      {"face without corners", file, corner + "f\n", "4", "0 corners"},
      {"face of one corner", file, corner + "f 1\n", "4", "1 corner"},
      {"face of two corners", file, corner + "f 1 2 # 3\n", "4", "2 corners"},
      {"bad face after continuation", file, corner + "f 1 \\\n 2 \\\n x\n", "6", "'x'"},
      {"free-form surface", file, corner + "surf 0 1 0 1 1 2 3\n", "4", "free-form"},
      {"other file called", file, "call more.obj\n", "1", "another file"},
      {"control character", file, "v 0 0 0\nv 1 \x01 0\n", "2", "control character (1)"},
      {"zero bytes inside", file, "v 0 0 0\nv 1" + std::string(2, '\0') + " 0 0\n", "2", "control character (0)"},
      {"endless word", file, corner + "f " + std::string(5000, '1') + "\n", "4", "more than 4096"},
      {"carriage returns as line ends", file, "v 0 0 0\rv 1 0 0\rv 0 x 0\r", "3", "'x'"},
  };
}

std::vector<Malformed> stl_table() {
  const std::string file = "bad.stl";
  const std::string facet = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n";
  const std::string rest = "vertex 0 1 0\nendloop\nendfacet\n";
  const std::string nan = bytes_of(std::numeric_limits<float>::quiet_NaN());
  const std::string infinity = bytes_of(std::numeric_limits<float>::infinity());
  const auto with = [](std::string content, std::size_t offset, const std::string& bytes) {
    return content.replace(offset, bytes.size(), bytes);
  };
  return {
      {"no facet", file, "solid a\nendsolid a\n", "2", "no face"},
      {"no solid", file, facet + rest, "1", "'solid' is expected"},
      {"text of another kind", file, "hello world, this is not a mesh\n", "1", "not 'hello'"},
      {"no end", file, "solid a\n" + facet + rest, "8", "the file ends"},
      {"ends in a facet", file, "solid a\n" + facet, "5", "the file ends"},
      {"ends in a number", file, "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0", "4", "the file ends"},
      {"ends after the name", file, "solid a", "1", "the file ends"},
      {"two vertices", file, "solid a\n" + facet + "endloop\nendfacet\nendsolid\n", "6", "not 'endloop'"},
      {"four vertices", file, "solid a\n" + facet + "vertex 1 1 0\n" + rest + "endsolid\n", "7", "more than 3"},
      {"no loop", file, "solid a\nfacet normal 0 0 1\nvertex 0 0 0\n", "3", "'outer' is expected"},
      {"no normal", file, "solid a\nfacet\nouter loop\n", "3", "'normal' is expected"},
      {"two numbers of a normal", file, "solid a\nfacet normal 0 0\nouter loop\n", "3", "of the normal"},
      {"word for a coordinate", file, "solid a\n" + facet + "vertex 0 y 0\n", "6", "'y'"},
      {"NaN", file, "solid a\n" + facet + "vertex 0 NaN 0\n", "6", "not finite"},
      {"two numbers", file, "solid a\n" + facet + "vertex 0 1\nendloop\n", "7", "'endloop'"},
      {"text behind the end", file, "solid a\n" + facet + rest + "endsolid a\nmore\n", "10", "'solid' is expected"},
      {"claims more than there is", file, stl_claiming(5, 4), "byte 80", "claims 5 triangles (250 bytes)"},
      {"claims four thousand million", file, stl_claiming(0xffffffff, 1), "byte 80", "but only 50 bytes"},
      {"claims less than there is", file, stl_claiming(1, 2), "byte 80", "but 100 bytes follow"},
      {"claims none", file, stl_claiming(0, 0), "byte 80", "no face"},
      {"solid in front, truncated", file, stl_claiming(2, 2, "solid").substr(0, 150), "byte 80", "but only 66 bytes"},
      {"header only", file, std::string(80, '\0'), "byte 80", "the file ends"},
      {"part of a header", file, std::string(20, '\0'), "byte 0", "the file ends"},
      {"byte behind the end", file, stl_claiming(1, 1) + "\n", "byte 80", "51 bytes follow"},
      {"binary NaN", file, with(stl_claiming(2, 2), 134 + 24, nan), "byte 158", "coordinate x is not finite"},
      {"binary infinity", file, with(stl_claiming(2, 2), 84 + 12 + 8, infinity), "byte 96",
       "coordinate z is not finite"},
      {"binary too far away", file, with(stl_claiming(1, 1), 84 + 12 + 4, bytes_of(1e16f)), "byte 96",
       "y exceeds 1e15"},
  };
}

const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
const std::string faces = "property list uchar int vertex_indices\n";
/// Ten lines of header for `vertices` and `count` faces.
std::string ply_header(const std::string& vertices, const std::string& count, const std::string& format = "ascii") {
  return "ply\nformat " + format + " 1.0\nelement vertex " + vertices + "\n" + xyz + "element face " + count + "\n" +
         faces + "end_header\n";
}

std::vector<Malformed> ply_header_table() {
  const std::string file = "bad.ply";
  return {
      {"no magic word", file, "plx\n", "1", "begins with the line 'ply'"},
      {"ends in the header", file, "ply\nformat ascii 1.0\n", "2", "inside the header"},
      {"no format", file, "ply\nelement vertex 0\nend_header\n", "3", "no format line"},
      {"two formats", file, "ply\nformat ascii 1.0\nformat ascii 1.0\n", "3", "second format"},
      {"unknown format", file, "ply\nformat binary 1.0\n", "2", "'binary'"},
      {"unknown version", file, "ply\nformat ascii 2.0\n", "2", "'2.0'"},
      {"unknown keyword", file, "ply\nformat ascii 1.0\nelephant 3\n", "3", "'elephant'"},
      {"unknown type", file, "ply\nformat ascii 1.0\nelement vertex 1\nproperty real x\n", "4", "'real'"},
      {"property without element", file, "ply\nformat ascii 1.0\nproperty float x\n", "3", "before the first element"},
      {"property without name", file, "ply\nformat ascii 1.0\nelement vertex 1\nproperty float\n", "4", "no name"},
      {"two words of a name", file, "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x y\n", "4",
       "'y' follows"},
      {"property twice", file, "ply\nformat ascii 1.0\nelement vertex 1\nproperty int x\nproperty int x\n", "5",
       "twice"},
      {"element twice", file, "ply\nformat ascii 1.0\nelement vertex 1\nelement vertex 1\n", "4", "twice"},
      {"element without count", file, "ply\nformat ascii 1.0\nelement vertex\n", "3", "count is missing"},
      {"negative count", file, "ply\nformat ascii 1.0\nelement vertex -1\n", "3", "negative"},
      {"count of letters", file, "ply\nformat ascii 1.0\nelement vertex many\n", "3", "'many'"},
      {"count beyond integers", file, "ply\nformat ascii 1.0\nelement vertex 99999999999999999999\n", "3", "beyond"},
      {"length of a list as float", file, "ply\nformat ascii 1.0\nelement face 1\nproperty list float int v\n", "4",
       "length"},
      {"four thousand million faces", file, ply_header("3", "4000000000") + "0 0 0\n1 0 0\n0 1 0\n", "9",
       "claims 4000000000"},
      {"more vertices than bytes", file, ply_header("100", "1") + "0 0 0\n", "9", "claims 100 elements 'vertex'"},
      {"counts that overflow together", file,
       "ply\nformat binary_little_endian 1.0\nelement vertex 9223372036854775807\n" + xyz +
           "element face 9223372036854775807\n" + faces + "end_header\n",
       "9", "claims 9223372036854775807"},
      {"more binary faces than bytes", file, ply_header("0", "8", "binary_little_endian") + "1234567", "9", "claims 8"},
      {"elements of nothing", file, "ply\nformat ascii 1.0\nelement vertex 4000000000\nend_header\n", "4",
       "no property"},
      {"no vertices declared", file, "ply\nformat ascii 1.0\nelement face 0\n" + faces + "end_header\n", "5",
       "no element vertex"},
      {"no faces declared", file, "ply\nformat ascii 1.0\nelement vertex 0\n" + xyz + "end_header\n", "7",
       "no element face"},
      {"only strips", file,
       "ply\nformat ascii 1.0\nelement vertex 0\n" + xyz +
           "element tristrips 0\nproperty list int int vertex_indices\nend_header\n",
       "9", "triangle strips"},
      {"no y", file,
       "ply\nformat ascii 1.0\nelement vertex 0\nproperty int x\nproperty int z\nelement face 0\n" + faces +
           "end_header\n",
       "8", "no number y"},
      {"x is a list", file,
       "ply\nformat ascii 1.0\nelement vertex 0\nproperty list int int x\nelement face 0\n" + faces + "end_header\n",
       "7", "no number x"},
      {"faces without corners", file,
       "ply\nformat ascii 1.0\nelement vertex 0\n" + xyz + "element face 0\nproperty int a\nend_header\n", "9",
       "no list"},
      {"corners as floats", file,
       "ply\nformat ascii 1.0\nelement vertex 0\n" + xyz +
           "element face 0\nproperty list uchar float vertex_indices\nend_header\n",
       "9", "no list of integers"},
  };
}

std::vector<Malformed> ply_data_table() {
  const std::string file = "bad.ply";
  const std::string header = ply_header("3", "1");  // nine lines
  const std::string points = "0 0 0\n1 0 0\n0 1 0\n";
  const std::string little = ply_header("3", "1", "binary_little_endian");
  const std::string big = ply_header("3", "1", "binary_big_endian");
  std::string nine;
  for (int i = 0; i < 9; ++i) nine += bytes_of(static_cast<float>(i));
  std::string first_nan = bytes_of(0.f) + bytes_of(std::numeric_limits<float>::quiet_NaN()) + nine.substr(8);
  const auto at = [](const std::string& before, std::size_t more) {
    return "byte " + std::to_string(before.size() + more);
  };
  const std::string zero = bytes_of(0);
  return {
      {"no face", file, ply_header("3", "0") + points, "12", "no face"},
      {"header of nothing", file, ply_header("0", "0"), "9", "no face"},
      {"header of nothing without line end", file, ply_header("0", "0").substr(0, header.size() - 1), "9", "no face"},
      {"letters for a coordinate", file, header + "0 0 0\n1 z 0\n0 1 0\n3 0 1 2\n", "11", "'z'"},
      {"NaN", file, header + "0 0 0\n1 0 nan\n0 1 0\n3 0 1 2\n", "11", "not finite"},
      {"two coordinates", file, header + "0 0 0\n1 0\n0 1 0\n3 0 1 2\n", "11", "missing"},
      {"four coordinates", file, header + "0 0 0\n1 0 0 0\n0 1 0\n3 0 1 2\n", "11", "'0' follows"},
      {"too few faces", file, ply_header("3", "2") + points + "3 0 1 2                \n", "13",
       "ends before the last element"},
      {"too many faces", file, header + points + "3 0 1 2\n3 0 1 2\n", "14", "'3' follows the last"},
      {"index too large", file, header + points + "3 0 1 3\n", "13", "index 3 is out of range"},
      {"negative index", file, header + points + "3 0 -1 2\n", "13", "index -1 is out of range"},
      {"index is a fraction", file, header + points + "3 0 1.0 2\n", "13", "'1.0'"},
      {"fewer corners than said", file, header + points + "4 0 1 2\n", "13", "missing"},
      {"more corners than said", file, header + points + "3 0 1 2 0\n", "13", "'0' follows"},
      {"two corners", file, header + points + "2 0 1  \n", "13", "2 corners"},
      {"negative number of corners", file, header + points + "-3 0 1 2\n", "13", "negative length -3"},
      {"binary NaN", file, little + first_nan + std::string("\x03") + zero + zero + zero, at(little, 4), "not finite"},
      {"binary index too large", file, little + nine + std::string("\x03") + zero + zero + bytes_of(3),
       at(little, 36 + 9), "index 3 is out of range"},
      {"binary index of the other byte order", file, big + nine + std::string("\x03") + zero + zero + bytes_of(1),
       at(big, 36 + 9), "index 16777216 is out of range"},
      {"binary negative index", file, little + nine + std::string("\x03") + zero + zero + bytes_of(-1), at(little, 45),
       "index -1 is out of range"},
      {"binary face cut off", file, little + nine + std::string("\x04") + zero + zero + zero, at(little, 36 + 13),
       "the file ends"},
      {"binary vertex cut off", file, ply_header("3", "0", "binary_little_endian") + nine.substr(0, 35), "9",
       "claims 3"},
      {"binary two corners", file, little + nine + std::string("\x02") + zero + zero, at(little, 36), "2 corners"},
      {"bytes behind the last element", file, little + nine + std::string("\x03") + zero + zero + zero + "!",
       at(little, 36 + 13), "bytes follow the last"},
      {"binary list longer than the file", file,
       "ply\nformat binary_little_endian 1.0\nelement vertex 0\n" + xyz + "element face 0\n" + faces +
           "element more 1\nproperty list uint double far\nend_header\n" + bytes_of(0xffffffffu) + "12345678",
       "byte 226", "the file ends"},
      {"binary negative list", file,
       "ply\nformat binary_little_endian 1.0\nelement vertex 0\n" + xyz + "element face 0\n" + faces +
           "element more 1\nproperty list char double far\nend_header\n\xff",
       "byte 214", "negative length -1"},
  };
}

std::vector<Malformed> off_table() {
  const std::string file = "bad.off";
  const std::string points = "0 0 0\n1 0 0\n0 1 0\n";
  return {
      {"no keyword", file, "3 1 0\n" + points + "3 0 1 2\n", "1", "not with '3'"},
      {"four-dimensional", file, "4OFF\n3 1 0\n", "1", "not three-dimensional"},
      {"binary", file, "OFF BINARY\n", "1", "binary OFF"},
      {"no counts", file, "OFF\n", "1", "vertex count is missing"},
      {"one count", file, "OFF\n3\n", "2", "face count is missing"},
      {"four counts", file, "OFF\n3 1 0 0\n", "2", "'0' follows"},
      {"count of letters", file, "OFF\nthree 1 0\n", "2", "'three'"},
      {"negative count", file, "OFF\n-3 1 0\n", "2", "negative"},
      {"claims more vertices than bytes", file, "OFF\n4000000 1 0\n" + points, "2", "claims 4000000 vertices"},
      {"claims more faces than bytes", file, "OFF\n3 200000000 0\n" + points, "2", "200000000 faces"},
      {"claims beyond the limit", file, "OFF\n9223372036854775807 9223372036854775807 0\n", "2", "vertices"},
      {"no face", file, "OFF\n3 0 0\n" + points, "5", "no face"},
      {"two coordinates", file, "OFF\n3 1 0\n0 0 0\n1 0\n0 1 0\n3 0 1 2\n", "4", "coordinate z is missing"},
      {"two vertices on a line", file, "OFF\n3 1 0\n0 0 0 1 1\n0 1 0\n3 0 1 2\n", "3", "5 numbers"},
      {"colour missing", file, "COFF\n3 1 0\n" + points + "3 0 1 2\n", "3", "3 numbers"},
      {"half a normal", file, "NOFF\n3 1 0\n0 0 0 1 1\n1 0 0\n0 1 0\n3 0 1 2\n", "3", "5 numbers"},
      {"infinite", file, "OFF\n3 1 0\n0 0 0\n1 0 inf\n0 1 0\n3 0 1 2\n", "4", "not finite"},
      {"index too large", file, "OFF\n3 1 0\n" + points + "3 0 1 7\n", "6", "index 7 is out of range"},
      {"negative index", file, "OFF\n3 1 0\n" + points + "3 0 1 -1\n", "6", "index -1 is out of range"},
      {"two corners", file, "OFF\n3 1 0\n" + points + "2 0 1  \n", "6", "2 corners"},
      {"negative number of corners", file, "OFF\n3 1 0\n" + points + "-3 0 1 2\n", "6", "0 corners"},
      {"fewer corners than said", file, "OFF\n3 1 0\n" + points + "4 0 1 2\n", "6", "index is missing"},
      {"too few faces", file, "OFF\n3 2 0\n" + points + "3 0 1 2          \n", "6", "after 1 of 2 faces"},
      {"too few vertices", file, "OFF\n4 0 0\n" + points + "#     \n", "6", "after 3 of 4 vertices"},
      {"too many faces", file, "OFF\n3 1 0\n" + points + "3 0 1 2\n3 0 1 2\n", "7", "'3' follows"},
      {"letters behind a face", file, "OFF\n3 1 0\n" + points + "3 0 1 2 red\n", "6", "'red'"},
      {"too many values behind a face", file, "OFF\n3 1 0\n" + points + "3 0 1 2 1 1 1 1 1\n", "6", "more than four"},
  };
}

std::vector<Malformed> gzip_table() {
  const std::string good = packed(corner + "f 1 2 3\n");
  std::string damaged = good;
  damaged[good.size() - 6] = static_cast<char>(damaged[good.size() - 6] ^ 1);  // the checksum
  std::string unknown_method = good;
  unknown_method[2] = 7;
  const auto end_of = [](const std::string& bytes) { return "byte " + std::to_string(bytes.size()) + " (packed)"; };
  return {
      {"empty", "bad.obj", "", "byte 0", "empty"},
      {"magic bytes only", "bad.obj.gz", "\x1f\x8b", "byte 2 (packed)", "ends early"},
      {"truncated", "bad.obj.gz", good.substr(0, good.size() - 12), end_of(good.substr(0, good.size() - 12)),
       "ends early"},
      {"trailer missing", "bad.obj.gz", good.substr(0, good.size() - 3), end_of(good.substr(0, good.size() - 3)),
       "ends early"},
      {"wrong checksum", "bad.obj.gz", damaged, "byte " + std::to_string(good.size() - 4) + " (packed)",
       "incorrect data check"},
      {"unknown method", "bad.obj.gz", unknown_method, "byte 4 (packed)", "unknown compression method"},
      {"bytes behind the end", "bad.obj.gz", good + "more", "byte " + std::to_string(good.size()) + " (packed)",
       "after the end"},
      {"packed twice", "bad.obj.gz", packed(good), "1", "control character"},
      {"packed nothing", "bad.obj.gz", packed(""), "1", "no face"},
      {"no format", "bad", "hello\n", "1", "neither the name nor the content"},
      {"no format, binary", "bad", std::string(9, '\0'), "byte 0", "neither the name nor the content"},
  };
}

void expect_refused(const Malformed& row, const std::string& content, const std::string& place) {
  SCOPED_TRACE(std::string(row.title) + " in " + row.file);
  const auto mesh = read_content(content, row.file);
  ASSERT_FALSE(mesh.ok()) << "was accepted";
  const Error& error = mesh.error();
  EXPECT_EQ(error.file, row.file);
  EXPECT_EQ(error.place, place) << error.message();
  EXPECT_NE(error.message().find(row.word), std::string::npos) << error.message();
  EXPECT_FALSE(error.remedy.empty()) << error.message();
}

using Table = std::vector<Malformed> (*)();
class MalformedMesh : public ::testing::TestWithParam<Table> {};

TEST_P(MalformedMesh, IsRefusedAtItsPlace) {
  for (const Malformed& row : GetParam()()) expect_refused(row, row.content, row.place);
}

TEST_P(MalformedMesh, IsRefusedAtTheSamePlaceWhenPacked) {
  for (const Malformed& row : GetParam()()) {
    if (row.content.empty() || row.content.front() == '\x1f') continue;
    const bool byte = row.place.starts_with("byte");
    expect_refused(row, packed(row.content), byte ? row.place + " (unpacked)" : row.place);
  }
}

INSTANTIATE_TEST_SUITE_P(Tables, MalformedMesh,
                         ::testing::Values(obj_table, stl_table, ply_header_table, ply_data_table, off_table,
                                           gzip_table));

TEST(MalformedMeshTables, HaveAtLeastSixtyRows) {
  std::size_t rows = 0;
  for (const Table table : {obj_table, stl_table, ply_header_table, ply_data_table, off_table, gzip_table})
    rows += table().size();
  EXPECT_GE(rows, 60u);
}

TEST(ReadLimits, AreErrorsWithAPlace) {
  const std::string square = corner + "v 1 1 0\nf 1 2 3 4\n";
  struct Row {
    mesh::ReadOptions options;
    std::string content, place, word;
  };
  const std::vector<Row> rows = {
      {{.max_file_bytes = 20}, square, "byte 20", "max_file_bytes"},
      {{.max_unpacked_bytes = 20},
       packed(square),
       "byte " + std::to_string(packed(square).size()) + " (packed)",
       "max_unpacked_bytes"},
      {{.max_vertices = 3}, square, "4", "more than 3 vertices"},
      {{.max_triangles = 1}, square, "5", "more than 1 triangles"},
      {{.max_triangles = 1}, stl_claiming(2, 2), "byte 80", "more than 1 triangles"},
      {{.max_vertices = 2}, ply_header("3", "1") + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "9", "more than 2 vertices"},
      {{.max_vertices = 2}, "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "2", "more than 2 vertices"},
      {{.scale = 0}, square, "", "scale"},
      {{.scale = -1}, square, "", "scale"},
      {{.scale = std::numeric_limits<double>::quiet_NaN()}, square, "", "scale"},
      {{.scale = std::numeric_limits<double>::infinity()}, square, "", "scale"},
      {{.scale = 1e300}, "v 0 0 0\nv 1e10 0 0\n", "2", "x is not finite"},
      {{.scale = 1e10}, "v 0 0 0\nv 1e10 0 0\n", "2", "x exceeds 1e15 m"},
  };
  for (const Row& row : rows) {
    const auto mesh = read_content(row.content, row.content.starts_with("v") ? "m.obj" : "m", row.options);
    ASSERT_FALSE(mesh.ok()) << row.word;
    EXPECT_EQ(mesh.error().place, row.place) << mesh.error().message();
    EXPECT_NE(mesh.error().message().find(row.word), std::string::npos) << mesh.error().message();
  }
}

/// Cutting a file anywhere in its last tenth never yields a mesh as if nothing were missing, unless only the last
/// line's end is gone or the cut leaves a shorter file that is complete in itself (OBJ has no counts).
TEST(TruncatedMesh, IsRefusedWhereTheFormatCanTell) {
  const auto mesh = mesh::TriangleMesh::make({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2}, {0, 1, 3}});
  ASSERT_TRUE(mesh.ok());
  for (const std::string& content :
       {test::stl_binary_file(mesh.value()), test::stl_ascii_file(mesh.value()), test::off_file(mesh.value()),
        test::ply_file(mesh.value(), test::PlyEncoding::ascii),
        test::ply_file(mesh.value(), test::PlyEncoding::little_endian),
        test::ply_file(mesh.value(), test::PlyEncoding::big_endian), packed(test::obj_file(mesh.value()))}) {
    const std::string name = content.starts_with("OFF") ? "m.off" : content.starts_with("ply") ? "m.ply" : "m.stl";
    for (std::size_t size = 0; size < content.size(); ++size) {
      const auto cut = read_content(content.substr(0, size), name);
      // A last number may lose digits, and text its last line end or name.
      if (!cut.ok()) continue;
      EXPECT_GE(size + 6, content.size()) << name << " cut to " << size << " bytes";
    }
  }
}

}  // namespace
}  // namespace odds
