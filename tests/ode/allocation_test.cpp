// No collision of a prepared pair touches the heap.
#include <random>

#include "ode/partners_fixture.hpp"
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
  const Partners known(space);
  const dGeomID plane = dCreatePlane(space, 0, 0, 1, 0.2);
  std::vector<dGeomID> partners = known.all;
  partners.push_back(other);
  for (const dGeomID partner : partners) ASSERT_EQ(oddsPreparePair(mesh, partner), 1) << oddsGetLastError();
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
        for (const dGeomID partner : partners) {
          dGeomSetPosition(partner, uniform(random), uniform(random), uniform(random));
        }
        const support::AllocationCounter counter;
        dCollide(mesh, plane, 16, contacts.data(), sizeof(dContactGeom));
        for (const dGeomID partner : partners) {
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

TEST_F(Allocation, NoneWhereContactsAreKept) {
  const dGeomID floor = mesh_geom(box_shape(8.0, 8.0, 2.0, 60), space);
  dGeomSetPosition(floor, 0, 0, -1);
  const Partners known(space);
  for (const dGeomID partner : known.all) ASSERT_EQ(oddsPreparePair(floor, partner), 1) << oddsGetLastError();
  dGeomOddsMeshSetWorkBudget(floor, 20);
  dContactGeom contacts[8];
  int found = 0;
  for (int round = 0; round < 50; ++round) {
    for (const dGeomID partner : known.all) {
      dGeomSetPosition(partner, 0.1, 0.2, 0.19 + 1e-4 * (round % 3));
      const support::AllocationCounter counter;
      found += dCollide(floor, partner, 8, contacts, sizeof(dContactGeom));
      ASSERT_EQ(counter.allocations(), 0U);
    }
  }
  EXPECT_GT(found, 500);
  EXPECT_GT(stats().primitive_cut_off, 150U) << "of 50 with each of four";
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
