// The large flat faces of a mesh do not depend on how it is cut into triangles.
#include "mesh/flat_faces.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <string>

#include "odds/math/pose.hpp"
#include "odds/math/random.hpp"
#include "odds/mesh/made/by_name.hpp"
#include "support/shapes.hpp"

namespace odds::mesh {
namespace {

TriangleMesh made_mesh(const std::string& name) { return std::move(made::make_shape(name)).value(); }

/// The same surface somewhere else, each triangle with corners of its own, as files of single precision have it.
TriangleMesh as_in_a_file(const TriangleMesh& mesh, const math::Pose& pose) {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
  for (const Triangle& t : mesh.triangles()) {
    const auto first = static_cast<std::uint32_t>(vertices.size());
    for (const std::uint32_t v : t) vertices.push_back((pose * mesh.vertices()[v]).cast<float>().cast<double>());
    triangles.push_back({first, first + 1, first + 2});
  }
  return std::move(TriangleMesh::make(std::move(vertices), std::move(triangles), "rounded")).value();
}

double area_of(const FlatFace& face) {
  Vec3 twice = Vec3::Zero();
  for (std::size_t i = 2; i < face.corner_count; ++i) {
    twice += (face.corner[i - 1] - face.corner[0]).cross(face.corner[i] - face.corner[0]);
  }
  return 0.5 * face.normal.dot(twice);
}

TEST(FlatFaces, OfABoxAreSixHoweverItIsCut) {
  math::Pose pose;
  pose.rotation = Eigen::AngleAxisd(1.0, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  pose.translation = {0.3, -0.2, 0.1};
  for (const int cells : {1, 2, 8, 11}) {
    const TriangleMesh box = made_mesh("made:box:x=0.2,y=0.5,z=0.248,cells=" + std::to_string(cells));
    for (const bool rounded : {false, true}) {
      const math::Pose at = rounded ? pose : math::Pose{};
      const std::vector<FlatFace> faces = find_flat_faces(rounded ? as_in_a_file(box, pose) : box);
      ASSERT_EQ(faces.size(), 6U) << cells << rounded;
      EXPECT_NEAR(area_of(faces[0]), 0.5 * 0.248, 1e-6);
      EXPECT_NEAR(area_of(faces[5]), 0.2 * 0.248, 1e-6);
      for (const FlatFace& face : faces) {
        EXPECT_EQ(face.corner_count, 4U);
        EXPECT_GT(area_of(face), 0.0) << "counter-clockwise, seen from outside";
        EXPECT_GT(face.normal.dot(face.centre - at.translation), 0.0) << "outwards";
        EXPECT_NEAR(face.normal.dot(face.centre), face.offset, 1e-7);
        for (const Vec3& corner : face.corners()) EXPECT_LE((corner - face.centre).norm(), face.radius);
        const Vec3 local = at.inverse().rotation * face.normal;
        EXPECT_NEAR(local.cwiseAbs().maxCoeff(), 1.0, 1e-6);
      }
    }
  }
}

TEST(FlatFaces, OfARoundBodyAreNone) {
  EXPECT_TRUE(find_flat_faces(*testing::wavy_sphere(20)).empty());
  EXPECT_TRUE(find_flat_faces(made_mesh("made:torus_knot:along=200,across=12")).empty());
  EXPECT_TRUE(find_flat_faces(made_mesh("made:terrain:cells=30")).empty());
}

TEST(FlatFaces, ARingIsNone) {
  // The two sides of the plate have a hole; its rim has four faces, the hole itself facets.
  const std::vector<FlatFace> faces = find_flat_faces(made_mesh("made:plate_with_hole"));
  for (const FlatFace& face : faces) EXPECT_LT(std::abs(face.normal.z()), 0.5);
  EXPECT_GE(faces.size(), 4U);
}

TEST(FlatFaces, TheEndOfAPegIsAPolygonWithinIt) {
  constexpr double radius = 0.01;
  const std::vector<FlatFace> faces = find_flat_faces(made_mesh("made:peg:radius=0.01,length=0.02,around=64"));
  const auto top = std::find_if(faces.begin(), faces.end(), [](const FlatFace& f) { return f.normal.z() > 0.99; });
  ASSERT_NE(top, faces.end());
  EXPECT_EQ(top->corner_count, FlatFace::most_corners);
  const double disc = std::numbers::pi * radius * radius;
  EXPECT_LT(area_of(*top), disc);
  EXPECT_GT(area_of(*top), 0.87 * disc) << "an octagon has 0.9 of its circle";
  for (const Vec3& corner : top->corners()) {
    EXPECT_NEAR(corner.z(), 0.02, 1e-12);
    EXPECT_LE(corner.head<2>().norm(), radius * (1.0 + 1e-12));
  }
  EXPECT_GT(top->beyond, 0.05 * radius) << "the arc over a side of an octagon";
  EXPECT_LT(top->beyond, 0.2 * radius);
  for (const FlatFace& face : find_flat_faces(made_mesh("made:box:cells=3"))) {
    EXPECT_LT(face.beyond, 1e-12);
  }
}

TEST(FlatFaces, ASlightBendDividesAFace) {
  // Two squares that meet at an angle: below what counts as flat they are one face, above it two.
  const auto bent = [](double lift) {
    std::vector<Vec3> v = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, lift}, {2, 1, lift}};
    std::vector<Triangle> t = {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}};
    return std::move(TriangleMesh::make(std::move(v), std::move(t), "bent")).value();
  };
  EXPECT_EQ(find_flat_faces(bent(0.0)).size(), 1U);
  EXPECT_EQ(find_flat_faces(bent(1e-7)).size(), 1U);
  EXPECT_EQ(find_flat_faces(bent(1e-3)).size(), 2U);
}

TEST(FlatFaces, DegenerateTrianglesDoNoHarm) {
  std::vector<Vec3> v = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 0}};
  std::vector<Triangle> t = {{0, 1, 2}, {0, 2, 3}, {0, 4, 2}, {1, 1, 2}, {0, 0, 0}};
  const auto mesh = std::move(TriangleMesh::make(std::move(v), std::move(t), "slit")).value();
  for (const FlatFace& face : find_flat_faces(mesh)) {
    EXPECT_TRUE(face.normal.allFinite() && face.centre.allFinite());
    EXPECT_NEAR(area_of(face), 1.0, 1e-9);
  }
}

}  // namespace
}  // namespace odds::mesh
