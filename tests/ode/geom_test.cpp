// One geom: its bounding box under any pose, its settings, its life.
#include <cmath>
#include <limits>
#include <random>

#include "ode/ode_fixture.hpp"

namespace odds::test {
namespace {

class GeomTest : public OdeTest {};

TEST_F(GeomTest, BoundingBoxHoldsEveryVertexAndIsNotLoose) {
  const auto shape = sphere_shape(0.3, 4);
  const dGeomID geom = mesh_geom(shape, space);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int round = 0; round < 100; ++round) {
    rotate(geom, Vec3(uniform(random), uniform(random), uniform(random)), 3.0 * uniform(random));
    dGeomSetPosition(geom, 1e3 * uniform(random), uniform(random), uniform(random));
    dReal aabb[6];
    dGeomGetAABB(geom, aabb);
    const dReal* p = dGeomGetPosition(geom);
    for (const Vec3& vertex : shape->mesh().vertices()) {
      dVector3 rotated;
      dMultiply0_331(rotated, dGeomGetRotation(geom), vertex.data());
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_GE(rotated[axis] + p[axis], aabb[2 * axis]);
        EXPECT_LE(rotated[axis] + p[axis], aabb[2 * axis + 1]);
      }
    }
    for (int axis = 0; axis < 3; ++axis) EXPECT_LT(aabb[2 * axis + 1] - aabb[2 * axis], 0.6 * std::sqrt(3.0) + 1e-9);
  }
}

TEST_F(GeomTest, BoundingBoxFollowsTheOffsetOnABody) {
  const dWorldID world = dWorldCreate();
  const dBodyID body = dBodyCreate(world);
  const dGeomID geom = mesh_geom(box_shape(0.2, 0.2, 0.2), space);
  dGeomSetBody(geom, body);
  dGeomSetOffsetPosition(geom, 1, 0, 0);
  dBodySetPosition(body, 0, 0, 5);
  dMatrix3 quarter_turn;
  dRFromAxisAndAngle(quarter_turn, 0, 0, 1, M_PI / 2);
  dBodySetRotation(body, quarter_turn);
  dReal aabb[6];
  dGeomGetAABB(geom, aabb);
  const double expected[6] = {-0.1, 0.1, 0.9, 1.1, 4.9, 5.1};
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(aabb[i], expected[i], 1e-9);
  dWorldDestroy(world);
}

TEST_F(GeomTest, ANanPoseGivesAFiniteBoxNoContactsAndIsCounted) {
  const auto shape = box_shape(1, 1, 1);
  const dGeomID bad = mesh_geom(shape);
  const dGeomID good = mesh_geom(shape);
  const dGeomID plane = dCreatePlane(nullptr, 0, 0, 1, 10);
  const dGeomID sphere = dCreateSphere(nullptr, 1);
  const dGeomID box = dCreateBox(nullptr, 1, 1, 1);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  std::uint64_t expected_bad = 0;
  for (const double x : {nan, infinity, -infinity, 1e200}) {
    dGeomSetPosition(bad, x, 0, 0);
    dReal aabb[6];
    dGeomGetAABB(bad, aabb);
    for (const double bound : aabb) EXPECT_TRUE(std::isfinite(bound));
    for (const dGeomID other : {good, plane, sphere, box}) {
      EXPECT_TRUE(collide(bad, other).empty());
      EXPECT_TRUE(collide(other, bad).empty());
      expected_bad += 2;
    }
    oddsAnswer answer;
    ASSERT_EQ(oddsGetLastAnswer(bad, good, &answer), 1);
    EXPECT_EQ(answer.bad_pose, 1);
    EXPECT_EQ(answer.basis, ODDS_BUDGET);
    EXPECT_EQ(stats().bad_poses, expected_bad);
  }
  for (const dGeomID geom : {bad, good, plane, sphere, box}) dGeomDestroy(geom);
}

TEST_F(GeomTest, ANanPoseDoesNotAbortAnySpace) {
  const auto shape = box_shape(1, 1, 1);
  dVector3 center = {0, 0, 0};
  dVector3 extents = {10, 10, 10};
  for (const dSpaceID each :
       {dSimpleSpaceCreate(nullptr), dHashSpaceCreate(nullptr), dSweepAndPruneSpaceCreate(nullptr, dSAP_AXES_XYZ),
        dQuadTreeSpaceCreate(nullptr, center, extents, 4)}) {
    const dGeomID bad = mesh_geom(shape, each);
    mesh_geom(shape, each);
    mesh_geom(shape, each);
    dGeomSetPosition(bad, std::numeric_limits<double>::quiet_NaN(), 0, 0);
    int contacts_of_bad = 0;
    int contacts_of_good = 0;
    struct Counts {
      dGeomID bad;
      int* of_bad;
      int* of_good;
    } counts = {bad, &contacts_of_bad, &contacts_of_good};
    dSpaceCollide(each, &counts, [](void* data, dGeomID a, dGeomID b) {
      auto* c = static_cast<Counts*>(data);
      const int found = static_cast<int>(collide(a, b).size());
      *(a == c->bad || b == c->bad ? c->of_bad : c->of_good) += found;
    });
    EXPECT_EQ(contacts_of_bad, 0);
    EXPECT_GT(contacts_of_good, 0);
    dSpaceDestroy(each);
  }
}

TEST_F(GeomTest, SettingsHaveTheDocumentedDefaultsAndKeepWhatIsSet) {
  const auto owned = ode::Geom::make(nullptr, box_shape(1, 1, 1));
  ASSERT_TRUE(owned.ok());
  const dGeomID geom = owned.value().id();
  EXPECT_EQ(dGeomOddsMeshGetBudget(geom), 100);
  EXPECT_EQ(dGeomOddsMeshGetWorkBudget(geom), 0u);
  EXPECT_EQ(dGeomOddsMeshGetPMin(geom), 1);
  EXPECT_EQ(dGeomOddsMeshGetKMin(geom), 10);
  EXPECT_EQ(dGeomOddsMeshGetMaxContacts(geom), 8);
  EXPECT_EQ(dGeomOddsMeshGetMethod(geom), ODDS_METHOD_INCREMENTAL);
  EXPECT_EQ(dGeomOddsMeshGetEstimator(geom), ODDS_ESTIMATOR_KINEMATIC);
  EXPECT_EQ(dGeomOddsMeshGetUndecidedPolicy(geom), ODDS_UNDECIDED_HIT);
  EXPECT_EQ(dGeomOddsMeshGetUndecidedProbability(geom), 0.5);

  EXPECT_EQ(dGeomOddsMeshSetBudget(geom, 20), 1);
  EXPECT_EQ(dGeomOddsMeshSetWorkBudget(geom, 77), 1);
  EXPECT_EQ(dGeomOddsMeshSetPMin(geom, 0.9), 1);
  EXPECT_EQ(dGeomOddsMeshSetKMin(geom, 3), 1);
  EXPECT_EQ(dGeomOddsMeshSetMaxContacts(geom, 4), 1);
  EXPECT_EQ(dGeomOddsMeshGetCarryMotion(geom), 1e-5);
  EXPECT_EQ(dGeomOddsMeshSetCarryMotion(geom, 1e-4), 1);
  EXPECT_EQ(dGeomOddsMeshGetLateContacts(geom), 1);
  EXPECT_EQ(dGeomOddsMeshSetLateContacts(geom, 0), 1);
  EXPECT_EQ(dGeomOddsMeshGetLateContacts(geom), 0);
  for (const int bad : {-1, 2}) EXPECT_EQ(dGeomOddsMeshSetLateContacts(geom, bad), 0);
  EXPECT_EQ(dGeomOddsMeshSetMethod(geom, ODDS_METHOD_EXACT), 1);
  EXPECT_EQ(dGeomOddsMeshSetEstimator(geom, ODDS_ESTIMATOR_CELLS), 1);
  EXPECT_EQ(dGeomOddsMeshSetUndecidedPolicy(geom, ODDS_UNDECIDED_NO_CONTACT, 0.7), 1);

  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {0.0, -1.0, nan}) EXPECT_EQ(dGeomOddsMeshSetBudget(geom, bad), 0);
  for (const double bad : {0.0, -1.0, 1.01, nan}) EXPECT_EQ(dGeomOddsMeshSetPMin(geom, bad), 0);
  EXPECT_EQ(dGeomOddsMeshSetKMin(geom, 0), 0);
  for (const int bad : {-1, 9}) EXPECT_EQ(dGeomOddsMeshSetMaxContacts(geom, bad), 0);
  for (const dReal bad : {-1e-9, 1.5, std::nan("")}) EXPECT_EQ(dGeomOddsMeshSetCarryMotion(geom, bad), 0);
  for (const int bad : {-1, 3}) EXPECT_EQ(dGeomOddsMeshSetMethod(geom, bad), 0);
  for (const int bad : {-1, 2}) EXPECT_EQ(dGeomOddsMeshSetEstimator(geom, bad), 0);
  for (const double bad : {-0.1, 1.0, nan})
    EXPECT_EQ(dGeomOddsMeshSetUndecidedPolicy(geom, ODDS_UNDECIDED_HIT, bad), 0);
  EXPECT_NE(std::string(oddsGetLastError()).find("dGeomOddsMeshSetUndecidedPolicy"), std::string::npos);

  EXPECT_EQ(dGeomOddsMeshGetBudget(geom), 20);
  EXPECT_EQ(dGeomOddsMeshGetWorkBudget(geom), 77u);
  EXPECT_EQ(dGeomOddsMeshGetPMin(geom), 0.9);
  EXPECT_EQ(dGeomOddsMeshGetKMin(geom), 3);
  EXPECT_EQ(dGeomOddsMeshGetMaxContacts(geom), 4);
  EXPECT_EQ(dGeomOddsMeshGetMethod(geom), ODDS_METHOD_EXACT);
  EXPECT_EQ(dGeomOddsMeshGetEstimator(geom), ODDS_ESTIMATOR_CELLS);
  EXPECT_EQ(dGeomOddsMeshGetUndecidedPolicy(geom), ODDS_UNDECIDED_NO_CONTACT);
  EXPECT_EQ(dGeomOddsMeshGetUndecidedProbability(geom), 0.7);
}

TEST_F(GeomTest, SettersRefuseGeomsOfOtherClasses) {
  const dGeomID sphere = dCreateSphere(space, 1);
  EXPECT_EQ(dGeomOddsMeshSetBudget(sphere, 10), 0);
  EXPECT_NE(std::string(oddsGetLastError()).find("dCreateOddsMesh"), std::string::npos);
  EXPECT_EQ(dGeomOddsMeshGetBudget(sphere), 0);
  EXPECT_EQ(dGeomOddsMeshSetBudget(nullptr, 10), 0);
}

TEST_F(GeomTest, CategoryBitsAndUserDataAreTheClients) {
  const dGeomID geom = mesh_geom(box_shape(1, 1, 1), space);
  EXPECT_EQ(dGeomGetCategoryBits(geom), ~0ul) << "the default of ODE";
  int mark = 0;
  dGeomSetData(geom, &mark);
  dGeomSetCategoryBits(geom, 4);
  dGeomSetCollideBits(geom, 2);
  const dGeomID other = mesh_geom(box_shape(1, 1, 1), space);
  collide(geom, other);
  EXPECT_EQ(dGeomGetData(geom), &mark);
  EXPECT_EQ(dGeomGetCategoryBits(geom), 4u);
  EXPECT_EQ(dGeomGetCollideBits(geom), 2u);
}

}  // namespace
}  // namespace odds::test
