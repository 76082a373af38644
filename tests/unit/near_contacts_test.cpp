// Contacts of surfaces that have come apart by a little.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "odds/math/random.hpp"
#include "odds/mesh/made/by_name.hpp"
#include "odds/query/pair.hpp"

namespace odds::query {
namespace {

constexpr double margin = 2e-4;

std::shared_ptr<const Shape> made(const std::string& name, volume::Kind volume = volume::Kind::wide) {
  auto mesh = mesh::made::make_shape(name).value();
  return Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(mesh)), {.volume = volume}).value();
}

/// Two bricks of 0.2 m, B above A.
class NearBricks : public ::testing::Test {
 protected:
  const std::shared_ptr<const Shape> brick = made("box:x=0.2,y=0.1,z=0.065,cells=4");
  Pair pair = std::move(Pair::make(brick, brick)).value();

  static math::Pose above(double gap, const Vec3& aside = {0.013, 0.007, 0}) {
    return {Mat3::Identity(), Vec3(0, 0, 0.065 + gap) + aside};
  }
  static Request request(double of_margin = margin) { return {.max_contacts = 8, .margin = of_margin}; }
  std::vector<Contact> run(const math::Pose& pose, const Request& asked = request()) {
    const auto contacts = pair.run(pose, asked).contacts;
    return {contacts.begin(), contacts.end()};
  }
};

TEST_F(NearBricks, ThatTouchedKeepTheirContactsAsTheyPart) {
  const std::size_t touching = run(above(-1e-5)).size();
  ASSERT_GE(touching, 4U);
  for (const double gap : {1e-9, 1e-7, 1e-5, 5e-5, 0.9 * margin}) {
    const Answer& answer = pair.run(above(gap), request());
    EXPECT_EQ(answer.verdict, Verdict::clear);
    EXPECT_EQ(answer.basis, Basis::proved);
    EXPECT_EQ(answer.probability, 0.0);
    ASSERT_EQ(answer.contacts.size(), touching) << gap;
    for (const Contact& contact : answer.contacts) {
      EXPECT_NEAR(contact.depth, -gap, 1e-12) << gap;
      EXPECT_NEAR(contact.normal.z(), -1.0, 1e-6) << "into A";
      EXPECT_NEAR(contact.position.z(), 0.0325 + 0.5 * gap, 1e-9) << "half-way";
    }
  }
  EXPECT_TRUE(run(above(1.01 * margin)).empty());
  EXPECT_TRUE(run(above(0.5 * margin)).empty()) << "what was let go is forgotten";
}

// The rays began as far behind as the margin reaches: a distance from there had lost the gap, and then the contact.
TEST_F(NearBricks, AreMeasuredAsWellWithinAMarginFarLargerThanTheyAre) {
  constexpr double gap = 1e-5;
  for (const double wide : {0.1, 1e3, 1e9, 1e15, 1e30, 1e200, std::numeric_limits<double>::max()}) {
    const std::size_t touching = run(above(-gap), request(wide)).size();
    ASSERT_GE(touching, 4U) << wide;
    const std::vector<Contact> contacts = run(above(gap), request(wide));
    ASSERT_EQ(contacts.size(), touching) << wide;
    for (const Contact& contact : contacts) {
      EXPECT_NEAR(contact.depth, -gap, 1e-12) << wide;
      EXPECT_NEAR(contact.position.z(), 0.0325 + 0.5 * gap, 1e-9) << wide;
    }
    pair.reset();
  }
}

TEST_F(NearBricks, HaveNoneUnlessAskedOrBeforeTheyTouch) {
  EXPECT_TRUE(run(above(1e-5)).empty());
  ASSERT_FALSE(run(above(-1e-5), request(0.0)).empty());
  EXPECT_TRUE(run(above(1e-5), request(0.0)).empty());
}

TEST_F(NearBricks, RockedOntoAnEdgeKeepTheOtherAsNear) {
  ASSERT_GE(run(above(-1e-5)).size(), 4U);
  const double angle = 2e-4;  // the far edge lifts by 40 um, the near one stays in by 10 um
  const Mat3 turned = Eigen::AngleAxisd(-angle, Vec3::UnitY()).toRotationMatrix();
  const std::vector<Contact> contacts = run({turned, Vec3(0.013, 0.007, 0.065 - 1e-5 + 0.1 * angle)});
  const auto meets = [](const Contact& contact) { return contact.depth >= 0.0; };
  EXPECT_TRUE(std::is_partitioned(contacts.begin(), contacts.end(), meets)) << "what meets comes first";
  const auto met = std::count_if(contacts.begin(), contacts.end(), meets);
  EXPECT_GE(met, 1);
  ASSERT_GE(static_cast<std::ptrdiff_t>(contacts.size()) - met, 2);
  double widest = 0.0;
  for (const Contact& contact : contacts) {
    if (meets(contact)) continue;
    const double there = -contact.depth;
    widest = std::max(widest, there);
    EXPECT_LE(there, 45e-6);
  }
  EXPECT_GT(widest, 20e-6);
}

TEST_F(NearBricks, WhatMeetsIsTheSameWithAMarginAsWithout) {
  auto plain = std::move(Pair::make(brick, brick)).value();
  math::Random random(5);
  for (int i = 0; i < 200; ++i) {
    const math::Pose pose = above(random.uniform(-1e-4, 1e-4), {1e-3 * random.uniform(-1, 1), 0, 0});
    const std::vector<Contact> with = run(pose);
    const Answer& without = plain.run(pose, request(0.0));
    ASSERT_LE(without.contacts.size(), with.size());
    for (std::size_t k = 0; k < without.contacts.size(); ++k) {
      EXPECT_EQ(with[k].position, without.contacts[k].position);
      EXPECT_EQ(with[k].depth, without.contacts[k].depth);
    }
    for (std::size_t k = without.contacts.size(); k < with.size(); ++k) EXPECT_LE(with[k].depth, 0.0);
  }
}

TEST_F(NearBricks, NeitherASlipNorARefusalIsRemembered) {
  ASSERT_GE(run(above(-1e-5)).size(), 4U);
  EXPECT_EQ(pair.run({Mat3::Zero(), Vec3::Zero()}, request()).basis, Basis::budget);
  EXPECT_TRUE(run(above(1e-5, {5.0, 0, 0})).empty()) << "far aside";
  ASSERT_GE(run(above(-1e-5)).size(), 4U);
  pair.reset();
  EXPECT_TRUE(run(above(1e-5)).empty());
}

TEST_F(NearBricks, OnlyTheRunBeforeCounts) {
  ASSERT_FALSE(run(above(-1e-5)).empty());
  EXPECT_TRUE(run(above(0.01), request(0.0)).empty());
  EXPECT_TRUE(run(above(1e-5)).empty()) << "a run without a margin was in between";
  ASSERT_FALSE(run(above(-1e-5)).empty());
  pair.note_apart(above(0.01));
  EXPECT_TRUE(run(above(1e-5)).empty()) << "a broad phase saw them apart";
}

TEST_F(NearBricks, RefuseAMarginThatIsNone) {
  for (const double bad : {-1e-9, std::nan(""), std::numeric_limits<double>::infinity()})
    EXPECT_EQ(pair.run(above(1e-5), request(bad)).basis, Basis::budget);
}

TEST_F(NearBricks, KeepWithinTheirWork) {
  for (const std::uint64_t units : {1U, 8U, 40U, 100U, 300U, 1000U}) {
    pair.reset();
    Request limited = request();
    for (const double gap : {-1e-5, 1e-6, 1e-5, -1e-6, 1e-5}) {
      limited.budget = Budget::work(units);
      const Answer& answer = pair.run(above(gap), limited);
      EXPECT_LE(answer.cost.node_pairs + answer.cost.triangle_pairs, units + 16) << units;
    }
  }
}

TEST(NearContacts, APegThatLeavesAWallIsNearIt) {
  const auto plate = made("plate_with_hole");
  const auto peg = made("peg");
  auto pair = std::move(Pair::make(plate, peg)).value();
  // Pushed against the wall of its hole until it meets it, then drawn away by a little.
  const auto at = [](double x) { return math::Pose{Mat3::Identity(), Vec3(x, 0, -0.005)}; };
  const Request asked{.max_contacts = 8, .margin = margin};
  double x = 0.0;
  while (x < 0.002 && pair.run(at(x), asked).verdict == Verdict::clear) x += 1e-6;
  ASSERT_LT(x, 0.002);
  const Answer& answer = pair.run(at(x - 2e-5), asked);
  ASSERT_EQ(answer.verdict, Verdict::clear);
  ASSERT_FALSE(answer.contacts.empty());
  for (const Contact& contact : answer.contacts) {
    EXPECT_GT(contact.normal.x(), 0.5) << "into the plate, as the peg pushed";
    EXPECT_NEAR(-contact.depth, 2e-5, 1e-5);
  }
}

TEST(NearContacts, ABallThatTurnedAwayIsNotNear) {
  // Turned about the place where it touched a block, by its edge, and moved off it: above the place, within the margin,
  // is the same side of the ball, which slants more and more; below the ball is nothing.
  const auto block = made("box:x=0.2,y=0.2,z=0.1");
  const auto ball = made("icosphere:radius=0.02,frequency=12");
  auto pair = std::move(Pair::make(block, ball)).value();
  const Request asked{.max_contacts = 8, .margin = margin};
  const Vec3 place(0.1 - 1e-5, 0, 0.05);
  for (const double degrees : {10.0, 30.0, 75.0}) {
    pair.reset();
    const Mat3 turned = Eigen::AngleAxisd(degrees * 3.14159265358979 / 180.0, Vec3::UnitY()).toRotationMatrix();
    ASSERT_FALSE(pair.run({Mat3::Identity(), place + Vec3(0, 0, 0.02 - 1e-6)}, asked).contacts.empty());
    const Answer& answer = pair.run({turned, place + turned * Vec3(0, 0, 0.02) + Vec3(2e-5, 0, 0)}, asked);
    ASSERT_EQ(answer.verdict, Verdict::clear) << degrees;
    EXPECT_EQ(answer.contacts.empty(), degrees > 60.0) << degrees;
  }
}

/// Whatever the shapes, volume, order and motion: gaps are no less than the distance and no more than the margin, and
/// nothing is given where bodies are farther apart.
TEST(NearContacts, AreNeverNearerThanTheBodies) {
  for (const volume::Kind volume : {volume::Kind::wide, volume::Kind::obb}) {
    const auto a = made("torus:ring=0.02,tube=0.008,around=24,across=12", volume);
    const auto b = made("bumpy_sphere:radius=0.02,frequency=6", volume);
    for (const bool swapped : {false, true}) {
      const auto& first = swapped ? b : a;
      const auto& second = swapped ? a : b;
      auto pair = std::move(Pair::make(first, second)).value();
      auto judge = std::move(Pair::make(made(swapped ? "bumpy_sphere:radius=0.02,frequency=6"
                                                     : "torus:ring=0.02,tube=0.008,around=24,across=12"),
                                        made(swapped ? "torus:ring=0.02,tube=0.008,around=24,across=12"
                                                     : "bumpy_sphere:radius=0.02,frequency=6")))
                       .value();
      math::Random random(9);
      int near = 0;
      for (int way = 0; way < 40; ++way) {
        const Mat3 turned = random.rotation().toRotationMatrix();
        const Vec3 direction = random.direction();
        double low = 0.0;
        double high = 0.1;  // by halving: where they touch
        for (int i = 0; i < 40; ++i) {
          const double middle = 0.5 * (low + high);
          (judge.distance({turned, middle * direction}).upper > 0.0 ? high : low) = middle;
        }
        for (const double step : {-3e-5, -1e-6, 1e-7, 2e-5, 1e-4, 3e-4}) {
          const math::Pose pose{turned, (high + step) * direction};
          const Answer& answer = pair.run(pose, {.max_contacts = 8, .solids = true, .margin = margin});
          const double distance = judge.distance(pose).upper;
          for (const Contact& contact : answer.contacts) {
            ASSERT_TRUE(contact.position.allFinite() && contact.normal.allFinite());
            EXPECT_NEAR(contact.normal.norm(), 1.0, 1e-9);
            if (contact.depth >= 0.0 && answer.verdict == Verdict::hit) continue;
            ++near;
            EXPECT_GE(-contact.depth, distance - 1e-9);
            EXPECT_LE(-contact.depth, margin);
          }
          if (distance > margin) {
            EXPECT_TRUE(answer.contacts.empty());
          }
        }
      }
      EXPECT_GT(near, 40) << volume::name(volume);
    }
  }
}

}  // namespace
}  // namespace odds::query
