// Mesh data: building from arrays with strides, adopting a dTriMesh, errors.
#include <cmath>
#include <cstring>
#include <limits>

#include "ode/ode_fixture.hpp"

namespace odds::test {
namespace {

constexpr double tetrahedron_vertices[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
constexpr dTriIndex tetrahedron_indices[] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
constexpr int index_size = static_cast<int>(sizeof(dTriIndex));

struct DataOwner {
  oddsMeshDataID id = oddsMeshDataCreate();
  ~DataOwner() { oddsMeshDataDestroy(id); }
};

class MeshData : public OdeTest {
 protected:
  DataOwner data;
  [[nodiscard]] std::string last_error() const { return oddsGetLastError(); }
};

TEST_F(MeshData, BuildsFromDoubles) {
  ASSERT_EQ(
      oddsMeshDataBuildDouble(data.id, tetrahedron_vertices, 24, 4, tetrahedron_indices, 12, 3 * index_size, nullptr),
      1)
      << last_error();
  EXPECT_EQ(oddsMeshDataGetTriangleCount(data.id), 4);
  EXPECT_EQ(oddsMeshDataIsClosed(data.id), 1);
}

TEST_F(MeshData, StridesAreInBytesForBothArrays) {
  struct WideVertex {
    float position[3];
    float texture[2];
  };
  struct WideTriangle {
    dTriIndex corner[3];
    std::uint32_t material;
  };
  WideVertex vertices[4];
  WideTriangle triangles[4];
  for (int i = 0; i < 4; ++i) {
    for (int k = 0; k < 3; ++k) {
      vertices[i].position[k] = static_cast<float>(tetrahedron_vertices[3 * i + k]);
      triangles[i].corner[k] = tetrahedron_indices[3 * i + k];
    }
    vertices[i].texture[0] = vertices[i].texture[1] = std::numeric_limits<float>::quiet_NaN();
    triangles[i].material = 0xffffffff;
  }
  ASSERT_EQ(oddsMeshDataBuildSingle(data.id, vertices[0].position, sizeof(WideVertex), 4, triangles[0].corner, 12,
                                    sizeof(WideTriangle), nullptr),
            1)
      << last_error();
  const dGeomID geom = dCreateOddsMesh(space, data.id);
  dReal aabb[6];
  dGeomGetAABB(geom, aabb);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(aabb[2 * axis], 0.0, 1e-12);
    EXPECT_NEAR(aabb[2 * axis + 1], 1.0, 1e-12);
  }
}

TEST_F(MeshData, OpenMeshIsNotClosed) {
  ASSERT_EQ(
      oddsMeshDataBuildDouble(data.id, tetrahedron_vertices, 24, 4, tetrahedron_indices, 9, 3 * index_size, nullptr),
      1);
  EXPECT_EQ(oddsMeshDataIsClosed(data.id), 0);
}

TEST_F(MeshData, ASheetWithBothItsSidesEnclosesNothing) {
  const dTriIndex both_sides[] = {0, 1, 2, 0, 2, 1};
  ASSERT_EQ(oddsMeshDataBuildDouble(data.id, tetrahedron_vertices, 24, 4, both_sides, 6, 3 * index_size, nullptr), 1);
  EXPECT_EQ(oddsMeshDataIsClosed(data.id), 0);
}

TEST_F(MeshData, ClosedThoughVerticesAreRepeatedAsInStl) {
  double corners[36];
  dTriIndex indices[12];
  for (int i = 0; i < 12; ++i) {
    indices[i] = static_cast<dTriIndex>(i);
    std::memcpy(corners + 3 * i, tetrahedron_vertices + 3 * tetrahedron_indices[i], 24);
  }
  ASSERT_EQ(oddsMeshDataBuildDouble(data.id, corners, 24, 12, indices, 12, 3 * index_size, nullptr), 1);
  EXPECT_EQ(oddsMeshDataIsClosed(data.id), 1);
}

TEST_F(MeshData, BadInputIsRefusedWithASentenceAndKeepsWhatWasThere) {
  ASSERT_EQ(
      oddsMeshDataBuildDouble(data.id, tetrahedron_vertices, 24, 4, tetrahedron_indices, 12, 3 * index_size, nullptr),
      1);
  const dTriIndex out_of_range[] = {0, 1, 4};
  EXPECT_EQ(oddsMeshDataBuildDouble(data.id, tetrahedron_vertices, 24, 4, out_of_range, 3, 3 * index_size, nullptr), 0);
  EXPECT_NE(last_error().find("index 4 is out of range"), std::string::npos) << last_error();

  double with_nan[12];
  std::memcpy(with_nan, tetrahedron_vertices, sizeof with_nan);
  with_nan[4] = std::numeric_limits<double>::quiet_NaN();
  oddsBuildParams params;
  oddsBuildParamsInit(&params);
  params.name = "blade";
  EXPECT_EQ(oddsMeshDataBuildDouble(data.id, with_nan, 24, 4, tetrahedron_indices, 12, 3 * index_size, &params), 0);
  EXPECT_NE(last_error().find("blade"), std::string::npos) << last_error();
  EXPECT_NE(last_error().find("not finite"), std::string::npos) << last_error();

  EXPECT_EQ(
      oddsMeshDataBuildDouble(data.id, tetrahedron_vertices, 8, 4, tetrahedron_indices, 12, 3 * index_size, nullptr),
      0);
  EXPECT_NE(last_error().find("bytes"), std::string::npos) << last_error();
  EXPECT_EQ(
      oddsMeshDataBuildDouble(data.id, tetrahedron_vertices, 24, 4, tetrahedron_indices, 11, 3 * index_size, nullptr),
      0);
  EXPECT_EQ(oddsMeshDataBuildDouble(data.id, nullptr, 24, 4, tetrahedron_indices, 12, 3 * index_size, nullptr), 0);
  EXPECT_EQ(
      oddsMeshDataBuildDouble(nullptr, tetrahedron_vertices, 24, 4, tetrahedron_indices, 12, 3 * index_size, nullptr),
      0);
  params.leaf_triangles = 17;
  EXPECT_EQ(
      oddsMeshDataBuildDouble(data.id, tetrahedron_vertices, 24, 4, tetrahedron_indices, 12, 3 * index_size, &params),
      0);
  EXPECT_NE(last_error().find("leaf_triangles"), std::string::npos) << last_error();
  EXPECT_EQ(oddsMeshDataGetTriangleCount(data.id), 4);
}

TEST_F(MeshData, UnbuiltDataMakesNoGeom) {
  EXPECT_EQ(dCreateOddsMesh(space, data.id), nullptr);
  EXPECT_NE(last_error().find("not built"), std::string::npos) << last_error();
}

TEST_F(MeshData, GeomsOutliveTheContainer) {
  const SlowLooks no_time_passes(0);
  oddsMeshDataID other = oddsMeshDataCreate();
  ASSERT_EQ(
      oddsMeshDataBuildDouble(other, tetrahedron_vertices, 24, 4, tetrahedron_indices, 12, 3 * index_size, nullptr), 1);
  const dGeomID geom = dCreateOddsMesh(space, other);
  oddsMeshDataDestroy(other);
  const dGeomID plane = dCreatePlane(space, 0, 0, 1, 0.25);
  EXPECT_EQ(collide(geom, plane).size(), 3u);
}

class AdoptedTriMesh : public MeshData {};

TEST_F(AdoptedTriMesh, KeepsTrianglesInTheirOwnFrameAndWeldsCorners) {
  const dTriMeshDataID source = dGeomTriMeshDataCreate();
  dGeomTriMeshDataBuildDouble(source, tetrahedron_vertices, 24, 4, tetrahedron_indices, 12, 3 * index_size);
  const dGeomID trimesh = dCreateTriMesh(space, source, nullptr, nullptr, nullptr);
  dGeomSetPosition(trimesh, 5, 6, 7);
  rotate(trimesh, Vec3(1, 2, 3), 0.7);
  ASSERT_EQ(oddsMeshDataBuildFromTriMesh(data.id, trimesh, nullptr), 1) << last_error();
  EXPECT_EQ(oddsMeshDataGetTriangleCount(data.id), 4);
  EXPECT_EQ(oddsMeshDataIsClosed(data.id), 1);
  const dGeomID geom = dCreateOddsMesh(space, data.id);
  dReal aabb[6];
  dGeomGetAABB(geom, aabb);
  EXPECT_NEAR(aabb[0], 0.0, 1e-12);
  EXPECT_NEAR(aabb[1], 1.0, 1e-12);
  dGeomDestroy(trimesh);
  dGeomTriMeshDataDestroy(source);
}

TEST_F(AdoptedTriMesh, AnyOtherGeomIsRefused) {
  const dGeomID sphere = dCreateSphere(space, 1);
  EXPECT_EQ(oddsMeshDataBuildFromTriMesh(data.id, sphere, nullptr), 0);
  EXPECT_EQ(oddsMeshDataBuildFromTriMesh(data.id, nullptr, nullptr), 0);
  EXPECT_NE(last_error().find("dTriMesh"), std::string::npos);
}

}  // namespace
}  // namespace odds::test
