// A single contact is made with the same care however late its hit comes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "odds/math/random.hpp"
#include "odds/mesh/made/by_name.hpp"
#include "odds/query/pair.hpp"
#include "odds/realtime/clock.hpp"
#include "support/shapes.hpp"

namespace odds::query {
namespace {

std::shared_ptr<const Shape> ball() { return Shape::build(testing::wavy_sphere(24, 0.02)).value(); }

/// A pose in which two of them overlap by a trifle.
math::Pose met(int i) {
  return {Eigen::AngleAxisd(0.3 * i, Vec3(1.0, 0.2 * i, 0.5).normalized()).toRotationMatrix(), Vec3(1.97, 0.05, 0.0)};
}

/// Within 5 us of a clock that goes on by so much a look.
Answer run(Pair& pair, int i, std::int64_t step_ns) {
  realtime::ManualClock clock(step_ns);
  Request request{.method = Method::exact, .budget = Budget::time(5.0)};
  request.budget.clock = clock.clock();
  pair.reset();
  return pair.run(met(i), request);
}

TEST(SingleContact, IsNoRougherWhereItsHitComesLast) {
  const std::shared_ptr<const Shape> shape = ball();
  Pair pair = Pair::make(shape, shape).value();
  int hits = 0;
  int last = 0;
  for (int i = 0; i < 20; ++i) {
    const Answer unhurried = run(pair, i, 1);
    if (unhurried.verdict != Verdict::hit) continue;
    const Contact expected = unhurried.contacts.front();
    for (std::int64_t step_ns = 20; step_ns <= 1500; step_ns += 5) {
      const Answer answer = run(pair, i, step_ns);
      if (answer.basis != Basis::proved) continue;
      ASSERT_EQ(answer.contacts.size(), 1U);
      EXPECT_TRUE(answer.contacts_complete);
      const Contact& contact = answer.contacts.front();
      // Near its end a search opens fewer pairs at a time, and may find another hit.
      if (contact.triangle_a != expected.triangle_a || contact.triangle_b != expected.triangle_b) continue;
      ++hits;
      EXPECT_EQ(contact.position, expected.position) << i << ", " << step_ns;
      EXPECT_EQ(contact.depth, expected.depth) << i << ", " << step_ns;
      // Only what the bodies are about the triangles is left out where there is no time for it.
      last += contact.normal != expected.normal ? 1 : 0;
    }
  }
  EXPECT_GT(hits, 200);
  EXPECT_GT(last, 20);
  EXPECT_LT(last, hits - 20);
}

// A sheet has two sides: which way its triangles are wound changes nothing. Of a ground wound downwards, walls of what
// stood on it pushed that into the ground.
TEST(SingleContact, OfASheetIsTheSameWhicheverWayItIsWound) {
  const mesh::TriangleMesh ground = mesh::made::make_shape("terrain:side=2,height=0.05,cells=20").value();
  std::vector<mesh::Triangle> turned(ground.triangles().begin(), ground.triangles().end());
  for (mesh::Triangle& t : turned) std::swap(t[1], t[2]);
  const auto sheet = [&ground](std::vector<mesh::Triangle> triangles) {
    return std::make_shared<const mesh::TriangleMesh>(
        mesh::TriangleMesh::make({ground.vertices().begin(), ground.vertices().end()}, std::move(triangles)).value());
  };
  const auto as_made = Shape::build(sheet({ground.triangles().begin(), ground.triangles().end()})).value();
  const auto downwards = Shape::build(sheet(turned)).value();
  int hits = 0;
  for (const char* name : {"box:x=0.4,y=0.3,z=0.2", "icosphere:radius=0.15"}) {
    const auto body =
        Shape::build(std::make_shared<const mesh::TriangleMesh>(mesh::made::make_shape(name).value())).value();
    Pair usual = Pair::make(as_made, body).value();
    Pair other = Pair::make(downwards, body).value();
    for (int i = 0; i < 200; ++i) {
      const Vec3 axis = Vec3(std::cos(i), std::sin(2.0 * i), 3.0 * std::sin(i)).normalized();
      const math::Pose pose{Eigen::AngleAxisd(0.1 * std::sin(5.0 * i), axis).toRotationMatrix(),
                            Vec3(0.7 * std::sin(7.0 * i), 0.7 * std::cos(11.0 * i), 0.08 + 0.0005 * i)};
      usual.reset();
      other.reset();
      const Answer& expected = usual.run(pose, {});
      const Answer& answer = other.run(pose, {});
      ASSERT_EQ(answer.verdict, expected.verdict);
      if (expected.contacts.empty() || answer.contacts[0].triangle_a != expected.contacts[0].triangle_a ||
          answer.contacts[0].triangle_b != expected.contacts[0].triangle_b) {
        continue;
      }
      ++hits;
      EXPECT_LE((answer.contacts[0].normal - expected.contacts[0].normal).norm(), 0.01) << name << " " << i;
      EXPECT_NEAR(answer.contacts[0].depth, expected.contacts[0].depth, 1e-6) << name << " " << i;
    }
  }
  EXPECT_GT(hits, 150);
}

// A face of a solid leads out of it only. Turned round, as a sheet's may be, it pushed the corner of one tetrahedron in
// 1,000 down into the ground.
TEST(SingleContact, OfACornerInASheetLeadsOutOfOneOfBoth) {
  const auto shape_of = [](mesh::TriangleMesh mesh) {
    return Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(mesh))).value();
  };
  const auto ground = shape_of(mesh::made::make_shape("terrain:side=2,height=0,cells=6").value());
  math::Random random(5);
  int hits = 0;
  for (int i = 0; i < 1000; ++i) {
    std::vector<Vec3> corners(4);
    double lowest = INFINITY;
    for (Vec3& corner : corners) {
      corner = Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)).normalized() * 0.2;
      lowest = std::min(lowest, corner.z());
    }
    if ((corners[1] - corners[0]).cross(corners[2] - corners[0]).dot(corners[3] - corners[0]) > 0.0)
      std::swap(corners[0], corners[1]);
    const auto body = shape_of(mesh::TriangleMesh::make(corners, {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}}).value());
    ASSERT_TRUE(body->is_solid());
    const double depth = 0.2 * std::exp(random.uniform(-8, -3));
    const math::Pose pose{Mat3::Identity(),
                          Vec3(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), -lowest - depth)};
    if (0.5 * (body->mesh().lower().z() + body->mesh().upper().z()) + pose.translation.z() < 2.0 * depth) continue;
    Pair pair = Pair::make(ground, body).value();
    const Answer& answer = pair.run(pose, {});
    if (answer.contacts.empty()) continue;
    ++hits;
    const Contact& contact = answer.contacts[0];
    const mesh::Triangle& t = body->mesh().triangles()[contact.triangle_b];
    const Vec3 outwards = (corners[t[1]] - corners[t[0]]).cross(corners[t[2]] - corners[t[0]]).normalized();
    EXPECT_TRUE(contact.normal.z() < 0.0 || contact.normal.dot(outwards) > 0.0)
        << i << ": " << contact.normal.transpose();
  }
  EXPECT_GT(hits, 900);
}

}  // namespace
}  // namespace odds::query
