// STL: ascii and binary told apart, positions welded exactly.
#include <gtest/gtest.h>

#include <sstream>

#include "odds/mesh/write.hpp"
#include "support/mesh_files.hpp"

namespace odds {
namespace {

using mesh::Triangle;
using mesh::TriangleMesh;
using test::read_content;

TriangleMesh read_stl(const std::string& content, const std::string& name = "m.stl") {
  auto mesh = read_content(content, name);
  EXPECT_TRUE(mesh.ok()) << mesh.error().message();
  return std::move(mesh).value();
}

const std::string facet =
    "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";

TEST(ReadStl, WeldsEqualPositionsInOrderOfAppearance) {
  const TriangleMesh mesh = read_stl("solid a\n" + facet +
                                     "facet normal 0 0 1\nouter loop\nvertex 1 0 0\nvertex 1 1 0\nvertex -0 1 -0.0\n"
                                     "endloop\nendfacet\nendsolid a\n");
  ASSERT_EQ(mesh.vertices().size(), 4u);
  EXPECT_EQ(mesh.triangles()[0], (Triangle{0, 1, 2}));
  EXPECT_EQ(mesh.triangles()[1], (Triangle{1, 3, 2})) << "-0 equals 0";
}

TEST(ReadStl, DoesNotWeldNeighbouringDoubles) {
  const TriangleMesh mesh = read_stl(
      "solid\nfacet normal nan nan nan\nouter loop\nvertex 1 0 0\nvertex 1.0000000000000002 0 0\nvertex 0 0 "
      "0\nendloop\n"
      "endfacet\nendsolid\n");
  EXPECT_EQ(mesh.vertices().size(), 3u);
}

TEST(ReadStl, ReadsSeveralSolidsAndAnyCase) {
  const TriangleMesh mesh = read_stl("solid a facet b\n" + facet +
                                     "endsolid a\n\nSOLID\r\n  FACET NORMAL 0 0 1 OUTER LOOP VERTEX 5 0 0 VERTEX 6 0 "
                                     "0 VERTEX 5 1 0 ENDLOOP ENDFACET\r\nENDSOLID\r\n");
  EXPECT_EQ(mesh.triangles().size(), 2u);
  EXPECT_EQ(mesh.vertices().size(), 6u);
}

TEST(ReadStl, RecognisesBinaryFilesThatBeginWithSolid) {
  EXPECT_EQ(read_stl(test::stl_claiming(3, 3, "solid from a CAD system")).triangles().size(), 3u);
  EXPECT_EQ(read_stl(test::stl_claiming(3, 3, "solid from a CAD system" + std::string(57, ' '))).triangles().size(),
            3u);
  EXPECT_EQ(read_stl(test::stl_claiming(1, 1, "OFF"), "without_extension").triangles().size(), 1u);
  EXPECT_EQ(read_stl(test::packed(test::stl_claiming(2, 2, "solid")), "packed").triangles().size(), 2u);
}

TEST(ReadStl, WeldsManyTriangles) {
  // A grid of n x n squares: (n + 1)^2 positions, each named up to six times.
  constexpr int n = 60;
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const auto first = static_cast<std::uint32_t>(vertices.size());
      for (const auto& [di, dj] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}})
        vertices.emplace_back(0.1f * float(i + di), 0.3f * float(j + dj), 0);
      triangles.push_back({first, first + 1, first + 2});
      triangles.push_back({first, first + 2, first + 3});
    }
  }
  const auto soup = TriangleMesh::make(vertices, triangles);
  ASSERT_TRUE(soup.ok());
  const TriangleMesh welded = read_stl(test::stl_binary_file(soup.value()));
  EXPECT_EQ(welded.vertices().size(), std::size_t{(n + 1) * (n + 1)});
  ASSERT_EQ(welded.triangles().size(), triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t c = 0; c < 3; ++c)
      ASSERT_EQ(welded.vertices()[welded.triangles()[t][c]], vertices[triangles[t][c]]);
  }
}

TEST(WriteStl, StoresUnitNormals) {
  const auto mesh = TriangleMesh::make({{0, 0, 0}, {1e-200, 0, 0}, {0, 1e-200, 0}, {5, 0, 0}}, {{0, 1, 2}, {0, 3, 3}});
  ASSERT_TRUE(mesh.ok());
  const std::string file = test::stl_binary_file(mesh.value());
  ASSERT_EQ(file.size(), 84u + 100u);
  EXPECT_EQ(file.substr(84, 12), test::bytes_of(0.f) + test::bytes_of(0.f) + test::bytes_of(1.f));
  EXPECT_EQ(file.substr(134, 12), test::bytes_of(0.f) + test::bytes_of(0.f) + test::bytes_of(0.f)) << "degenerate";
}

}  // namespace
}  // namespace odds
