// The loop from a program, without a scene: the order of the calls that docs/haptics.md names.
#include "odds/haptics/renderer.hpp"

#include <gtest/gtest.h>

#include "odds/haptics/effect_registry.hpp"
#include "odds/haptics/scripted_device.hpp"
#include "odds/mesh/made/by_name.hpp"
#include "support/allocation_counter.hpp"

namespace odds::haptics {
namespace {

std::shared_ptr<const query::Shape> made(const char* name) {
  return query::Shape::build(std::make_shared<const mesh::TriangleMesh>(mesh::made::make_shape(name).value())).value();
}

TEST(Renderer, WithoutASceneEffectsActOnceTheyAreBound) {
  const std::array<BodyInfo, 2> bodies = {{{"floor", false}, {"tip", true}}};
  const Settings plain;
  Settings soft;
  soft.entries = {{"body", {}, {std::string("tip"), {}}}, {"stiffness_n_per_m", {}, {1000.0, {}}}};
  EffectSet effects;
  for (const char* name : {"virtual_coupling", "contact", "compliance", "events"}) {
    auto effect = make_effect(name, {name == std::string("compliance") ? &soft : &plain, bodies, 0.001});
    ASSERT_TRUE(effect.ok()) << effect.error().message();
    effects.add(name, {}, std::move(effect).value());
  }
  ode::WorldOptions options;
  effects.configure(options);
  ode::World world = std::move(ode::World::make(options)).value();
  ASSERT_TRUE(
      world.add_fixed(made("made:box:x=1,y=1,z=0.1,cells=2"), {Mat3::Identity(), Vec3(0, 0, -0.05)}, "floor").ok());
  const auto tip = world.add_dynamic(made("made:icosphere:radius=0.02"), {}, {.mass_kg = 0.05}, "tip");
  ASSERT_TRUE(tip.ok());
  Motion down;
  down.kind = MotionKind::slide;
  down.duration_s = 0.3;
  down.by_m = Vec3(0, 0, -0.02);
  ScriptedDevice device({Mat3::Identity(), Vec3(0, 0, 0.03)}, {down}, false);
  Renderer renderer(world, Hand{&device, tip.value(), {}, {}}, effects);
  ASSERT_FALSE(world.prepare().has_value());
  ASSERT_FALSE(effects.bind(world).has_value());
  ASSERT_TRUE(renderer.begin());
  TickRecord record;
  const support::AllocationCounter counter;
  for (std::int64_t i = 0; i < 600; ++i) renderer.tick(i * 1'000'000, record);
  if (support::counts_allocations) {
    EXPECT_EQ(counter.allocations(), 0U);
  }
  // The hand is 1 cm deep: three springs in a row.
  const double stiffness = 1.0 / (1.0 / 500 + 1.0 / 1000 + 1.0 / 20000);
  EXPECT_NEAR(record.force_n[2], 0.01 * stiffness, 0.02 * 0.01 * stiffness);
  EXPECT_EQ(effects.events().size(), 1U);
}

}  // namespace
}  // namespace odds::haptics
