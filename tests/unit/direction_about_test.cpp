// The direction of a single contact: what lies around it says more than one pair of triangles does.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "odds/math/random.hpp"
#include "odds/mesh/made/by_name.hpp"
#include "odds/query/pair.hpp"
#include "query/contacts/direction_about.hpp"
#include "support/instruction_sets.hpp"

namespace odds::query {
namespace {

std::shared_ptr<const mesh::TriangleMesh> made(const std::string& name) {
  auto mesh = mesh::made::make_shape("made:" + name);
  EXPECT_TRUE(mesh.ok());
  return std::make_shared<const mesh::TriangleMesh>(std::move(mesh).value());
}

std::shared_ptr<const Shape> shape_of(const std::shared_ptr<const mesh::TriangleMesh>& mesh,
                                      volume::Kind volume = volume::Kind::wide) {
  ShapeOptions options;
  options.volume = volume;
  return std::move(Shape::build(mesh, options)).value();
}

double degrees_between(const Vec3& x, const Vec3& y) {
  return std::atan2(x.cross(y).norm(), x.dot(y)) * 180.0 / 3.14159265358979323846;
}

/// Of a ball that another has come into by a part of its size: how far single contacts point from the line of centres.
std::vector<double> off_of_balls(volume::Kind volume, double penetration) {
  const auto ball = shape_of(made("icosphere"), volume);
  const double radius = 0.5 * (ball->mesh().upper() - ball->mesh().lower()).x();
  auto pair = std::move(Pair::make(ball, ball)).value();
  math::Random random(7);
  std::vector<double> off;
  for (int i = 0; i < 100; ++i) {
    const math::Pose pose{random.rotation().toRotationMatrix(),
                          random.direction() * (2.0 * radius - penetration * ball->mesh().size())};
    pair.reset();
    const Answer& answer = pair.run(pose, {});
    if (answer.contacts.empty()) continue;
    off.push_back(degrees_between(answer.contacts.front().normal, -pose.translation));
  }
  std::sort(off.begin(), off.end());
  return off;
}

class DirectionAbout : public ::testing::TestWithParam<volume::Kind> {};

TEST_P(DirectionAbout, OfTwoBallsIsNearTheLineOfTheirCentres) {
  const std::vector<double> off = off_of_balls(GetParam(), 0.01);
  ASSERT_GT(off.size(), 90U);
  EXPECT_LT(off[off.size() / 2], 5.0) << "that of two triangles is 10 degrees off";
  EXPECT_LT(off[off.size() * 9 / 10], 12.0);
}

INSTANTIATE_TEST_SUITE_P(EveryVolume, DirectionAbout,
                         ::testing::Values(volume::Kind::wide, volume::Kind::aabb, volume::Kind::obb,
                                           volume::Kind::sphere, volume::Kind::kdop14, volume::Kind::kdop18,
                                           volume::Kind::kdop26, volume::Kind::hull),
                         [](const auto& kind) { return std::string(volume::name(kind.param)); });

TEST(DirectionAboutAnything, IsTheSameByEveryInstructionSet) {
  const auto knot = shape_of(made("torus_knot"));
  math::Random random(3);
  const PosedMeshes meshes(knot->mesh(), knot->mesh(), Vec3::Zero(), Vec3::Zero(),
                           {random.rotation().toRotationMatrix(), Vec3(0.01, 0.02, 0.0)});
  int compared = 0;
  for (int i = 0; i < 200; ++i) {
    const Vec3 place = knot->mesh().vertices()[static_cast<std::size_t>(i) * 37U];
    const Contact contact{place, random.direction(), 1e-4, 5, 7};
    const Vec3 best = direction_about(*knot, *knot, *wide::searches_for(InstructionSet::best), meshes, contact);
    for (const InstructionSet set : testing::instruction_sets) {
      const wide::Searches* const searches = wide::searches_for(set);
      if (searches == nullptr) continue;
      ++compared;
      EXPECT_EQ(direction_about(*knot, *knot, *searches, meshes, contact), best) << i;
    }
  }
  EXPECT_GE(compared, 200);
}

/// A corner that has just come through a large triangle is pushed out as by that.
TEST(DirectionAboutATouch, IsThatOfTheTriangles) {
  const auto slab = shape_of(made("box:x=4,y=4,z=1,cells=1"));
  const auto brick = shape_of(made("box:x=0.3,y=0.2,z=0.1,cells=1"));
  auto pair = std::move(Pair::make(slab, brick)).value();
  const Mat3 turned =
      (Eigen::AngleAxisd(0.7, Vec3::UnitX()) * Eigen::AngleAxisd(0.6, Vec3::UnitY())).toRotationMatrix();
  double lowest = 0.0;
  for (const Vec3& corner : brick->mesh().vertices()) lowest = std::min(lowest, (turned * corner).z());
  for (const double depth : {1e-7, 1e-5, 1e-4}) {
    pair.reset();
    const Answer& answer = pair.run({turned, Vec3(0.3, 0.4, 0.5 - lowest - depth)}, {});
    ASSERT_EQ(answer.contacts.size(), 1U) << depth;
    EXPECT_LT(degrees_between(answer.contacts.front().normal, -Vec3::UnitZ()), 2.0) << depth;
    EXPECT_NEAR(answer.contacts.front().depth, depth, 0.1 * depth);
  }
}

/// What comes from below a sheet is pushed back, not through it.
// A rim of one piece spans no area: what rounding leaves of one points anywhere.
TEST(DirectionAboutAnything, OfTwoTrianglesStaysWhileTheyHardlyMove) {
  const auto sphere = made("bumpy_sphere");
  const auto shape = shape_of(sphere);
  auto pair = std::move(Pair::make(shape, shape)).value();
  Request request;
  request.method = Method::incremental;
  math::Pose pose;
  pose.rotation = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  Contact before;
  int of_the_same = 0;
  for (int i = 0; i < 400; ++i) {
    const double way = 1e-5 * sphere->size() * (i % 200 < 100 ? i % 200 : 200 - i % 200);
    pose.translation = Vec3(0.3 * sphere->size() + way, 0.3 * way, 0.1 * way);
    const Answer& answer = pair.run(pose, request);
    ASSERT_EQ(answer.contacts.size(), 1U);
    const Contact contact = answer.contacts.front();
    if (contact.triangle_a == before.triangle_a && contact.triangle_b == before.triangle_b) {
      ++of_the_same;
      EXPECT_LT(degrees_between(contact.normal, before.normal), 25.0) << i;
    }
    before = contact;
  }
  EXPECT_GT(of_the_same, 300);
}

TEST(DirectionAboutASheet, StaysOnTheSideThatTheTrianglesSay) {
  const auto sheet = shape_of(made("terrain"));
  ASSERT_FALSE(sheet->is_solid());
  const auto ball = shape_of(made("icosphere:radius=0.05"));
  const PosedMeshes meshes(sheet->mesh(), ball->mesh(), Vec3::Zero(), Vec3::Zero(), {});
  for (const Vec3& says : {Vec3(Vec3::UnitZ()), Vec3(-Vec3::UnitZ())}) {
    const Contact contact{Vec3::Zero(), says, 0.01, 0, 0};
    EXPECT_GT(direction_about(*sheet, *ball, *wide::searches_for(InstructionSet::best), meshes, contact).dot(says),
              0.0);
  }
}

/// Bodies of 1e14 m and of 1e-13 m, and places that are no place.
TEST(DirectionAboutAnything, IsAUnitVector) {
  for (const double scale : {1e-12, 1.0, 1e15}) {
    auto mesh = mesh::made::make_shape("made:icosphere");
    ASSERT_TRUE(mesh.ok());
    std::vector<Vec3> vertices(mesh.value().vertices().begin(), mesh.value().vertices().end());
    for (Vec3& vertex : vertices) vertex *= scale;
    std::vector<mesh::Triangle> triangles(mesh.value().triangles().begin(), mesh.value().triangles().end());
    auto scaled = mesh::TriangleMesh::make(std::move(vertices), std::move(triangles), "scaled");
    ASSERT_TRUE(scaled.ok());
    for (const volume::Kind volume : {volume::Kind::wide, volume::Kind::obb}) {
      const auto ball = shape_of(std::make_shared<const mesh::TriangleMesh>(scaled.value()), volume);
      const PosedMeshes meshes(ball->mesh(), ball->mesh(), Vec3::Zero(), Vec3::Zero(), {});
      for (const double x : {0.0, 1.0, 1e30, std::nan(""), HUGE_VAL}) {
        const Contact contact{Vec3(x * scale, 0.0, 0.0), Vec3::UnitX(), 0.01 * scale, 0, 0};
        EXPECT_NEAR(direction_about(*ball, *ball, *wide::searches_for(InstructionSet::best), meshes, contact).norm(),
                    1.0, 1e-9)
            << scale << " " << x;
      }
    }
  }
}

}  // namespace
}  // namespace odds::query
