// Runs within a short budget that have proved a hit before any search: they answer it, in either order of the bodies.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "odds/math/random.hpp"
#include "odds/query/pair.hpp"
#include "support/shapes.hpp"
#include "support/short_request.hpp"
#include "support/slabs.hpp"

namespace odds::query {
namespace {

using testing::made_mesh;
using testing::short_request;

std::shared_ptr<const Shape> shape_of(mesh::TriangleMesh mesh) {
  return Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(mesh))).value();
}

/// With its top at z = 0, and a wall on it whose side is at x = 0.5.
std::shared_ptr<const Shape> floor_with_wall() {
  return shape_of(testing::joined(made_mesh("made:box:x=2,y=2,z=0.2,cells=6"),
                                  made_mesh("made:box:x=0.2,y=2,z=0.78,cells=5"), Vec3(0.6, 0.0, 0.51)));
}
constexpr double floor_top = 0.1;

std::shared_ptr<const Shape> crate(int cells) {
  return shape_of(made_mesh("made:box:x=0.2,y=0.2,z=0.2,cells=" + std::to_string(cells)));
}

/// How far the lowest corner of a crate so turned is below its middle.
double reach_down(const Mat3& turned) { return 0.1 * turned.row(2).cwiseAbs().sum(); }

Pair late_pair(const std::shared_ptr<const Shape>& ground, const std::shared_ptr<const Shape>& body, bool exchanged) {
  return std::move(exchanged ? Pair::make(body, ground, {.late_contacts = true})
                             : Pair::make(ground, body, {.late_contacts = true}))
      .value();
}

// The proof used to be thrown away where nothing that is carried served, for a search that had no time left.
TEST(ProvedHits, OfACrateThatRocksBesideAWallAreNotLost) {
  const auto ground = floor_with_wall();
  const auto body = crate(8);
  constexpr int runs = 800;
  for (const auto& [microseconds, look_ns] : {std::pair(4.0, 80), std::pair(6.0, 150), std::pair(10.0, 250)}) {
    for (const bool exchanged : {false, true}) {
      Pair pair = late_pair(ground, body, exchanged);
      realtime::ManualClock clock(look_ns);
      math::Random random(1);
      double x = 0.38;
      double speed = 2e-4;
      double angle = 0.0;
      double turning = 0.0;
      int undecided = 0;
      int without_contact = 0;
      for (int run = 0; run < runs; ++run) {
        x += speed;
        if (x > 0.4002) speed = -2e-4;
        if (x < 0.39) speed = 2e-4;
        turning = 0.98 * (turning - 0.02 * angle + 3e-4 * random.uniform(-1.0, 1.0));
        angle += turning;
        const Mat3 turned = Eigen::AngleAxisd(angle, Vec3(0.3, 1.0, 0.0).normalized()).toRotationMatrix();
        const double height = floor_top + reach_down(turned) - random.uniform(1e-5, 5e-5);
        const math::Pose pose{turned, {std::min(x, 0.4002), 0.017, height}};
        const Answer& answer = pair.run(exchanged ? pose.inverse() : pose, short_request(clock, microseconds));
        undecided += answer.basis == Basis::budget ? 1 : 0;
        without_contact += answer.basis == Basis::proved && answer.contacts.empty() ? 1 : 0;
      }
      EXPECT_LT(undecided, runs / 20) << microseconds << " us, exchanged " << exchanged;
      EXPECT_EQ(without_contact, 0) << microseconds << " us, exchanged " << exchanged;
    }
  }
}

// A layer along the leaning face alone leaves a floor of large triangles: the crate's walls, which cross the floor at
// its edge, used to be taken for something that touches beside, if the crate was the first body.
TEST(ProvedHits, OfACrateOnItsEdgeAreOfThatEdgeInEitherOrder) {
  const auto ground = shape_of(made_mesh("made:box:x=2,y=2,z=0.2,cells=4"));
  const auto body = crate(6);
  for (const double microseconds : {6.0, 15.0}) {
    for (const bool exchanged : {false, true}) {
      Pair pair = late_pair(ground, body, exchanged);
      realtime::ManualClock clock(120);
      int tilted = 0;
      int known = 0;
      for (int run = 0; run < 400; ++run) {
        const double angle = std::clamp(0.0005 * (run - 60), 0.0, 0.1);
        const Mat3 turned = Eigen::AngleAxisd(angle, Vec3::UnitY()).toRotationMatrix();
        const math::Pose pose{turned, {0.013, 0.017, floor_top + reach_down(turned) - 2e-5}};
        const Answer& answer = pair.run(exchanged ? pose.inverse() : pose, short_request(clock, microseconds));
        if (angle < 0.05) continue;
        ++tilted;
        known += answer.contacts_flush || answer.contacts_late ? 1 : 0;
      }
      EXPECT_GT(known, tilted * 9 / 10) << microseconds << " us, exchanged " << exchanged << ", of " << tilted;
    }
  }
}

// What has slid over an edge is no contact any more: if it was all there was, what meets now is looked at.
TEST(ProvedHits, OfABodyThatSlidesOverAnEdgeHaveContacts) {
  const auto block = shape_of(made_mesh("made:box:cells=8"));
  const auto ball = shape_of(made_mesh("made:icosphere"));
  const double radius = -ball->mesh().lower().z();
  const double size = std::min(block->mesh().size(), ball->mesh().size());
  const Mat3 turned = Eigen::AngleAxisd(0.3, Vec3(1.0, 2.0, 3.0).normalized()).toRotationMatrix();
  int hits = 0;
  for (const int look_ns : {60, 100, 150}) {
    for (const double microseconds : {5.0, 10.0, 20.0}) {
      for (const double deep : {1e-3, 5e-3}) {
        Pair pair = std::move(Pair::make(block, ball, {.late_contacts = true})).value();
        realtime::ManualClock clock(look_ns);
        const double edge = block->mesh().upper().x();
        for (double x = edge - 0.3 * radius; x < edge + 0.3 * radius; x += 1e-3 * size) {
          const math::Pose pose{turned, {x, 0.0137 * radius, block->mesh().upper().z() + radius - deep * size}};
          const Answer& answer = pair.run(pose, short_request(clock, microseconds));
          if (answer.basis != Basis::proved || answer.verdict != Verdict::hit) continue;
          ++hits;
          ASSERT_FALSE(answer.contacts.empty()) << look_ns << " ns, " << microseconds << " us, " << deep << ", " << x;
        }
      }
    }
  }
  EXPECT_GT(hits, 1000);
}

// That nothing touched beside one face used to outlive a reset, and the others were not looked for.
TEST(ProvedHits, OfAPairThatWasResetAreThoseOfANewOne) {
  Pair pair = late_pair(floor_with_wall(), crate(10), false);
  realtime::ManualClock clock(150);
  const math::Pose pose{Mat3::Identity(), {0.40001, 0.013, floor_top + 0.1 - 1e-5}};
  const auto runs_until_both = [&] {
    int runs = 0;
    for (bool both = false; !both && runs < 100; ++runs) {
      const Answer& answer = pair.run(pose, short_request(clock, 8.0));
      const auto along = [&answer](int axis) {
        return std::any_of(answer.contacts.begin(), answer.contacts.end(),
                           [axis](const Contact& contact) { return std::abs(contact.normal[axis]) > 0.9; });
      };
      both = along(0) && along(2);
    }
    return runs;
  };
  const int of_a_new_pair = runs_until_both();
  for (int run = 0; run < 60; ++run) static_cast<void>(pair.run(pose, short_request(clock, 8.0)));
  EXPECT_FALSE(pair.crossings().empty());
  pair.reset();
  EXPECT_TRUE(pair.crossings().empty());
  EXPECT_LE(runs_until_both(), of_a_new_pair);
  static_cast<void>(pair.run({Mat3::Constant(std::nan("")), Vec3::Zero()}, short_request(clock, 8.0)));
  EXPECT_TRUE(pair.crossings().empty()) << "a refused run finds nothing";
}

// Rays that tell that a body is within a solid may take all that there was for those that look for a way out: the hit
// was proved, and had no contact.
TEST(ProvedHits, OfABodyWithinASolidHaveAWayOut) {
  const auto ball = shape_of(made_mesh("made:bumpy_sphere:frequency=12,radius=1"));
  const auto body = shape_of(made_mesh("made:bolt"));
  const Vec3 place(0.3, 0.1, 0.2);
  for (const bool exchanged : {false, true}) {
    int hits = 0;
    for (std::uint64_t units = 1; units <= 400; ++units) {
      Pair pair = (exchanged ? Pair::make(body, ball) : Pair::make(ball, body)).value();
      Request request;
      request.method = Method::incremental;
      request.max_contacts = 4;
      request.solids = true;
      request.budget = Budget::work(units);
      const math::Pose pose{Mat3::Identity(), place};
      for (int run = 0; run < 2; ++run) {
        const Answer& answer = pair.run(exchanged ? pose.inverse() : pose, request);
        if (answer.basis != Basis::proved || answer.verdict != Verdict::hit) continue;
        ++hits;
        ASSERT_FALSE(answer.contacts.empty()) << units << " units, exchanged " << exchanged << ", run " << run;
        const Contact& out = answer.contacts.front();
        EXPECT_GT((exchanged ? 1.0 : -1.0) * out.normal.dot(place), 0.0) << "away from the middle";
        EXPECT_GT(out.depth, 0.0);
      }
    }
    EXPECT_GT(hits, 100);
  }
}

}  // namespace
}  // namespace odds::query
