// Bodies in the inner corners of one mesh, whose overlaps with its faces are one: each face pushes along its own
// normal.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "odds/math/random.hpp"
#include "odds/query/pair.hpp"
#include "support/blocks.hpp"
#include "support/contact_scene.hpp"

namespace odds::query {
namespace {

using test::Body;
using Profile = std::vector<std::array<double, 2>>;

std::shared_ptr<const Shape> shape_of(Body body) {
  auto mesh = mesh::TriangleMesh::make(std::move(body.vertices), std::move(body.triangles)).value();
  return Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(mesh))).value();
}

/// A profile (x, z), counter-clockwise seen from -y, along y, every side of it and the length in `cells`. Its ends are
/// fans about `middle`, from where all of it must be seen.
Body along_y(const Profile& profile, const Vec3& middle, double length, std::uint32_t cells) {
  Body body;
  std::vector<Vec3> ring;
  for (std::size_t i = 0; i < profile.size(); ++i) {
    const auto& [x, z] = profile[i];
    const auto& [next_x, next_z] = profile[(i + 1) % profile.size()];
    for (std::uint32_t k = 0; k < cells; ++k) {
      const double t = static_cast<double>(k) / cells;
      ring.emplace_back(x + t * (next_x - x), 0.0, z + t * (next_z - z));
    }
  }
  const auto count = static_cast<std::uint32_t>(ring.size());
  const auto at = [&](std::uint32_t j) { return Vec3(0.0, length * (static_cast<double>(j) / cells - 0.5), 0.0); };
  for (std::uint32_t j = 0; j <= cells; ++j) {
    for (const Vec3& p : ring) body.vertices.push_back(p + at(j));
  }
  const auto first_middle = static_cast<std::uint32_t>(body.vertices.size());
  for (const std::uint32_t j : {0U, cells}) body.vertices.push_back(middle + at(j));
  for (std::uint32_t k = 0; k < count; ++k) {
    const std::uint32_t after = (k + 1) % count;
    for (std::uint32_t j = 0; j < cells; ++j) {
      body.triangles.push_back({j * count + k, (j + 1) * count + after, j * count + after});
      body.triangles.push_back({j * count + k, (j + 1) * count + k, (j + 1) * count + after});
    }
    body.triangles.push_back({first_middle, k, after});
    body.triangles.push_back({first_middle + 1, cells * count + after, cells * count + k});
  }
  return body;
}

/// A floor, z = 0, and a wall that leans over it or back, at an angle to it; along y, at x = 0.
Profile floor_with_wall(double angle) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return {{0.0, 0.0},   {1.5 * c, 1.5 * s}, {1.5 * c - 0.5 * s, 1.5 * s + 0.5 * c},
          {-1.2, -0.5}, {2.0, -0.5},        {2.0, 0.0}};
}

/// A room's corner, in x, y, z >= 0: with walls half a metre thick, or without.
Body corner_of_a_room(bool solid) {
  const std::vector<double> lines = {-0.5, 0.0, 0.7, 2.0};
  const test::Blocks walls{{lines, lines, lines}, [](int i, int j, int k) { return i == 0 || j == 0 || k == 0; }};
  bool (*const inside)(const Vec3&) = [](const Vec3& p) { return p.minCoeff() == 0.0 && p.maxCoeff() < 2.0; };
  auto [vertices, triangles] = test::surface_of(walls, solid ? nullptr : inside);
  return {std::move(vertices), std::move(triangles), solid, Vec3::Zero()};
}

/// A floor at z = 0 and on it a pillar, half a metre high, in x < 0 and y < 0.
Body pillar() {
  auto [vertices, triangles] = test::surface_of({{{{-2.0, -0.5, 0.0, 2.0}, {-2.0, -0.5, 0.0, 2.0}, {-0.5, 0.0, 0.5}}},
                                                 [](int i, int j, int k) { return k == 0 || (i == 1 && j == 1); }});
  return {std::move(vertices), std::move(triangles), true, Vec3::Zero()};
}

/// Contacts of the room with a body in it, in the room's frame, each pushing the body out of the room; of the body with
/// the room if `swapped`.
std::vector<Contact> contacts_of(const std::shared_ptr<const Shape>& room, const std::shared_ptr<const Shape>& body,
                                 const math::Pose& pose, bool swapped, int most = 8) {
  Pair pair = swapped ? Pair::make(body, room).value() : Pair::make(room, body).value();
  const Answer& answer = pair.run(swapped ? pose.inverse() : pose, {.max_contacts = most});
  std::vector<Contact> contacts(answer.contacts.begin(), answer.contacts.end());
  for (Contact& contact : contacts) {
    contact.normal = swapped ? Vec3(pose.rotation * contact.normal) : Vec3(-contact.normal);
    if (swapped) contact.position = pose * contact.position;
  }
  return contacts;
}

/// How deep a body's deepest corner is under the plane through the origin.
double depth_under(const std::shared_ptr<const Shape>& body, const math::Pose& pose, const Vec3& normal) {
  double depth = 0.0;
  for (const Vec3& vertex : body->mesh().vertices()) depth = std::max(depth, -normal.dot(pose * vertex));
  return depth;
}

/// Each contact is along one of the faces' normals, no deeper than the body is under that face, and each face has one.
void expect_held_by_each(const std::vector<Contact>& contacts, const std::vector<Vec3>& faces,
                         const std::shared_ptr<const Shape>& body, const math::Pose& pose, const std::string& where) {
  std::vector<double> deepest(faces.size(), -1.0);
  for (const Contact& contact : contacts) {
    const auto face =
        std::find_if(faces.begin(), faces.end(), [&](const Vec3& n) { return n.dot(contact.normal) > 0.9999; });
    ASSERT_NE(face, faces.end()) << where << ": along " << contact.normal.transpose() << ", " << contact.depth << " m";
    double& known = deepest[static_cast<std::size_t>(face - faces.begin())];
    known = std::max(known, contact.depth);
  }
  for (std::size_t k = 0; k < faces.size(); ++k) {
    const double depth = depth_under(body, pose, faces[k]);
    EXPECT_GE(deepest[k], 0.0) << where << ": nothing along " << faces[k].transpose();
    EXPECT_LE(deepest[k], 1.001 * depth + 1e-6) << where << ", along " << faces[k].transpose();
  }
}

Mat3 leaning(math::Random& random, double most) {
  return Eigen::AngleAxisd(random.uniform(0.0, most), random.direction()).toRotationMatrix();
}

double some_depth(math::Random& random) { return std::pow(10.0, random.uniform(-4.5, -2.0)); }

class ConcaveCorners : public ::testing::TestWithParam<int> {};

// Where both overlaps were 0.05 mm, the one direction of both was (1, 0, 0), and along it the floor's 9.7 cm.
TEST_P(ConcaveCorners, HoldByEachFace) {
  const double angle = GetParam() * std::numbers::pi / 180.0;
  const Vec3 up = Vec3::UnitZ();
  const Vec3 wall(std::sin(angle), 0.0, -std::cos(angle));
  math::Random random(53);
  for (int i = 0; i < 200; ++i) {
    const auto room = shape_of(
        along_y(floor_with_wall(angle), -0.1 * (up + wall), 4.0, 1 + static_cast<std::uint32_t>(random.below(4))));
    ASSERT_TRUE(room->is_solid());
    const double a = random.uniform(0.1, 0.6);
    const double c = random.uniform(0.1, 0.6);
    const double far = GetParam() > 100 ? 1.0 : 0.8;  // or the fourth corner would be beyond the second
    const Profile fitting = {{0.0, 0.0},
                             {a, 0.0},
                             {far * a + 0.7 * c * std::cos(angle), 0.7 * c * std::sin(angle)},
                             {c * std::cos(angle), c * std::sin(angle)}};
    const Vec3 middle(0.5 * (fitting[1][0] + fitting[3][0]), 0.0, 0.5 * fitting[3][1]);
    const auto body =
        shape_of(along_y(fitting, middle, random.uniform(0.1, 0.6), 1 + static_cast<std::uint32_t>(random.below(3))));
    ASSERT_TRUE(body->is_solid());
    const double down = some_depth(random);
    const double aside = some_depth(random);
    math::Pose pose;
    pose.rotation = i % 2 == 0 ? Mat3(Mat3::Identity()) : leaning(random, 0.01);
    // So that it is `down` under the floor and `aside` beyond the wall.
    const double cosine = up.dot(wall);
    const double sine2 = 1.0 - cosine * cosine;
    pose.translation = ((-down + cosine * aside) * up + (-aside + cosine * down) * wall) / sine2;
    pose.translation.y() = random.uniform(-0.8, 0.8);
    const std::string where = "corner of " + std::to_string(GetParam()) + " degrees, " + std::to_string(i);
    if (pose.rotation != Mat3::Identity() && std::min(down, aside) < 1e-3) continue;  // may not reach both
    expect_held_by_each(contacts_of(room, body, pose, i % 4 < 2), {up, wall}, body, pose, where);
  }
}

INSTANTIATE_TEST_SUITE_P(Degrees, ConcaveCorners, ::testing::Values(60, 75, 90, 120, 150));

TEST(ConcaveCorners, OfARoomHoldByThreeFaces) {
  math::Random random(54);
  for (const bool solid : {true, false}) {
    const auto room = shape_of(corner_of_a_room(solid));
    ASSERT_EQ(room->is_solid(), solid);
    for (int i = 0; i < 200; ++i) {
      const Vec3 size(random.uniform(0.1, 0.6), random.uniform(0.1, 0.6), random.uniform(0.1, 0.6));
      const auto crate = shape_of(Body::box(size.x(), size.y(), size.z(), 1 + static_cast<int>(random.below(5))));
      const Vec3 in(some_depth(random), some_depth(random), some_depth(random));
      const math::Pose pose{Mat3::Identity(), 0.5 * size - in};
      const std::string where = (solid ? "walls, " : "sheets, ") + std::to_string(i);
      expect_held_by_each(contacts_of(room, crate, pose, i % 2 == 0), {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()},
                          crate, pose, where);
    }
  }
}

TEST(ConcaveCorners, GiveEachFaceOneOfAFewContacts) {
  const auto room = shape_of(corner_of_a_room(true));
  const auto crate = shape_of(Body::box(0.3, 0.4, 0.5, 2));
  const math::Pose pose{Mat3::Identity(), Vec3(0.15 - 1e-3, 0.2 - 2e-3, 0.25 - 3e-3)};
  const std::vector<Contact> contacts = contacts_of(room, crate, pose, false, 3);
  ASSERT_EQ(contacts.size(), 3U);
  expect_held_by_each(contacts, {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()}, crate, pose, "three");
  EXPECT_NEAR(contacts[0].depth, 3e-3, 1e-6);  // the deepest first
}

// A pillar's edge has two faces, which are one side, and often no one way out of floor and pillar is short: up it is as
// long as the pillar or the crate is high.
TEST(ConcaveCorners, APillarOnAFloorIsOne) {
  const auto room = shape_of(pillar());
  ASSERT_TRUE(room->is_solid());
  math::Random random(55);
  for (int i = 0; i < 300; ++i) {
    const Vec3 size(random.uniform(0.2, 0.6), random.uniform(0.2, 0.6), random.uniform(0.1, 0.6));
    const auto crate = shape_of(Body::box(size.x(), size.y(), size.z(), 2));
    const double down = some_depth(random);
    const double aside = some_depth(random);
    const double angle = random.uniform(0.5, 1.0);
    const Vec3 out(std::cos(angle), std::sin(angle), 0.0);
    math::Pose pose;
    pose.rotation = Eigen::AngleAxisd(angle, Vec3::UnitZ()).toRotationMatrix();
    pose.translation = out * (0.5 * size.x() - aside) + Vec3(-out.y(), out.x(), 0.0) * random.uniform(-0.08, 0.08) +
                       Vec3(0.0, 0.0, 0.5 * size.z() - down);
    double up = 0.0;
    double sideways = 0.0;
    for (const Contact& contact : contacts_of(room, crate, pose, i % 2 == 0)) {
      // Where one way out of both is hardly longer, it may be that.
      EXPECT_LE(contact.depth, 2.0 * std::max(down, aside) + 1e-6) << i << ": along " << contact.normal.transpose();
      up = std::max(up, contact.depth * contact.normal.z());
      sideways = std::max(sideways, contact.depth * contact.normal.dot(out));
    }
    EXPECT_GE(up, 0.9 * down - 1e-6) << i;
    EXPECT_GE(sideways, 0.9 * aside - 1e-6) << i;
  }
}

TEST(ConcaveCorners, AnEdgeOnAFloorIsNone) {
  const auto floor = shape_of(Body::box(2.0, 2.0, 1.0, 4));
  const auto crate = shape_of(Body::box(0.3, 0.4, 0.5, 3));
  for (const double lean : {0.3, 0.7}) {
    math::Pose pose;
    pose.rotation = Eigen::AngleAxisd(lean, Vec3::UnitY()).toRotationMatrix();
    pose.translation = Vec3(0.1, 0.1, 0.5);
    double lowest = 0.0;
    for (const Vec3& vertex : crate->mesh().vertices()) lowest = std::min(lowest, (pose.rotation * vertex).z());
    pose.translation.z() -= lowest + 2e-3;
    for (const bool swapped : {false, true}) {
      for (const Contact& contact : contacts_of(floor, crate, pose, swapped)) {
        EXPECT_GT(contact.normal.z(), 0.9999) << lean;
        EXPECT_LE(contact.depth, 2e-3 + 1e-9) << lean;
      }
    }
  }
}

// A surface that bends on all the way between its faces has no corner: a rounded rod in a rounded gutter is pushed one
// way.
TEST(ConcaveCorners, AGutterIsNone) {
  constexpr int facets = 24;
  const auto arc = [](double radius, double from, double to) {
    Profile points;
    for (int k = 0; k <= facets; ++k) {
      const double t = from + (to - from) * k / facets;
      points.push_back({radius * std::cos(t), radius * std::sin(t)});
    }
    return points;
  };
  constexpr double pi = std::numbers::pi;
  Body gutter{{}, {}, true, Vec3::Zero()};
  Profile profile = arc(1.5, pi, 2.0 * pi);  // below
  for (const auto& point : arc(1.0, 2.0 * pi, pi)) profile.push_back(point);
  const auto count = static_cast<std::uint32_t>(profile.size());
  for (const double y : {-1.0, 1.0}) {
    for (const auto& [x, z] : profile) gutter.vertices.emplace_back(x, y, z);
  }
  for (std::uint32_t k = 0; k < count; ++k) {
    const std::uint32_t next = (k + 1) % count;
    gutter.triangles.push_back({k, count + next, next});
    gutter.triangles.push_back({k, count + k, count + next});
    if (k + 1 >= count / 2) continue;  // the ends: between the arcs
    const std::uint32_t across = count - 1 - k;
    for (const auto& [p, q, r] : {mesh::Triangle{k, k + 1, across}, {k + 1, across - 1, across}}) {
      gutter.triangles.push_back({p, q, r});
      gutter.triangles.push_back({count + p, count + r, count + q});
    }
  }
  const auto room = shape_of(gutter);
  ASSERT_TRUE(room->is_solid());
  Profile circle = arc(0.95, 0.0, 2.0 * pi);
  circle.pop_back();
  const auto rod = shape_of(along_y(circle, Vec3::Zero(), 0.5, 1));
  ASSERT_TRUE(rod->is_solid());
  for (const double deep : {0.052, 0.055, 0.058}) {  // 0.05 touches
    const math::Pose pose{Mat3::Identity(), Vec3(0.0, 0.0, -deep)};
    for (const bool swapped : {false, true}) {
      for (const Contact& contact : contacts_of(room, rod, pose, swapped)) {
        EXPECT_GT(contact.normal.z(), 0.85) << deep;
        EXPECT_LT(contact.depth, deep - 0.04) << deep;
      }
    }
  }
}

}  // namespace
}  // namespace odds::query
