// Bodies that were apart stay on their sides of a sheet, and are no deeper than they have come since.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "odds/mesh/made/by_name.hpp"
#include "odds/query/pair.hpp"
#include "support/short_request.hpp"

namespace odds::query {
namespace {

std::shared_ptr<const Shape> sheet() {
  std::vector<Vec3> corners{{-0.05, -0.05, 0}, {0.05, -0.05, 0}, {0.05, 0.05, 0}, {-0.05, 0.05, 0}};
  std::vector<mesh::Triangle> triangles{{0, 1, 2}, {0, 2, 3}};
  return Shape::build(std::make_shared<const mesh::TriangleMesh>(
                          mesh::TriangleMesh::make(std::move(corners), std::move(triangles), "sheet").value()))
      .value();
}
std::shared_ptr<const Shape> ball() {
  return Shape::build(
             std::make_shared<const mesh::TriangleMesh>(mesh::made::make_shape("icosphere:radius=0.005").value()))
      .value();
}
math::Pose at(double z) { return {Mat3::Identity(), {0.001, 0.002, z}}; }

/// The first contact's normal at `z`; into the sheet.
Vec3 normal_at(Pair& pair, double z, const Budget& budget) {
  const Answer& answer =
      pair.run(at(z), {.method = Method::incremental, .budget = budget, .max_contacts = 8, .solids = true});
  return answer.contacts.empty() ? Vec3(Vec3::Zero()) : answer.contacts.front().normal;
}

TEST(SheetInAHurry, ABallThatHasAllButPassedIsPushedBackWhenceItCame) {
  for (const double side : {1.0, -1.0}) {
    for (const std::uint64_t units : {100000ULL, 100ULL, 60ULL}) {
      auto pair = std::move(Pair::make(sheet(), ball())).value();
      EXPECT_EQ(pair.run(at(side * 0.02), {.method = Method::incremental, .max_contacts = 8}).verdict, Verdict::clear);
      // 5 m/s at 1 kHz, and the centre has passed by 1 mm: by its place it belongs to the other side.
      Vec3 normal = Vec3::Zero();
      for (int run = 0; run < 8 && normal.isZero(); ++run) normal = normal_at(pair, -side * 0.001, Budget::work(units));
      EXPECT_LT(side * normal.z(), units > 1000 ? -0.9 : -0.5) << side << " " << units;
    }
  }
}

TEST(SheetInAHurry, ABallThatWasNeverSeenApartIsPushedTowardsItsPlace) {
  auto pair = std::move(Pair::make(sheet(), ball())).value();
  EXPECT_GT(normal_at(pair, -0.001, Budget::unlimited()).z(), 0.9);
}

TEST(SheetInAHurry, ABroadPhaseMaySayThatTheyWereApart) {
  auto pair = std::move(Pair::make(sheet(), ball())).value();
  pair.note_apart(at(0.0055));
  EXPECT_LT(normal_at(pair, -0.001, Budget::unlimited()).z(), -0.9);
  auto starved = std::move(Pair::make(sheet(), ball())).value();
  starved.note_apart(at(0.0055));
  double deepest = 0.0;
  for (int run = 0; run < 20; ++run) {
    const Answer& answer = starved.run(
        at(0.003), {.method = Method::incremental, .budget = Budget::work(40), .max_contacts = 8, .solids = true});
    for (const Contact& contact : answer.contacts) deepest = std::max(deepest, contact.depth);
  }
  EXPECT_GT(deepest, 0.0019) << "it is 2 mm deep";
  EXPECT_LT(deepest, 0.0026) << "it has come by 2.5 mm";
}

// Until its centre has passed: then it is pushed either way, as little time as there is to tell.
TEST(SheetInAHurry, ABallThatCameSlowlyIsPushedBackToo) {
  for (const std::uint64_t units : {38ULL, 40ULL, 45ULL, 50ULL}) {
    for (const double side : {1.0, -1.0}) {
      auto pair = std::move(Pair::make(sheet(), ball())).value();
      int pushed = 0;
      int back = 0;
      for (double z = 0.0051; z > 0.0; z -= 1e-6) {  // each run's motion alone is a tremor
        const Vec3 normal = normal_at(pair, side * z, Budget::work(units));
        pushed += normal.isZero() ? 0 : 1;
        back += side * normal.z() < -0.5 ? 1 : 0;
      }
      EXPECT_GT(pushed, 4000) << units << " " << side;
      EXPECT_GT(back, 0.97 * pushed) << units << " " << side;
    }
  }
}

TEST(SheetInAHurry, ABallThatWentRoundIsPushedTowardsItsPlace) {
  auto pair = std::move(Pair::make(sheet(), ball())).value();
  static_cast<void>(normal_at(pair, 0.0055, Budget::work(40)));
  Vec3 above = Vec3::Zero();
  for (int run = 0; run < 4; ++run) above = normal_at(pair, 0.0045, Budget::work(40));
  EXPECT_LT(above.z(), -0.8);
  // Farther than half of it in one run, and nobody has said how.
  Vec3 below = Vec3::Zero();
  for (int run = 0; run < 4; ++run) below = normal_at(pair, -0.0049, Budget::work(40));
  EXPECT_GT(below.z(), 0.8);
}

TEST(SheetInAHurry, ABallThatTouchedAndWentRoundIsPushedTowardsItsPlace) {
  auto pair = std::move(Pair::make(sheet(), ball())).value();
  static_cast<void>(normal_at(pair, 0.0050002, Budget::unlimited()));
  static_cast<void>(normal_at(pair, 0.0049998, Budget::work(20)));  // by less than a tremor: no side is known yet
  EXPECT_GT(normal_at(pair, -0.0049, Budget::work(100)).z(), 0.8);
}

TEST(SheetInAHurry, ANewStartForgetsWhereItWasApart) {
  auto pair = std::move(Pair::make(sheet(), ball())).value();
  pair.note_apart(at(0.0055));
  pair.reset();
  EXPECT_GT(normal_at(pair, -0.001, Budget::unlimited()).z(), 0.9);
}

TEST(SheetInAHurry, APoseThatIsNoneSaysNothing) {
  auto pair = std::move(Pair::make(sheet(), ball())).value();
  math::Pose none = at(0.0055);
  none.translation.x() = std::numeric_limits<double>::quiet_NaN();
  pair.note_apart(none);
  none = at(0.0055);
  none.rotation *= 2.0;
  pair.note_apart(none);
  EXPECT_GT(normal_at(pair, -0.001, Budget::unlimited()).z(), 0.9);
}

std::shared_ptr<const Shape> shape_of(mesh::TriangleMesh mesh) {
  return Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(mesh))).value();
}

/// Open, 2 m wide.
std::shared_ptr<const Shape> uneven_ground() {
  constexpr std::uint32_t side = 40;
  std::vector<Vec3> corners;
  std::vector<mesh::Triangle> triangles;
  for (std::uint32_t y = 0; y <= side; ++y) {
    for (std::uint32_t x = 0; x <= side; ++x) {
      const auto here = static_cast<std::uint32_t>(corners.size());
      corners.emplace_back(0.05 * x - 1.0, 0.05 * y - 1.0, 0.002 * std::sin(1.0 * here));
      if (x == side || y == side) continue;
      triangles.push_back({here, here + 1, here + side + 2});
      triangles.push_back({here, here + side + 2, here + side + 1});
    }
  }
  return shape_of(mesh::TriangleMesh::make(std::move(corners), std::move(triangles)).value());
}

// The side was told by where the ground's middle is, which lies sideways: half of what was guessed pushed into the
// ground.
TEST(SheetInAHurry, ABallFarFromTheMiddleOfTheGroundIsPushedUp) {
  const auto ground = uneven_ground();
  const auto small = shape_of(mesh::made::make_shape("icosphere:radius=0.005,frequency=12").value());
  for (const int kind : {0, 1, 2, 3}) {
    const bool late = kind % 2 == 0;
    const bool ground_first = kind < 2;
    int guessed = 0;
    int upwards = 0;
    for (int place = 0; place < 24; ++place) {
      const auto pair_of = [&] {
        const PairOptions options{.late_contacts = late};
        return std::move(ground_first ? Pair::make(ground, small, options) : Pair::make(small, ground, options))
            .value();
      };
      const auto pose = [&](double z) {
        const math::Pose there{Mat3::Identity(), {0.8 * std::cos(place), 0.8 * std::sin(place), z}};
        return ground_first ? there : there.inverse();
      };
      Pair sinks = pair_of();
      double touching = 0.01;
      while (sinks.run(pose(touching), {}).verdict == Verdict::clear) touching -= 1e-4;
      Pair pair = pair_of();
      realtime::ManualClock clock(100);
      Request request = testing::short_request(clock, 8.0);
      request.late_contacts = late;
      for (int run = 0; run < 6; ++run) {
        for (const Contact& contact : pair.run(pose(touching - 5e-4), request).contacts) {
          ++guessed;
          upwards += (ground_first ? -1.0 : 1.0) * contact.normal.z() > 0.5 ? 1 : 0;
        }
      }
    }
    EXPECT_GT(guessed, 200) << kind;
    EXPECT_EQ(upwards, guessed) << kind;
  }
}

// In the frame of the ball, which was the first body, what lies below it seemed to have come from above, and what
// pushed it up pushed it down once it had turned: it was drawn through the ground by all of its diameter.
TEST(SheetInAHurry, ABallThatTurnsKnowsItsSideInEitherOrder) {
  const auto ground = uneven_ground();
  const auto small = shape_of(mesh::made::make_shape("icosphere:radius=0.05,frequency=8").value());
  for (const bool ground_first : {true, false}) {
    for (const double microseconds : {std::numeric_limits<double>::infinity(), 20.0, 5.0}) {
      for (int way = 0; way < 24; ++way) {
        const Vec3 axis = Vec3(std::cos(way), std::sin(way), 0.2).normalized();
        const auto pose = [&](double turned, double z) {
          const math::Pose there{Eigen::AngleAxisd(turned, axis).toRotationMatrix(), {0.2, 0.1, z}};
          return ground_first ? there : there.inverse();
        };
        const PairOptions options{.late_contacts = true};
        Pair pair =
            std::move(ground_first ? Pair::make(ground, small, options) : Pair::make(small, ground, options)).value();
        realtime::ManualClock clock(100);
        Request request = testing::short_request(clock, microseconds);
        request.solids = true;
        const auto expect_upwards = [&](double turned, const char* when) {
          for (const Contact& contact : pair.run(pose(turned, 0.048), request).contacts) {
            const Vec3 normal =
                ground_first ? Vec3(-contact.normal) : Vec3(pose(turned, 0.0).inverse().rotation * contact.normal);
            EXPECT_GT(normal.z(), 0.5) << when << ", ground first " << ground_first << ", " << microseconds << " us";
          }
        };
        static_cast<void>(pair.run(pose(0.0, 0.055), request));
        expect_upwards(2.0, "comes down");
        for (int run = 0; run < 20; ++run) static_cast<void>(pair.run(pose(2.0, 0.048), request));
        expect_upwards(2.0 + 3.0, "turns");
      }
    }
  }
}

}  // namespace
}  // namespace odds::query
