// What most ODE tests need: the library held open, meshes made quickly, contacts read back.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <vector>

#include "odds/mesh/made/box.hpp"
#include "odds/mesh/made/icosphere.hpp"
#include "odds/ode/geom.hpp"
#include "odds/realtime/clock.hpp"
#include "ode/budget_clock.hpp"

namespace odds::test {

/// A shape of a made mesh; fails the test (and throws) if it cannot be built.
template <class Made>
std::shared_ptr<const query::Shape> shape_of(const Made& made) {
  auto mesh = make(made);  // found by its argument, so that every made shape will do
  if (!mesh.ok()) throw std::runtime_error(mesh.error().message());
  auto shape = query::Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(mesh).value()));
  if (!shape.ok()) throw std::runtime_error(shape.error().message());
  return std::move(shape).value();
}

inline std::shared_ptr<const query::Shape> box_shape(double x, double y, double z, std::uint32_t cells = 1) {
  return shape_of(mesh::made::Box{.x = x, .y = y, .z = z, .cells = cells});
}

inline std::shared_ptr<const query::Shape> sphere_shape(double radius, std::uint32_t frequency = 8) {
  return shape_of(mesh::made::Icosphere{.radius = radius, .frequency = frequency});
}

/// A geom whose time is unlimited, so that results do not depend on the machine. ODE destroys it with its space, or the
/// test does.
inline dGeomID mesh_geom(const std::shared_ptr<const query::Shape>& shape, dSpaceID space = nullptr) {
  auto geom = ode::Geom::make(space, shape);
  if (!geom.ok()) throw std::runtime_error(geom.error().message());
  dGeomOddsMeshSetBudget(geom.value().id(), dInfinity);
  return geom.value().release();
}

/// dCollide with room for `room` contacts.
inline std::vector<dContactGeom> collide(dGeomID g1, dGeomID g2, int room = 16, unsigned flags = 0) {
  std::vector<dContactGeom> contacts(static_cast<std::size_t>(room));
  const int count =
      dCollide(g1, g2, static_cast<int>(static_cast<unsigned>(room) | flags), contacts.data(), sizeof(dContactGeom));
  contacts.resize(static_cast<std::size_t>(count));
  return contacts;
}

inline Vec3 position_of(const dContactGeom& contact) { return {contact.pos[0], contact.pos[1], contact.pos[2]}; }
inline Vec3 normal_of(const dContactGeom& contact) { return {contact.normal[0], contact.normal[1], contact.normal[2]}; }

/// A vector in a geom's frame, in the world's axes.
inline Vec3 in_world(dGeomID geom, const Vec3& vector) {
  dVector3 world;
  dGeomVectorToWorld(geom, vector.x(), vector.y(), vector.z(), world);
  return {world[0], world[1], world[2]};
}

inline void rotate(dGeomID geom, const Vec3& axis, double angle) {
  dMatrix3 rotation;
  dRFromAxisAndAngle(rotation, axis.x(), axis.y(), axis.z(), angle);
  dGeomSetRotation(geom, rotation);
}

/// What every contact of any pair must satisfy by ODE's contract.
inline void expect_sound(const std::vector<dContactGeom>& contacts, dGeomID g1, dGeomID g2) {
  for (const dContactGeom& contact : contacts) {
    EXPECT_EQ(contact.g1, g1);
    EXPECT_EQ(contact.g2, g2);
    EXPECT_TRUE(position_of(contact).allFinite());
    EXPECT_NEAR(normal_of(contact).norm(), 1.0, 1e-9);
    EXPECT_GE(contact.depth, 0.0);
    EXPECT_EQ(contact.pos[3], 0.0);
    EXPECT_EQ(contact.normal[3], 0.0);
  }
}

inline oddsStats stats() {
  oddsStats now;
  oddsGetStats(&now);
  return now;
}

/// Holds the library from SetUp to TearDown; geoms made in `space` die before it closes.
class OdeTest : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(oddsInitODE(0), 1) << oddsGetLastError();
    oddsResetStats();
    space = dSimpleSpaceCreate(nullptr);
  }
  void TearDown() override {
    dSpaceDestroy(space);
    EXPECT_EQ(stats().live_geoms, 0u) << "a geom outlived its space";
    EXPECT_EQ(stats().live_pairs, 0u) << "a workspace outlived its geoms";
    EXPECT_EQ(stats().caught, 0u);
    oddsCloseODE();
  }

  dSpaceID space = nullptr;
};

/// While it lives, every look at the budgets' clock takes so long.
struct SlowLooks {
  explicit SlowLooks(std::int64_t look_ns) : clock(look_ns) { ode::use_budget_clock(clock.clock()); }
  ~SlowLooks() { ode::use_budget_clock({}); }
  SlowLooks(const SlowLooks&) = delete;
  SlowLooks& operator=(const SlowLooks&) = delete;

  realtime::ManualClock clock;
};

}  // namespace odds::test
