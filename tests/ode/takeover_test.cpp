// Collisions of dTriMesh geoms under a takeover: as our own geoms answer, ODE's own collider where we cannot, nothing
// left behind.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <random>

#include "ode/geom/partners.hpp"
#include "ode/geom/takeover.hpp"
#include "ode/trimesh_fixture.hpp"

namespace odds::test {
namespace {

class Takeover : public OdeTest {
 protected:
  void TearDown() override {
    oddsGiveBackTriMesh();
    ode::observe_takeover(nullptr);
    OdeTest::TearDown();
  }
  // Unlimited time, so that results do not depend on the machine.
  static void take_over(unsigned partners = ODDS_TAKE_ALL) {
    oddsTakeOverParams params;
    oddsTakeOverParamsInit(&params);
    params.partners = partners;
    params.budget_us = dInfinity;
    ASSERT_EQ(oddsTakeOverTriMesh(&params), 1) << oddsGetLastError();
  }
  std::mt19937 random{47};
  std::uniform_real_distribution<double> uniform{-1.0, 1.0};
};

TEST_F(Takeover, EveryPartnerAnswersAsForOneOfOurGeoms) {
  const auto shape = box_shape(1, 0.5, 0.25, 4);  // exact in single precision
  const TriMesh trimesh(shape->mesh(), space);
  const TriMesh other(sphere_shape(0.5, 4)->mesh(), space);
  const dGeomID twin = mesh_geom(shape, space);
  take_over();
  const dGeomID ray = dCreateRay(space, 2);
  const std::vector<dGeomID> partners = {other.geom,
                                         dCreateSphere(space, 0.3),
                                         dCreateBox(space, 0.3, 0.4, 0.5),
                                         dCreateCapsule(space, 0.2, 0.4),
                                         dCreateCylinder(space, 0.2, 0.4),
                                         ray};
  for (const dGeomID partner : partners) {
    int hits = 0;
    for (int round = 0; round < 100; ++round) {
      rotate(partner, Vec3(uniform(random), uniform(random), uniform(random)), 3.0 * uniform(random));
      dGeomSetPosition(partner, 0.7 * uniform(random), 0.5 * uniform(random), 0.5 * uniform(random));
      const auto expected = collide(twin, partner);
      const auto forward = collide(trimesh.geom, partner);
      const auto backward = collide(partner, trimesh.geom);
      expect_sound(forward, trimesh.geom, partner);
      expect_sound(backward, partner, trimesh.geom);
      ASSERT_EQ(forward.empty(), expected.empty()) << "class " << dGeomGetClass(partner) << ", round " << round;
      ASSERT_EQ(backward.empty(), expected.empty());
      if (expected.empty()) continue;
      ++hits;
      if (partner == other.geom) continue;  // a search that remembers, in another order of the two meshes
      EXPECT_NEAR(forward[0].depth, expected[0].depth, 1e-6) << "class " << dGeomGetClass(partner);
      EXPECT_LT((normal_of(forward[0]) - normal_of(expected[0])).norm(), 1e-5);
    }
    EXPECT_GT(hits, 10) << "class " << dGeomGetClass(partner);
  }
  const dGeomID plane = dCreatePlane(space, 0, 0, 1, -0.1);
  EXPECT_EQ(collide(trimesh.geom, plane).size(), collide(twin, plane).size());
  EXPECT_EQ(stats().fallbacks, 0u);
  EXPECT_GE(stats().taken_over, 1200u);
}

TEST_F(Takeover, OnlyWhatWasAskedForIsTakenAndItIsGivenBack) {
  const TriMesh ground(box_shape(2, 2, 0.5, 8)->mesh(), space);
  const dGeomID sphere = dCreateSphere(space, 0.25);
  dGeomSetPosition(sphere, 0.1, 0.1, 0.45);
  const auto before = collide(ground.geom, sphere);
  take_over(ODDS_TAKE_TRIMESH | ODDS_TAKE_BOX);
  EXPECT_EQ(collide(ground.geom, sphere).size(), before.size());
  EXPECT_EQ(stats().taken_over, 0u);
  take_over(ODDS_TAKE_SPHERE);
  EXPECT_EQ(collide(ground.geom, sphere).size(), 1u);
  EXPECT_EQ(stats().taken_over, 1u);
  const dGeomID box = dCreateBox(space, 0.2, 0.2, 0.2);
  dGeomSetPosition(box, 0.1, 0.1, 0.3);
  collide(ground.geom, box);
  EXPECT_EQ(stats().taken_over, 1u) << "the second call replaces the first";
  EXPECT_EQ(oddsGiveBackTriMesh(), 1) << oddsGetLastError();
  EXPECT_EQ(oddsGiveBackTriMesh(), 0);
  const auto after = collide(ground.geom, sphere);
  EXPECT_EQ(stats().taken_over, 1u);
  ASSERT_EQ(after.size(), before.size());
  for (std::size_t i = 0; i < after.size(); ++i) EXPECT_EQ(after[i].depth, before[i].depth);
}

TEST_F(Takeover, WhatItCannotAnswerIsLeftToOde) {
  const auto shape = box_shape(1, 1, 1, 2);
  const TriMesh first(shape->mesh(), space);
  const TriMesh second(shape->mesh(), space);
  dGeomSetPosition(second.geom, 0.1, 0.2, 0.9);
  dGeomTriMeshSetCallback(second.geom, [](dGeomID, dGeomID, int) { return 1; });
  const dGeomID cylinder = dCreateCylinder(space, 0.2, 0.5);
  dGeomSetPosition(cylinder, 0.1, 0.2, 1.6);
  const auto odes = collide(first.geom, second.geom);
  const auto odes_cylinder = collide(second.geom, cylinder);
  const auto odes_cylinder_swapped = collide(cylinder, second.geom);
  ASSERT_FALSE(odes.empty());
  ASSERT_FALSE(odes_cylinder.empty());
  take_over();
  const auto same = [](const std::vector<dContactGeom>& a, const std::vector<dContactGeom>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
      EXPECT_EQ(a[i].g1, b[i].g1);
      EXPECT_EQ(a[i].depth, b[i].depth);
      EXPECT_EQ(normal_of(a[i]), normal_of(b[i]));
      EXPECT_EQ(a[i].side1, b[i].side1);
    }
  };
  const auto by_ode = collide(first.geom, second.geom);  // ODE swaps the meshes from the second call on
  ASSERT_FALSE(by_ode.empty());
  EXPECT_TRUE(std::ranges::any_of(by_ode, [](const dContactGeom& c) { return c.pos[3] != 0.0 || c.depth <= 0.0; }))
      << "ODE's collider leaves its scratch behind, ours never does";
  same(collide(second.geom, cylinder), odes_cylinder);
  same(collide(cylinder, second.geom), odes_cylinder_swapped);
  EXPECT_EQ(stats().fallbacks, 3u);
  EXPECT_EQ(stats().taken_over, 0u);
}

// It was read for the wide engine, so that the first collision had no contacts, and all others were ODE's.
TEST_F(Takeover, AMeshThatNobodyPreparedIsReadWithTheVolumeOfTheOneThatItMeets) {
  const auto shape = box_shape(1, 1, 1, 2);
  const TriMesh known(shape->mesh(), space);
  const TriMesh second(shape->mesh(), space);
  const TriMesh third(shape->mesh(), space);
  const TriMesh wide(shape->mesh(), space);
  dGeomSetPosition(known.geom, 0.1, 0.2, 0.9);
  take_over();
  oddsBuildParams params;
  oddsBuildParamsInit(&params);
  params.volume = ODDS_VOLUME_OBB;
  ASSERT_EQ(oddsPrepareTriMesh(known.geom, &params), 1) << oddsGetLastError();
  EXPECT_FALSE(collide(known.geom, second.geom).empty());
  EXPECT_FALSE(collide(third.geom, known.geom).empty());
  EXPECT_EQ(stats().fallbacks, 0u);
  EXPECT_EQ(stats().taken_over, 2u);
  ASSERT_EQ(oddsPrepareTriMesh(wide.geom, nullptr), 1) << oddsGetLastError();
  EXPECT_FALSE(collide(known.geom, wide.geom).empty()) << "ODE's own, from the first collision on";
  EXPECT_EQ(stats().fallbacks, 1u);
  EXPECT_EQ(stats().failed_pairs, 0u);
}

TEST_F(Takeover, AMeshWithAMovedCornerIsLeftToOdeUntilItIsReadAgain) {
  const auto shape = box_shape(1, 1, 1, 4);
  const TriMesh first(shape->mesh(), space);
  TriMesh second(shape->mesh(), space);
  dGeomSetPosition(second.geom, 0.1, 0.2, 0.9);
  take_over();
  ASSERT_EQ(oddsPreparePair(first.geom, second.geom), 1) << oddsGetLastError();
  ASSERT_FALSE(collide(first.geom, second.geom).empty());
  second.vertices[0] -= 0.3;
  const auto triangles = static_cast<int>(second.indices.size() / 3);
  // One triangle is compared in each collision: the first round finds out, whatever the corner's triangles are.
  for (int i = 0; i < triangles; ++i) static_cast<void>(collide(first.geom, second.geom));
  const auto before = stats();
  EXPECT_GT(before.fallbacks, 0u);
  for (int i = 0; i < triangles; ++i) static_cast<void>(collide(first.geom, second.geom));
  EXPECT_EQ(stats().fallbacks, before.fallbacks + static_cast<unsigned>(triangles)) << "not now ours and then ODE's";
  ASSERT_EQ(oddsPrepareTriMesh(second.geom, nullptr), 1) << oddsGetLastError();
  const auto again = stats();
  for (int i = 0; i < triangles; ++i) EXPECT_FALSE(collide(first.geom, second.geom).empty());
  EXPECT_EQ(stats().fallbacks, again.fallbacks);
}

TEST_F(Takeover, AProgramThatSaysItMovedVerticesIsBelievedAtOnce) {
  const auto shape = sphere_shape(0.5, 16);  // of thousands of triangles one is moved
  TriMesh first(shape->mesh(), space);
  const TriMesh second(shape->mesh(), space);
  dGeomSetPosition(second.geom, 0.1, 0.2, 0.9);
  take_over();
  ASSERT_EQ(oddsPreparePair(first.geom, second.geom), 1) << oddsGetLastError();
  ode::note_changed(second.data);
  ode::note_changed(nullptr);
  static_cast<void>(collide(first.geom, second.geom));
  EXPECT_EQ(stats().fallbacks, 1u);
  ASSERT_EQ(oddsPreparePair(first.geom, second.geom), 1) << oddsGetLastError();
  EXPECT_FALSE(collide(first.geom, second.geom).empty());
  EXPECT_EQ(stats().fallbacks, 1u);
}

// Each collision used to read it again.
TEST_F(Takeover, AMeshThatCannotBeReadIsLeftToOdeAndReadOnce) {
  const auto shape = box_shape(1, 1, 1, 2);
  TriMesh first(shape->mesh(), space);
  first.vertices[1] = std::nan("");
  const TriMesh second(shape->mesh(), space);
  dGeomSetPosition(first.geom, 0.1, 0.2, 0.9);
  take_over();
  EXPECT_EQ(oddsPrepareTriMesh(first.geom, nullptr), 0);
  EXPECT_EQ(stats().live_partners, 0u) << "who asks hears of it, and what was known would stay";
  static_cast<void>(collide(first.geom, second.geom));
  const auto partners = stats().live_partners;
  EXPECT_GE(partners, 1u) << "that it cannot be read is known";
  for (int i = 0; i < 2; ++i) static_cast<void>(collide(first.geom, second.geom));
  EXPECT_EQ(stats().live_partners, partners);
  EXPECT_EQ(stats().fallbacks, 3u);
  first.vertices[1] = second.vertices[1];
  ASSERT_EQ(oddsPreparePair(first.geom, second.geom), 1) << oddsGetLastError();
  EXPECT_FALSE(collide(first.geom, second.geom).empty());
  EXPECT_EQ(stats().fallbacks, 3u);
}

TEST_F(Takeover, ARotationThatIsOffByLittleIsNoMovedCorner) {
  const auto shape = sphere_shape(0.5, 8);
  const TriMesh first(shape->mesh(), space);
  const TriMesh second(shape->mesh(), space);
  dGeomSetPosition(second.geom, 0.1, 0.2, 0.9);
  dMatrix3 scaled = {1 + 1e-4, 0, 0, 0, 0, 1, 1e-4, 0, 0, 0, 1 - 1e-4, 0};
  dGeomSetRotation(second.geom, scaled);
  take_over();
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(collide(first.geom, second.geom).empty());
  EXPECT_EQ(stats().fallbacks, 0u);
  EXPECT_EQ(stats().changed_partners, 0u);
}

TEST_F(Takeover, AStackOfMeshBricksStands) {
  constexpr double height = 0.248;
  const dWorldID world = dWorldCreate();
  dWorldSetGravity(world, 0, 0, -9.81);
  const dJointGroupID joints = dJointGroupCreate(0);
  dCreatePlane(space, 0, 0, 1, 0);
  const auto shape = box_shape(0.2, 0.5, height, 1);
  std::vector<std::unique_ptr<TriMesh>> bricks;
  std::vector<dBodyID> bodies;
  for (int i = 0; i < 3; ++i) {
    bricks.push_back(std::make_unique<TriMesh>(shape->mesh(), space));
    bodies.push_back(dBodyCreate(world));
    dMass mass;
    dMassSetBox(&mass, 1000, 0.2, 0.5, height);
    dBodySetMass(bodies.back(), &mass);
    dGeomSetBody(bricks.back()->geom, bodies.back());
    dBodySetPosition(bodies.back(), 0, 0, height * (i + 0.5) + 0.001 * i);
  }
  take_over();
  for (const auto& one : bricks) {
    for (const auto& other : bricks) {
      if (one != other) {
        ASSERT_EQ(oddsPreparePair(one->geom, other->geom), 1) << oddsGetLastError();
      }
    }
  }
  struct Step {
    dWorldID world;
    dJointGroupID joints;
  } step = {world, joints};
  for (int tick = 0; tick < 2000; ++tick) {
    dSpaceCollide(space, &step, [](void* data, dGeomID a, dGeomID b) {
      auto* self = static_cast<Step*>(data);
      dContact contacts[8];
      const int count = dCollide(a, b, 8, &contacts[0].geom, sizeof(dContact));
      for (int i = 0; i < count; ++i) {
        contacts[i].surface = {};
        contacts[i].surface.mu = 1.0;
        dJointAttach(dJointCreateContact(self->world, self->joints, &contacts[i]), dGeomGetBody(a), dGeomGetBody(b));
      }
    });
    dWorldStep(world, 0.001);
    dJointGroupEmpty(joints);
  }
  for (int i = 0; i < 3; ++i) {
    const dReal* p = dBodyGetPosition(bodies[static_cast<std::size_t>(i)]);
    EXPECT_LT(std::hypot(p[0], p[1]), 1e-3) << "brick " << i;
    EXPECT_NEAR(p[2], height * (i + 0.5), 2e-3) << "brick " << i;
  }
  EXPECT_EQ(stats().lazy_partners, 0u);
  EXPECT_EQ(stats().lazy_pairs, 0u);
  bricks.clear();
  dJointGroupDestroy(joints);
  dWorldDestroy(world);
}

int observed = 0;
int observed_contacts = 0;

TEST_F(Takeover, AnObserverHearsOfEveryCollision) {
  const TriMesh trimesh(box_shape(1, 1, 1)->mesh(), space);
  const dGeomID sphere = dCreateSphere(space, 0.3);
  dGeomSetPosition(sphere, 0, 0, 0.7);
  take_over();
  ode::observe_takeover([](int partner_class, std::int64_t ns, int contacts, bool by_ode) noexcept {
    observed += partner_class == dSphereClass && ns >= 0 && !by_ode;
    observed_contacts += contacts;
  });
  collide(trimesh.geom, sphere);
  collide(sphere, trimesh.geom);
  EXPECT_EQ(observed, 2);
  EXPECT_EQ(observed_contacts, 2);
}

// DART 6.12 reads the pose of a geom after dGeomSetBody has given its record up: that is still there as long as ODE can
// keep it for the next geom, and it can keep one.
TEST_F(Takeover, LeavesTheRecordThatOdeKeepsForTheNextGeomToTheClient) {
  const auto record_of = [](dGeomID geom) { return reinterpret_cast<std::uintptr_t>(dGeomGetPosition(geom)); };
  const dWorldID world = dWorldCreate();
  const auto record_comes_back = [world, record_of](bool prepared) {
    const dGeomID first = dCreateSphere(nullptr, 1);  // takes what earlier geoms have left
    const TriMesh mesh(box_shape(1, 1, 1)->mesh(), nullptr);
    if (prepared) {
      EXPECT_EQ(oddsPrepareTriMesh(mesh.geom, nullptr), 1) << oddsGetLastError();
    }
    const std::uintptr_t record = record_of(mesh.geom);
    const dBodyID body = dBodyCreate(world);
    dGeomSetBody(mesh.geom, body);
    const dGeomID next = dCreateSphere(nullptr, 1);
    const bool back = record_of(next) == record;
    for (const dGeomID geom : {first, next}) dGeomDestroy(geom);
    dGeomSetBody(mesh.geom, nullptr);
    dBodyDestroy(body);
    return back;
  };
  const bool is_kept = record_comes_back(false);
  take_over();
  EXPECT_TRUE(record_comes_back(true) || !is_kept);
  dWorldDestroy(world);
  if (!is_kept) GTEST_SKIP() << "this build of ODE keeps no record";
}

TEST_F(Takeover, ParametersOutOfRangeAreRefused) {
  oddsTakeOverParams params;
  oddsTakeOverParamsInit(&params);
  params.budget_us = 0;
  EXPECT_EQ(oddsTakeOverTriMesh(&params), 0);
  oddsTakeOverParamsInit(&params);
  params.partners = 256;
  EXPECT_EQ(oddsTakeOverTriMesh(&params), 0);
  oddsTakeOverParamsInit(&params);
  params.max_contacts = 9;
  EXPECT_EQ(oddsTakeOverTriMesh(&params), 0);
  EXPECT_NE(std::string(oddsGetLastError()).find("oddsTakeOverParams"), std::string::npos);
}

#define EXPECT_HOLDS(condition)                    \
  if (!(condition)) {                              \
    fprintf(stderr, "not true: %s\n", #condition); \
    _Exit(1);                                      \
  }

void outlive_the_clients_cycles() {
  EXPECT_HOLDS(oddsTakeOverTriMesh(nullptr) == 1);
  for (int cycle = 0; cycle < 3; ++cycle) {
    dInitODE();
    {
      const TriMesh trimesh(box_shape(1, 1, 1)->mesh(), nullptr);
      const dGeomID sphere = dCreateSphere(nullptr, 0.3);
      dGeomSetPosition(sphere, 0, 0, 0.7);
      oddsResetStats();
      EXPECT_HOLDS(collide(trimesh.geom, sphere).size() == 1);
      EXPECT_HOLDS(stats().taken_over == 1);
      dGeomDestroy(sphere);
    }
    dCloseODE();
  }
  dCloseODE();  // once too often: ODE forgets everything
  dInitODE();
  EXPECT_HOLDS(oddsTakeOverTriMesh(nullptr) == 1);
  {
    const TriMesh trimesh(box_shape(1, 1, 1)->mesh(), nullptr);
    const dGeomID sphere = dCreateSphere(nullptr, 0.3);
    dGeomSetPosition(sphere, 0, 0, 0.7);
    oddsResetStats();
    EXPECT_HOLDS(collide(trimesh.geom, sphere).size() == 1);
    EXPECT_HOLDS(stats().taken_over == 1);
    dGeomDestroy(sphere);
  }
  EXPECT_HOLDS(oddsGiveBackTriMesh() == 1);
  _Exit(0);
}

TEST(TakeoverDeathTest, OutlivesCyclesOfInitAndCloseOfTheClient) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(outlive_the_clients_cycles(), ::testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace odds::test
