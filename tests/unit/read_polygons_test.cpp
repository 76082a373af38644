// Polygons of files, cut into triangles: those that are not convex are covered once, and nothing beyond them.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "odds/math/random.hpp"
#include "odds/mesh/faults.hpp"
#include "support/mesh_files.hpp"

namespace odds {
namespace {

using mesh::Triangle;
using mesh::TriangleMesh;
using test::read_content;

TriangleMesh read(const std::string& text, const std::string& name) {
  auto mesh = read_content(text, name);
  EXPECT_TRUE(mesh.ok()) << mesh.error().message();
  return std::move(mesh).value();
}

std::string vertex_lines(const std::vector<Vec3>& corners) {
  std::string text;
  for (const Vec3& c : corners) {
    text += "v " + std::to_string(c.x()) + " " + std::to_string(c.y()) + " " + std::to_string(c.z()) + "\n";
  }
  return text;
}

/// "f 1 2 ... n", begun at corner `begin`.
std::string face_line(std::size_t corners, std::size_t begin = 0) {
  std::string text = "f";
  for (std::size_t i = 0; i < corners; ++i) text += " " + std::to_string((begin + i) % corners + 1);
  return text + "\n";
}

Vec3 twice_area(const TriangleMesh& mesh, const Triangle& t) {
  const std::span<const Vec3> v = mesh.vertices();
  return (v[t[1]] - v[t[0]]).cross(v[t[2]] - v[t[0]]);
}

/// Twice the area vector of the polygon itself, by the shoelace formula.
Vec3 twice_area(const std::vector<Vec3>& corners) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < corners.size(); ++i) sum += corners[i].cross(corners[(i + 1) % corners.size()]);
  return sum;
}

/// All triangles face as the polygon does, and their areas add up to its: they cover it, once, and nothing else.
void expect_covered(const TriangleMesh& mesh, const std::vector<Vec3>& corners) {
  EXPECT_EQ(mesh.triangles().size(), corners.size() - 2);
  const Vec3 whole = twice_area(corners);
  double sum = 0.0;
  for (const Triangle& t : mesh.triangles()) {
    EXPECT_GT(twice_area(mesh, t).dot(whole), 0.0);
    sum += twice_area(mesh, t).norm();
  }
  EXPECT_NEAR(sum, whole.norm(), 1e-9 * whole.norm());
}

const std::vector<Vec3> l_shape = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}};

TEST(ReadPolygons, AnLShapeIsCoveredFromWhicheverCornerItBegins) {
  for (std::size_t begin = 0; begin < l_shape.size(); ++begin) {
    expect_covered(read(vertex_lines(l_shape) + face_line(l_shape.size(), begin), "m.obj"), l_shape);
  }
}

TEST(ReadPolygons, ADartIsCutAtItsInnerCorner) {
  const std::vector<Vec3> dart = {{0, 0, 0}, {2, -1, 0}, {0.5, 0, 0}, {2, 1, 0}};
  for (std::size_t begin = 0; begin < dart.size(); ++begin) {
    expect_covered(read(vertex_lines(dart) + face_line(dart.size(), begin), "m.obj"), dart);
  }
}

TEST(ReadPolygons, NoTriangleIsFlatWhereACornerLiesOnASide) {
  const std::vector<Vec3> shape = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}};
  for (const std::size_t begin : {2U, 5U}) {  // where the fan folds
    expect_covered(read(vertex_lines(shape) + face_line(shape.size(), begin), "m.obj"), shape);
  }
}

TEST(ReadPolygons, FacesInFrontOfTheirVerticesToo) {
  expect_covered(read(face_line(l_shape.size(), 1) + vertex_lines(l_shape), "m.obj"), l_shape);
  expect_covered(
      read("ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_indices\nelement vertex 6\n"
           "property float x\nproperty float y\nproperty float z\nend_header\n6 1 2 3 4 5 0\n"
           "0 0 0\n2 0 0\n2 1 0\n1 1 0\n1 2 0\n0 2 0\n",
           "m.ply"),
      l_shape);
}

TEST(ReadPolygons, InEveryFormatThatHasThem) {
  const std::string vertices = "0 0 0\n2 0 0\n2 1 0\n1 1 0\n1 2 0\n0 2 0\n";
  expect_covered(read("OFF\n6 1 0\n" + vertices + "6 1 2 3 4 5 0\n", "m.off"), l_shape);
  expect_covered(read("ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n"
                      "element face 1\nproperty list uchar int vertex_indices\nend_header\n" +
                          vertices + "6 1 2 3 4 5 0\n",
                      "m.ply"),
                 l_shape);
}

TEST(ReadPolygons, ARingWithASlitIsCovered) {
  // As programs write a face with a hole: the outline, to the hole, round it the other way, and back.
  const std::vector<Vec3> ring = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {0, 0, 0},
                                  {1, 1, 0}, {1, 3, 0}, {3, 3, 0}, {3, 1, 0}, {1, 1, 0}};
  for (std::size_t begin = 0; begin < ring.size(); ++begin) {
    expect_covered(read(vertex_lines(ring) + face_line(ring.size(), begin), "m.obj"), ring);
  }
}

TEST(ReadPolygons, ManyCornersInAnyPlane) {
  math::Random random(7);
  for (int trial = 0; trial < 200; ++trial) {
    const std::size_t count = 5 + random.below(60);
    const Vec3 normal = random.direction();
    const Vec3 u = normal.unitOrthogonal();
    const Vec3 v = normal.cross(u);
    const Vec3 middle = random.uniform(0.0, 8.0) * random.direction();
    std::vector<Vec3> corners;
    for (std::size_t i = 0; i < count; ++i) {  // a star about the middle
      const double angle = 2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(count);
      corners.push_back(middle + random.uniform(0.2, 3.0) * (std::cos(angle) * u + std::sin(angle) * v));
    }
    const TriangleMesh mesh = read(vertex_lines(corners) + face_line(count), "m.obj");
    EXPECT_EQ(mesh.triangles().size(), count - 2);
    double sum = 0.0;
    for (const Triangle& t : mesh.triangles()) sum += twice_area(mesh, t).norm();
    const double whole = twice_area(corners).norm();
    EXPECT_NEAR(sum, whole, 1e-3 * whole) << trial;  // six digits of a number that may lie 8 m off
  }
}

/// Each step has a corner that turns inwards.
std::vector<Vec3> stair(int steps) {
  std::vector<Vec3> corners;
  for (int i = 0; i < steps; ++i) {
    corners.push_back({1.0 * i, 1.0 * i, 0});
    corners.push_back({1.0 * i + 1.0, 1.0 * i, 0});
  }
  corners.push_back({0, 1.0 * steps, 0});
  return corners;
}

TEST(ReadPolygons, AStairOfThousandsOfCornersIsCovered) {
  const std::vector<Vec3> corners = stair(3000);
  expect_covered(read(vertex_lines(corners) + face_line(corners.size()), "m.obj"), corners);
}

TEST(ReadPolygons, WhatNoTimeIsLeftForKeepsItsFan) {
  // Cutting takes the square of the number of corners: a file could ask for hours.
  const std::vector<Vec3> corners = stair(50'000);
  const TriangleMesh mesh = read(vertex_lines(corners) + face_line(corners.size(), 1) + "f 1 2 4 3\n", "m.obj");
  ASSERT_EQ(mesh.triangles().size(), corners.size());
  EXPECT_EQ(mesh.triangles()[7], (Triangle{1, 9, 10}));
}

TEST(ReadPolygons, AConvexOneStaysAFan) {
  const std::vector<Vec3> corners = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}};
  const TriangleMesh mesh = read(vertex_lines(corners) + face_line(corners.size()), "m.obj");
  ASSERT_EQ(mesh.triangles().size(), 3U);
  EXPECT_EQ(mesh.triangles()[0], (Triangle{0, 1, 2}));
  EXPECT_EQ(mesh.triangles()[1], (Triangle{0, 2, 3}));
  EXPECT_EQ(mesh.triangles()[2], (Triangle{0, 3, 4}));
}

TEST(ReadPolygons, ABowTieKeepsItsFan) {
  const std::vector<Vec3> corners = {{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}};
  EXPECT_EQ(read(vertex_lines(corners) + face_line(corners.size()), "m.obj").triangles().size(), 2U);
}

}  // namespace
}  // namespace odds
