// Initialising, pinning ODE, one class for everything, cycles of closing and initialising.
#include <cstdlib>

#include "ode/ode_fixture.hpp"

namespace odds::test {
namespace {

int foreign_class() {
  dGeomClass description = {};
  description.bytes = 8;
  description.collider = [](int) -> dColliderFn* { return nullptr; };
  description.aabb = [](dGeomID, dReal aabb[6]) { std::fill_n(aabb, 6, 0.0); };
  return dCreateGeomClass(&description);
}

// Each of the following runs in its own process: ODE's registry is global and cannot be emptied while others hold ODE.
class RegistryDeathTest : public ::testing::Test {
 protected:
  void SetUp() override { GTEST_FLAG_SET(death_test_style, "threadsafe"); }
};

#define EXPECT_HOLDS(condition)                    \
  if (!(condition)) {                              \
    fprintf(stderr, "not true: %s\n", #condition); \
    _Exit(1);                                      \
  }

void take_one_class_only() {
  EXPECT_HOLDS(oddsInitODE(0) == 1);
  EXPECT_HOLDS(oddsInitODE(0) == 1);
  const int ours = oddsGetClass();
  EXPECT_HOLDS(ours == dFirstUserClass);
  oddsCloseODE();
  EXPECT_HOLDS(oddsGetClass() == ours);
  for (int i = 1; i < dMaxUserClasses; ++i) EXPECT_HOLDS(foreign_class() == ours + i);
  _Exit(0);
}

TEST_F(RegistryDeathTest, TakesOneOfTheFourClassesHoweverOftenItIsInitialised) {
  EXPECT_EXIT(take_one_class_only(), ::testing::ExitedWithCode(0), "");
}

TEST_F(RegistryDeathTest, OdeAbortsAtTheFifthClassNotAtOurs) {
  const auto overfill = [] {
    oddsInitODE(0);
    for (int i = 0; i < dMaxUserClasses; ++i) foreign_class();
  };
  EXPECT_DEATH(overfill(), "too many user classes");
}

void survive_cycles_of_the_client() {
  EXPECT_HOLDS(oddsInitODE(0) == 1);
  const auto shape = box_shape(1, 1, 1);
  const dGeomID a = mesh_geom(shape);
  const dGeomID b = mesh_geom(shape);
  dGeomSetPosition(b, 0, 0, 0.9);
  for (int i = 0; i < 3; ++i) {
    dInitODE();
    dCloseODE();
  }
  EXPECT_HOLDS(dGeomGetClass(a) == oddsGetClass());
  EXPECT_HOLDS(!collide(a, b).empty());
  dGeomDestroy(a);
  dGeomDestroy(b);
  oddsCloseODE();
  _Exit(0);
}

TEST_F(RegistryDeathTest, SurvivesCyclesOfInitAndCloseOfTheClient) {
  EXPECT_EXIT(survive_cycles_of_the_client(), ::testing::ExitedWithCode(0), "");
}

void register_anew_after_a_real_close() {
  EXPECT_HOLDS(oddsInitODE(0) == 1);
  EXPECT_HOLDS(oddsGetClass() == dFirstUserClass);
  oddsCloseODE();  // the last holder: ODE forgets its classes
  EXPECT_HOLDS(oddsGetClass() == -1);
  dInitODE();
  EXPECT_HOLDS(foreign_class() == dFirstUserClass);  // our old number now belongs to somebody else
  EXPECT_HOLDS(oddsInitODE(0) == 1);
  EXPECT_HOLDS(oddsGetClass() == dFirstUserClass + 1);
  const auto shape = box_shape(1, 1, 1);
  const dGeomID a = mesh_geom(shape);
  const dGeomID plane = dCreatePlane(nullptr, 0, 0, 1, -0.4);
  EXPECT_HOLDS(collide(a, plane).size() == 4);
  _Exit(0);
}

TEST_F(RegistryDeathTest, RegistersAnewAfterOdeWasReallyClosed) {
  EXPECT_EXIT(register_anew_after_a_real_close(), ::testing::ExitedWithCode(0), "");
}

void reuse_the_class_while_the_client_holds_ode() {
  dInitODE();
  int first = -1;
  for (int i = 0; i < 10; ++i) {  // ten registrations would overfill ODE's four classes
    EXPECT_HOLDS(oddsInitODE(0) == 1);
    if (i == 0) first = oddsGetClass();
    EXPECT_HOLDS(oddsGetClass() == first);
    oddsCloseODE();
  }
  _Exit(0);
}

TEST_F(RegistryDeathTest, ReusesItsClassWhileTheClientHoldsOde) {
  EXPECT_EXIT(reuse_the_class_while_the_client_holds_ode(), ::testing::ExitedWithCode(0), "");
}

void leave_foreign_classes_to_their_owner() {
  EXPECT_HOLDS(oddsInitODE(0) == 1);
  dGeomClass description = {};
  description.bytes = 8;
  description.collider = [](int) -> dColliderFn* {
    return [](dGeomID o1, dGeomID o2, int, dContactGeom* contact, int) {
      *contact = {};
      contact->g1 = o1;
      contact->g2 = o2;
      return 1;
    };
  };
  description.aabb = [](dGeomID, dReal aabb[6]) { std::fill_n(aabb, 6, 0.0); };
  const dGeomID theirs = dCreateGeom(dCreateGeomClass(&description));
  const dGeomID ours = mesh_geom(box_shape(1, 1, 1));
  EXPECT_HOLDS(collide(ours, theirs).size() == 1);
  EXPECT_HOLDS(collide(theirs, ours).size() == 1);
  _Exit(0);
}

TEST_F(RegistryDeathTest, AClassOfAnotherLibraryIsAskedForItsOwnCollider) {
  EXPECT_EXIT(leave_foreign_classes_to_their_owner(), ::testing::ExitedWithCode(0), "");
}

TEST(Registry, ClosingTooOftenIsRefusedWithAnError) {
  ASSERT_EQ(oddsGetClass(), -1);
  oddsCloseODE();
  EXPECT_NE(std::string(oddsGetLastError()).find("more often"), std::string::npos);
}

TEST(Registry, NothingCanBeCreatedBeforeInit) {
  const auto shape = box_shape(1, 1, 1);
  const oddsMeshDataID data = ode::oddsMeshDataFromShape(shape);
  ASSERT_NE(data, nullptr);
  EXPECT_EQ(dCreateOddsMesh(nullptr, data), nullptr);
  EXPECT_NE(std::string(oddsGetLastError()).find("oddsInitODE"), std::string::npos);
  oddsMeshDataDestroy(data);
}

}  // namespace
}  // namespace odds::test
