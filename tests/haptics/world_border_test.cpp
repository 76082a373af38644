// What a world refuses, and what it leaves to the program and to other worlds.
#include <gtest/gtest.h>
#include <ode/ode.h>

#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <thread>

#include "odds/mesh/made/by_name.hpp"
#include "odds/ode/world.hpp"

namespace odds::ode {
namespace {

const std::shared_ptr<const query::Shape>& cube() {
  static const auto made = query::Shape::build(std::make_shared<const mesh::TriangleMesh>(
                                                   mesh::made::make_shape("made:box:x=0.1,y=0.1,z=0.1").value()))
                               .value();
  return made;
}

World make(const WorldOptions& options) { return World::make(options).value(); }

math::Pose at(double x, double y, double z) { return {Mat3::Identity(), Vec3(x, y, z)}; }

TEST(WorldBorder, RefusesBodiesWithoutAShape) {
  World world = make({});
  const auto fixed = world.add_fixed(nullptr, at(0, 0, 0), "floor");
  ASSERT_FALSE(fixed.ok());
  EXPECT_EQ(fixed.error().file, "floor");
  const auto dynamic = world.add_dynamic(nullptr, at(0, 0, 0), {.mass_kg = 1.0}, "cube");
  ASSERT_FALSE(dynamic.ok());
  EXPECT_EQ(dynamic.error().file, "cube");
}

// ODE's own friction may be infinite; here such contacts were left out, and bodies fell through each other.
TEST(WorldBorder, RefusesContactsThatAreNotFinite) {
  const double infinity = std::numeric_limits<double>::infinity();
  for (double ContactModel::*number :
       {&ContactModel::stiffness_n_per_m, &ContactModel::damping_ns_per_m, &ContactModel::friction}) {
    WorldOptions options;
    options.contact.*number = infinity;
    EXPECT_FALSE(World::make(options).ok());
  }
  WorldOptions options;
  options.contact.max_correcting_velocity_m_per_s = std::nan("");
  EXPECT_FALSE(World::make(options).ok());
}

TEST(WorldBorder, KeepsItsContactWhereAnotherIsOutOfRange) {
  World world = make({});
  const auto refused = [&](double ContactModel::*number, double value) {
    ContactModel contact = world.options().contact;
    contact.friction = 0.5;
    contact.*number = value;
    world.set_contact(contact);
    return world.options().contact.friction == 0.0 || number == &ContactModel::friction;
  };
  for (const double value : {-1.0, 0.0, std::nan("")}) {
    EXPECT_TRUE(refused(&ContactModel::max_correcting_velocity_m_per_s, value)) << value;
    EXPECT_TRUE(refused(&ContactModel::stiffness_n_per_m, value)) << value;
    EXPECT_TRUE(refused(&ContactModel::error_reduction, value)) << value;
  }
  EXPECT_TRUE(refused(&ContactModel::damping_ns_per_m, -1.0));
  refused(&ContactModel::friction, -1.0);
  EXPECT_EQ(world.options().contact.friction, 0.0);
  EXPECT_EQ(world.options().contact.max_correcting_velocity_m_per_s, 1.0);
  EXPECT_FALSE(refused(&ContactModel::max_correcting_velocity_m_per_s, 2.0));
  EXPECT_EQ(world.options().contact.max_correcting_velocity_m_per_s, 2.0);
}

// ODE ended the program, in most runs of this.
// Gravity that is not a number ended the program, in ODE; such a damping held all bodies where they were, and one below
// zero drove them through the floor.
TEST(WorldBorder, KeepsItsGravityAndDampingWhereOthersAreOutOfRange) {
  const double nan = std::nan("");
  const double infinity = std::numeric_limits<double>::infinity();
  WorldOptions options;
  options.gravity_m_per_s2 = Vec3(0, 0, -9.81);
  World world = make(options);
  ASSERT_TRUE(world.add_fixed(cube(), at(0, 0, -0.1), "floor").ok());
  const BodyId body = world.add_dynamic(cube(), at(0, 0, 0.001), {.mass_kg = 1.0}, "cube").value();
  ASSERT_FALSE(world.prepare());
  for (const double bad : {nan, infinity, -infinity}) {
    world.set_gravity(Vec3(0, 0, bad));
    world.set_damping({.linear_per_s = bad});
    world.set_damping({.angular_per_s = bad});
  }
  world.set_damping({.linear_per_s = -5000.0});
  world.set_damping({.angular_per_s = -5000.0});
  for (int i = 0; i < 500; ++i) EXPECT_EQ(world.step().bodies_recovered, 0u);
  EXPECT_LT(world.state(body).pose.translation.z(), 0.0);
  EXPECT_GT(world.state(body).pose.translation.z(), -0.01);
  const auto is_made = [](const auto& change) {
    WorldOptions changed;
    change(changed);
    return World::make(changed).ok();
  };
  EXPECT_FALSE(is_made([&](WorldOptions& o) { o.damping.linear_per_s = nan; }));
  EXPECT_FALSE(is_made([&](WorldOptions& o) { o.damping.angular_per_s = -1.0; }));
  EXPECT_FALSE(is_made([&](WorldOptions& o) { o.max_speed_m_per_s = nan; }));
  EXPECT_FALSE(is_made([&](WorldOptions& o) { o.max_spin_rad_per_s = 0.0; }));
  EXPECT_TRUE(is_made([&](WorldOptions& o) { o.max_speed_m_per_s = infinity; }));
}

TEST(WorldBorder, StepsBesideAnotherOneInAnotherThread) {
  std::atomic<int> ready{0};
  const auto hang = [&ready](double& height) {
    WorldOptions options;
    options.gravity_m_per_s2 = Vec3(0, 0, -10);
    World world = make(options);
    const BodyId body = world.add_dynamic(cube(), at(0, 0, 0), {.mass_kg = 0.5}, "cube").value();
    world.add_coupling(body);
    Coupling spring;
    spring.stiffness_n_per_m = 500;
    spring.damping_ns_per_m = 30;
    world.set_coupling(body, spring);
    EXPECT_FALSE(world.prepare().has_value());
    for (++ready; ready < 2;) {
    }
    for (int i = 0; i < 200'000; ++i) world.step();
    height = world.state(body).pose.translation.z();
  };
  std::array<double, 2> heights = {};
  std::thread other([&] { hang(heights[0]); });
  hang(heights[1]);
  other.join();
  EXPECT_NEAR(heights[0], -0.5 * 10 / 500, 1e-6);
  EXPECT_EQ(heights[1], heights[0]);
}

int messages_heard = 0;

TEST(WorldBorder, LeavesTheProgramItsMessageHandler) {
  dMessageFunction* const before = dGetMessageHandler();
  dMessageFunction* const own = [](int, const char*, va_list) { ++messages_heard; };
  dSetMessageHandler(own);
  {
    const World world = make({});
    const World other = make({});
    dMessage(0, "between steps");
    EXPECT_EQ(messages_heard, 1);
  }
  EXPECT_EQ(dGetMessageHandler(), own);
  dSetMessageHandler(before);
}

}  // namespace
}  // namespace odds::ode
