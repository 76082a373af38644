// Which pairs a frame finds: spaces inside of spaces, and that finding them costs nothing but their search.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <string>
#include <utility>

#include "ode/frame_fixture.hpp"
#include "support/allocation_counter.hpp"

namespace odds::test {
namespace {

using Calls = std::map<std::pair<dGeomID, dGeomID>, int>;

void count_call(void* calls, dGeomID a, dGeomID b) { ++(*static_cast<Calls*>(calls))[std::minmax(a, b)]; }

class FrameSpaces : public FrameTest {
 protected:
  static dGeomID sphere(dSpaceID into, double x) {
    const dGeomID geom = dCreateSphere(into, 1.0);
    dGeomSetPosition(geom, x, 0.0, 0.0);
    return geom;
  }
};

TEST_F(FrameSpaces, EachPairIsCalledOnceHoweverManyThingsItsSpaceMeets) {
  const dSpaceID inner = dHashSpaceCreate(space);
  const dSpaceID innermost = dSimpleSpaceCreate(inner);
  for (int i = 0; i < 2; ++i) sphere(inner, 0.1 * i);
  for (int i = 0; i < 2; ++i) sphere(innermost, 0.3 + 0.1 * i);
  for (int i = 0; i < 5; ++i) sphere(space, 0.05 * i);
  Calls calls;
  ASSERT_EQ(oddsSpaceCollide(space, &calls, &count_call, budget), 1);
  EXPECT_EQ(calls.size(), 36U);  // nine spheres, each on each
  for (const auto& [pair, count] : calls) EXPECT_EQ(count, 1);
  EXPECT_EQ(summary().pairs, 36);
}

// ODE aborts where one asks a quad tree for its members.
TEST_F(FrameSpaces, AQuadTreeIsSearchedAndSoIsOneInAnotherSpace) {
  const dVector3 centre = {0, 0, 0, 0};
  const dVector3 extents = {10, 10, 10, 0};
  const dSpaceID tree = dQuadTreeSpaceCreate(nullptr, centre, extents, 3);
  for (int i = 0; i < 3; ++i) sphere(tree, 0.1 * i);
  Calls calls;
  ASSERT_EQ(oddsSpaceCollide(tree, &calls, &count_call, budget), 1) << oddsGetLastError();
  EXPECT_EQ(calls.size(), 3U);
  dSpaceAdd(space, reinterpret_cast<dGeomID>(tree));
  sphere(space, 0.2);
  calls.clear();
  ASSERT_EQ(oddsSpaceCollide(space, &calls, &count_call, budget), 1);
  EXPECT_EQ(calls.size(), 6U) << "those in the tree, and each with the other sphere";
}

TEST_F(FrameSpaces, ASpaceThatMeetsNothingIsSearched) {
  const dSpaceID inner = dSimpleSpaceCreate(space);
  for (int i = 0; i < 2; ++i) sphere(inner, 0.1 * i);
  Calls calls;
  oddsSpaceCollide(space, &calls, &count_call, budget);
  EXPECT_EQ(calls.size(), 1U);
  dGeomDisable(reinterpret_cast<dGeomID>(inner));
  calls.clear();
  oddsSpaceCollide(space, &calls, &count_call, budget);
  EXPECT_EQ(calls.size(), 0U);
}

TEST_F(FrameSpaces, PrimitivesCostNoMemoryAndLeaveTheLastErrorAlone) {
  for (int i = 0; i < 4; ++i) sphere(space, 0.1 * i);
  mesh_geom(sphere_shape(0.5), space);
  const auto callback = [](void*, dGeomID a, dGeomID b) {
    dContactGeom contacts[8];
    dCollide(a, b, 8, contacts, sizeof(dContactGeom));
  };
  EXPECT_EQ(oddsFrameBudgetSetWork(nullptr, 1), 0);
  const std::string error = oddsGetLastError();
  oddsSpaceCollide(space, nullptr, callback, budget);
  const support::AllocationCounter counter;
  for (int frame = 0; frame < 10; ++frame) oddsSpaceCollide(space, nullptr, callback, budget);
  EXPECT_EQ(counter.allocations(), 0U);
  EXPECT_EQ(summary().served, 10);
  EXPECT_EQ(oddsGetLastError(), error);
}

// What they look at of the mesh was not counted: any number of boxes was one unit each.
TEST_F(FrameSpaces, PrimitivesCostWork) {
  const dGeomID mesh = mesh_geom(sphere_shape(1.0, 24), space);
  dGeomSetCategoryBits(mesh, 1);
  dGeomSetCollideBits(mesh, 2);
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 60; ++i) {
    const dGeomID body = i % 3 == 0   ? dCreateBox(space, 0.2, 0.2, 0.2)
                         : i % 3 == 1 ? dCreateCylinder(space, 0.1, 0.2)
                                      : dCreateCapsule(space, 0.1, 0.1);
    const Vec3 place = Vec3(normal(random), normal(random), normal(random)).normalized();
    dGeomSetPosition(body, place.x(), place.y(), place.z());
    dGeomSetCategoryBits(body, 2);
    dGeomSetCollideBits(body, 1);
  }
  const oddsFrameBudgetID frame = oddsFrameBudgetCreate(100);
  ASSERT_EQ(oddsFrameBudgetSetWork(frame, 500), 1);
  int contacts = 0;
  const auto near = [](void* found, dGeomID a, dGeomID b) {
    *static_cast<int*>(found) += static_cast<int>(collide(a, b, 8).size());
  };
  ASSERT_EQ(oddsSpaceCollide(space, &contacts, near, frame), 1);
  oddsFrameSummary summary;
  oddsFrameBudgetGetSummary(frame, &summary);
  EXPECT_GE(summary.pairs, 60);
  EXPECT_GT(contacts, 0);
  EXPECT_LT(summary.served, 40);
  EXPECT_GT(summary.work, 250u);
  EXPECT_LE(summary.work, 510u);
  oddsFrameBudgetDestroy(frame);
}

}  // namespace
}  // namespace odds::test
