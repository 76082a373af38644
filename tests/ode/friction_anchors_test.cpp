// Friction that holds places: what rests stays, and what slides, rolls or is carried does so as without.
#include "odds/ode/odds_friction.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "ode/ode_fixture.hpp"
#include "support/allocation_counter.hpp"

namespace odds {
namespace {

constexpr double step_s = 0.001;
constexpr double slip_m = 1e-5;

using Anchors = std::unique_ptr<oddsFrictionAnchors, decltype(&oddsFrictionAnchorsDestroy)>;
Anchors make_anchors(int pairs = 64, double slip = slip_m) {
  return {oddsFrictionAnchorsCreate(pairs, slip), &oddsFrictionAnchorsDestroy};
}

struct Surface {
  double mu = 0.5;
  double turntable_rad_per_s = 0.0;  ///< about z, of b1 against b2; 0: none
  double slip1 = 0.0;                ///< dContactSlip1 and 2; 0: none
  double conveyor_m_per_s = 0.0;     ///< along x, of b1 against b2 as ODE has it; 0: none
  bool bodies_swapped = false;       ///< geoms, and bodies, in the other order
};

struct Destroy {
  void operator()(dxWorld* world) const { dWorldDestroy(world); }
  void operator()(dxSpace* space) const { dSpaceDestroy(space); }
  void operator()(dxJointGroup* joints) const { dJointGroupDestroy(joints); }
  void operator()(dxGeom* geom) const { dGeomDestroy(geom); }
};
template <class What>
using Owned = std::unique_ptr<What, Destroy>;

/// A world of ODE's own geoms, with or without anchors.
class World {
 public:
  World(const Surface& surface, bool anchored, const Vec3& gravity, int iterations = 20) : surface_(surface) {
    if (anchored) anchors_ = make_anchors();
    dWorldSetGravity(world_.get(), gravity.x(), gravity.y(), gravity.z());
    dWorldSetQuickStepNumIterations(world_.get(), iterations);
    dCreatePlane(space_.get(), 0, 0, 1, 0);
  }

  dBodyID add_box(const Vec3& sides, const Vec3& place) {
    dMass mass;
    dMassSetBox(&mass, 1000.0, sides.x(), sides.y(), sides.z());
    return add(dCreateBox(space_.get(), sides.x(), sides.y(), sides.z()), mass, place);
  }
  dBodyID add_ball(double radius, const Vec3& place) {
    dMass mass;
    dMassSetSphere(&mass, 1000.0, radius);
    return add(dCreateSphere(space_.get(), radius), mass, place);
  }
  void run(double seconds) {
    for (int i = 0; i < static_cast<int>(seconds / step_s); ++i) {
      oddsFrictionAnchorsNextStep(anchors_.get());
      dSpaceCollide(space_.get(), this, &World::near);
      dWorldQuickStep(world_.get(), step_s);
      dJointGroupEmpty(joints_.get());
    }
  }

 private:
  dBodyID add(dGeomID geom, const dMass& mass, const Vec3& place) {
    const dBodyID body = dBodyCreate(world_.get());
    dBodySetMass(body, &mass);
    dGeomSetBody(geom, body);
    dBodySetPosition(body, place.x(), place.y(), place.z());
    return body;
  }
  static void near(void* self, dGeomID a, dGeomID b) {
    auto& world = *static_cast<World*>(self);
    if (world.surface_.bodies_swapped) std::swap(a, b);
    const dBodyID body_a = dGeomGetBody(a);
    const dBodyID body_b = dGeomGetBody(b);
    dContact contacts[8];
    const int count = dCollide(a, b, 8, &contacts[0].geom, sizeof(dContact));
    for (int i = 0; i < count; ++i) {
      contacts[i].surface = {};
      contacts[i].surface.mode = dContactApprox1;
      contacts[i].surface.mu = world.surface_.mu;
      if (world.surface_.slip1 > 0.0) {
        contacts[i].surface.mode |= dContactSlip1 | dContactSlip2;
        contacts[i].surface.slip1 = contacts[i].surface.slip2 = world.surface_.slip1;
      }
      if (world.surface_.turntable_rad_per_s != 0.0) {
        const double x = contacts[i].geom.pos[0];
        const double y = contacts[i].geom.pos[1];
        const double radius = std::hypot(x, y);
        contacts[i].surface.mode |= dContactFDir1 | dContactMotion1;
        contacts[i].surface.motion1 = world.surface_.turntable_rad_per_s * radius;
        contacts[i].fdir1[0] = -y / radius;
        contacts[i].fdir1[1] = x / radius;
        contacts[i].fdir1[2] = 0.0;
      }
      if (world.surface_.conveyor_m_per_s == 0.0) continue;
      contacts[i].surface.mode |= dContactFDir1 | dContactMotion1;
      contacts[i].surface.motion1 = world.surface_.conveyor_m_per_s;
      contacts[i].fdir1[0] = 1.0;
      contacts[i].fdir1[1] = contacts[i].fdir1[2] = 0.0;
    }
    if (count > 0 && world.anchors_) {
      EXPECT_EQ(oddsFrictionAnchorsHold(world.anchors_.get(), body_a, body_b, contacts, count, step_s), 1);
    }
    for (int i = 0; i < count; ++i) {
      dJointAttach(dJointCreateContact(world.world_.get(), world.joints_.get(), &contacts[i]), body_a, body_b);
    }
  }

  Surface surface_;
  Anchors anchors_{nullptr, &oddsFrictionAnchorsDestroy};
  Owned<dxWorld> world_{dWorldCreate()};
  Owned<dxSpace> space_{dHashSpaceCreate(nullptr)};
  Owned<dxJointGroup> joints_{dJointGroupCreate(0)};
};

Vec3 place_of(dBodyID body) { return Eigen::Map<const Vec3>(dBodyGetPosition(body)); }
Vec3 speed_of(dBodyID body) { return Eigen::Map<const Vec3>(dBodyGetLinearVel(body)); }
Vec3 spin_of(dBodyID body) { return Eigen::Map<const Vec3>(dBodyGetAngularVel(body)); }

class FrictionAnchors : public test::OdeTest {};

const Vec3 down(0.0, 0.0, -9.81);

/// Gravity leans by less than what friction bears. Few iterations leave a speed at the contacts in every step, and the
/// box rocks on them.
TEST_F(FrictionAnchors, HoldABoxOnASlopeInItsPlace) {
  for (const auto& [iterations, swapped] : {std::pair(5, false), std::pair(20, false), std::pair(20, true)}) {
    const auto crept = [iterations = iterations, swapped = swapped](bool anchored) {
      World world({.mu = 0.5, .bodies_swapped = swapped}, anchored, Vec3(3.0, 1.0, -9.0), iterations);
      const dBodyID box = world.add_box({0.2, 0.1, 0.1}, {0.0, 0.0, 0.05});
      world.run(1.0);
      const Vec3 begun = place_of(box);
      world.run(30.0);
      return (place_of(box) - begun).norm();
    };
    const double without = crept(false);
    const double with = crept(true);
    EXPECT_GT(without, 1e-3) << "there is something to hold";
    EXPECT_LT(with, 0.05 * without) << iterations << " " << swapped;
  }
}

TEST_F(FrictionAnchors, HoldAStackInItsPlace) {
  const auto crept = [&](bool anchored) {
    World world({.mu = 1.0}, anchored, down, 20);
    std::vector<dBodyID> boxes;
    for (int i = 0; i < 5; ++i) boxes.push_back(world.add_box({0.2, 0.5, 0.25}, {0.0, 0.0, 0.125 + 0.2501 * i}));
    world.run(2.0);
    std::vector<Vec3> begun;
    for (const dBodyID box : boxes) begun.push_back(place_of(box));
    world.run(30.0);
    double most = 0.0;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      most = std::max(most, (place_of(boxes[i]) - begun[i]).head<2>().norm());
    }
    return most;
  };
  const double without = crept(false);
  EXPECT_GT(without, 5e-5) << "there is something to hold";
  EXPECT_LT(crept(true), 0.1 * without);
}

TEST_F(FrictionAnchors, LetABoxSlideAsWithout) {
  for (const bool swapped : {false, true}) {
    const auto slid = [&](bool anchored) {
      World world({.mu = 0.3, .bodies_swapped = swapped}, anchored, down);
      const dBodyID box = world.add_box({0.2, 0.2, 0.1}, {0.0, 0.0, 0.05});
      dBodySetLinearVel(box, 1.0, 0.4, 0.0);
      world.run(1.0);
      return place_of(box);
    };
    EXPECT_LT((slid(true) - slid(false)).norm(), 2e-3 * slid(false).norm());
  }
}

TEST_F(FrictionAnchors, LetABallRollAsWithout) {
  const auto rolled = [&](bool anchored) {
    World world({.mu = 1.0}, anchored, down);
    const dBodyID ball = world.add_ball(0.05, {0.0, 0.0, 0.05});
    dBodySetLinearVel(ball, 0.5, 0.0, 0.0);
    dBodySetAngularVel(ball, 0.0, 10.0, 0.0);
    world.run(2.0);
    return std::pair(place_of(ball), spin_of(ball));
  };
  const auto [place, spin] = rolled(true);
  EXPECT_NEAR(place.x(), rolled(false).first.x(), 1e-4);
  EXPECT_NEAR(place.x(), 1.0, 0.01);
  EXPECT_NEAR(spin.y(), 10.0, 0.1);
}

TEST_F(FrictionAnchors, LetAConveyorCarryAsWithout) {
  for (const bool swapped : {false, true}) {
    const auto speed = [&](bool anchored) {
      World world({.mu = 1.0, .conveyor_m_per_s = 0.2, .bodies_swapped = swapped}, anchored, down);
      const dBodyID box = world.add_box({0.2, 0.2, 0.1}, {0.0, 0.0, 0.05});
      world.run(1.0);
      return speed_of(box).x();
    };
    EXPECT_NEAR(std::abs(speed(false)), 0.2, 1e-6);
    EXPECT_NEAR(speed(true), speed(false), 1e-6) << swapped;
  }
}

TEST_F(FrictionAnchors, LetATurntableTurnAsWithout) {
  for (const double wanted : {0.01, 0.2, 2.0}) {
    const auto spin = [&](bool anchored) {
      World world({.mu = 1.0, .turntable_rad_per_s = wanted}, anchored, down);
      const dBodyID box = world.add_box({0.2, 0.2, 0.1}, {0.0, 0.0, 0.05});
      world.run(1.0);
      return spin_of(box).z();
    };
    EXPECT_NEAR(std::abs(spin(false)), wanted, 1e-3 * wanted);
    EXPECT_NEAR(spin(true), spin(false), 1e-3 * wanted);
  }
}

/// Force-dependent slip is what the caller asks for.
TEST_F(FrictionAnchors, LeaveAnAxisWithASlipOfItsOwn) {
  const auto slid = [&](bool anchored) {
    World world({.mu = 1.0, .slip1 = 1e-3}, anchored, Vec3(1.0, 0.0, -9.81));
    const dBodyID box = world.add_box({0.2, 0.2, 0.1}, {0.0, 0.0, 0.05});
    world.run(2.0);
    return place_of(box).x();
  };
  EXPECT_GT(slid(false), 1e-3);
  EXPECT_NEAR(slid(true), slid(false), 0.2 * slid(false)) << "the solver is not that exact";
}

/// No contact gets more force than its mu allows, and nobody is pulled back by more than the slip.
TEST_F(FrictionAnchors, PullNothingBackByMoreThanTheSlip) {
  World world({.mu = 0.5}, true, down);
  const dBodyID box = world.add_box({0.2, 0.2, 0.1}, {0.0, 0.0, 0.05});
  world.run(0.5);
  dBodySetLinearVel(box, 0.3, 0.0, 0.0);
  double farthest = 0.0;
  for (int i = 0; i < 500; ++i) {
    world.run(step_s * 1.01);
    farthest = std::max(farthest, place_of(box).x());
  }
  EXPECT_GT(farthest, 0.3 * 0.3 / (2.0 * 0.5 * 9.81) * 0.9);
  EXPECT_GT(place_of(box).x(), farthest - 2.0 * slip_m);
}

/// One pair of bodies, as a near callback has it.
struct Touching {
  Owned<dxWorld> world{dWorldCreate()};
  dBodyID body = dBodyCreate(world.get());
  Owned<dxGeom> geom{dCreateSphere(nullptr, 0.1)};
  Owned<dxGeom> ground{dCreatePlane(nullptr, 0, 0, 1, 0)};
  dContact contact = {};

  Touching() {
    dGeomSetBody(geom.get(), body);
    contact.geom.normal[2] = 1.0;
    contact.geom.g1 = geom.get();
    contact.geom.g2 = ground.get();
    contact.surface.mu = 1.0;
  }
};

TEST_F(FrictionAnchors, BeginAnewAfterSomeStepsApart) {
  Touching touching;
  const Anchors anchors = make_anchors();
  const auto motion = [&] {
    dContact contact = touching.contact;
    EXPECT_EQ(oddsFrictionAnchorsHold(anchors.get(), touching.body, nullptr, &contact, 1, step_s), 1);
    return Vec3(contact.surface.motion1, contact.surface.motion2, 0.0).norm();
  };
  double x = 0.0;
  const auto next_step = [&] {
    dBodySetPosition(touching.body, x += 1e-6, 0.0, 0.0);
    oddsFrictionAnchorsNextStep(anchors.get());
  };
  next_step();
  EXPECT_EQ(motion(), 0.0) << "they have only just met";
  next_step();
  EXPECT_NEAR(motion(), 0.2e-3, 1e-9);
  EXPECT_NEAR(motion(), 0.2e-3, 1e-9) << "asked twice in a step, it is the same";
  next_step();
  EXPECT_NEAR(motion(), 0.4e-3, 1e-9);
  next_step();
  next_step();
  EXPECT_NEAR(motion(), 0.8e-3, 1e-9) << "a step apart is none";
  for (int i = 0; i < 17; ++i) next_step();
  EXPECT_EQ(motion(), 0.0) << "they were apart";
}

TEST_F(FrictionAnchors, HoldNothingWithoutNextStep) {
  Touching touching;
  const Anchors anchors = make_anchors();
  for (int i = 0; i < 5; ++i) {
    dContact contact = touching.contact;
    dBodySetPosition(touching.body, 1e-6 * i, 0.0, 0.0);
    EXPECT_EQ(oddsFrictionAnchorsHold(anchors.get(), touching.body, nullptr, &contact, 1, step_s), 1);
    EXPECT_EQ(std::hypot(contact.surface.motion1, contact.surface.motion2), 0.0) << i;
  }
}

/// A body that spins on one contact holds no turn, nor does what it has turned meanwhile.
TEST_F(FrictionAnchors, PullNoContactBackByMoreThanTheSlip) {
  Touching touching;
  const Anchors anchors = make_anchors();
  for (int i = 0; i < 100; ++i) {
    dMatrix3 turned;
    dRFromAxisAndAngle(turned, 0.0, 0.0, 1.0, 0.01 * i);
    dBodySetRotation(touching.body, turned);
    dBodySetPosition(touching.body, 3e-6 * i, 0.0, 0.0);
    oddsFrictionAnchorsNextStep(anchors.get());
    for (const int count : {1, 4}) {
      dContact contacts[4];
      for (int k = 0; k < count; ++k) {
        contacts[k] = touching.contact;
        contacts[k].geom.pos[0] = 0.1 * (k % 2);
        contacts[k].geom.pos[1] = 0.1 * (k / 2);
      }
      ASSERT_EQ(oddsFrictionAnchorsHold(anchors.get(), touching.body, nullptr, contacts, count, step_s), 1);
      for (int k = 0; k < count; ++k) {
        const double motion = std::hypot(contacts[k].surface.motion1, contacts[k].surface.motion2);
        EXPECT_LE(motion, 0.2 * slip_m / step_s * (1.0 + 1e-9));
      }
    }
  }
}

/// As a sweep-and-prune space gives them, whose order follows the boxes, or any space once a body was moved.
TEST_F(FrictionAnchors, DoNotMindInWhichOrderTheGeomsCome) {
  const Touching touching;
  const Anchors anchors = make_anchors();
  const Anchors others = make_anchors();
  const auto hold = [&](oddsFrictionAnchorsID held, bool swapped) {
    std::array<dContact, 4> contacts;
    for (int k = 0; k < 4; ++k) {
      dContact& contact = contacts[static_cast<std::size_t>(k)] = touching.contact;
      contact.geom.pos[0] = 0.1 * (k % 2) - 0.05;
      contact.geom.pos[1] = 0.1 * (k / 2) - 0.05;
      contact.surface.mode = dContactFDir1;
      contact.fdir1[0] = 1.0;
      if (!swapped) continue;
      std::swap(contact.geom.g1, contact.geom.g2);
      contact.geom.normal[2] = -1.0;
    }
    const dBodyID body = touching.body;
    oddsFrictionAnchorsNextStep(held);
    EXPECT_EQ(
        oddsFrictionAnchorsHold(held, swapped ? nullptr : body, swapped ? body : nullptr, contacts.data(), 4, step_s),
        1);
    return contacts;
  };
  // ODE wants the same of the body's motion whichever comes first, where the other is the world.
  double most = 0.0;
  for (int i = 0; i < 40; ++i) {
    const double angle = 1e-4 * std::min(i, 20);  // turns by more than what its contacts hold, then stands still
    dMatrix3 turned;
    dRFromAxisAndAngle(turned, 0.0, 0.0, 1.0, angle);
    dBodySetRotation(touching.body, turned);
    const auto expected = hold(anchors.get(), false);
    const auto given = hold(others.get(), i % 3 == 0);
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_NEAR(given[k].surface.motion1, expected[k].surface.motion1, 1e-9) << i;
      EXPECT_NEAR(given[k].surface.motion2, expected[k].surface.motion2, 1e-9) << i;
      most = std::max(most, std::abs(double{expected[k].surface.motion1}));
    }
  }
  EXPECT_GT(most, 1e-3);
}

TEST_F(FrictionAnchors, ForgetWhatOverflowed) {
  Touching touching;
  const Anchors anchors = make_anchors();
  const auto motion_at = [&](double x) {
    dContact contact = touching.contact;
    dBodySetPosition(touching.body, x, 0.0, 0.0);
    oddsFrictionAnchorsNextStep(anchors.get());
    EXPECT_EQ(oddsFrictionAnchorsHold(anchors.get(), touching.body, nullptr, &contact, 1, step_s), 1);
    return std::hypot(contact.surface.motion1, contact.surface.motion2);
  };
  EXPECT_EQ(motion_at(-1.7e308), 0.0);
  EXPECT_TRUE(std::isfinite(motion_at(1.7e308)));
  static_cast<void>(motion_at(0.0));
  EXPECT_LT(motion_at(0.0), 0.2 * slip_m / step_s * 1.01);
  EXPECT_TRUE(std::isfinite(motion_at(1e-6)));
}

TEST_F(FrictionAnchors, HaveRoomForAllPairsOfTwoStepsThatShareNone) {
  Touching touching;
  constexpr int most = 1024;
  const Anchors anchors = make_anchors(most);
  std::vector<dGeomID> others;
  for (int i = 0; i < 2 * most; ++i) others.push_back(dCreateSphere(nullptr, 0.1));
  for (int step = 1; step < most; ++step) {  // many, so that it does not depend on where they are in memory
    oddsFrictionAnchorsNextStep(anchors.get());
    for (int i = 0; i < most; ++i) {
      dContact contact = touching.contact;
      contact.geom.g1 = others[static_cast<std::size_t>(i)];
      contact.geom.g2 = others[static_cast<std::size_t>(i + step)];
      ASSERT_EQ(oddsFrictionAnchorsHold(anchors.get(), touching.body, nullptr, &contact, 1, step_s), 1) << i;
    }
  }
  for (const dGeomID other : others) dGeomDestroy(other);
}

TEST_F(FrictionAnchors, SayWhenThereIsNoRoomAndTakeItBack) {
  Touching touching;
  const Anchors anchors = make_anchors(1);
  std::vector<dGeomID> others;
  for (int i = 0; i < 400; ++i) others.push_back(dCreateSphere(nullptr, 0.1));
  const auto held = [&] {
    int count = 0;
    for (const dGeomID other : others) {
      dContact contact = touching.contact;
      contact.geom.g2 = other;
      const int done = oddsFrictionAnchorsHold(anchors.get(), touching.body, nullptr, &contact, 1, step_s);
      count += done;
      if (done == 0) {
        EXPECT_EQ(contact.surface.mode, touching.contact.surface.mode) << "unchanged";
      }
    }
    return count;
  };
  oddsFrictionAnchorsNextStep(anchors.get());
  EXPECT_GE(held(), 1);
  EXPECT_LT(held(), 400);
  oddsFrictionAnchorsNextStep(anchors.get());
  oddsFrictionAnchorsNextStep(anchors.get());
  EXPECT_GE(held(), 1) << "those of old steps make room";
  for (const dGeomID other : others) dGeomDestroy(other);
}

TEST_F(FrictionAnchors, RefuseWhatMakesNoSense) {
  const double nan = std::nan("");
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(oddsFrictionAnchorsCreate(0, slip_m), nullptr);
  EXPECT_EQ(oddsFrictionAnchorsCreate(1048577, slip_m), nullptr);
  for (const double bad : {0.0, -1.0, nan, infinity}) EXPECT_EQ(oddsFrictionAnchorsCreate(8, bad), nullptr) << bad;
  EXPECT_STRNE(oddsGetLastError(), "");
  oddsFrictionAnchorsDestroy(nullptr);
  oddsFrictionAnchorsNextStep(nullptr);
  Touching touching;
  const Anchors anchors = make_anchors();
  const auto hold = [&](dContact contact, dBodyID b1, dBodyID b2, double step) {
    const dContact before = contact;
    const int done = oddsFrictionAnchorsHold(anchors.get(), b1, b2, &contact, 1, step);
    if (done == 0) {
      EXPECT_EQ(contact.surface.mode, before.surface.mode);
    }
    return done;
  };
  EXPECT_EQ(hold(touching.contact, nullptr, nullptr, step_s), 1) << "nothing to hold";
  EXPECT_EQ(hold(touching.contact, touching.body, touching.body, step_s), 0);
  for (const double bad : {0.0, -1.0, nan, infinity, 1e-310})
    EXPECT_EQ(hold(touching.contact, touching.body, nullptr, bad), 0);
  dContact odd = touching.contact;
  odd.geom.pos[1] = nan;
  EXPECT_EQ(hold(odd, touching.body, nullptr, step_s), 0);
  odd = touching.contact;
  odd.geom.normal[2] = 0.0;
  EXPECT_EQ(hold(odd, touching.body, nullptr, step_s), 0) << "no normal: its directions would not be numbers";
  odd = touching.contact;
  odd.surface.mode = dContactMotion1;
  odd.surface.motion1 = infinity;
  EXPECT_EQ(hold(odd, touching.body, nullptr, step_s), 0);
  dContact two[2] = {touching.contact, touching.contact};
  std::swap(two[1].geom.g1, two[1].geom.g2);
  EXPECT_EQ(oddsFrictionAnchorsHold(anchors.get(), touching.body, nullptr, two, 2, step_s), 0);
  EXPECT_EQ(oddsFrictionAnchorsHold(nullptr, touching.body, nullptr, two, 1, step_s), 0);
  EXPECT_EQ(oddsFrictionAnchorsHold(anchors.get(), touching.body, nullptr, nullptr, 1, step_s), 0);
  EXPECT_EQ(oddsFrictionAnchorsHold(anchors.get(), touching.body, nullptr, two, -1, step_s), 0);
  EXPECT_EQ(oddsFrictionAnchorsHold(anchors.get(), touching.body, nullptr, nullptr, 0, step_s), 1) << "nothing to hold";
  dBodySetPosition(touching.body, nan, 0.0, 0.0);
  EXPECT_EQ(hold(touching.contact, touching.body, nullptr, step_s), 0);
  dBodySetPosition(touching.body, 1.0, 0.0, 0.0);
  EXPECT_EQ(hold(touching.contact, touching.body, nullptr, step_s), 1);
}

TEST_F(FrictionAnchors, AllocateNothingInTheLoop) {
  if (!support::counts_allocations) GTEST_SKIP() << "the sanitizer's own malloc is in place";
  Touching touching;
  const Anchors anchors = make_anchors(4);
  const support::AllocationCounter counter;
  for (int i = 0; i < 100; ++i) {
    dContact contact = touching.contact;
    oddsFrictionAnchorsNextStep(anchors.get());
    ASSERT_EQ(oddsFrictionAnchorsHold(anchors.get(), touching.body, nullptr, &contact, 1, step_s), 1);
  }
  EXPECT_EQ(counter.allocations(), 0u);
}

}  // namespace
}  // namespace odds
