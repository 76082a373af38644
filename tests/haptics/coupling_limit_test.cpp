// The greatest force and torque of a coupling's spring: it pulls with that much, however stiff it is.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "odds/mesh/made/by_name.hpp"
#include "odds/ode/world.hpp"

namespace odds::ode {
namespace {

constexpr double mass_kg = 0.05;
constexpr double moment_kg_m2 = mass_kg * 0.01 / 6.0;  // of a cube of 0.1 m

// A body at rest at the origin, without weight, and a spring to it.
class LimitedCoupling : public testing::Test {
 public:
  LimitedCoupling() : world_(World::make(WorldOptions()).value()) {
    auto mesh =
        std::make_shared<const mesh::TriangleMesh>(mesh::made::make_shape("made:box:x=0.1,y=0.1,z=0.1").value());
    body_ = world_.add_dynamic(query::Shape::build(mesh).value(), {}, {.mass_kg = mass_kg}, "cube").value();
    world_.add_coupling(body_);
    EXPECT_FALSE(world_.prepare().has_value());
  }

 protected:
  void steps(int count, const Coupling& coupling) {
    for (int i = 0; i < count; ++i) {
      world_.set_coupling(body_, coupling);
      world_.step();
    }
  }
  World world_;
  BodyId body_;
};

Coupling spring(double k, double k_r, double most_n, double most_nm) {
  Coupling coupling;
  coupling.stiffness_n_per_m = k;
  coupling.angular_stiffness_nm_per_rad = k_r;
  coupling.max_spring_force_n = most_n;
  coupling.max_spring_torque_nm = most_nm;
  return coupling;
}

// The rows kept the softness of the unlimited spring: a body far from its target crept at limit / (step * stiffness),
// here 5 mm/s, and the hand felt nothing of 0.5 N.
TEST_F(LimitedCoupling, PullsWithItsGreatestForceAndTorqueHoweverStiff) {
  for (const double k : {20.0, 500.0, 1e5, 1e9}) {
    Coupling coupling = spring(k, k, 0.5, 0.01);
    coupling.target.translation = Vec3(0.3, 0.4, 0.0);
    coupling.target.rotation = Eigen::AngleAxisd(2.0, Vec3::UnitZ()).toRotationMatrix();
    world_.set_state(body_, {});
    steps(30, coupling);
    const BodyState state = world_.state(body_);
    EXPECT_NEAR(state.velocity_m_per_s.norm(), 0.5 * 0.03 / mass_kg, 0.003) << k;
    EXPECT_NEAR(state.angular_velocity_rad_per_s.z(), 0.01 * 0.03 / moment_kg_m2, 0.04) << k;
    EXPECT_NEAR(world_.coupling_wrench(body_).force_n.norm(), 0.5, 0.005) << k;
    EXPECT_NEAR(world_.coupling_wrench(body_).torque_nm.z(), 0.01, 1e-4) << k;
  }
}

// What is dragged along at a speed feels the limit, too.
TEST_F(LimitedCoupling, DoesNotSlowABodyThatMovesWithItsTarget) {
  Coupling coupling = spring(1e5, 1.0, 0.5, 0.01);
  coupling.damping_ns_per_m = 2.0;
  coupling.target_velocity_m_per_s = Vec3(0.2, 0, 0);
  for (int i = 0; i < 500; ++i) {
    coupling.target.translation = Vec3(0.1 + 0.2e-3 * i, 0, 0);
    world_.apply(body_, {Vec3(-0.5, 0, 0), Vec3::Zero()});  // holds as much as the spring pulls
    steps(1, coupling);
  }
  EXPECT_NEAR(world_.state(body_).velocity_m_per_s.x(), 0.2, 0.004);
  EXPECT_NEAR(world_.coupling_wrench(body_).force_n.x(), 0.5, 0.005);
}

// A spring whose force is bounded has the potential of a funnel: steep as the limit beyond limit / k.
RC_GTEST_FIXTURE_PROP(LimitedCoupling, NeverGainsEnergy, ()) {
  const double k = std::pow(10.0, *rc::gen::inRange(0, 7));
  const double b = std::pow(10.0, *rc::gen::inRange(-3, 4));
  const double most_n = std::pow(10.0, *rc::gen::inRange(-3, 3));
  Coupling coupling = spring(k, 1.0, most_n, 1.0);
  coupling.damping_ns_per_m = b;
  world_.set_state(body_, {{Mat3::Identity(), Vec3(0.2, -0.1, 0.05)}, Vec3(-1, 2, 0.5), Vec3::Zero()});
  const auto energy = [&] {
    const BodyState state = world_.state(body_);
    const double away = state.pose.translation.norm();
    const double linear = std::min(away, most_n / k);
    return 0.5 * mass_kg * state.velocity_m_per_s.squaredNorm() + 0.5 * k * linear * linear + most_n * (away - linear);
  };
  double last = energy();
  for (int i = 0; i < 300; ++i) {
    steps(1, coupling);
    const double now = energy();
    RC_ASSERT(now <= last * (1 + 1e-9) + 1e-15);
    last = now;
  }
}

}  // namespace
}  // namespace odds::ode
