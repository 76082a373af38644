// Reading holds at most 10 times the file's size as stored + 64 MiB, whatever the file says or unpacks to.
#include <gtest/gtest.h>

#include "counted_memory.hpp"
#include "support/mesh_files.hpp"

namespace odds {
namespace {

constexpr std::size_t constant = std::size_t{64} << 20;

struct Outcome {
  Result<mesh::TriangleMesh> result;
  std::size_t peak;
};

Outcome measured(const std::string& content, const std::string& name) {
  fuzz::restart_peak();
  auto result = test::read_content(content, name);
  const std::size_t peak = fuzz::peak_bytes();
  EXPECT_LE(peak, 10 * content.size() + constant) << name;
  return {std::move(result), peak};
}

std::string repeated(const std::string& begin, const std::string& piece, std::size_t size,
                     const std::string& end = "") {
  std::string text = begin;
  text.reserve(size + piece.size() + end.size());
  while (text.size() < size) text += piece;
  return text + end;
}

const std::string corner = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
constexpr std::size_t mebibyte = std::size_t{1} << 20;

TEST(CountedMemory, SeesWhatIsAllocated) {
  fuzz::restart_peak();
  { const std::vector<char> block(3 * mebibyte); }
  EXPECT_GE(fuzz::peak_bytes(), 3 * mebibyte);
  EXPECT_LT(fuzz::peak_bytes(), 4 * mebibyte);
}

TEST(ReaderMemory, ClaimsOfHeadersAllocateNothing) {
  const std::string claims[] = {test::stl_claiming(0xffffffff, 1),
                                "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty "
                                "float z\nelement face 4000000000\n"
                                "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
                                "ply\nformat binary_little_endian 1.0\nelement vertex 200000000\nproperty float "
                                "x\nproperty float y\nproperty float z\n"
                                "element face 1\nproperty list uchar int vertex_indices\nend_header\n0123456789",
                                "OFF\n200000000 200000000 0\n0 0 0\n", "OFF\n1000000 1000000 0\n0 0 0\n"};
  for (const std::string& content : claims) {
    for (const std::string& file : {content, test::packed(content)}) {
      const Outcome outcome = measured(file, "claims.stl");
      EXPECT_FALSE(outcome.result.ok());
      EXPECT_LT(outcome.peak, mebibyte) << outcome.result.error().message();
    }
  }
}

TEST(ReaderMemory, PackedNothingIsReadInConstantMemory) {
  for (const std::string& piece :
       {std::string(4096, '\n'), std::string(4096, ' '), std::string(4096, 'c'), std::string(4096, '\0')}) {
    const std::string bomb = test::packed(repeated("# ", piece, 16 * mebibyte));
    ASSERT_LT(bomb.size(), 30'000u);
    for (const char* name : {"bomb.obj", "bomb.off", "bomb.stl", "bomb.ply"}) {
      const Outcome outcome = measured(bomb, name);
      EXPECT_FALSE(outcome.result.ok());
      EXPECT_LT(outcome.peak, mebibyte) << outcome.result.error().message();
    }
  }
}

TEST(ReaderMemory, PackedGeometryBeyondTheBoundIsRefused) {
  const std::string bombs[] = {repeated(corner + "f 1 2 3", " 1", 32 * mebibyte),
                               repeated("", "v 0 0 0\n", 32 * mebibyte), repeated(corner, "f 1 2 3\n", 64 * mebibyte)};
  for (const std::string& bomb : bombs) {
    const Outcome outcome = measured(test::packed(bomb), "bomb.obj");
    ASSERT_FALSE(outcome.result.ok());
    EXPECT_NE(outcome.result.error().what.find("10 times"), std::string::npos) << outcome.result.error().message();
    EXPECT_FALSE(outcome.result.error().place.empty());
    EXPECT_GT(outcome.peak, constant / 3) << "refused long before the bound";
  }
}

TEST(ReaderMemory, WellPackedMeshesAreRead) {
  // A regular surface packs to less than a hundredth.
  const std::string facet =
      "facet normal 0 0 1\n  outer loop\n    vertex 0 0 0\n    vertex 1 0 0\n    vertex 0 1 0\n  endloop\nendfacet\n";
  const std::string text = repeated("solid a\n", facet, 32 * mebibyte, "endsolid a\n");
  const std::string file = test::packed(text);
  ASSERT_LT(file.size() * 100, text.size());
  const Outcome outcome = measured(file, "packed.stl.gz");
  ASSERT_TRUE(outcome.result.ok()) << outcome.result.error().message();
  EXPECT_GT(outcome.result.value().triangles().size(), 300'000u);
}

TEST(ReaderMemory, TheDensestPlainFilesAreRead) {
  // The fewest bytes per vertex, per triangle and per corner that each format allows.
  std::string ply =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty uchar x\nproperty uchar y\nproperty uchar z\n"
      "element face 80000\nproperty list uchar uchar vertex_indices\nend_header\n" +
      std::string("\0\0\0\1\0\0\0\1\0", 9);
  for (int i = 0; i < 80'000; ++i) ply += "\xff" + std::string(255, '\1');
  std::string off = "OFF\n3 1000000 0\n0 0 0\n1 0 0\n0 1 0\n" + repeated("", "3 0 1 2\n", 8'000'000);
  const std::string files[] = {repeated(corner + "f 1 2 3", " 1", 24 * mebibyte),
                               repeated(corner, "v 0 0 0\n", 16 * mebibyte, "f 1 2 3\n"),
                               repeated(corner, "f 1 2 3\n", 16 * mebibyte), off};
  for (const std::string& file : files) {
    const Outcome outcome = measured(file, "dense.obj");
    EXPECT_TRUE(outcome.result.ok()) << outcome.result.error().message();
  }
  // 12 bytes of triangle for one byte of index: no sensible mesh, and over the bound.
  const Outcome outcome = measured(ply, "dense.ply");
  ASSERT_FALSE(outcome.result.ok());
  EXPECT_NE(outcome.result.error().what.find("10 times"), std::string::npos) << outcome.result.error().message();
}

TEST(ReaderMemory, AMillionTrianglesOfStlAreRead) {
  std::string file = test::stl_claiming(1'000'000, 0);
  for (int i = 0; i < 1'000'000; ++i) {
    const float x = static_cast<float>(i / 1000);
    const float y = static_cast<float>(i % 1000);
    for (const float value : {0.f, 0.f, 1.f, x, y, 0.f, x + 1, y, 0.f, x, y + 1, 0.f}) file += test::bytes_of(value);
    file += std::string(2, '\0');
  }
  const Outcome outcome = measured(file, "million.stl");
  ASSERT_TRUE(outcome.result.ok()) << outcome.result.error().message();
  EXPECT_EQ(outcome.result.value().triangles().size(), 1'000'000u);
  EXPECT_EQ(outcome.result.value().vertices().size(), 1'000'000u + 2000u);
}

}  // namespace
}  // namespace odds
