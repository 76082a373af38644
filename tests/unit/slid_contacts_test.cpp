// Late contacts of bodies that slide: rays see how deep they are where they have slid to.
#include "query/contacts/slid_contacts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "odds/mesh/made/by_name.hpp"
#include "query/memory/late_contacts.hpp"
#include "query/memory/pair_memory.hpp"

namespace odds::query {
namespace {

std::shared_ptr<const Shape> made(const std::string& name) {
  auto mesh = mesh::made::make_shape(name).value();
  return Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(mesh))).value();
}

math::Pose at(const Vec3& place) { return {Mat3::Identity(), place}; }

/// A pair with one late contact, as a run at `pose` found it.
struct Slid {
  Slid(const std::shared_ptr<const Shape>& a, const std::shared_ptr<const Shape>& b, const math::Pose& pose)
      : pair(a, b, {}) {
    pair.late = std::make_unique<LateContacts>(a, b, PairOptions{});
    auto careful = std::move(Pair::make(a, b)).value();
    const Answer& answer = careful.run(pose, {.method = Method::exact, .max_contacts = 4});
    found.assign(answer.contacts.begin(), answer.contacts.end());
    pair.late->manifold().keep(std::span(found).first(std::min<std::size_t>(found.size(), 1)), pose, pose,
                               smaller_size(pair), 12);
  }
  /// The contact at another pose, measured there; none if it is none.
  std::vector<Contact> at(const math::Pose& pose, std::uint64_t work = Budget{}.work_units) {
    Budget budget;
    budget.work_units = work;
    Spending spending(budget);
    pair.late->age(pose, smaller_size(pair));
    measure_slid(pose, {}, pair, spending);
    std::vector<Contact> contacts(8);
    contacts.resize(pair.late->manifold().write(pose, smaller_size(pair), contacts));
    return contacts;
  }

  Pair::Implementation pair;
  std::vector<Contact> found;
};

const double radius = 0.05;
const std::string ball = "made:icosphere:radius=0.05,frequency=8";
const std::string plate = "made:box:x=0.4,y=0.4,z=0.1,cells=16";
constexpr double deep = 1e-4;

// Whichever body is the first, and moves.
TEST(SlidContacts, AreAsDeepAsTheyWereOnAPlate) {
  for (const bool ball_is_b : {true, false}) {
    const auto pose = [ball_is_b](double x) {
      const math::Pose ball_in_plate = at({x, 0.013, 0.05 + radius - deep});
      return ball_is_b ? ball_in_plate : ball_in_plate.inverse();
    };
    Slid slid(made(ball_is_b ? plate : ball), made(ball_is_b ? ball : plate), pose(0.0));
    ASSERT_FALSE(slid.found.empty());
    const double size = 2.0 * radius * std::sqrt(3.0);
    double x = 0.0;
    for (int run = 0; run < 6; ++run) {
      x += 0.04 * size;
      const auto now = slid.at(pose(x));
      if (0.16 * size < x) break;  // farther than it is carried
      ASSERT_EQ(now.size(), 1u) << run << ball_is_b;
      EXPECT_LE(now[0].depth, slid.found[0].depth + 1e-9);
      EXPECT_GT(now[0].normal.dot(slid.found[0].normal), 1.0 - 1e-9);
      const Vec3 place = ball_is_b ? now[0].position : Vec3(pose(x).inverse() * now[0].position);
      EXPECT_NEAR(place.x(), x, 1e-3) << "it slides with the ball";
      EXPECT_NEAR(place.z(), 0.05, deep);
    }
  }
}

TEST(SlidContacts, AreNoneBeyondAnEdge) {
  const auto pose = [](double x) { return at({x, 0.013, 0.05 + radius - deep}); };
  Slid slid(made(plate), made(ball), pose(0.195));
  ASSERT_FALSE(slid.found.empty());
  EXPECT_EQ(slid.at(pose(0.1995)).size(), 1u);
  EXPECT_TRUE(slid.at(pose(0.203)).empty());
  EXPECT_TRUE(slid.at(pose(0.1995)).empty()) << "what has gone is not waited for";
}

TEST(SlidContacts, WaitForWork) {
  const auto pose = [](double x) { return at({x, 0.013, 0.05 + radius - deep}); };
  Slid slid(made(plate), made(ball), pose(0.0));
  EXPECT_TRUE(slid.at(pose(0.004), 1).empty());
  EXPECT_EQ(slid.at(pose(0.004)).size(), 1u);
}

// A small ball goes round a great one: its contact's normal follows.
TEST(SlidContacts, TurnWithTheSurface) {
  const auto pose = [](double angle) { return at((1.0 + 0.5 - 1e-3) * Vec3(std::sin(angle), 0.0, std::cos(angle))); };
  Slid slid(made("made:icosphere:radius=1,frequency=48"), made("made:icosphere:radius=0.5,frequency=24"), pose(0.02));
  ASSERT_FALSE(slid.found.empty());
  const double size = 0.5 * 2.0 * std::sqrt(3.0);
  const double angle = 0.02 + 0.04 * size;
  static_cast<void>(slid.at(pose(angle)));
  std::vector<Contact> near(1);
  // By then the point itself has come off the surface, by what a ball's does.
  ASSERT_EQ(slid.pair.late->manifold().write(pose(angle), size, near, 0.01), 1u);
  const Vec3 into_a = -Vec3(std::sin(angle), 0.0, std::cos(angle));
  EXPECT_GT(near[0].normal.dot(into_a), std::cos(0.05)) << "two facets lean by what it is to their corners each";
  EXPECT_LT(slid.found[0].normal.dot(into_a), std::cos(0.065)) << "as it was it leans";
  const double from_centre = (pose(angle).translation - pose(0.02).translation.normalized() * 0.5).norm();
  EXPECT_NEAR(near[0].depth, 1.0 - from_centre, 1.5e-3);
}

}  // namespace
}  // namespace odds::query
