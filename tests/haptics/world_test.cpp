// The physics world: springs that hold what they promise, contacts that rest, memory taken once.
#include "odds/ode/world.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>

#include "odds/mesh/made/by_name.hpp"
#include "support/allocation_counter.hpp"

namespace odds::ode {
namespace {

std::shared_ptr<const query::Shape> shape(const std::string& made) {
  Result<mesh::TriangleMesh> mesh = mesh::made::make_shape(made);
  EXPECT_TRUE(mesh.ok()) << mesh.error().message();
  auto built = query::Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(mesh).value()));
  EXPECT_TRUE(built.ok());
  return std::move(built).value();
}

const std::shared_ptr<const query::Shape>& cube() {  // 0.1 m, 1 kg at 1000 kg/m3
  static const auto made = shape("made:box:x=0.1,y=0.1,z=0.1");
  return made;
}
const std::shared_ptr<const query::Shape>& floor_plate() {  // top at z = 0.05
  static const auto made = shape("made:box:x=2,y=2,z=0.1,cells=8");
  return made;
}

WorldOptions repeatable_options() {
  WorldOptions options;
  options.query.budget = query::Budget::work(100000);
  return options;
}

World make(const WorldOptions& options) {
  Result<World> world = World::make(options);
  EXPECT_TRUE(world.ok());
  return std::move(world).value();
}

math::Pose at(double x, double y, double z) { return {Mat3::Identity(), Vec3(x, y, z)}; }

Coupling pull(const math::Pose& target, double k, double b, double k_r = 1.0, double b_r = 0.01) {
  Coupling coupling;
  coupling.target = target;
  coupling.stiffness_n_per_m = k;
  coupling.damping_ns_per_m = b;
  coupling.angular_stiffness_nm_per_rad = k_r;
  coupling.angular_damping_nms_per_rad = b_r;
  return coupling;
}

TEST(WorldMass, OfAClosedMeshFollowsFromItsVolume) {
  World world = make(repeatable_options());
  const auto id = world.add_dynamic(cube(), at(0, 0, 0), {.mass_kg = 0.0, .density_kg_per_m3 = 1000.0}, "cube");
  ASSERT_TRUE(id.ok()) << id.error().message();
  const MassProperties& mass = world.mass(id.value());
  EXPECT_TRUE(mass.from_closed_mesh);
  EXPECT_NEAR(mass.mass_kg, 1.0, 1e-12);
  EXPECT_LT((mass.inertia_kg_m2 - Mat3::Identity() * (1.0 * 0.01 / 6.0)).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(WorldMass, OfAnOpenMeshNeedsKilogramsAndTakesTheBoundingBox) {
  World world = make(repeatable_options());
  const auto sheet = shape("made:terrain:cells=4,side=1,height=0.1");
  const auto refused = world.add_dynamic(sheet, at(0, 0, 0), {}, "sheet");
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().remedy.find("kilograms"), std::string::npos);
  const auto id = world.add_dynamic(sheet, at(0, 0, 0), {.mass_kg = 0.5}, "sheet");
  ASSERT_TRUE(id.ok());
  EXPECT_FALSE(world.mass(id.value()).from_closed_mesh);
}

TEST(WorldMass, CentreAwayFromTheOriginDoesNotMoveTheMesh) {
  World world = make(repeatable_options());
  const auto peg = shape("made:peg");  // its centre of mass lies far from its tip
  const math::Pose pose = math::Pose::from_quaternion(Vec3(1, 2, 3), Quat(0.5, 0.5, -0.5, 0.5));
  const auto id = world.add_dynamic(peg, pose, {.mass_kg = 0.1}, "peg");
  ASSERT_TRUE(id.ok());
  EXPECT_GT(world.mass(id.value()).center_m.z(), 0.02);
  EXPECT_LT((world.state(id.value()).pose.translation - pose.translation).norm(), 1e-14);
  EXPECT_LT((world.state(id.value()).pose.rotation - pose.rotation).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(World, AStepInPartsNeedsAFrameAndAFewParts) {
  for (const std::uint32_t parts : {0U, 65U, 2U}) {
    WorldOptions options = repeatable_options();
    options.frame_work_units = parts == 2 ? std::numeric_limits<std::uint64_t>::max() : 1000;
    options.parts = parts;
    EXPECT_FALSE(World::make(options).ok()) << parts;
  }
}

TEST(WorldCoupling, HoldsAWeightByItsStiffness) {
  WorldOptions options = repeatable_options();
  options.gravity_m_per_s2 = Vec3(0, 0, -9.81);
  World world = make(options);
  const BodyId body = world.add_dynamic(cube(), at(0, 0, 0), {.mass_kg = 0.2}, "cube").value();
  world.add_coupling(body);
  ASSERT_FALSE(world.prepare().has_value());
  for (int i = 0; i < 5000; ++i) {
    world.set_coupling(body, pull(at(0, 0, 0), 500, 10));
    world.step();
  }
  EXPECT_NEAR(world.state(body).pose.translation.z(), -0.2 * 9.81 / 500, 1e-9);
  EXPECT_LT((world.coupling_wrench(body).force_n - Vec3(0, 0, 0.2 * 9.81)).norm(), 1e-6);
}

TEST(WorldCoupling, TurnsABodyToItsTarget) {
  World world = make(repeatable_options());
  const BodyId body = world.add_dynamic(cube(), at(0, 0, 0), {.mass_kg = 0.2}, "cube").value();
  world.add_coupling(body);
  ASSERT_FALSE(world.prepare().has_value());
  const Quat target(Eigen::AngleAxisd(2.0, Vec3(1, 2, -1).normalized()));
  for (int i = 0; i < 5000; ++i) {
    world.set_coupling(body, pull(math::Pose::from_quaternion(Vec3(0.1, 0, 0), target), 500, 10, 1.0, 0.05));
    world.step();
  }
  EXPECT_LT(Quat(world.state(body).pose.rotation).angularDistance(target), 1e-6);
  EXPECT_LT((world.state(body).pose.translation - Vec3(0.1, 0, 0)).norm(), 1e-6);
}

RC_GTEST_PROP(WorldCoupling, NeverGainsEnergyWhateverItsParameters, ()) {
  const double k = std::pow(10.0, *rc::gen::inRange(0, 7));
  const double b = std::pow(10.0, *rc::gen::inRange(-3, 4));
  const double mass = std::pow(10.0, *rc::gen::inRange(-4, 3));
  World world = make(repeatable_options());
  const BodyId body = world.add_dynamic(cube(), at(0.02, -0.01, 0.005), {.mass_kg = mass}, "cube").value();
  world.add_coupling(body);
  RC_ASSERT(!world.prepare().has_value());
  const auto energy = [&] {
    const BodyState state = world.state(body);
    return 0.5 * mass * state.velocity_m_per_s.squaredNorm() + 0.5 * k * state.pose.translation.squaredNorm();
  };
  double last = energy();
  for (int i = 0; i < 300; ++i) {
    world.set_coupling(body, pull(at(0, 0, 0), k, b));
    world.step();
    const double now = energy();
    RC_ASSERT(now <= last * (1 + 1e-9) + 1e-15);
    last = now;
  }
}

TEST(WorldContact, ABoxRestsOnAPlateAsDeepAsTheStiffnessSays) {
  WorldOptions options = repeatable_options();
  options.gravity_m_per_s2 = Vec3(0, 0, -9.81);
  options.contact.stiffness_n_per_m = 5000;
  options.contact.damping_ns_per_m = 50;
  options.contact.friction = 0.5;
  World world = make(options);
  ASSERT_TRUE(world.add_fixed(floor_plate(), at(0, 0, 0), "floor").ok());
  const BodyId body = world.add_dynamic(cube(), at(0, 0, 0.1005), {.mass_kg = 0.5}, "cube").value();
  ASSERT_FALSE(world.prepare().has_value());
  StepSummary last;
  for (int i = 0; i < 3000; ++i) last = world.step();
  EXPECT_EQ(last.queries, 1U);
  EXPECT_EQ(last.verdict, query::Verdict::hit);
  EXPECT_GE(last.contacts, 1U);
  EXPECT_NEAR(world.state(body).pose.translation.z(), 0.1 - 0.5 * 9.81 / 5000, 3e-4);
  EXPECT_LT(world.state(body).velocity_m_per_s.norm(), 5e-3);
  EXPECT_LT(world.state(body).pose.translation.head<2>().norm(), 5e-3);
}

// Whoever puts contacts in the place of others (deep_contact) goes by it.
TEST(WorldContact, AMeetingTellsHowStiffThePairIsByItsLaw) {
  struct Heard {
    double stiffness_n_per_m = 0.0;
    double of_points_n_per_m = 0.0;
    double damping_ns_per_m = 0.0;
  };
  for (const ContactLaw law : {ContactLaw::compliant, ContactLaw::penalty, ContactLaw::constraint}) {
    WorldOptions options = repeatable_options();
    options.contact.law = law;
    options.contact.stiffness_n_per_m = 5000;
    World world = make(options);
    ASSERT_TRUE(world.add_fixed(floor_plate(), at(0, 0, 0), "floor").ok());
    ASSERT_TRUE(world.add_dynamic(cube(), at(0, 0, 0.0999), {.mass_kg = 0.5}, "cube").ok());
    ASSERT_FALSE(world.prepare().has_value());
    Heard heard;
    world.set_meeting_hook({[](void* self, Meeting& meeting) noexcept {
                              auto& to = *static_cast<Heard*>(self);
                              to.stiffness_n_per_m = meeting.stiffness_n_per_m;
                              to.damping_ns_per_m = meeting.damping_ns_per_m;
                              for (const ContactPoint& point : meeting.contacts)
                                to.of_points_n_per_m += point.surface.stiffness_n_per_m;
                            },
                            &heard});
    ASSERT_GT(world.step().contacts, 0U);
    EXPECT_NEAR(heard.of_points_n_per_m, heard.stiffness_n_per_m, 1e-9 * heard.stiffness_n_per_m);
    if (law != ContactLaw::constraint) {
      EXPECT_EQ(heard.stiffness_n_per_m, 5000);
      continue;
    }
    const double weight = 1e-3 * heard.stiffness_n_per_m + heard.damping_ns_per_m;
    EXPECT_NEAR(weight, 1e6 * 0.5 / 1e-3, 1.0) << "yields by a millionth";
    EXPECT_NEAR(1e-3 * heard.stiffness_n_per_m / weight, 0.2, 1e-12) << "takes a fifth away";
  }
}

// Its row tells the spring as a speed: a bounce of that would push by a multiple of the spring.
TEST(WorldContact, APenaltyThatPushesDoesNotBounce) {
  std::array<double, 2> fastest = {};
  for (const bool bounces : {false, true}) {
    WorldOptions options = repeatable_options();
    options.contact.law = ContactLaw::penalty;
    options.contact.stiffness_n_per_m = 5000;
    World world = make(options);
    ASSERT_TRUE(world.add_fixed(floor_plate(), at(0, 0, 0), "floor").ok());
    const BodyId body = world.add_dynamic(cube(), at(0, 0, 0.0999), {.mass_kg = 0.5}, "cube").value();
    ASSERT_FALSE(world.prepare().has_value());
    if (bounces) {
      world.set_meeting_hook({[](void*, Meeting& meeting) noexcept {
                                for (ContactPoint& point : meeting.contacts) point.surface.restitution = 1.0;
                              },
                              nullptr});
    }
    for (int i = 0; i < 100; ++i) {
      world.step();
      fastest[bounces ? 1 : 0] = std::max(fastest[bounces ? 1 : 0], world.state(body).velocity_m_per_s.norm());
    }
  }
  EXPECT_GT(fastest[0], 1e-4);
  EXPECT_EQ(fastest[1], fastest[0]);
}

TEST(WorldContact, TheImpulseOfContactsCarriesTheWeightWhereItIsAskedFor) {
  for (const bool asked : {true, false}) {
    WorldOptions options = repeatable_options();
    options.gravity_m_per_s2 = Vec3(0, 0, -9.81);
    options.contact.damping_ns_per_m = 200;
    options.contact_work = asked;
    World world = make(options);
    ASSERT_TRUE(world.add_fixed(floor_plate(), at(0, 0, 0), "floor").ok());
    const BodyId body = world.add_dynamic(cube(), at(0, 0, 0.0998), {.mass_kg = 0.5}, "cube").value();
    ASSERT_FALSE(world.prepare().has_value());
    for (int i = 0; i < 500; ++i) world.step();
    const Vec3 before = world.contact_impulse(body);
    for (int i = 0; i < 1000; ++i) world.step();
    const Vec3 force = world.contact_impulse(body) - before;  // over a second
    if (asked) {
      EXPECT_NEAR(force.z(), 0.5 * 9.81, 0.01);
    } else {
      EXPECT_EQ(force.norm(), 0.0);
    }
    EXPECT_LT(force.head<2>().norm(), 0.01);
  }
}

TEST(WorldFrame, WorkIsBoundedCountedAndShared) {
  const auto run = [](std::uint64_t units, std::uint64_t& left_out, std::uint64_t& most_work) {
    WorldOptions options = repeatable_options();
    options.gravity_m_per_s2 = Vec3(0, 0, -9.81);
    options.solver = Solver::iterative;
    options.max_contacts_per_step = 256;
    options.frame_work_units = units;
    World world = make(options);
    EXPECT_TRUE(world.add_fixed(floor_plate(), at(0, 0, 0), "floor").ok());
    std::vector<BodyId> bodies;
    for (int i = 0; i < 16; ++i) {
      const double x = 0.2 * (i % 4) - 0.3;
      const double y = 0.2 * (i / 4) - 0.3;
      bodies.push_back(world.add_dynamic(cube(), at(x, y, 0.105), {.mass_kg = 0.2}, "cube").value());
    }
    EXPECT_FALSE(world.prepare().has_value());
    left_out = 0;
    most_work = 0;
    double lowest_m = 1.0;
    for (int i = 0; i < 400; ++i) {
      const StepSummary step = world.step();
      left_out += step.pairs_left_out;
      most_work = std::max(most_work, step.node_pairs + step.triangle_pairs);
    }
    for (const BodyId body : bodies) lowest_m = std::min(lowest_m, world.state(body).pose.translation.z());
    return lowest_m;
  };
  std::uint64_t left_out = 0;
  std::uint64_t most_work = 0;
  EXPECT_GT(run(std::numeric_limits<std::uint64_t>::max(), left_out, most_work), 0.098);
  EXPECT_EQ(left_out, 0U);
  const std::uint64_t all = most_work;
  ASSERT_GT(all, 100U);
  EXPECT_GT(run(all / 4, left_out, most_work), 0.09);  // nobody falls through
  EXPECT_LE(most_work, all / 4 + 200);                 // no more than the last query's own step
}

TEST(WorldFrame, RefusesWhatIsNoBudget) {
  WorldOptions options = repeatable_options();
  options.frame_us = 0.0;
  EXPECT_FALSE(World::make(options).ok());
  options.frame_us = 100.0;
  options.frame_work_units = 0;
  EXPECT_FALSE(World::make(options).ok());
}

double slid(double mu) {
  WorldOptions options = repeatable_options();
  options.gravity_m_per_s2 = Vec3(3.0, 0, -9.81);  // a slope of tan 0.306
  options.contact.friction = mu;
  World world = make(options);
  EXPECT_TRUE(world.add_fixed(floor_plate(), at(0, 0, 0), "floor").ok());
  const BodyId body = world.add_dynamic(cube(), at(0, 0, 0.0998), {.mass_kg = 0.5}, "cube").value();
  EXPECT_FALSE(world.prepare().has_value());
  for (int i = 0; i < 500; ++i) world.step();
  return world.state(body).pose.translation.x();
}

TEST(WorldContact, FrictionHoldsOnASlopeThatIsFlatterThanItsAngle) {
  EXPECT_LT(slid(0.6), 0.01);
  EXPECT_NEAR(slid(0.0), 0.5 * 3.0 * 0.25, 0.02);
  const double braked = slid(0.15);  // a = 3.0 - 0.15 * 9.81
  EXPECT_NEAR(braked, 0.5 * (3.0 - 0.15 * 9.81) * 0.25, 0.03);
}

TEST(WorldContact, SwitchedOffNothingIsCollided) {
  WorldOptions options = repeatable_options();
  options.contact.enabled = false;
  options.gravity_m_per_s2 = Vec3(0, 0, -9.81);
  World world = make(options);
  ASSERT_TRUE(world.add_fixed(floor_plate(), at(0, 0, 0), "floor").ok());
  const BodyId body = world.add_dynamic(cube(), at(0, 0, 0.1), {.mass_kg = 0.5}, "cube").value();
  ASSERT_FALSE(world.prepare().has_value());
  std::uint32_t queries = 0;
  for (int i = 0; i < 100; ++i) queries += world.step().queries;
  EXPECT_EQ(queries, 0U);
  EXPECT_LT(world.state(body).pose.translation.z(), 0.06);
}

TEST(WorldContact, ATwoWayPressBalancesAndStaysBounded) {
  WorldOptions options = repeatable_options();
  World world = make(options);
  ASSERT_TRUE(world.add_fixed(floor_plate(), at(0, 0, 0), "floor").ok());
  const BodyId body = world.add_dynamic(cube(), at(0, 0, 0.11), {.mass_kg = 0.1}, "cube").value();
  world.add_coupling(body);
  ASSERT_FALSE(world.prepare().has_value());
  double fastest = 0.0;
  for (int i = 0; i < 3000; ++i) {
    world.set_coupling(body, pull(at(0, 0, 0.09), 500, 3));  // asks for 10 mm inside
    world.step();
    fastest = std::max(fastest, world.state(body).velocity_m_per_s.norm());
  }
  // Two springs in series: 500 N/m and the contact's 20000 N/m over 10 mm.
  const double expected = 0.01 * 500.0 * 20000.0 / 20500.0;
  EXPECT_NEAR(-world.coupling_wrench(body).force_n.z(), expected, 0.1 * expected);
  EXPECT_LT(fastest, 1.0);
}

TEST(WorldContact, AToolThatBeginsInsideLeavesWithoutAnExplosion) {
  World world = make(repeatable_options());
  ASSERT_TRUE(world.add_fixed(floor_plate(), at(0, 0, 0), "floor").ok());
  const BodyId body = world.add_dynamic(cube(), at(0.013, 0.007, 0.03), {.mass_kg = 0.01}, "cube").value();
  world.add_coupling(body);
  ASSERT_FALSE(world.prepare().has_value());
  for (int i = 0; i < 2000; ++i) {
    world.set_coupling(body, pull(at(0.013, 0.007, 0.03), 1000, 3));
    const StepSummary step = world.step();
    const BodyState state = world.state(body);
    ASSERT_TRUE(state.pose.translation.allFinite());
    ASSERT_LE(state.velocity_m_per_s.norm(), world.options().max_speed_m_per_s * (1 + 1e-12));
    ASSERT_LT(state.pose.translation.norm(), 1.0);
    ASSERT_LT(world.coupling_wrench(body).force_n.norm(), 500.0);
    ASSERT_EQ(step.bodies_recovered, 0U);
  }
}

TEST(World, KnowsAfterALookHowDeepABodyBegins) {
  // With twenty pairs of nodes a step can at best tell that they touch.
  WorldOptions options = repeatable_options();
  options.query.budget = query::Budget::work(20);
  World world = make(options);
  ASSERT_TRUE(world.add_fixed(floor_plate(), {}, "plate").ok());
  ASSERT_TRUE(world.add_dynamic(cube(), at(0.0, 0.0, 0.098), {}, "cube").ok());  // 2 mm deep
  ASSERT_FALSE(world.prepare());
  world.look();
  const StepSummary first = world.step();
  EXPECT_GE(first.contacts, 4U);
  EXPECT_NEAR(first.max_depth_m, 0.002, 1e-4);
  EXPECT_LE(first.node_pairs + first.triangle_pairs, 20U) << "the budget is the scene's own again";
}

TEST(World, TakesNoMemoryInAStepAfterPrepare) {
  if (!support::counts_allocations) GTEST_SKIP() << "a sanitizer owns the allocator";
  for (const Solver solver : {Solver::exact, Solver::iterative}) {
    WorldOptions options = repeatable_options();
    options.solver = solver;
    options.frame_us = solver == Solver::exact ? 500.0 : std::numeric_limits<double>::infinity();
    options.contact_work = true;
    options.contact.friction = 0.3;
    options.gravity_m_per_s2 = Vec3(0, 0, -9.81);
    World world = make(options);
    ASSERT_TRUE(world.add_fixed(floor_plate(), at(0, 0, 0), "floor").ok());
    std::vector<BodyId> bodies;
    for (int i = 0; i < 3; ++i) {
      bodies.push_back(world.add_dynamic(cube(), at(0.02 * i, 0, 0.12 + 0.11 * i), {.mass_kg = 0.2}, "cube").value());
    }
    world.add_coupling(bodies[0]);
    ASSERT_FALSE(world.prepare().has_value());
    const support::AllocationCounter counter;
    std::uint32_t most = 0;
    for (int i = 0; i < 1000; ++i) {
      world.set_coupling(bodies[0], pull(at(0, 0, 0.095), 500, 3));
      most = std::max(most, world.step().contacts);
    }
    EXPECT_EQ(counter.allocations(), 0U) << (solver == Solver::exact ? "exact" : "iterative");
    EXPECT_GE(most, 8U);
  }
}

TEST(World, IgnoresWrenchesAndCouplingsThatAreNotFinite) {
  World world = make(repeatable_options());
  const BodyId body = world.add_dynamic(cube(), at(0, 0, 0), {.mass_kg = 0.2}, "cube").value();
  world.add_coupling(body);
  ASSERT_FALSE(world.prepare().has_value());
  const double nan = std::nan("");
  world.apply(body, {Vec3(nan, 0, 0), Vec3::Zero()});
  world.set_coupling(body, pull(at(nan, 0, 0), 500, 3));
  world.set_state(body, {at(nan, 0, 0), Vec3::Zero(), Vec3::Zero()});
  world.step();
  EXPECT_EQ(world.state(body).pose.translation, Vec3::Zero());
}

// It was the force of the moment, and held no weight.
TEST(WorldCoupling, ThatIsSetOnceIsASpringFromThenOn) {
  World world = make(repeatable_options());
  world.set_gravity(Vec3(0, 0, -10));
  const BodyId body = world.add_dynamic(cube(), at(0.01, 0, 0), {.mass_kg = 0.2}, "cube").value();
  world.add_coupling(body);
  ASSERT_FALSE(world.prepare().has_value());
  world.set_coupling(body, pull(at(0, 0, 0), 500, 10));
  for (int i = 0; i < 2000; ++i) world.step();
  EXPECT_NEAR(world.state(body).pose.translation.x(), 0.0, 1e-6);
  EXPECT_NEAR(world.state(body).pose.translation.z(), -0.2 * 10 / 500, 1e-6);
  EXPECT_NEAR(world.coupling_wrench(body).force_n.z(), 2.0, 1e-4);
}

// It said what it had exerted last, for as long as it was off.
TEST(WorldCoupling, ThatIsOffExertsNothing) {
  World world = make(repeatable_options());
  world.set_gravity(Vec3(0, 0, -9.81));
  const BodyId body = world.add_dynamic(cube(), at(0, 0, 0), {.mass_kg = 0.2}, "cube").value();
  world.add_coupling(body);
  world.set_coupling(body, pull(at(0, 0, 0.1), 500, 3));
  ASSERT_FALSE(world.prepare().has_value());
  EXPECT_EQ(world.coupling_wrench(body).force_n, Vec3::Zero()) << "before the first step";
  for (const Coupling& off : {pull(at(0, 0, 0), 0, 0, 0, 0), pull(at(std::nan(""), 0, 0), 500, 3, 0, 0)}) {
    world.set_coupling(body, pull(at(0, 0, 0.1), 500, 3));
    world.step();
    EXPECT_GT(world.coupling_wrench(body).force_n.z(), 1.0);
    world.set_coupling(body, off);
    world.step();
    EXPECT_EQ(world.coupling_wrench(body).force_n, Vec3::Zero());
    EXPECT_EQ(world.coupling_wrench(body).torque_nm, Vec3::Zero());
  }
}

TEST(World, HoldsBodiesToTheGreatestSpeed) {
  WorldOptions options = repeatable_options();
  options.max_speed_m_per_s = 3.0;
  World world = make(options);
  const BodyId body = world.add_dynamic(cube(), at(0, 0, 0), {.mass_kg = 0.001}, "cube").value();
  ASSERT_FALSE(world.prepare().has_value());
  world.apply(body, {Vec3(1e6, 0, 0), Vec3::Zero()});
  EXPECT_EQ(world.step().bodies_slowed, 1U);
  EXPECT_NEAR(world.state(body).velocity_m_per_s.norm(), 3.0, 1e-12);
  EXPECT_NEAR(world.state(body).pose.translation.norm(), 3.0 * options.step_s, 1e-12);
}

TEST(World, RefusesUnlikeBoundingVolumesWithTheirNames) {
  World world = make(repeatable_options());
  query::ShapeOptions options;
  options.volume = volume::Kind::sphere;
  auto mesh = std::make_shared<const mesh::TriangleMesh>(std::move(mesh::made::make_shape("made:box")).value());
  const auto spheres = query::Shape::build(mesh, options).value();
  ASSERT_TRUE(world.add_fixed(floor_plate(), at(0, 0, 0), "floor").ok());
  ASSERT_TRUE(world.add_dynamic(spheres, at(0, 0, 1), {.mass_kg = 1.0}, "ball").ok());
  const auto error = world.prepare();
  ASSERT_TRUE(error.has_value());
  EXPECT_NE(error->what.find("'floor' and 'ball'"), std::string::npos) << error->what;
}

}  // namespace
}  // namespace odds::ode
