// A mesh wholly within a solid: found, led out, and never made up.
#include <gtest/gtest.h>

#include <random>

#include "odds/mesh/made/by_name.hpp"
#include "odds/query/pair.hpp"
#include "support/all_kinds.hpp"
#include "support/shapes.hpp"

namespace odds::query {
namespace {

std::shared_ptr<const Shape> made(const std::string& what, volume::Kind kind = volume::Kind::wide) {
  auto mesh = std::make_shared<const mesh::TriangleMesh>(std::move(mesh::made::make_shape("made:" + what)).value());
  return Shape::build(std::move(mesh), {.volume = kind}).value();
}

math::Pose at(const Vec3& place) { return {Mat3::Identity(), place}; }

class WithinASolid : public ::testing::TestWithParam<volume::Kind> {};

TEST_P(WithinASolid, IsAHitWithOneContactThatLeadsOut) {
  const auto slab = made("box:x=1,y=1,z=0.3,cells=4", GetParam());
  const auto ball = made("icosphere:radius=0.02", GetParam());
  auto ball_in = std::move(Pair::make(slab, ball)).value();
  auto ball_around = std::move(Pair::make(ball, slab)).value();
  const math::Pose pose = at({0.01, 0.02, 0.10});
  EXPECT_EQ(ball_in.run(pose, {}).verdict, Verdict::clear) << "surfaces that do not meet, unless solids are asked for";
  for (const Method method : {Method::exact, Method::incremental, Method::time_critical}) {
    const Answer a = ball_in.run(pose, {.method = method, .max_contacts = 4, .solids = true});
    ASSERT_EQ(a.verdict, Verdict::hit);
    EXPECT_EQ(a.basis, Basis::proved);
    ASSERT_EQ(a.contacts.size(), 1U);
    EXPECT_TRUE(a.contacts_complete);
    EXPECT_NEAR(a.contacts[0].normal.z(), -1.0, 1e-12) << "into the slab below";
    EXPECT_NEAR(a.contacts[0].depth, 0.05 + 0.02, 1e-3);
    EXPECT_NEAR(a.contacts[0].position.z(), 0.5 * (0.15 + 0.08), 1e-3);
    const Answer b = ball_around.run(pose.inverse(), {.method = method, .max_contacts = 4, .solids = true});
    ASSERT_EQ(b.contacts.size(), 1U);
    EXPECT_NEAR(b.contacts[0].normal.z(), 1.0, 1e-12);
    EXPECT_NEAR(b.contacts[0].depth, a.contacts[0].depth, 1e-12);
    EXPECT_EQ(b.contacts[0].triangle_a, a.contacts[0].triangle_b);
    EXPECT_EQ(b.contacts[0].triangle_b, a.contacts[0].triangle_a);
  }
  EXPECT_EQ(ball_in.run(pose, {.max_contacts = 0, .solids = true}).verdict, Verdict::hit);
  EXPECT_EQ(ball_in.run(at({0, 0, 0.18}), {.solids = true}).verdict, Verdict::clear);
}

TEST_P(WithinASolid, EndsWhereTheContactSays) {
  const auto outer = Shape::build(testing::wavy_sphere(14), {.volume = GetParam()}).value();
  const auto inner = made("torus:ring=0.03,tube=0.01,around=24,across=12", GetParam());
  auto pair = std::move(Pair::make(outer, inner)).value();
  std::mt19937 generator(3);
  std::normal_distribution<double> normal;
  int within = 0;
  for (int i = 0; i < 200; ++i) {
    const Vec3 place = 0.35 * Vec3(normal(generator), normal(generator), normal(generator));
    const Quat turn = Quat(normal(generator), normal(generator), normal(generator), normal(generator)).normalized();
    const auto pose = math::Pose::from_quaternion(place, turn);
    if (pair.run(pose, {.method = Method::exact}).verdict == Verdict::hit) continue;
    pair.reset();
    const Answer answer = pair.run(pose, {.method = Method::exact, .max_contacts = 4, .solids = true});
    ASSERT_EQ(answer.verdict == Verdict::hit, place.norm() < 1.0) << place.transpose();
    if (answer.verdict == Verdict::clear) continue;
    ++within;
    ASSERT_EQ(answer.contacts.size(), 1U);
    const Contact contact = answer.contacts[0];
    // Out by a line through the middle, which is not all of the gear; by its own size more it is.
    const double more = contact.depth + inner->mesh().size();
    const Answer out = pair.run({pose.rotation, place - more * contact.normal}, {.max_contacts = 0, .solids = true});
    EXPECT_EQ(out.verdict, Verdict::clear);
  }
  EXPECT_GT(within, 100);
}

TEST_P(WithinASolid, IsAlwaysDecidedWithoutALimit) {
  const auto outer = made("torus_knot", GetParam());
  auto pair = std::move(Pair::make(outer, made("icosphere:radius=0.001,frequency=2", GetParam()))).value();
  const Vec3 lower = outer->mesh().lower();
  const Vec3 size = outer->mesh().upper() - lower;
  std::mt19937 generator(8);
  std::uniform_real_distribution<double> uniform;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 place = lower + Vec3(uniform(generator), uniform(generator), uniform(generator)).cwiseProduct(size);
    ASSERT_EQ(pair.run(at(place), {.method = Method::exact, .max_contacts = 4, .solids = true}).basis, Basis::proved)
        << place.transpose();
  }
}

INSTANTIATE_TEST_SUITE_P(AllVolumes, WithinASolid, ::testing::ValuesIn(testing::all_kinds()),
                         [](const auto& tested) { return testing::name_of(tested.param); });

TEST(MeshWithinASolid, GoesBackTheWayItCame) {
  const auto floor = made("box:x=1,y=1,z=0.2,cells=4");
  const auto ball = made("icosphere:radius=0.02");
  auto pair = std::move(Pair::make(floor, ball)).value();
  for (const Method method : {Method::exact, Method::incremental}) {
    pair.reset();
    for (double z = 0.13; z > -0.06; z -= 0.004) {  // through the middle: below, the way on is shorter
      const Answer answer = pair.run(at({0, 0, z}), {.method = method, .max_contacts = 4, .solids = true});
      if (z > 0.12 + 1e-9) continue;
      ASSERT_FALSE(answer.contacts.empty()) << z;
      EXPECT_LT(answer.contacts[0].normal.z(), -0.99) << z;
      EXPECT_NEAR(answer.contacts[0].depth, 0.1 - z + 0.02, 2e-3) << z;
    }
  }
}

/// A body that may be within a solid, and is the first or the second of the pair.
class WithinSolid {
 public:
  WithinSolid(const std::shared_ptr<const Shape>& body, const std::shared_ptr<const Shape>& solid, bool body_first)
      : body_first_(body_first), pair_((body_first ? Pair::make(body, solid) : Pair::make(solid, body)).value()) {}

  /// The way in which the body is pushed there, in the solid's frame; zero if it is not.
  Vec3 push(const math::Pose& body_in_solid) {
    const Request request{.method = Method::incremental, .max_contacts = 4, .solids = true};
    const Answer answer = pair_.run(body_first_ ? body_in_solid.inverse() : body_in_solid, request);
    if (answer.contacts.empty()) return Vec3::Zero();
    const Vec3& into_first = answer.contacts[0].normal;
    return body_first_ ? Vec3(body_in_solid.rotation * into_first) : Vec3(-into_first);
  }

 private:
  bool body_first_;
  Pair pair_;
};

// In the frame of a crate that turns as it falls in, it is the ground's middle that goes far, and sideways.
TEST(MeshWithinASolid, GoesBackTheWayItCameAlsoWhereItTurns) {
  const auto ground = made("box:x=1000,y=1000,z=100,cells=4");
  const auto crate = made("box:x=1,y=1,z=1");
  for (const bool crate_first : {false, true}) {
    WithinSolid falling(crate, ground, crate_first);
    const auto at_height = [](double height, double turn) -> math::Pose {
      return {Eigen::AngleAxisd(turn, Vec3(1, 0.2, 0.1).normalized()).toRotationMatrix(), Vec3(40, 30, 50.0 + height)};
    };
    ASSERT_TRUE(falling.push(at_height(1.0, 0.0)).isZero());
    EXPECT_GT(falling.push(at_height(-1.0, 0.1)).z(), 0.999) << crate_first;
  }
}

// Of a map of 10 km a thin wall: a disc that flew into it, almost through, goes back although it flew no farther than a
// hundred-thousandth of the map.
TEST(MeshWithinASolid, GoesBackTheWayItCameHoweverLargeTheOtherIs) {
  const auto wall = made("box:x=0.05,y=10000,z=100");
  const auto disc = made("box:x=0.004,y=0.1,z=0.1");
  for (const bool disc_first : {false, true}) {
    WithinSolid flying(disc, wall, disc_first);
    ASSERT_TRUE(flying.push(at({-0.0275, 0, 0})).isZero());
    EXPECT_LT(flying.push(at({0.005, 0, 0})).x(), -0.999) << disc_first;
  }
}

TEST(MeshWithinASolid, OneThatJumpedInGoesBackAndIsNotThrown) {
  const auto floor = made("box:x=1,y=1,z=0.2,cells=4");
  const auto ball = made("icosphere:radius=0.02");
  auto pair = std::move(Pair::make(floor, ball)).value();
  Request request{.max_contacts = 4, .solids = true};
  EXPECT_EQ(pair.run(at({0, 0, 0.125}), request).verdict, Verdict::clear);
  const Answer in = pair.run(at({0, 0, -0.03}), request);  // past the middle in one step
  ASSERT_EQ(in.contacts.size(), 1U);
  EXPECT_LT(in.contacts[0].normal.z(), -0.99);
  EXPECT_NEAR(in.contacts[0].depth, 0.15, 1e-3);
  const Answer rests = pair.run(at({0, 0, -0.03}), request);
  ASSERT_EQ(rests.contacts.size(), 1U);
  EXPECT_LT(rests.contacts[0].normal.z(), -0.99);
  EXPECT_LE(rests.contacts[0].depth, 0.16) << "no deeper than it has come";
}

TEST(MeshWithinASolid, IsNeitherAHoleNorASheetNorAHollow) {
  const auto ring = made("torus");
  const auto ball = made("icosphere:radius=0.01");
  auto in_hole = std::move(Pair::make(ring, ball)).value();
  EXPECT_EQ(in_hole.run({}, {.max_contacts = 4, .solids = true}).verdict, Verdict::clear);
  std::vector<Vec3> vertices{{-1, -1, -1}, {1, -1, -1}, {0, 1, -1}, {0, 0, 1}};
  std::vector<mesh::Triangle> open{{0, 1, 2}, {0, 3, 1}, {1, 3, 2}};  // a tetrahedron that lacks a face
  auto cup_mesh =
      std::make_shared<const mesh::TriangleMesh>(std::move(mesh::TriangleMesh::make(vertices, open, "cup")).value());
  const auto cup = Shape::build(std::move(cup_mesh)).value();
  auto in_cup = std::move(Pair::make(cup, ball)).value();
  EXPECT_EQ(in_cup.run(at({0, -0.1, -0.5}), {.max_contacts = 4, .solids = true}).verdict, Verdict::clear);
}

/// A ball and a slab: outside, near the slab's top, and within.
struct BallAndSlab {
  Pair pair = std::move(Pair::make(made("box:x=1,y=1,z=0.3,cells=4"), made("icosphere:radius=0.02"))).value();
  math::Pose outside = at({0.01, 0.02, 0.18});
  math::Pose within = at({0.01, 0.02, 0.10});

  Verdict verdict(const math::Pose& pose, Method method, bool solids = true) {
    const Answer& answer = pair.run(pose, {.method = method, .max_contacts = 4, .solids = solids});
    EXPECT_EQ(answer.basis, Basis::proved);
    return answer.verdict;
  }
};

TEST(MeshWithinASolid, IsNotDecidedWithoutTheWork) {
  BallAndSlab scene;
  int decided = 0;
  int undecided = 0;
  for (const math::Pose& before : {scene.outside, scene.within}) {
    for (const math::Pose& now : {scene.outside, scene.within}) {
      const Verdict right = now.translation.z() < 0.15 ? Verdict::hit : Verdict::clear;
      for (std::uint64_t units = 1; units < 400; ++units) {
        scene.pair.reset();
        static_cast<void>(scene.verdict(before, Method::incremental));
        for (const Method method : {Method::incremental, Method::time_critical}) {
          const Answer answer =
              scene.pair.run(now, {.method = method, .budget = Budget::work(units), .max_contacts = 4, .solids = true});
          EXPECT_LE(answer.cost.node_pairs + answer.cost.triangle_pairs, units);
          ++(answer.basis == Basis::proved ? decided : undecided);
          if (answer.basis == Basis::proved) {
            ASSERT_EQ(answer.verdict, right) << units;
          }
        }
        // What was left open is not taken for looked at.
        ASSERT_EQ(scene.verdict(now, Method::incremental), right) << units;
      }
    }
  }
  EXPECT_GT(decided, 500);
  EXPECT_GT(undecided, 100);
}

TEST(MeshWithinASolid, IsNotProvedInTimeThatThereWasNot) {
  BallAndSlab scene;
  struct Jumping {
    std::int64_t now = 0;
    int looks = 0;
  } clock;
  int undecided = 0;
  for (int looks = 1; looks < 60; ++looks) {
    scene.pair.reset();
    static_cast<void>(scene.verdict(scene.outside, Method::incremental));
    clock.looks = looks;
    Request request{.method = Method::incremental, .budget = Budget::time(50.0), .max_contacts = 4, .solids = true};
    request.budget.clock = {[](void* state) noexcept {
                              auto& jumping = *static_cast<Jumping*>(state);
                              jumping.now += --jumping.looks == 0 ? 1'000'000 : 1;
                              return jumping.now;
                            },
                            &clock};
    const Answer answer = scene.pair.run(scene.within, request);
    undecided += answer.basis == Basis::proved ? 0 : 1;
    if (answer.basis == Basis::proved) {
      ASSERT_EQ(answer.verdict, Verdict::hit) << looks;
    }
    ASSERT_EQ(scene.verdict(scene.within, Method::incremental), Verdict::hit) << looks;
  }
  EXPECT_GT(undecided, 2);
}

TEST(MeshWithinASolid, IsFoundWhateverThePairWasAskedBefore) {
  std::mt19937 generator(5);
  BallAndSlab scene;
  constexpr Method methods[] = {Method::exact, Method::incremental, Method::time_critical};
  for (int run = 0; run < 3000; ++run) {
    const bool is_within = generator() % 2 == 0;
    const bool solids = generator() % 2 == 0;
    const Verdict right = is_within && solids ? Verdict::hit : Verdict::clear;
    ASSERT_EQ(scene.verdict(is_within ? scene.within : scene.outside, methods[generator() % 3], solids), right) << run;
  }
}

TEST(MeshWithinASolid, WithoutASingleTriangleThatHasAnAreaLeavesFiniteContacts) {
  std::vector<Vec3> vertices{{0, 0, 0}, {0.01, 0, 0}, {0.02, 0, 0}};
  std::vector<mesh::Triangle> flat{{0, 1, 2}};
  auto needle =
      std::make_shared<const mesh::TriangleMesh>(std::move(mesh::TriangleMesh::make(vertices, flat, "needle")).value());
  auto pair = std::move(Pair::make(made("box:x=1,y=1,z=0.3"), Shape::build(std::move(needle)).value())).value();
  const Answer answer = pair.run(at({0, 0, 0.1}), {.max_contacts = 4, .solids = true});
  EXPECT_EQ(answer.verdict, Verdict::hit);
  for (const Contact& contact : answer.contacts) {
    EXPECT_TRUE(contact.position.allFinite());
    EXPECT_NEAR(contact.normal.norm(), 1.0, 1e-9);
    EXPECT_NEAR(contact.depth, 0.05, 1e-6);
  }
}

}  // namespace
}  // namespace odds::query
