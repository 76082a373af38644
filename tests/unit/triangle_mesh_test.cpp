#include "odds/mesh/triangle_mesh.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace odds::mesh {
namespace {

const std::vector<Vec3> corner = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}};

TEST(TriangleMesh, KeepsWhatItWasGiven) {
  const auto mesh = TriangleMesh::make(corner, {{0, 1, 2}}, "corner");
  ASSERT_TRUE(mesh.ok());
  EXPECT_EQ(mesh.value().triangles().size(), 1u);
  EXPECT_EQ(mesh.value().upper(), Vec3(1, 2, 0));
  EXPECT_DOUBLE_EQ(mesh.value().size(), std::sqrt(5.0));
}

TEST(TriangleMesh, RefusesAnEmptyMesh) { EXPECT_FALSE(TriangleMesh::make(corner, {}).ok()); }

TEST(TriangleMesh, NamesTheTriangleWithABadIndex) {
  const auto mesh = TriangleMesh::make(corner, {{0, 1, 2}, {0, 1, 3}}, "bad.obj");
  ASSERT_FALSE(mesh.ok());
  EXPECT_EQ(mesh.error().message(),
            "bad.obj:triangle 1: vertex index 3 is out of range (the mesh has 3 vertices); correct the face");
}

TEST(TriangleMesh, RefusesNonFiniteAndHugeCoordinates) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e16}) {
    EXPECT_FALSE(TriangleMesh::make({{0, 0, 0}, {1, 0, 0}, {0, bad, 0}}, {{0, 1, 2}}).ok());
  }
}

}  // namespace
}  // namespace odds::mesh
