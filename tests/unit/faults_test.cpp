#include "odds/mesh/faults.hpp"

#include <gtest/gtest.h>

#include "odds/math/random.hpp"
#include "odds/mesh/enclosed_volume.hpp"
#include "odds/mesh/made/box.hpp"
#include "odds/mesh/made/by_name.hpp"
#include "odds/mesh/made/plates.hpp"
#include "odds/mesh/repair.hpp"

namespace odds::mesh {
namespace {

TriangleMesh mesh_of(std::vector<Vec3> vertices, std::vector<Triangle> triangles) {
  return TriangleMesh::make(std::move(vertices), std::move(triangles)).value();
}

const std::vector<Vec3> tetrahedron = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
const std::vector<Triangle> tetrahedron_faces = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};

/// Every triangle with its own three vertices, as in STL files.
TriangleMesh soup_of(const TriangleMesh& mesh) {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
  for (const Triangle& t : mesh.triangles()) {
    const auto first = static_cast<std::uint32_t>(vertices.size());
    for (const std::uint32_t i : t) vertices.push_back(mesh.vertices()[i]);
    triangles.push_back({first, first + 1, first + 2});
  }
  return mesh_of(vertices, triangles);
}

TEST(ZeroArea, IsExactWhereRoundingWouldDecideWrongly) {
  EXPECT_TRUE(has_zero_area({0, 0, 0}, {1, 1, 1}, {3, 3, 3}));
  EXPECT_TRUE(has_zero_area({0.1, 0.2, 0.3}, {0.1, 0.2, 0.3}, {1, 2, 3}));
  EXPECT_FALSE(has_zero_area({0, 0, 0}, {1, 0, 0}, {0, 1e-300, 0}));
  // Near 1e15 the cross product in doubles is dominated by its error; the points are one unit in the last place off a
  // line.
  const double big = 1e15;
  EXPECT_TRUE(has_zero_area({big, big, 0}, {big - 1, big - 1, 0}, {big - 3, big - 3, 0}));
  EXPECT_FALSE(has_zero_area({big, big, 0}, {big - 1, big - 1, 0}, {big - 3, big - 3.125, 0}));
  // (0.1, 0.1), (0.2, 0.2), (0.3, 0.3) lie on the diagonal exactly; moving one coordinate by its last bit leaves it.
  EXPECT_TRUE(has_zero_area({0.1, 0.1, 7}, {0.2, 0.2, 7}, {0.3, 0.3, 7}));
  EXPECT_FALSE(has_zero_area({0.1, 0.1, 7}, {0.2, 0.2, 7}, {0.3, std::nextafter(0.3, 1.0), 7}));
  // 3 * 0.1, 3 * 0.2 and 3 * 0.3 round differently: the points are off the line by the rounding and nothing else.
  EXPECT_FALSE(has_zero_area({0.1, 3 * 0.1, 0}, {0.2, 3 * 0.2, 0}, {0.3, 3 * 0.3, 0}));
  EXPECT_FALSE(has_zero_area({0, 0, 0}, {3e-200, 0, 0}, {0, 2e-200, 1e-200}));
  EXPECT_TRUE(has_zero_area({0, 0, 0}, {3e-200, 6e-200, 0}, {6e-200, 1.2e-199, 0}));
  EXPECT_FALSE(has_zero_area({0, 0, 0}, {0, 1e-200, 0}, {1e-200, 1, 0}));
}

TEST(Faults, ACleanBoxHasNoneWhetherIndicesAreSharedOrNot) {
  const TriangleMesh box = made::make(made::Box{.x = 1, .y = 2, .z = 3, .cells = 3}).value();
  for (const TriangleMesh& mesh : {box, soup_of(box)}) {
    const Faults faults = find_faults(mesh);
    EXPECT_TRUE(faults.closed);
    EXPECT_TRUE(faults.manifold);
    EXPECT_TRUE(faults.orientable);
    EXPECT_TRUE(faults.clean());
    EXPECT_EQ(faults.components, 1u);
    EXPECT_NEAR(faults.area, 22.0, 1e-12);
    ASSERT_TRUE(faults.volume.has_value());
    EXPECT_NEAR(*faults.volume, 6.0, 1e-12);
  }
  EXPECT_EQ(find_faults(box).duplicate_vertex.count, 0u);
  EXPECT_EQ(find_faults(soup_of(box)).duplicate_vertex.count, 3 * box.triangles().size() - box.vertices().size());
}

TEST(Faults, NamesWhatIsWrong) {
  auto vertices = tetrahedron;
  vertices.push_back({-0.0, 0, 0});  // equals vertex 0, for 0 == -0
  vertices.push_back({9, 9, 9});     // unused
  vertices.push_back({0.5, 0, 0});
  auto faces = tetrahedron_faces;
  faces.push_back({1, 4, 2});  // the first face again, turned and by another index
  faces.push_back({0, 6, 1});  // on a line
  faces.push_back({0, 4, 3});  // two corners at one place
  const Faults faults = find_faults(mesh_of(vertices, faces));
  EXPECT_EQ(faults.duplicate.examples, std::vector<std::uint32_t>({4}));
  EXPECT_EQ(faults.degenerate.examples, std::vector<std::uint32_t>({5, 6}));
  EXPECT_EQ(faults.unused_vertex.examples, std::vector<std::uint32_t>({5}));
  EXPECT_EQ(faults.duplicate_vertex.examples, std::vector<std::uint32_t>({4}));
  EXPECT_FALSE(faults.manifold);
  EXPECT_FALSE(faults.clean());
}

TEST(Faults, AHoleIsABoundary) {
  const Faults faults = find_faults(mesh_of(tetrahedron, {tetrahedron_faces.begin(), tetrahedron_faces.end() - 1}));
  EXPECT_FALSE(faults.closed);
  EXPECT_TRUE(faults.manifold);
  EXPECT_EQ(faults.boundary.count, 3u);
  EXPECT_EQ(faults.boundary.examples.front(), (Edge{0, 2}));
  EXPECT_FALSE(faults.volume.has_value());
}

TEST(Faults, ATurnedTriangleIsInconsistentButOrientable) {
  auto faces = tetrahedron_faces;
  std::swap(faces[2][0], faces[2][1]);
  const Faults faults = find_faults(mesh_of(tetrahedron, faces));
  EXPECT_TRUE(faults.orientable);
  EXPECT_EQ(faults.inconsistent.count, 3u);
  EXPECT_FALSE(faults.volume.has_value());
}

TEST(Faults, AMoebiusStripIsNotOrientable) {
  std::vector<Vec3> vertices;
  std::vector<Triangle> faces;
  constexpr std::uint32_t count = 12;
  for (std::uint32_t i = 0; i < count; ++i) {
    const double angle = 2.0 * 3.14159265358979 * i / count;
    for (const double side : {-0.3, 0.3}) {
      const double r = 1.0 + side * std::cos(0.5 * angle);
      vertices.push_back({r * std::cos(angle), r * std::sin(angle), side * std::sin(0.5 * angle)});
    }
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t a = 2 * i;
    const bool last = i + 1 == count;  // after one turn the sides have changed places
    const std::uint32_t c = last ? 1 : a + 2;
    const std::uint32_t d = last ? 0 : a + 3;
    faces.push_back({a, a + 1, d});
    faces.push_back({a, d, c});
  }
  const TriangleMesh strip = mesh_of(vertices, faces);
  const Faults faults = find_faults(strip);
  EXPECT_FALSE(faults.orientable);
  EXPECT_TRUE(faults.manifold);
  EXPECT_EQ(faults.components, 1u);
  const auto repaired = repair(strip).value();
  EXPECT_EQ(repaired.log.unorientable_components, 1u);
  EXPECT_EQ(repaired.log.turned_triangles, 0u);
}

TEST(Faults, TwoSolidsThatShareACornerOrAnEdgeAreNotManifold) {
  auto corner = tetrahedron;
  auto corner_faces = tetrahedron_faces;
  for (const Vec3& v : tetrahedron) corner.push_back(-v);
  for (const Triangle& t : tetrahedron_faces) corner_faces.push_back({t[0] + 4, t[2] + 4, t[1] + 4});
  const Faults at_corner = find_faults(mesh_of(corner, corner_faces));
  EXPECT_EQ(at_corner.non_manifold_vertex.examples, std::vector<std::uint32_t>({0}));
  EXPECT_EQ(at_corner.non_manifold.count, 0u);
  EXPECT_EQ(at_corner.components, 2u);
  EXPECT_FALSE(at_corner.manifold);

  auto edge = tetrahedron;
  auto edge_faces = tetrahedron_faces;
  for (const Vec3& v : tetrahedron) edge.push_back({-v.x(), -v.y(), v.z()});
  for (const Triangle& t : tetrahedron_faces) edge_faces.push_back({t[0] + 4, t[1] + 4, t[2] + 4});
  const Faults at_edge = find_faults(mesh_of(edge, edge_faces));
  EXPECT_EQ(at_edge.non_manifold.examples, std::vector<Edge>({{0, 3}}));
  EXPECT_TRUE(at_edge.closed);
  EXPECT_EQ(at_edge.components, 1u);
}

TEST(Faults, SliversAreCountedByHeightOverLength) {
  const Faults faults =
      find_faults(mesh_of({{0, 0, 0}, {1, 0, 0}, {0.5, 1e-4, 0}, {0.5, 1, 0}}, {{0, 1, 2}, {0, 1, 3}}));
  EXPECT_EQ(faults.sliver.examples, std::vector<std::uint32_t>({0}));
  EXPECT_EQ(faults.degenerate.count, 0u);
}

TEST(Faults, UnitsHintSpeaksOnlyWhereSizesAreOdd) {
  EXPECT_TRUE(units_hint(made::make_shape("box").value()).empty());
  EXPECT_NE(units_hint(made::make_shape("box:x=100").value()).find("millimetres"), std::string::npos);
  EXPECT_FALSE(units_hint(made::make_shape("box:x=1e-5,y=1e-5,z=1e-5").value()).empty());
  EXPECT_NE(units_hint(mesh_of({{1e6, 0, 0}, {1e6 + 1, 0, 0}, {1e6, 1, 0}}, {{0, 1, 2}})).find("origin"),
            std::string::npos);
}

TEST(Repair, MakesASoupWithTurnedTrianglesWholeAgain) {
  const TriangleMesh torus = made::make_shape("torus:around=24,across=12").value();
  std::vector<Triangle> faces(torus.triangles().begin(), torus.triangles().end());
  for (std::size_t i = 0; i < faces.size(); i += 3) std::swap(faces[i][0], faces[i][1]);
  faces.push_back(faces[7]);
  const TriangleMesh broken = soup_of(mesh_of({torus.vertices().begin(), torus.vertices().end()}, faces));
  const auto repaired = repair(broken).value();
  const Faults faults = find_faults(repaired.mesh);
  EXPECT_TRUE(faults.clean());
  EXPECT_TRUE(faults.closed);
  EXPECT_NEAR(faults.volume.value(), find_faults(torus).volume.value(), 1e-12);
  EXPECT_EQ(repaired.mesh.vertices().size(), torus.vertices().size());
  EXPECT_EQ(repaired.log.dropped_duplicates, 1u);
  EXPECT_EQ(repaired.log.turned_triangles, (torus.triangles().size() + 2) / 3);
  EXPECT_EQ(repaired.log.lines().size(), 4u);
}

TEST(Repair, TurnsASolidThatIsInsideOutButKeepsCavities) {
  auto inside_out = tetrahedron_faces;
  for (Triangle& t : inside_out) std::swap(t[0], t[1]);
  const auto turned = repair(mesh_of(tetrahedron, inside_out)).value();
  EXPECT_EQ(turned.log.turned_components, 1u);
  EXPECT_NEAR(find_faults(turned.mesh).volume.value(), 1.0 / 6.0, 1e-15);

  const TriangleMesh hollow = made::make_shape("nested_shells:frequency=4").value();
  const auto kept = repair(hollow).value();
  EXPECT_EQ(kept.log.cavities_kept, 1u);
  EXPECT_FALSE(kept.log.changed());
}

TEST(Repair, OfAHollowBodyThatIsInsideOutTurnsTheCavityToo) {
  const TriangleMesh hollow = made::make_shape("nested_shells:frequency=4").value();
  std::vector<Triangle> over(hollow.triangles().begin(), hollow.triangles().end());
  for (Triangle& t : over) std::swap(t[0], t[1]);
  const auto turned = repair(mesh_of({hollow.vertices().begin(), hollow.vertices().end()}, over)).value();
  EXPECT_EQ(turned.log.turned_components, 1u);
  EXPECT_EQ(turned.log.turned_inner_components, 1u);
  EXPECT_EQ(turned.log.cavities_kept, 0u);
  const double volume = find_faults(hollow).volume.value();
  EXPECT_NEAR(find_faults(turned.mesh).volume.value(), volume, 1e-12 * volume);
}

/// Both as they are, or inside out.
TriangleMesh joined(const TriangleMesh& a, bool a_over, const TriangleMesh& b, bool b_over) {
  std::vector<Vec3> vertices(a.vertices().begin(), a.vertices().end());
  std::vector<Triangle> triangles(a.triangles().begin(), a.triangles().end());
  const auto first = static_cast<std::uint32_t>(vertices.size());
  vertices.insert(vertices.end(), b.vertices().begin(), b.vertices().end());
  for (const Triangle& t : b.triangles()) triangles.push_back({first + t[0], first + t[1], first + t[2]});
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    if (i < a.triangles().size() ? a_over : b_over) std::swap(triangles[i][0], triangles[i][1]);
  }
  return mesh_of(vertices, triangles);
}

TEST(Repair, OfABallInTheHoleOfARingTurnsWhatIsInsideOutAndNothingElse) {
  const TriangleMesh ball = made::make_shape("icosphere:radius=0.1,frequency=4").value();
  for (const int axis : {0, 1, 2}) {
    const TriangleMesh lying = made::make_shape("torus:ring=1,tube=0.3,around=24,across=12").value();
    std::vector<Vec3> vertices;  // turned, so that the ring lies across each axis once
    for (const Vec3& v : lying.vertices()) vertices.push_back({v[(axis + 1) % 3], v[(axis + 2) % 3], v[axis]});
    const TriangleMesh ring = mesh_of(vertices, {lying.triangles().begin(), lying.triangles().end()});
    const double volume = find_faults(ring).volume.value() + find_faults(ball).volume.value();
    for (const bool ring_over : {false, true}) {
      for (const bool ball_over : {false, true}) {
        const auto repaired = repair(joined(ring, ring_over, ball, ball_over)).value();
        EXPECT_NEAR(find_faults(repaired.mesh).volume.value(), volume, 1e-12) << axis << ring_over << ball_over;
        EXPECT_EQ(repaired.log.turned_components, (ring_over ? 1u : 0u) + (ball_over ? 1u : 0u));
        EXPECT_EQ(repaired.log.turned_inner_components, 0u);
        EXPECT_EQ(repaired.log.cavities_kept, 0u);
      }
    }
  }
}

// The ray goes through corners and along edges here.
TEST(Repair, KeepsACavityWhereverItLiesInABox) {
  const TriangleMesh box = made::make_shape("box:x=2,y=2,z=2,cells=4").value();
  const TriangleMesh small = made::make_shape("box:x=0.5,y=0.5,z=0.5").value();
  for (int place = 0; place < 27; ++place) {
    const Vec3 at = 0.5 * Vec3(place % 3 - 1, place / 3 % 3 - 1, place / 9 - 1);
    std::vector<Vec3> vertices;
    for (const Vec3& v : small.vertices()) vertices.push_back(v + at);
    const TriangleMesh cavity = mesh_of(vertices, {small.triangles().begin(), small.triangles().end()});
    const auto kept = repair(joined(box, false, cavity, true)).value();
    EXPECT_EQ(kept.log.cavities_kept, 1u) << place;
    EXPECT_FALSE(kept.log.changed()) << place;
    const auto turned = repair(joined(box, true, cavity, false)).value();
    EXPECT_EQ(turned.log.turned_inner_components, 1u) << place;
    EXPECT_NEAR(find_faults(turned.mesh).volume.value(), 8.0 - 0.125, 1e-12) << place;
  }
}

/// The mesh with `count` corners more on a side of every fourth triangle: that triangle is cut there, its neighbour is
/// not, and triangles without area close the gap, as programs write it.
TriangleMesh with_caps(const TriangleMesh& mesh, std::uint32_t count) {
  std::vector<Vec3> vertices(mesh.vertices().begin(), mesh.vertices().end());
  std::vector<Triangle> triangles;
  for (std::size_t i = 0; i < mesh.triangles().size(); ++i) {
    const auto [a, b, c] = mesh.triangles()[i];
    if (i % 4 != 0) {
      triangles.push_back({a, b, c});
      continue;
    }
    std::uint32_t last = a;
    for (std::uint32_t k = 1; k <= count; ++k) {
      const double share = static_cast<double>(k) / 4.0;  // exact along the axes of a box of whole cells
      const auto next = static_cast<std::uint32_t>(vertices.size());
      vertices.push_back((1.0 - share) * mesh.vertices()[a] + share * mesh.vertices()[b]);
      triangles.push_back({last, next, c});
      triangles.push_back({a, k < count ? next + 1 : b, next});
      last = next;
    }
    triangles.push_back({last, b, c});
  }
  return mesh_of(vertices, triangles);
}

TEST(Repair, WhatWasClosedByTrianglesWithoutAreaStaysClosedWithoutThem) {
  const TriangleMesh box = made::make(made::Box{.x = 2, .y = 4, .z = 8, .cells = 4}).value();
  for (const std::uint32_t count : {1U, 2U, 3U}) {
    const TriangleMesh whole = with_caps(box, count);
    for (const TriangleMesh& mesh : {whole, soup_of(whole)}) {
      const Faults before = find_faults(mesh);
      ASSERT_TRUE(before.closed && before.consistent());
      const auto repaired = repair(mesh).value();
      const Faults after = find_faults(repaired.mesh);
      EXPECT_TRUE(after.clean());
      EXPECT_TRUE(after.closed);
      EXPECT_EQ(after.degenerate.count, 0U);
      EXPECT_EQ(after.volume.value_or(0.0), 64.0);
      EXPECT_EQ(after.area, before.area);
      EXPECT_EQ(repaired.mesh.triangles().size(), mesh.triangles().size());
      EXPECT_EQ(repaired.log.flipped_degenerate, before.degenerate.count);
      EXPECT_EQ(repaired.log.dropped_degenerate, 0U);
    }
  }
}

TEST(Repair, DropsATriangleWithoutAreaThatClosesNothing) {
  auto faces = tetrahedron_faces;
  faces.push_back({0, 1, 4});
  auto corners = tetrahedron;
  corners.push_back({0.5, 0, 0});
  const auto repaired = repair(mesh_of(corners, faces)).value();
  EXPECT_EQ(repaired.log.dropped_degenerate, 1U);
  EXPECT_EQ(repaired.log.flipped_degenerate, 0U);
  EXPECT_TRUE(find_faults(repaired.mesh).clean());
}

TEST(Repair, SaysSoWhenThereIsNothingToDo) {
  const auto repaired = repair(made::make_shape("gear").value()).value();
  EXPECT_FALSE(repaired.log.changed());
  EXPECT_EQ(repaired.log.lines(), std::vector<std::string>({"nothing to repair"}));
}

TEST(Repair, RefusesToReturnNothing) {
  EXPECT_FALSE(repair(mesh_of({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}, {{0, 1, 2}})).ok());
}

TEST(EnclosedVolume, IsThatOfTheFaultsForWholeAndForDamagedMeshes) {
  std::vector<TriangleMesh> meshes;
  for (const std::string_view name : made::shape_names()) {
    const bool is_car = name == "car_body";
    meshes.push_back(made::make_shape(std::string(name) + (is_car ? ":triangles=2000" : "")).value());
  }
  const TriangleMesh box = made::make(made::Box{.x = 1, .y = 2, .z = 3, .cells = 3}).value();
  const std::vector<Vec3> vertices(box.vertices().begin(), box.vertices().end());
  const std::vector<Triangle> triangles(box.triangles().begin(), box.triangles().end());
  meshes.push_back(soup_of(box));
  std::vector<Triangle> damaged = triangles;
  damaged.pop_back();  // a hole
  meshes.push_back(mesh_of(vertices, damaged));
  damaged = triangles;
  std::swap(damaged[5][0], damaged[5][1]);  // turned around
  meshes.push_back(mesh_of(vertices, damaged));
  damaged = triangles;
  damaged.push_back(damaged[7]);  // edges of three triangles
  meshes.push_back(mesh_of(vertices, damaged));
  damaged = triangles;
  damaged.push_back({4, 4, 9});  // no edges of its own
  meshes.push_back(mesh_of(vertices, damaged));
  for (Triangle& t : damaged = triangles) std::swap(t[0], t[1]);  // inside out
  meshes.push_back(mesh_of(vertices, damaged));
  std::vector<Vec3> signed_zeros = tetrahedron;
  for (Vec3& v : signed_zeros) v = -v;  // zeros become -0
  std::vector<Triangle> split_faces = tetrahedron_faces;
  signed_zeros.push_back(Vec3::Zero());
  split_faces[0][0] = 4;
  meshes.push_back(mesh_of(signed_zeros, split_faces));
  std::size_t closed = 0;
  for (const TriangleMesh& mesh : meshes) {
    const std::optional<double> expected = find_faults(mesh).volume;
    EXPECT_EQ(enclosed_volume(mesh), expected) << mesh.name();
    closed += expected.has_value() ? 1 : 0;
  }
  EXPECT_GT(closed, 5u);
  EXPECT_LT(closed, meshes.size() - 3);
  EXPECT_TRUE(enclosed_volume(meshes.back()).has_value());
}

// As models for pictures have them. What is left of the volume is rounding, and its sign was a matter of the pose.
TEST(EnclosedVolume, OfASheetWithBothItsSidesIsNothing) {
  math::Random random(3);
  for (int turn = 0; turn < 40; ++turn) {
    const Mat3 rotation = random.rotation().toRotationMatrix();
    const Vec3 place = random.uniform(0.0, 2.0) * random.direction();
    const double bend = turn % 2 == 0 ? 0.0 : 0.5;
    constexpr std::uint32_t cells = 10;
    std::vector<Vec3> vertices;
    std::vector<Triangle> triangles;
    for (std::uint32_t i = 0; i <= cells; ++i) {
      for (std::uint32_t j = 0; j <= cells; ++j) {
        const double x = 0.2 * i - 1.0;
        const double y = 0.2 * j - 1.0;
        vertices.push_back(rotation * Vec3(x, y, bend * (x * x + y * y)) + place);
        if (i == cells || j == cells) continue;
        const std::uint32_t here = i * (cells + 1) + j;
        for (const Triangle& t :
             {Triangle{here, here + cells + 1, here + 1}, Triangle{here + 1, here + cells + 1, here + cells + 2}}) {
          triangles.push_back(t);
          triangles.push_back({t[1], t[0], t[2]});
        }
      }
    }
    const TriangleMesh sheet = mesh_of(vertices, triangles);
    ASSERT_EQ(enclosed_volume(sheet), 0.0) << turn;
    ASSERT_EQ(find_faults(sheet).volume, 0.0) << turn;
    // The thinnest wall between the two sides is a body.
    const auto wall = made::make(made::Plates{.side = 1.0, .thickness = 1e-9, .count = 1, .cells = 4}).value();
    std::vector<Vec3> turned;
    for (const Vec3& vertex : wall.vertices()) turned.push_back(rotation * vertex);
    EXPECT_NEAR(enclosed_volume(mesh_of(turned, {wall.triangles().begin(), wall.triangles().end()})).value(), 1e-9,
                1e-15);
  }
}

}  // namespace
}  // namespace odds::mesh
