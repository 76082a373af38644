// No collision of a prepared pair touches the heap.
#include <random>

#include "ode/ode_fixture.hpp"
#include "support/allocation_counter.hpp"

namespace odds::test {
namespace {

class Allocation : public OdeTest {
 protected:
  void SetUp() override {
    OdeTest::SetUp();
    if (!support::counts_allocations) GTEST_SKIP() << "the sanitizer's own malloc is in place";
  }
};

TEST_F(Allocation, TheCounterSeesMallocAndNew) {
  const support::AllocationCounter counter;
  void* volatile by_malloc = malloc(10);
  free(by_malloc);
  int* volatile by_new = new int(3);
  delete by_new;
  struct alignas(64) Wide {
    char bytes[64];
  };
  Wide* volatile by_aligned_new = new Wide;
  delete by_aligned_new;
  EXPECT_EQ(counter.allocations(), 3u);
  EXPECT_EQ(counter.frees(), 3u);
}

TEST_F(Allocation, NoneInAnyCollisionOfPreparedPairs) {
  const auto shape = sphere_shape(1.0, 12);
  const dGeomID mesh = mesh_geom(shape, space);
  const dGeomID other = mesh_geom(shape, space);
  const dGeomID sphere = dCreateSphere(space, 0.5);
  const dGeomID box = dCreateBox(space, 0.5, 0.6, 0.7);
  const dGeomID capsule = dCreateCapsule(space, 0.3, 0.5);
  const dGeomID cylinder = dCreateCylinder(space, 0.3, 0.5);
  const dGeomID ray = dCreateRay(space, 3);
  const dGeomID plane = dCreatePlane(space, 0, 0, 1, 0.2);
  ASSERT_EQ(oddsPreparePair(mesh, other), 1);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-2.0, 2.0);
  std::array<dContactGeom, 16> contacts;
  std::size_t collisions = 0;
  for (const int method : {ODDS_METHOD_EXACT, ODDS_METHOD_INCREMENTAL, ODDS_METHOD_TIME_CRITICAL}) {
    for (const unsigned long work : {0ul, 1ul, 100ul}) {
      dGeomOddsMeshSetMethod(mesh, method);
      dGeomOddsMeshSetWorkBudget(mesh, work);
      dGeomOddsMeshSetBudget(mesh, work == 100 ? 20 : dInfinity);
      for (int round = 0; round < 40; ++round) {
        rotate(mesh, Vec3(uniform(random), uniform(random), uniform(random)), uniform(random));
        for (const dGeomID partner : {other, sphere, box, capsule, cylinder, ray}) {
          dGeomSetPosition(partner, uniform(random), uniform(random), uniform(random));
        }
        const support::AllocationCounter counter;
        for (const dGeomID partner : {other, sphere, box, capsule, cylinder, ray, plane}) {
          collisions += dCollide(mesh, partner, 16, contacts.data(), sizeof(dContactGeom)) > 0;
          dCollide(partner, mesh, 16, contacts.data(), sizeof(dContactGeom));
        }
        oddsAnswer answer;
        oddsGetLastAnswer(mesh, other, &answer);
        ASSERT_EQ(counter.allocations(), 0u);
        ASSERT_EQ(counter.frees(), 0u);
      }
    }
  }
  EXPECT_GT(collisions, 300u) << "the poses must not be all misses";
}

TEST_F(Allocation, NoneInASimpleSpace) {
  const auto shape = sphere_shape(1.0, 6);
  std::vector<dGeomID> geoms;
  for (int i = 0; i < 6; ++i) {
    geoms.push_back(mesh_geom(shape, space));
    dGeomSetPosition(geoms.back(), 0.9 * i, 0, 0);
  }
  for (const dGeomID g : geoms) {
    for (const dGeomID h : geoms) {
      if (g != h) {
        ASSERT_EQ(oddsPreparePair(g, h), 1);
      }
    }
  }
  const support::AllocationCounter counter;
  int found = 0;
  dSpaceCollide(space, &found, [](void* data, dGeomID a, dGeomID b) {
    dContactGeom contacts[8];
    *static_cast<int*>(data) += dCollide(a, b, 8, contacts, sizeof(dContactGeom));
  });
  EXPECT_EQ(counter.allocations(), 0u);
  EXPECT_GE(found, 5);
}

}  // namespace
}  // namespace odds::test
