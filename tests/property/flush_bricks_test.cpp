// Bricks that lie flush on each other, or touch along an edge or at a corner: whatever part of the rim a budget leaves,
// no contact points sideways or is stated deeper than one brick is in the other.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "odds/math/random.hpp"
#include "odds/mesh/made/by_name.hpp"
#include "odds/query/pair.hpp"
#include "support/short_request.hpp"

namespace odds::query {
namespace {

const Vec3 half(0.1, 0.25, 0.124);  ///< of the bricks' sides, metres

std::shared_ptr<const Shape> brick(int cells) {
  auto made = mesh::made::make_shape("made:box:x=0.2,y=0.5,z=0.248,cells=" + std::to_string(cells));
  return Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(made.value()))).value();
}

struct Stand {
  math::Pose below;  ///< of the lower brick, B, in the upper one's frame
  double dip = 0.0;  ///< how deep its highest corner is in the upper brick, metres
};

/// `most` is the power of ten of each: of the turn (radians), the offset and the dip (metres); each is spread over
/// `less` powers below it. One stand in two turns about one axis only, or is offset along one only.
struct Powers {
  double turn, offset, dip, less;
};
Stand random_stand(math::Random& random, const Powers& most) {
  const auto power = [&](double ten) { return std::pow(10.0, ten - random.uniform(0.0, most.less)); };
  const double angle = power(most.turn);
  Vec3 turn(angle * random.uniform(-1, 1), angle * random.uniform(-1, 1), angle * random.uniform(-1, 1));
  if (const auto axis = random.below(4); axis < 2) turn[static_cast<Eigen::Index>(axis)] *= 1e-3;
  const double offset = power(most.offset);
  Vec3 place(offset * random.uniform(-1, 1), offset * random.uniform(-1, 1), 0.0);
  if (const auto axis = random.below(4); axis < 2) place[static_cast<Eigen::Index>(axis)] *= 1e-4;
  const Quat rotation = Quat(1.0, 0.5 * turn.x(), 0.5 * turn.y(), 0.5 * turn.z()).normalized();
  double top = -1.0;
  for (const double x : {-half.x(), half.x()}) {
    for (const double y : {-half.y(), half.y()}) top = std::max(top, (rotation * Vec3(x, y, half.z())).z());
  }
  const double dip = power(most.dip);
  place.z() = -half.z() + dip - top;
  return {math::Pose::from_quaternion(place, rotation), dip};
}

struct Found {
  int contacts = 0;
  int sideways = 0;
  int deep = 0;  ///< ten times deeper than a brick is in the other, and not by what is believed where none has measured
};
Found over_stands(int cells_a, int cells_b, int stands, const Powers& most, const Budget& budget, double unmeasured) {
  auto pair = std::move(Pair::make(brick(cells_a), brick(cells_b))).value();
  math::Random random(5, 8);
  Found found;
  for (int i = 0; i < stands; ++i) {
    const Stand stand = random_stand(random, most);
    pair.reset();
    Request request;
    request.max_contacts = most_contacts;
    request.budget = budget;
    for (const Contact& contact : pair.run(stand.below, request).contacts) {
      ++found.contacts;
      found.sideways += contact.normal.z() < 0.99 ? 1 : 0;
      found.deep += contact.depth > std::max(10.0 * stand.dip, unmeasured) ? 1 : 0;
    }
  }
  return found;
}

constexpr Powers settled{-4.5, -4.0, -5.0, 5.0};

TEST(FlushBricks, AreNotPushedSidewaysHoweverLittleTimeThereIs) {
  for (const std::uint64_t units : {400U, 500U, 900U, 2000U}) {
    for (const auto& [a, b] : {std::pair{11, 11}, {8, 11}, {11, 1}}) {
      const Found found = over_stands(a, b, 2500, settled, Budget::work(units), 2e-5);
      EXPECT_GT(found.contacts, 2500);
      EXPECT_EQ(found.sideways, 0) << units << " units, " << a << " and " << b << " cells";
      EXPECT_EQ(found.deep, 0) << units << " units, " << a << " and " << b << " cells";
    }
  }
}

/// Area of the polygon of the contacts' places, seen from above, square metres.
double supported_area(std::span<const Contact> contacts) {
  double area = 0.0;
  Vec3 centre = Vec3::Zero();
  for (const Contact& contact : contacts) centre += contact.position / static_cast<double>(contacts.size());
  std::vector<Vec3> places;
  for (const Contact& contact : contacts) places.push_back(contact.position - centre);
  std::sort(places.begin(), places.end(),
            [](const Vec3& p, const Vec3& q) { return std::atan2(p.y(), p.x()) < std::atan2(q.y(), q.x()); });
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Vec3& p = places[i];
    const Vec3& q = places[(i + 1) % places.size()];
    area += 0.5 * (p.x() * q.y() - p.y() * q.x());
  }
  return area;
}

TEST(FlushBricks, InFiveMicrosecondsAreHeldAsWithoutALimit) {
  math::Random random(5, 9);
  for (const auto& [cells_a, cells_b] : {std::pair{1, 1}, {8, 8}, {11, 1}, {5, 12}}) {
    const auto a = brick(cells_a);
    const auto b = brick(cells_b);
    int flush = 0;
    int stands = 0;
    for (int i = 0; i < 100; ++i) {
      Stand stand = random_stand(random, {-3.5, -4.0, -5.0, 2.0});
      stand.below.rotation =
          Eigen::AngleAxisd(random.uniform(-3, 3), Vec3::UnitZ()).toRotationMatrix() * stand.below.rotation;
      stand.below.translation.x() += random.uniform(-0.1, 0.1);
      auto careful = std::move(Pair::make(a, b)).value();
      Request all;
      all.max_contacts = most_contacts;
      const Answer& exact = careful.run(stand.below, all);
      if (exact.contacts.size() < 3) continue;  // it stands on one edge
      ++stands;
      auto pair = std::move(Pair::make(a, b, {.late_contacts = true})).value();
      realtime::ManualClock clock(60);
      Request request = testing::short_request(clock);
      request.max_contacts = most_contacts;
      for (int run = 0; run < 10; ++run) static_cast<void>(pair.run(stand.below, request));
      const Answer& answer = pair.run(stand.below, request);
      if (!answer.contacts_flush) continue;
      ++flush;
      double deepest[2] = {0.0, 0.0};
      for (const Contact& contact : exact.contacts) deepest[0] = std::max(deepest[0], contact.depth);
      for (const Contact& contact : answer.contacts) {
        deepest[1] = std::max(deepest[1], contact.depth);
        EXPECT_GT(contact.normal.z(), 0.999);
      }
      EXPECT_NEAR(deepest[1], deepest[0], 0.05 * deepest[0] + 1e-9) << cells_a << " " << cells_b << " " << i;
      EXPECT_GT(supported_area(answer.contacts), 0.8 * supported_area(exact.contacts)) << cells_a << " " << i;
    }
    EXPECT_GT(stands, 50);
    EXPECT_GE(flush, stands * 95 / 100) << cells_a << " and " << cells_b << " cells";
  }
}

TEST(FlushBricks, AreNotPushedSidewaysWithoutABudget) {
  for (const auto& [a, b] : {std::pair{1, 1}, {8, 8}, {11, 1}}) {
    const Found found = over_stands(a, b, 1500, settled, {}, 0.0);
    EXPECT_GT(found.contacts, 1500);
    EXPECT_EQ(found.sideways, 0) << a << " and " << b << " cells";
    EXPECT_EQ(found.deep, 0) << a << " and " << b << " cells";
  }
}

// By so little that a rim is what rounding has left of it: a point where two walls cross has no face that leads out.
TEST(FlushBricks, ThatTouchWithinRoundingAreNotPushedFromEndToEnd) {
  for (const auto& [a, b] : {std::pair{1, 1}, {8, 8}, {11, 1}}) {
    const Found found = over_stands(a, b, 6000, {-5.5, -2.0, -14.0, 5.0}, {}, 1e-9);
    EXPECT_GT(found.contacts, 2000);
    EXPECT_EQ(found.deep, 0) << a << " and " << b << " cells";
    if (a == b) {
      EXPECT_EQ(found.sideways, 0) << a << " and " << b << " cells";
    }
  }
}

// As late contacts ask for bodies that are pressed together, flush by any power of ten, or exactly, along each axis:
// strips of their sides overlap, and what rounding makes of their rims is closed and points anywhere. With `known` the
// run before has left its direction.
void expect_upward_pushes(bool known) {
  for (const auto& [cells, seed] : {std::pair{1, 3}, {1, 6}, {8, 5}, {8, 6}}) {
    auto pair = std::move(Pair::make(brick(cells), brick(cells))).value();
    math::Random random(static_cast<std::uint64_t>(seed));
    const auto power = [&random](double least, double most) {
      if (random.uniform(0, 1) < 0.15) return 0.0;
      return std::pow(10.0, random.uniform(least, most)) * (random.uniform(0, 1) < 0.5 ? -1.0 : 1.0);
    };
    int sideways = 0;
    double deepest = 0.0;
    for (int i = 0; i < 20000; ++i) {
      const double x = power(-10, -3.5);
      const double y = power(-10, -3.5);
      const double z = power(-10, -3.5);
      math::Pose pose;
      pose.rotation = (Eigen::AngleAxisd(x, Vec3::UnitX()) * Eigen::AngleAxisd(y, Vec3::UnitY()) *
                       Eigen::AngleAxisd(z, Vec3::UnitZ()))
                          .toRotationMatrix();
      pose.translation.x() = power(-12, -3.5);
      pose.translation.y() = power(-12, -3.5);
      pose.translation.z() = 2.0 * half.z() - 6e-4 - std::abs(power(-9, -4));
      if (!known) pair.reset();
      for (const Contact& contact :
           pair.run(pose, {.method = Method::exact, .max_contacts = most_contacts, .solids = true}).contacts) {
        sideways += contact.normal.z() > -0.99 ? 1 : 0;
        deepest = std::max(deepest, contact.depth);
      }
    }
    EXPECT_EQ(sideways, 0) << cells << " cells, seed " << seed;
    EXPECT_LE(deepest, 1e-3) << cells << " cells, seed " << seed;
  }
}

TEST(FlushBricks, ThatLieInEachOtherPushUpwards) { expect_upward_pushes(false); }
TEST(FlushBricks, ThatLieInEachOtherPushUpwardsAsBefore) { expect_upward_pushes(true); }

// As a stack at rest does: the sides are flush to within the rounding of a simulation, and what crosses there is
// closed.
TEST(FlushBricks, ThatStandExactlyOnEachOtherPushUpwards) {
  for (const std::uint64_t units : {900U, 2000U, 1000000U}) {
    for (const double offset : {-7.0, -9.0, -11.0}) {
      const Found found = over_stands(11, 11, 500, {-9.0, offset, -4.0, 1.5}, Budget::work(units), 6e-5);
      EXPECT_GT(found.contacts, 500);
      EXPECT_EQ(found.sideways, 0) << units << " units, offsets of 1e" << offset << " m";
      EXPECT_EQ(found.deep, 0) << units << " units, offsets of 1e" << offset << " m";
    }
  }
}

}  // namespace
}  // namespace odds::query
