// What a world's broad phase says of bodies for which it did not ask.
#include "ode/geom/broad_phase.hpp"

#include <limits>

#include "odds/ode/world.hpp"
#include "ode/geom/pair_table.hpp"
#include "ode/ode_fixture.hpp"

namespace odds::test {
namespace {

class BroadPhase : public OdeTest {
 protected:
  void SetUp() override {
    OdeTest::SetUp();
    a = mesh_geom(sphere_shape(1.0, 12), space);
    b = mesh_geom(sphere_shape(1.0, 12), space);
    place(3.0);
  }
  void place(double x) const { dGeomSetPosition(b, x, 0.5, 0.25); }
  [[nodiscard]] std::optional<math::Pose> before(std::uint64_t number) const {
    const ode::BroadPhaseScope scope(number);
    return ode::before_this_broad_phase(ode::own_data(a), ode::own_data(b));
  }
  dGeomID a = nullptr;
  dGeomID b = nullptr;
};

TEST_F(BroadPhase, TellsWhereBodiesWereInTheOneBefore) {
  dGeomSetPosition(a, 1.0, 0.0, 0.0);
  rotate(a, Vec3::UnitZ(), std::acos(0.0));
  ode::note_places(space, 7);
  place(1.5);
  const auto pose = before(8);
  ASSERT_TRUE(pose);
  EXPECT_NEAR((pose->translation - Vec3(0.5, -2.0, 0.25)).norm(), 0.0, 1e-12) << "as b was, seen from a";
}

TEST_F(BroadPhase, TellsNothingOfWhatItHasNotSeen) {
  EXPECT_FALSE(before(1)) << "the first";
  ode::note_places(space, 3);
  EXPECT_FALSE(before(5)) << "one was left out";
  EXPECT_FALSE(before(0)) << "none is under way";
  const dGeomID added = mesh_geom(sphere_shape(1.0, 12), space);
  {
    const ode::BroadPhaseScope scope(4);
    EXPECT_FALSE(ode::before_this_broad_phase(ode::own_data(a), ode::own_data(added)));
  }
  EXPECT_TRUE(before(4));
  dGeomSetPosition(b, dNaN, 0.0, 0.0);
  ode::note_places(space, 4);
  dGeomSetPosition(b, 3.0, 0.0, 0.0);
  EXPECT_FALSE(before(5)) << "it was nowhere";
}

TEST_F(BroadPhase, OneWithinAnotherLeavesTheOuterOneAsItWas) {
  const ode::BroadPhaseScope outer(2);
  {
    const ode::BroadPhaseScope inner(9);
    EXPECT_EQ(ode::current_broad_phase, 9U);
  }
  EXPECT_EQ(ode::current_broad_phase, 2U);
}

TEST_F(BroadPhase, HasAskedForAPairThatAnotherThreadIsAt) {
  place(1.5);
  ASSERT_EQ(oddsPreparePair(a, b), 1);
  ode::PairEntry* entry = ode::pair_table().find(ode::own_data(a), ode::own_data(b));
  ASSERT_NE(entry, nullptr);
  {
    const ode::BroadPhaseScope scope(5);
    entry->busy = true;
    EXPECT_TRUE(collide(a, b).empty());
    entry->busy = false;
  }
  EXPECT_EQ(entry->asked_in, 5U) << "the next one must not take it for apart";
  EXPECT_FALSE(collide(a, b).empty());
  EXPECT_EQ(entry->asked_in, 5U) << "no broad phase has asked";
}

/// What contacts there were: the deepest one's depth, and their mean normal, into the first body.
struct Seen {
  int contacts = 0;
  double deepest_m = 0.0;
  Vec3 normal = Vec3::Zero();
  static void note(void* self, ode::Meeting& meeting) noexcept {
    auto& seen = *static_cast<Seen*>(self);
    for (const ode::ContactPoint& point : meeting.contacts) {
      ++seen.contacts;
      seen.deepest_m = std::max(seen.deepest_m, point.depth_m);
      seen.normal += (meeting.a.index == 0 ? 1.0 : -1.0) * point.normal;
    }
  }
};

/// A body that a hand puts here and there over another one, by 40 pairs of nodes a step.
class BroadPhaseOfAWorld : public ::testing::Test {
 protected:
  void make(const std::shared_ptr<const query::Shape>& fixed, const std::shared_ptr<const query::Shape>& moved,
            std::uint64_t frame_units = std::numeric_limits<std::uint64_t>::max()) {
    ode::WorldOptions options;
    options.query.budget = query::Budget::work(40);
    options.contact.responds = false;
    options.frame_work_units = frame_units;
    auto made = ode::World::make(options);
    ASSERT_TRUE(made.ok());
    world.emplace(std::move(made).value());
    ASSERT_TRUE(world->add_fixed(fixed, {}, "fixed").ok());
    body = world->add_dynamic(moved, at(1.0), {.mass_kg = 1.0}, "moved").value();
    ASSERT_FALSE(world->prepare().has_value());
    world->set_meeting_hook({&Seen::note, &seen});
  }
  static math::Pose at(double z) { return {Mat3::Identity(), {0.001, 0.002, z}}; }
  /// Of `steps` steps there.
  const Seen& put(double z, int steps = 1) {
    seen = {};
    for (int i = 0; i < steps; ++i) {
      world->set_state(body, {at(z), Vec3::Zero(), Vec3::Zero()});
      world->step();
    }
    return seen;
  }
  std::optional<ode::World> world;
  ode::BodyId body;
  Seen seen;
};

TEST_F(BroadPhaseOfAWorld, WhatIsPutIntoAnotherBodyIsAsDeepAsItHasCome) {
  make(box_shape(0.1, 0.1, 0.1, 6), box_shape(0.1, 0.1, 0.1, 6));
  put(0.103);
  EXPECT_EQ(seen.contacts, 0);
  EXPECT_GT(put(0.095, 30).deepest_m, 0.0045) << "5 mm, and it was apart 8 mm from there";
  EXPECT_LT(seen.deepest_m, 0.0085);
}

/// A ball of 5 mm about a sheet without thickness. Its normal into the sheet is along -z above it.
class BallAboutASheet : public BroadPhaseOfAWorld {
 protected:
  void SetUp() override {
    std::vector<Vec3> corners{{-0.05, -0.05, 0}, {0.05, -0.05, 0}, {0.05, 0.05, 0}, {-0.05, 0.05, 0}};
    std::vector<mesh::Triangle> triangles{{0, 1, 2}, {0, 2, 3}};
    auto sheet = mesh::TriangleMesh::make(std::move(corners), std::move(triangles), "sheet").value();
    make(query::Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(sheet))).value(),
         sphere_shape(0.005));
  }
  void switch_contacts(bool on) {
    ode::ContactModel contact = world->options().contact;
    contact.enabled = on;
    world->set_contact(contact);
  }
};

TEST_F(BallAboutASheet, ThatHasFlownRoundIsPushedBackWhenceItCameNow) {
  for (const double side : {1.0, -1.0, 1.0}) {
    put(side * 0.0055);
    EXPECT_EQ(seen.contacts, 0) << "no box is near, and nobody asks";
    put(side * 0.0045, 4);
    put(-side * 0.001, 4);  // 5 m/s: the centre has passed
    ASSERT_GT(seen.contacts, 0) << side;
    EXPECT_LT(side * seen.normal.z(), 0.0) << side;
    put(0.1, 3);
    EXPECT_EQ(seen.contacts, 0);
  }
}

// A frame leaves pairs out for which it has no time: that nobody asked does not mean that they were apart.
TEST_F(BroadPhaseOfAWorld, WithAFrameClaimsNothing) {
  std::vector<Vec3> corners{{-0.05, -0.05, 0}, {0.05, -0.05, 0}, {0.05, 0.05, 0}, {-0.05, 0.05, 0}};
  std::vector<mesh::Triangle> triangles{{0, 1, 2}, {0, 2, 3}};
  auto sheet = mesh::TriangleMesh::make(std::move(corners), std::move(triangles), "sheet").value();
  auto shape = query::Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(sheet))).value();
  make(shape, sphere_shape(0.005), 100000);
  put(0.0055);
  put(-0.001, 4);
  ASSERT_GT(seen.contacts, 0);
  EXPECT_GT(seen.normal.z(), 0.0) << "towards where its centre is";
}

TEST_F(BallAboutASheet, ThatWasTakenRoundWhileContactsWereOffIsPushedTowardsItsPlace) {
  put(0.0055);
  switch_contacts(false);
  for (const double z : {0.0055, -0.0055}) put(z);
  switch_contacts(true);
  put(-0.0045, 8);
  ASSERT_GT(seen.contacts, 0);
  EXPECT_GT(seen.normal.z(), 0.0);
  EXPECT_LT(seen.deepest_m, 0.001);
}

TEST_F(BallAboutASheet, ThatWasPutElsewhereHasNotComeFromThere) {
  put(0.1);
  put(-0.0045, 8);  // faster than a body may be
  ASSERT_GT(seen.contacts, 0);
  EXPECT_GT(seen.normal.z(), 0.0);
  EXPECT_LT(seen.deepest_m, 0.001);
}

TEST_F(BallAboutASheet, ThatWasLookedAtIsKnownAsItIs) {
  put(0.0055);
  world->set_state(body, {at(-0.0045), Vec3::Zero(), Vec3::Zero()});
  world->look();
  put(-0.00445, 8);
  ASSERT_GT(seen.contacts, 0);
  EXPECT_GT(seen.normal.z(), 0.0);
  EXPECT_LT(seen.deepest_m, 0.001);
}

}  // namespace
}  // namespace odds::test
