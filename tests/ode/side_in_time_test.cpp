// The ray that tells on which side of a surface a starved body is ends with the budget.
#include <gtest/gtest.h>

#include <cstdint>

#include "odds/math/random.hpp"
#include "odds/mesh/made/torus_knot.hpp"
#include "ode/ode_fixture.hpp"

namespace odds::test {
namespace {

using SideInTimeTest = OdeTest;

// A capsule may need two such rays. Each look at the clock takes as long as two nodes of a ray; rays of up to 24 nodes,
// begun when the time for looking was up, made a collision eight looks late.
TEST_F(SideInTimeTest, RaysEndWithTheBudget) {
  const auto shape = shape_of(mesh::made::TorusKnot{.along = 600, .across = 50});
  const double size = shape->mesh().size();
  const dGeomID mesh = mesh_geom(shape, space);
  const dGeomID capsule = dCreateCapsule(space, 0.1 * size, 0.2 * size);
  constexpr std::int64_t look_ns = 500;
  constexpr std::int64_t budget_looks = 20;
  ASSERT_EQ(dGeomOddsMeshSetBudget(mesh, budget_looks * look_ns * 1e-3), 1);
  math::Random random(4);
  int met = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 place = 0.4 * size * random.uniform() * random.direction();
    dGeomSetPosition(capsule, place.x(), place.y(), place.z());
    const SlowLooks looks(look_ns);
    met += collide(mesh, capsule).empty() ? 0 : 1;
    EXPECT_LE(looks.clock.readings(), budget_looks + 5) << i;
  }
  EXPECT_GT(met, 200);
}

}  // namespace
}  // namespace odds::test
