// Contacts guessed in runs without time for a patch: bodies that touch elsewhere than before.
#include "query/contacts/guess_contacts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "odds/math/random.hpp"
#include "odds/math/tolerances.hpp"
#include "support/brute_force.hpp"
#include "support/shapes.hpp"
#include "support/short_request.hpp"
#include "support/slabs.hpp"

namespace odds::query {
namespace {

std::shared_ptr<const Shape> shape_of(mesh::TriangleMesh mesh) {
  return Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(mesh))).value();
}

/// A bump in a wall and one in the floor, both of radius 1, whose tops face the origin.
std::shared_ptr<const Shape> corner_of_bumps() {
  const auto bump = testing::wavy_sphere(40, 0.0);
  const Vec3 apart(1.3, 0.0, -1.3);
  return shape_of(testing::joined(*bump, *bump, apart));
}

// All contacts of a run used to get the direction of those before: a body that came off a wall onto the floor was
// pushed sideways while it sank in.
TEST(GuessedContacts, OfAnotherPlaceHaveADirectionOfTheirOwn) {
  const auto corner = corner_of_bumps();
  const auto ball = shape_of(testing::made_mesh("made:icosphere:frequency=24,radius=0.3"));
  const Vec3 middle(1.3, 0.0, 0.0);
  for (const std::int64_t look_ns : {100, 150, 200}) {
    int guessed = 0;
    int sideways = 0;
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      constexpr double deep = 0.01;
      realtime::ManualClock clock(look_ns);
      Pair pair = std::move(Pair::make(corner, ball, {.late_contacts = true})).value();
      const Request request = testing::short_request(clock, 5.0);
      math::Random random(seed);
      const Mat3 turned = random.rotation().toRotationMatrix();
      const auto run_at = [&](double x, double z) {
        return pair.run({turned, middle + Vec3(x, random.uniform(-1e-5, 1e-5), z)}, request);
      };
      for (int run = 0; run < 60; ++run) static_cast<void>(run_at(-deep, deep));
      for (int run = 0; run < 10; ++run) {
        const Answer answer = run_at(deep, -deep);
        for (const Contact& contact : answer.contacts) {
          ++guessed;
          sideways += std::abs(contact.normal.x()) > 0.7 ? 1 : 0;
        }
      }
    }
    EXPECT_GT(guessed, 200) << look_ns;
    EXPECT_LT(sideways, guessed / 4) << look_ns << " ns a look, of " << guessed;
  }
}

// Where two facets cross by little they overlap as little in the wrong direction: a bolt was pushed into the other side
// of its nut, and jammed.
TEST(GuessedContacts, OfTheOppositeSideDoNotPushIntoIt) {
  const auto bump = testing::wavy_sphere(40, 0.0);
  const auto walls = shape_of(testing::joined(*bump, *bump, Vec3(2.602, 0.0, 0.0)));
  const auto ball = shape_of(testing::made_mesh("made:icosphere:frequency=24,radius=0.3"));
  for (const std::int64_t look_ns : {100, 150, 200}) {
    int guessed = 0;
    int into = 0;
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
      realtime::ManualClock clock(look_ns);
      Pair pair = std::move(Pair::make(walls, ball, {.late_contacts = true})).value();
      const Request request = testing::short_request(clock, 5.0);
      math::Random random(seed);
      const Mat3 turned = random.rotation().toRotationMatrix();
      const auto run_at = [&](double x) {
        return pair.run({turned, Vec3(1.301 + x, random.uniform(-1e-5, 1e-5), 0.0)}, request);
      };
      for (int run = 0; run < 60; ++run) static_cast<void>(run_at(-0.004));
      for (int run = 0; run < 6; ++run) {
        const Answer answer = run_at(0.004);
        for (const Contact& contact : answer.contacts) {
          ++guessed;
          into += contact.normal.x() < -0.7 ? 1 : 0;  // into the walls
        }
      }
    }
    EXPECT_GT(guessed, 100) << look_ns;
    EXPECT_LT(into, guessed / 20) << look_ns << " ns a look, of " << guessed;
  }
}

// Where the ground came second, and its frame begins far away, a ball that rocked a little was said to be elsewhere in
// every run: what is guessed never got deeper while it sank in.
TEST(GuessedContacts, GetDeeperWhileABodySinksInWhereverFramesBegin) {
  const auto hill = testing::wavy_sphere(40, 0.0);
  const auto ball = shape_of(testing::made_mesh("made:bumpy_sphere:radius=0.3"));
  for (const double far : {0.0, 1000.0}) {
    const auto ground = Shape::build(testing::changed(*hill, 4.0, {Mat3::Identity(), Vec3(far, 0, 0)}, 0)).value();
    for (const bool ground_first : {true, false}) {
      realtime::ManualClock clock(150);
      const auto& [a, b] = ground_first ? std::pair(ground, ball) : std::pair(ball, ground);
      Pair pair = std::move(Pair::make(a, b, {.late_contacts = true})).value();
      double deepest = 0.0;
      for (int run = 0; run < 1500; ++run) {
        const Mat3 rocking = Eigen::AngleAxisd(2e-3 * std::sin(0.1 * run), Vec3::UnitY()).toRotationMatrix();
        const math::Pose ball_in_ground{rocking, Vec3(far, 0.0, 4.3 - 2e-6 * run)};
        const Answer& answer =
            pair.run(ground_first ? ball_in_ground : ball_in_ground.inverse(), testing::short_request(clock, 2.0));
        ASSERT_FALSE(answer.contacts_late);
        deepest = 0.0;
        for (const Contact& contact : answer.contacts) deepest = std::max(deepest, contact.depth);
      }
      EXPECT_GT(deepest, 3.0 * tolerances::unmeasured_depth * ball->mesh().size()) << far << " " << ground_first;
    }
  }
}

}  // namespace
}  // namespace odds::query
