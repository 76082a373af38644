// Where a rim alone misleads: sloping sides over an edge, a sample of a long rim, a ground of huge triangles.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "odds/math/random.hpp"
#include "odds/mesh/made/by_name.hpp"
#include "odds/query/pair.hpp"

namespace odds::query {
namespace {

std::shared_ptr<const Shape> shape_of(mesh::TriangleMesh mesh) {
  return Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(mesh))).value();
}
std::shared_ptr<const Shape> made(const std::string& name) {
  return shape_of(mesh::made::make_shape("made:" + name).value());
}

/// The same surface, wound the other way.
std::shared_ptr<const Shape> turned(const Shape& shape) {
  const auto vertices = shape.mesh().vertices();
  std::vector<mesh::Triangle> triangles(shape.mesh().triangles().begin(), shape.mesh().triangles().end());
  for (mesh::Triangle& t : triangles) std::swap(t[1], t[2]);
  return shape_of(mesh::TriangleMesh::make({vertices.begin(), vertices.end()}, std::move(triangles)).value());
}

/// Its base is at z = 0, its tip up.
mesh::TriangleMesh cone(double radius, double height, std::uint32_t sides) {
  std::vector<Vec3> vertices = {Vec3::Zero(), Vec3(0, 0, height)};
  std::vector<mesh::Triangle> triangles;
  for (std::uint32_t i = 0; i < sides; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / sides;
    vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0.0);
    const std::uint32_t next = 2 + (i + 1) % sides;
    triangles.push_back({0, next, 2 + i});
    triangles.push_back({1, 2 + i, next});
  }
  return mesh::TriangleMesh::make(std::move(vertices), std::move(triangles)).value();
}

const Answer& contacts_of(Pair& pair, const math::Pose& pose) {
  Request request;
  request.max_contacts = 8;
  pair.reset();
  return pair.run(pose, request);
}

TEST(MisleadingRims, AConeWhoseFootHangsOverAnEdgeIsPushedUp) {
  Pair pair = Pair::make(made("box:x=1,y=1,z=1"), shape_of(cone(0.5, 1.0, 24))).value();
  math::Random random(7);
  int met = 0;
  for (int i = 0; i < 500; ++i) {
    const double depth = i % 2 == 0 ? 1e-2 : 1e-3;
    const math::Pose pose{Mat3::Identity(), Vec3(random.uniform(-0.02, 0.05), random.uniform(-0.3, 0.3), 0.5 - depth)};
    const Answer& answer = contacts_of(pair, pose);
    met += answer.verdict == Verdict::hit ? 1 : 0;
    for (const Contact& contact : answer.contacts) {
      ASSERT_LT(contact.normal.z(), -0.7) << i;
      ASSERT_LT(contact.depth, 2.0 * depth) << i;
    }
  }
  EXPECT_EQ(met, 500);
}

// The rim is at the table's edge only: its area points out there, by as much as the plate lies on the table, and a
// plate that had come by its own thickness in a step was shot off at 8 m/s.
TEST(MisleadingRims, APlateThatFellThroughTheEdgeOfATableIsPushedUp) {
  const auto table = made("box:x=2,y=2,z=0.2");
  constexpr double deep = 0.03;
  for (const double thick : {0.004, 0.012, 0.028}) {
    const auto plate = made("box:x=0.5,y=0.4,z=" + std::to_string(thick) + ",cells=3");
    for (const double on_table : {0.1, 0.2, 0.3, 0.4}) {
      const math::Pose pose{Mat3::Identity(), Vec3(1.25 - on_table, 0.3, 0.1 + 0.5 * thick - deep)};
      for (const bool table_first : {true, false}) {
        Pair pair = Pair::make(table_first ? table : plate, table_first ? plate : table).value();
        const Answer& answer = contacts_of(pair, table_first ? pose : pose.inverse());
        ASSERT_GE(answer.contacts.size(), 4U) << thick << " " << on_table;
        double inmost = 0.0;
        for (const Contact& contact : answer.contacts) {
          const double x = (table_first ? contact.position : pose * contact.position).x();
          inmost = std::max(inmost, 1.0 - x);
          EXPECT_GT((table_first ? -1.0 : 1.0) * contact.normal.z(), 0.999) << thick << " " << on_table;
          EXPECT_NEAR(contact.depth, deep, 1e-9) << thick << " " << on_table;
        }
        EXPECT_GT(inmost, 0.9 * on_table) << "and held on all of what is on the table";
      }
    }
  }
}

// Both of its rims are at the beam's sides: it was pushed out lengthwise.
TEST(MisleadingRims, ARodThatFellThroughABeamIsPushedUp) {
  Pair pair = Pair::make(made("box:x=0.2,y=3,z=0.2"), made("box:x=1,y=0.04,z=0.04")).value();
  for (const double aside : {0.0, 0.1, -0.3}) {
    const math::Pose pose{Eigen::AngleAxisd(0.2, Vec3::UnitZ()).toRotationMatrix(), Vec3(aside, 0.3, 0.1 - 0.03)};
    const Answer& answer = contacts_of(pair, pose);
    ASSERT_GE(answer.contacts.size(), 2U);
    for (const Contact& contact : answer.contacts) {
      EXPECT_LT(contact.normal.z(), -0.999) << aside;
      EXPECT_NEAR(contact.depth, 0.05, 1e-9) << aside;
    }
  }
}

// As slender, but it has only just met: pushed sideways it would slip off.
TEST(MisleadingRims, AKnifeThatRestsOnAnEdgeIsPushedUp) {
  mesh::TriangleMesh blade = mesh::made::make_shape("made:box:x=0.02,y=0.5,z=0.2").value();
  std::vector<Vec3> vertices(blade.vertices().begin(), blade.vertices().end());
  for (Vec3& vertex : vertices) vertex.x() *= vertex.z() < 0.0 ? 0.0 : 1.0;
  std::vector<mesh::Triangle> triangles;
  for (const mesh::Triangle& t : blade.triangles()) {
    const auto side = [&](int i, int j) { return (vertices[t[i]] - vertices[t[j]]).norm(); };
    if (std::min({side(0, 1), side(1, 2), side(2, 0)}) > 0.0) triangles.push_back(t);
  }
  const auto knife = shape_of(mesh::TriangleMesh::make(std::move(vertices), std::move(triangles)).value());
  Pair pair = Pair::make(made("box:x=2,y=0.1,z=0.1"), knife).value();
  for (const double deep : {1e-5, 1e-3, 4e-3}) {
    const Answer& answer = contacts_of(pair, {Mat3::Identity(), Vec3(0.2, 0.0, 0.05 + 0.1 - deep)});
    ASSERT_FALSE(answer.contacts.empty());
    for (const Contact& contact : answer.contacts) EXPECT_LT(contact.normal.z(), -0.99) << deep;
  }
}

// 1,320 pairs of triangles cross; 512 are kept.
TEST(MisleadingRims, ABrickThatLiesInAFloorIsPushedUpWhateverIsKeptOfItsRim) {
  Pair pair = Pair::make(made("box:x=2,y=2,z=0.4,cells=200"), made("box:x=0.7,y=0.5,z=0.3,cells=100")).value();
  math::Pose pose;
  pose.rotation = Eigen::AngleAxisd(0.3, Vec3::UnitZ()).toRotationMatrix();
  pose.translation = Vec3(0.013, 0.021, 0.2 + 0.15 - 0.02);
  const Answer& answer = contacts_of(pair, pose);
  ASSERT_EQ(answer.contacts.size(), 8U);
  for (const Contact& contact : answer.contacts) {
    EXPECT_LT(contact.normal.z(), -0.999);
    EXPECT_NEAR(contact.depth, 0.02, 1e-3);
  }
}

TEST(MisleadingRims, ASmallBoxOnTheInnerEdgeOfAHugeFloorIsPushedUp) {
  constexpr double size = 1e-2;
  constexpr double floor_size = 100.0;
  const auto box = made("box:x=0.01,y=0.01,z=0.01");
  Pair pair = Pair::make(made("box:x=100,y=100,z=10"), box).value();
  math::Random random(4);
  for (int i = 0; i < 3000; ++i) {
    const double depth = size * std::pow(10.0, random.uniform(-4, -1));
    math::Pose pose;
    pose.rotation = random.rotation().toRotationMatrix();
    double lowest = INFINITY;
    for (const Vec3& vertex : box->mesh().vertices()) lowest = std::min(lowest, (pose.rotation * vertex).z());
    const double along = random.uniform(-0.4, 0.4) * floor_size;  // on one diagonal of its top
    const double side = i % 2 == 0 ? 1.0 : -1.0;                  // or on the other: one of them is an edge
    pose.translation = Vec3(along + random.uniform(-0.4, 0.4) * size, side * along + random.uniform(-0.4, 0.4) * size,
                            5.0 - lowest - depth);
    const Answer& answer = contacts_of(pair, pose);
    if (answer.verdict != Verdict::hit) continue;
    ASSERT_FALSE(answer.contacts.empty());
    ASSERT_LT(answer.contacts.front().normal.z(), -0.99) << i;
    ASSERT_LT(answer.contacts.front().depth, 2.0 * depth) << i;
  }
}

// The rim ends where the sheet does, and spans a piece of the sheet.
TEST(MisleadingRims, TheBorderOfASheetIsPushedOutSideways) {
  const auto box = made("box:x=1,y=1,z=1");
  const auto ball = made("icosphere:radius=0.5,frequency=8");
  const auto coarse = made("terrain:side=0.6,height=0,cells=1");
  const auto fine = made("terrain:side=0.6,height=0,cells=16");
  for (const auto& sheet : {coarse, fine, turned(*coarse), turned(*fine)}) {
    ASSERT_FALSE(sheet->is_solid());
    for (const double tilt : {0.0, 0.2, 0.6}) {
      for (const double depth : {1e-2, 3e-2, 5e-2}) {
        for (const bool round : {false, true}) {
          if (round && tilt > 0.0) continue;
          math::Pose pose;
          pose.rotation =
              (Eigen::AngleAxisd(tilt, Vec3::UnitY()) * Eigen::AngleAxisd(0.01, Vec3::UnitZ())).toRotationMatrix();
          double lowest = INFINITY;
          for (const Vec3& vertex : sheet->mesh().vertices()) lowest = std::min(lowest, (pose.rotation * vertex).x());
          pose.translation = Vec3(0.5 - lowest - depth, 0.021, round ? 0.013 : 0.1);
          Pair pair = Pair::make(round ? ball : box, sheet).value();
          const Answer& answer = contacts_of(pair, pose);
          SCOPED_TRACE(testing::Message()
                       << sheet->mesh().triangles().size() << ", " << tilt << ", " << depth << ", " << round);
          ASSERT_FALSE(answer.contacts.empty());
          EXPECT_LT(answer.contacts.front().normal.x(), -0.9);
          EXPECT_LT(answer.contacts.front().depth, 1.2 * depth);
        }
      }
    }
  }
}

// A scanned body has holes, so that it counts as a sheet. One at the rim is not a border that has come in from a side,
// which would be the shorter way out here.
TEST(MisleadingRims, AHoleInABodyTakesNoDirectionFromIt) {
  constexpr double depth = 0.06;
  const auto rod = mesh::made::make_shape("made:box:x=0.05,y=0.05,z=0.3,cells=6").value();
  const Vec3 at_rim(0.025, 0.0, depth - 0.15);
  std::vector<mesh::Triangle> triangles;
  for (const mesh::Triangle& t : rod.triangles()) {
    const auto v = rod.vertices();
    if (((v[t[0]] + v[t[1]] + v[t[2]]) / 3.0 - at_rim).norm() > 0.02) triangles.push_back(t);
  }
  ASSERT_LT(triangles.size(), rod.triangles().size());
  const auto body =
      shape_of(mesh::TriangleMesh::make({rod.vertices().begin(), rod.vertices().end()}, triangles).value());
  ASSERT_FALSE(body->is_solid());
  Pair pair = Pair::make(made("terrain:side=1,height=0,cells=16"), body).value();
  math::Random random(3);
  for (int i = 0; i < 60; ++i) {
    math::Pose pose;
    pose.rotation = Eigen::AngleAxisd(random.uniform(0, 6), Vec3::UnitZ()).toRotationMatrix();
    pose.translation = Vec3(random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2), 0.15 - depth);
    const Answer& answer = contacts_of(pair, pose);
    ASSERT_FALSE(answer.contacts.empty());
    EXPECT_LT(answer.contacts.front().normal.z(), -0.9) << i;
  }
}

// Their tips lie aside of their rims, and the ground's triangles at the rim are small.
TEST(LeaningSpikes, AreAsDeepAsTheirTips) {
  const mesh::TriangleMesh mesh = cone(0.02, 0.6, 8);
  Pair pair = Pair::make(made("box:x=2,y=2,z=0.3,cells=100"), shape_of(mesh)).value();
  math::Random random(2);
  int shallow = 0;
  for (int i = 0; i < 300; ++i) {
    const double depth = std::pow(10.0, random.uniform(-3.0, -1.5));
    math::Pose pose;
    do {
      pose.rotation = random.rotation().toRotationMatrix();
    } while (pose.rotation(2, 2) > -0.1);
    const double lowest = (pose.rotation * Vec3(0.0, 0.0, 0.6)).z();
    pose.translation = Vec3(random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), 0.15 - lowest - depth);
    const Answer& answer = contacts_of(pair, pose);
    ASSERT_FALSE(answer.contacts.empty());
    ASSERT_LT(answer.contacts.front().normal.z(), -0.9) << i;
    EXPECT_LT(answer.contacts.front().depth, 1.01 * depth) << i;
    shallow += answer.contacts.front().depth < 0.7 * depth ? 1 : 0;
  }
  // 44; it was 98 when a second start began with the longest step, and 156 when what lay beside the middle was not
  // followed.
  EXPECT_LT(shallow, 60);
}

}  // namespace
}  // namespace odds::query
