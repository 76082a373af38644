// Bodies of ODE on finely cut ground, within so little work that each collision sees a small part of it: they stand,
// for what earlier collisions have found is kept.
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "odds/math/random.hpp"
#include "odds/mesh/made/terrain.hpp"
#include "ode/known_convexes.hpp"
#include "ode/world_fixture.hpp"

namespace odds::test {
namespace {

constexpr double radius = 0.1;  // of the coin and the cylinder; half of the box's side
constexpr double height = 0.05;
constexpr double hill = 0.01;

enum class Ground : std::uint8_t { flat, hilly, stepped };

/// Steps of 12 mm up along x, each 13 cm long; cells of 10 mm.
std::shared_ptr<const query::Shape> make_steps() {
  constexpr int cells = 200;
  constexpr double side = 2.0;
  std::vector<Vec3> vertices;
  std::vector<mesh::Triangle> triangles;
  for (int i = 0; i <= cells; ++i) {
    for (int k = 0; k <= cells; ++k) {
      const double x = side * (static_cast<double>(i) / cells - 0.5);
      vertices.emplace_back(x, side * (static_cast<double>(k) / cells - 0.5), 0.012 * std::floor(x / 0.13));
    }
  }
  for (std::uint32_t i = 0; i < cells; ++i) {
    for (std::uint32_t k = 0; k < cells; ++k) {
      const std::uint32_t at = i * (cells + 1) + k;
      const std::uint32_t beside = at + cells + 1;
      triangles.push_back({at, beside, beside + 1});
      triangles.push_back({at, beside + 1, at + 1});
    }
  }
  auto mesh = mesh::TriangleMesh::make(std::move(vertices), std::move(triangles), "steps");
  return query::Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(mesh).value())).value();
}

class StarvedPartners : public WorldTest {
 protected:
  void SetUp() override {
    WorldTest::SetUp();
    friction = 0.5;
    contact_mode = dContactApprox1;
  }
  void TearDown() override {
    coin.reset();
    WorldTest::TearDown();
  }

  /// Flat at z = 0, or hills and valleys between -1 and 1 cm, both of cells of 8 mm; or steps.
  void lay(Ground kind, unsigned long work_units) {
    if (kind == Ground::stepped) {
      static const std::shared_ptr<const query::Shape> steps = make_steps();
      ground = mesh_geom(steps, space);
    } else if (kind == Ground::flat) {
      ground = mesh_geom(box_shape(1.0, 1.0, 0.2, 120), space);
      dGeomSetPosition(ground, 0, 0, -0.1);
    } else {
      ground = mesh_geom(
          shape_of(mesh::made::Terrain{.side = 1.0, .height = hill, .feature = 0.3, .depth = 0.2, .cells = 120}),
          space);
    }
    ASSERT_EQ(dGeomOddsMeshSetWorkBudget(ground, work_units), 1);
  }
  void put(const std::string& kind) {
    dMass mass;
    dGeomID geom = nullptr;
    dMassSetCylinder(&mass, 500, 3, radius, height);
    if (kind == "box") {
      geom = dCreateBox(space, 2 * radius, 2 * radius, height);
      dMassSetBox(&mass, 500, 2 * radius, 2 * radius, height);
    }
    if (kind == "cylinder") geom = dCreateCylinder(space, radius, height);
    if (kind == "convex") geom = coin.emplace(space, radius, height, 40).geom;
    dMatrix3 turn;
    dRFromAxisAndAngle(turn, 0, 0, 1, 0.7);
    if (kind == "capsule") {
      geom = dCreateCapsule(space, 0.5 * height, 2 * radius);
      dMassSetCapsule(&mass, 500, 3, 0.5 * height, 2 * radius);
      dRFromAxisAndAngle(turn, 0.6, 0.8, 0, 0.5 * std::numbers::pi);
    }
    body = dBodyCreate(world);
    dBodySetMass(body, &mass);
    dGeomSetBody(geom, body);
    dBodySetPosition(body, 0.03, 0.02, 0.5 * height + hill + 1e-3);
    dBodySetRotation(body, turn);
  }
  [[nodiscard]] double degrees_from_upright() const {
    return std::acos(std::min(1.0, dBodyGetRotation(body)[10])) * 180.0 / std::numbers::pi;
  }
  [[nodiscard]] Vec3 place() const {
    const dReal* const at = dBodyGetPosition(body);
    return {at[0], at[1], at[2]};
  }

  /// Of place and motion, over the weight, metres.
  [[nodiscard]] double energy_as_height() const {
    constexpr double gravity = 9.81;
    dMass mass;
    dBodyGetMass(body, &mass);
    const dReal* const v = dBodyGetLinearVel(body);
    const dReal* const w = dBodyGetAngularVel(body);
    dVector3 own;
    dBodyVectorFromWorld(body, w[0], w[1], w[2], own);
    const double spin = mass.I[0] * own[0] * own[0] + mass.I[5] * own[1] * own[1] + mass.I[10] * own[2] * own[2];
    const double speed = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    return place().z() + 0.5 * (speed + spin / mass.mass) / gravity;
  }

  /// By how much at most the energy rises in the second to the fifth second, as a height, metres.
  [[nodiscard]] double rise_of_energy_on_hills(const char* kind, const dMatrix3 turn, unsigned long units) {
    lay(Ground::hilly, units);
    put(kind);
    dBodySetRotation(body, turn);
    double least = 1.0;
    double rise = 0.0;
    for (int i = 0; i < 5000 && place().z() > -0.05; ++i) {
      step();
      if (i < 1000) continue;
      const double now = energy_as_height();
      least = std::min(least, now);
      rise = std::max(rise, now - least);
    }
    dGeomDestroy(dBodyGetFirstGeom(body));
    dGeomDestroy(ground);
    return rise;
  }

  dGeomID ground = nullptr;
  dBodyID body = nullptr;
  std::optional<ConvexCoin> coin;
};

struct Starved {
  const char* body;
  Ground ground;
  unsigned long units;
  double tilt;  ///< degrees, at most

  [[nodiscard]] std::string name() const {
    return body + std::string(ground == Ground::flat ? "Flat" : "Hilly") + std::to_string(units);
  }
  friend void PrintTo(const Starved& starved, std::ostream* out) { *out << starved.name(); }
};

class Standing : public StarvedPartners, public ::testing::WithParamInterface<Starved> {};

TEST_P(Standing, StandsThroughFiveSeconds) {
  lay(GetParam().ground, GetParam().units);
  put(GetParam().body);
  for (int i = 0; i < 2000; ++i) step();
  const Vec3 settled = place();
  for (int i = 0; i < 3000; ++i) {
    step();
    ASSERT_LE(degrees_from_upright(), GetParam().tilt) << "step " << i;
    ASSERT_GE(place().z(), 0.5 * height - (GetParam().ground == Ground::hilly ? hill : 0.0) - 1e-3);
  }
  EXPECT_LE((place() - settled).norm(), 5e-3);
  EXPECT_GT(stats().primitive_cut_off, 100u) << "there was time for all";
}

INSTANTIATE_TEST_SUITE_P(
    Bodies, Standing,
    ::testing::Values(Starved{"box", Ground::flat, 40, 0.5}, Starved{"box", Ground::hilly, 40, 8},
                      Starved{"box", Ground::hilly, 80, 8}, Starved{"cylinder", Ground::flat, 40, 0.5},
                      Starved{"cylinder", Ground::hilly, 40, 8}, Starved{"cylinder", Ground::hilly, 80, 8},
                      Starved{"convex", Ground::flat, 40, 0.5}, Starved{"convex", Ground::hilly, 40, 8},
                      Starved{"convex", Ground::hilly, 320, 8}),
    [](const auto& of) { return of.param.name(); });

TEST_F(StarvedPartners, ACapsuleLiesOnBothEnds) {
  for (const unsigned long units : {24UL, 40UL, 80UL}) {
    lay(Ground::flat, units);
    put("capsule");
    Vec3 settled = Vec3::Zero();
    for (int i = 0; i < 5000; ++i) {
      step();
      ASSERT_NEAR(degrees_from_upright(), 90.0, 0.5) << "step " << i << ", units " << units;
      if (i == 1000) settled = place();
    }
    EXPECT_NEAR(place().z(), 0.5 * height, 1e-3);
    EXPECT_LE((place() - settled).norm(), 1e-3) << "it rolls by itself, units " << units;
    dGeomDestroy(dBodyGetFirstGeom(body));
    dGeomDestroy(ground);
  }
}

/// Nothing is kept of one that has met nothing yet: a part of its axis is not enough.
TEST_F(StarvedPartners, ACapsuleFindsWhatItMeetsFirst) {
  lay(Ground::hilly, 0);
  const dGeomID all_of_it = ground;
  lay(Ground::hilly, 40);
  math::Random random(5, 1);
  std::vector<dGeomID> capsules;  // another each time: what is known of one that touched counts for it alone
  int touching = 0;
  int overlooked = 0;
  for (int i = 0; i < 60; ++i) {
    const double angle = random.uniform(0.0, 2.0 * std::numbers::pi);
    dMatrix3 turn;
    dRFromAxisAndAngle(turn, std::cos(angle), std::sin(angle), 0, random.uniform(0.0, std::numbers::pi));
    const dGeomID capsule = capsules.emplace_back(dCreateCapsule(nullptr, 0.5 * height, 2 * radius));
    dGeomSetRotation(capsule, turn);
    dGeomSetPosition(capsule, random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), 0);
    double above = 0.2;  // metres, of its middle
    while (above > 0.0 && collide(all_of_it, capsule).empty()) {
      above -= 0.1 * height;
      const dReal* const at = dGeomGetPosition(capsule);
      dGeomSetPosition(capsule, at[0], at[1], above);
    }
    touching += collide(all_of_it, capsule).empty() ? 0 : 1;
    overlooked += collide(ground, capsule).empty() ? 1 : 0;
  }
  EXPECT_EQ(touching, 60);
  EXPECT_EQ(overlooked, 0);
  for (const dGeomID capsule : capsules) dGeomDestroy(capsule);
}

/// What earlier collisions found lies behind a capsule that rolls, and drove it up the hills.
TEST_F(StarvedPartners, ACapsuleRollsUpNoHillByItself) {
  struct Work {
    unsigned long units;
    double most_rise;  // metres
  };
  for (const auto& [units, most_rise] : {Work{40, 5e-4}, Work{80, 5e-5}}) {
    for (const double angle : {0.3, 0.9, 2.5}) {
      dMatrix3 turn;
      dRFromAxisAndAngle(turn, std::cos(angle), std::sin(angle), 0, 0.5 * std::numbers::pi);
      EXPECT_LE(rise_of_energy_on_hills("capsule", turn, units), most_rise) << "units " << units << ", angle " << angle;
    }
  }
}

/// Its ends and its axis have their turns: if what one of them finds were given no deeper than what the others did, it
/// would lie 8 mm deep in the side of a step for seconds.
TEST_F(StarvedPartners, ACapsuleThatRunsIntoAStepDoesNotStayInIt) {
  friction = 0.1;
  lay(Ground::stepped, 0);
  const dGeomID all_of_it = ground;
  dSpaceRemove(space, all_of_it);
  double sunk = 0.0;  // mean, metres
  int looks = 0;
  for (const unsigned long units : {12UL, 20UL, 40UL}) {
    for (const double angle : {0.3, 1.4, 2.5, 4.0}) {
      lay(Ground::stepped, units);
      put("capsule");
      dMatrix3 turn;
      dRFromAxisAndAngle(turn, std::cos(angle), std::sin(angle), 0, 0.5 * std::numbers::pi);
      dBodySetRotation(body, turn);
      dGeomCapsuleSetParams(dBodyGetFirstGeom(body), height, 2 * radius);
      dBodySetPosition(body, 0.05, 0.02, 0.024 + height + 1e-3);
      dBodySetLinearVel(body, 0.8, 0.3, 0.0);
      for (int i = 0; i < 2000; ++i) {
        step();
        if (i < 300 || i % 10 != 0) continue;
        double deepest = 0.0;
        for (const dContactGeom& contact : collide(all_of_it, dBodyGetFirstGeom(body))) {
          deepest = std::max(deepest, static_cast<double>(contact.depth));
        }
        sunk += deepest;
        ++looks;
      }
      dGeomDestroy(dBodyGetFirstGeom(body));
      dGeomDestroy(ground);
    }
  }
  EXPECT_LE(sunk / looks, 3e-4) << "0.66 mm where it is not believed";
  dGeomDestroy(all_of_it);
}

/// What they stand on was let go after a while, though it was there, and they sank in and were thrown back.
TEST_F(StarvedPartners, BodiesThatStandOnHillsDoNotRock) {
  for (const char* const kind : {"box", "cylinder"}) {
    for (const unsigned long units : {12UL, 20UL}) {
      for (const double angle : {0.0, 0.7, 2.5, 4.0}) {
        dMatrix3 turn;
        dRFromAxisAndAngle(turn, 0, 0, 1, angle);
        EXPECT_LE(rise_of_energy_on_hills(kind, turn, units), 5e-5)
            << kind << ", units " << units << ", angle " << angle;
      }
    }
  }
}

/// Some of its collisions see all, the next ones a part: what those find beside what the former did must count at once.
TEST_F(StarvedPartners, ACylinderThatTipsOverSinksInNowhere) {
  for (const unsigned long units : {200UL, 400UL}) {
    lay(Ground::flat, units);
    put("cylinder");
    dMatrix3 turn;
    dRFromAxisAndAngle(turn, 0, 1, 0, 0.5 * std::numbers::pi);
    dBodySetRotation(body, turn);
    dBodySetPosition(body, -0.37, 0.02, radius + 1e-3);
    dBodySetLinearVel(body, 0.5, 0, 0);
    dBodySetAngularVel(body, 0, 5, 0);
    for (int i = 0; i < 900; ++i) {
      step();
      const double upright = std::min(1.0, std::abs(dBodyGetRotation(body)[10]));
      const double lowest = place().z() - 0.5 * height * upright - radius * std::sqrt(1.0 - upright * upright);
      ASSERT_GE(lowest, -1.5e-3) << "step " << i << ", units " << units;
    }
    dGeomDestroy(dBodyGetFirstGeom(body));
    dGeomDestroy(ground);
  }
}

TEST_F(StarvedPartners, WhatSeesAllThereIsRoomForGivesNothingElse) {
  for (const char* const kind : {"box", "cylinder", "convex", "capsule"}) {
    lay(Ground::hilly, 0);
    put(kind);
    const dGeomID geom = dBodyGetFirstGeom(body);
    std::vector<dContactGeom> first[2];
    for (int i = 0; i < 20; ++i) {
      dBodySetPosition(body, 0.03 + 1e-3 * (i % 2), 0.02, 0.5 * height - 4e-3);
      const auto contacts = collide(ground, geom);
      if (i < 2) first[i] = contacts;
      ASSERT_EQ(contacts.size(), first[i % 2].size()) << kind;
      for (std::size_t k = 0; k < contacts.size(); ++k) {
        EXPECT_EQ(position_of(contacts[k]), position_of(first[i % 2][k])) << kind << ", collision " << i;
      }
    }
    if (coin) {
      coin.reset();
    } else {
      dGeomDestroy(geom);
    }
    dGeomDestroy(ground);
  }
}

TEST_F(StarvedPartners, NothingIsKeptWhereNothingIsToBeCarried) {
  lay(Ground::flat, 40);
  dGeomOddsMeshSetCarryMotion(ground, 0);
  put("box");
  dBodySetPosition(body, 0.03, 0.02, 0.5 * height - 1e-4);
  const dGeomID box = dBodyGetFirstGeom(body);
  const auto first = collide(ground, box);
  for (int i = 0; i < 10; ++i) {
    const auto again = collide(ground, box);
    ASSERT_EQ(again.size(), first.size());
    for (std::size_t k = 0; k < first.size(); ++k) EXPECT_EQ(position_of(again[k]), position_of(first[k]));
  }
}

TEST_F(StarvedPartners, AnotherTurnFindsOtherContacts) {
  lay(Ground::flat, 40);
  put("box");
  dBodySetPosition(body, 0.03, 0.02, 0.5 * height - 1e-4);
  const dGeomID box = dBodyGetFirstGeom(body);
  const auto first = collide(ground, box);
  auto last = first;
  for (int i = 0; i < 10; ++i) last = collide(ground, box);
  double spread = 0.0;
  int others = 0;
  for (const auto& a : last) {
    for (const auto& b : last) spread = std::max(spread, (position_of(a) - position_of(b)).norm());
    others += std::none_of(first.begin(), first.end(), [&](const auto& b) { return position_of(a) == position_of(b); });
  }
  EXPECT_GT(spread, 1.2 * radius);
  EXPECT_GT(others, 1);
}

}  // namespace
}  // namespace odds::test
