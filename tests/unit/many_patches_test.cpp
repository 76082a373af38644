// Bodies that touch in more places than there may be contacts, or right through each other.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <span>
#include <vector>

#include "odds/math/random.hpp"
#include "odds/mesh/made/by_name.hpp"
#include "odds/query/pair.hpp"

namespace odds::query {
namespace {

using Soup = std::pair<std::vector<Vec3>, std::vector<mesh::Triangle>>;

Soup made(const std::string& name) {
  const auto mesh = mesh::made::make_shape("made:" + name).value();
  return {{mesh.vertices().begin(), mesh.vertices().end()}, {mesh.triangles().begin(), mesh.triangles().end()}};
}

void add(Soup& soup, const Soup& more, const Vec3& at) {
  const auto first = static_cast<std::uint32_t>(soup.first.size());
  for (const Vec3& vertex : more.first) soup.first.push_back(vertex + at);
  for (const mesh::Triangle& t : more.second) soup.second.push_back({t[0] + first, t[1] + first, t[2] + first});
}

std::shared_ptr<const Shape> shape_of(const Soup& soup) {
  auto mesh = mesh::TriangleMesh::make(soup.first, soup.second).value();
  return Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(mesh))).value();
}

/// How far contacts reach beyond a point of the floor in the direction in which they do so least: below 0 it is not
/// between them.
double support(std::span<const Contact> contacts, const Vec3& center) {
  double least = INFINITY;
  for (int degrees = 0; degrees < 360; ++degrees) {
    const double angle = degrees * std::numbers::pi / 180.0;
    double most = -INFINITY;
    for (const Contact& c : contacts) {
      most = std::max(most, (c.position - center).dot(Vec3(std::cos(angle), std::sin(angle), 0.0)));
    }
    least = std::min(least, most);
  }
  return least;
}

/// A bed on so many feet times so many, a millimetre deep in a floor, whose top is at z = 0.5, more or less level.
void expect_all_around(const Soup& foot, int feet, double lowest) {
  Soup bed = made("box:x=1,y=1,z=0.1");
  for (Vec3& vertex : bed.first) vertex.z() += 0.25;
  for (int i = 0; i < feet * feet; ++i) {
    const auto place = [&](int k) { return -0.45 + 0.9 * k / (feet - 1); };
    add(bed, foot, {place(i % feet), place(i / feet), 0.1});
  }
  const auto floor = shape_of(made("box:x=4,y=4,z=1"));
  const auto body = shape_of(bed);
  for (const double tilt : {0.0, 1e-6, 1e-4}) {
    for (const int most : {3, 4, 8}) {
      math::Pose pose;
      pose.rotation = (Eigen::AngleAxisd(0.37, Vec3::UnitZ()) * Eigen::AngleAxisd(tilt, Vec3(0.6, 0.8, 0))).matrix();
      pose.translation = Vec3(0.03, 0.02, 0.5 - lowest - 1e-3);
      Request request;
      request.max_contacts = most;
      Pair pair = Pair::make(floor, body).value();
      const Answer& answer = pair.run(pose, request);
      ASSERT_EQ(answer.contacts.size(), static_cast<std::size_t>(most));
      EXPECT_GT(support(answer.contacts, pose.translation), most == 3 ? 0.0 : 0.2) << tilt << ", " << most;
    }
  }
}

class BedOnManyFeet : public ::testing::TestWithParam<int> {};

TEST_P(BedOnManyFeet, IsHeldByThoseAllAround) {
  expect_all_around(made("box:x=0.05,y=0.05,z=0.25"), GetParam(), -0.025);
}

INSTANTIATE_TEST_SUITE_P(Feet, BedOnManyFeet, ::testing::Values(4, 6, 8));

// More of them than patches are kept, and to rounding all rims are as long.
TEST(BedOnManySpikes, IsHeldByThoseAllAround) {
  constexpr std::uint32_t sides = 8;
  Soup spike{{Vec3(0.0, 0.0, 0.12), Vec3(0.0, 0.0, -0.13)}, {}};
  for (std::uint32_t i = 0; i < sides; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / sides;
    spike.first.emplace_back(0.04 * std::cos(angle), 0.04 * std::sin(angle), 0.12);
    const std::uint32_t next = 2 + (i + 1) % sides;
    spike.second.push_back({0, 2 + i, next});
    spike.second.push_back({1, next, 2 + i});
  }
  expect_all_around(spike, 8, -0.03);
}

TEST(TwoFeet, EachKeepsItsOwnDepthFromRunToRun) {
  // One is longer; its deepest corner is as near to the other as that one is wide.
  constexpr double apart = 0.12;
  constexpr double longer = 2e-3;
  Soup body = made("box:x=0.3,y=0.1,z=0.1");
  const Soup foot = made("box:x=0.1,y=0.1,z=0.2");
  add(body, foot, {-0.5 * apart, 0.0, -0.1});
  add(body, foot, {0.5 * apart, 0.0, -0.1 - longer});
  const auto floor = shape_of(made("box:x=2,y=2,z=0.4,cells=8"));
  const auto table = shape_of(body);
  for (const double tilt : {0.002, 0.005, 0.01}) {
    math::Pose pose;
    pose.rotation = (Eigen::AngleAxisd(0.02, Vec3::UnitZ()) * Eigen::AngleAxisd(-tilt, Vec3::UnitY())).matrix();
    pose.translation = Vec3(0.013, 0.021, 0.2 + 0.2 - 0.004);
    Pair pair = Pair::make(floor, table).value();
    Request request;
    request.max_contacts = 8;
    for (int run = 0; run < 3; ++run) {
      std::array<double, 2> depth{};
      std::array<int, 2> under{};
      for (const Contact& contact : pair.run(pose, request).contacts) {
        const std::size_t of = (pose.inverse() * contact.position).x() > 0.0 ? 1 : 0;
        depth[of] = std::max(depth[of], contact.depth);
        ++under[of];
      }
      EXPECT_NEAR(depth[1] - depth[0], longer - apart * tilt, 1e-4) << tilt << ", " << run;
      EXPECT_EQ(under[0], 4) << tilt << ", " << run;
      EXPECT_EQ(under[1], 4) << tilt << ", " << run;
    }
  }
}

// A rod lies across the edge of a box, deeper than it is thick: it goes in at one side of the edge and comes out at the
// other.
TEST(TwoRimsOfOneOverlap, GiveEachContactOnce) {
  constexpr double lean = 0.3;
  const auto box = shape_of(made("box:x=1,y=1,z=1"));
  const auto rod = shape_of(made("box:x=0.02,y=0.02,z=3"));
  for (const double roll : {0.0, 0.2, 0.4}) {
    const Vec3 out(std::sin(lean), 0.0, std::cos(lean));
    math::Pose pose;
    pose.rotation =
        (Eigen::AngleAxisd(0.5 * std::numbers::pi + lean, Vec3::UnitY()) * Eigen::AngleAxisd(roll, Vec3::UnitZ()))
            .toRotationMatrix();
    pose.translation = Vec3(0.5, 0.013, 0.5) + (0.01 * (std::cos(roll) + std::sin(roll)) - 0.03) * out;
    Request request;
    request.max_contacts = 8;
    Pair pair = Pair::make(box, rod).value();
    const std::span<const Contact> contacts = pair.run(pose, request).contacts;
    ASSERT_GE(contacts.size(), 2U);
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        EXPECT_GT((contacts[i].position - contacts[k].position).norm(), 1e-6) << roll << ": " << i << ", " << k;
      }
    }
  }
}

class ThroughAPlate : public ::testing::TestWithParam<const char*> {};

// Deeper than the plate is thick: its rims on both faces push against each other.
TEST_P(ThroughAPlate, TheShorterWayOutStands) {
  const auto plate = shape_of(made("box:x=2,y=2,z=0.02"));
  const Soup soup = made(GetParam());
  const auto body = shape_of(soup);
  math::Random random(5);
  for (int i = 0; i < 100; ++i) {
    math::Pose pose;
    pose.rotation = random.rotation().toRotationMatrix();
    double lowest = INFINITY;
    for (const Vec3& vertex : soup.first) lowest = std::min(lowest, (pose.rotation * vertex).z());
    const double depth = random.uniform(0.021, 0.05);
    pose.translation = Vec3(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), 0.01 - lowest - depth);
    Request request;
    request.max_contacts = 8;
    Pair pair = Pair::make(plate, body).value();
    const Answer& answer = pair.run(pose, request);
    ASSERT_FALSE(answer.contacts.empty());
    for (const Contact& contact : answer.contacts) {
      EXPECT_LT(contact.normal.z(), 0.5) << i << ": B is above, so A's way is down";
      EXPECT_LT(contact.depth, 2.0 * depth) << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Bodies, ThroughAPlate,
                         ::testing::Values("box:x=0.3,y=0.3,z=0.3", "box:x=0.3,y=0.2,z=0.1,cells=4",
                                           "icosphere:radius=0.3,frequency=6"));

}  // namespace
}  // namespace odds::query
