// Contacts of flat faces that lie on each other: what two polygons say.
#include "query/flush/flush_contacts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "odds/math/random.hpp"
#include "odds/math/tolerances.hpp"
#include "support/flush_slabs.hpp"

namespace odds::query {
namespace {

using testing::below;
using testing::contacts_of;
using testing::Flush;
using testing::made_mesh;
using testing::slab;
using testing::written;

constexpr double size = testing::flush_size;
const Vec3 under = testing::under_slab;

TEST(FlushContacts, OfASlabOnASlabAreAtItsCorners) {
  auto flush = contacts_of(slab(), slab(5));
  math::Pose pose = below(1e-3);
  pose.translation.x() = 0.5;
  const auto contacts = written(flush, pose, under);
  ASSERT_EQ(contacts.size(), 4U);
  std::set<std::pair<double, double>> corners;
  for (const Contact& contact : contacts) {
    EXPECT_NEAR(contact.depth, 1e-3, 1e-12);
    EXPECT_NEAR(contact.normal.z(), 1.0, 1e-12) << "into A, which is above";
    EXPECT_NEAR(contact.position.z(), -0.1 + 0.5e-3, 1e-12) << "half-way";
    corners.emplace(std::round(1e6 * contact.position.x()), std::round(1e6 * contact.position.y()));
    EXPECT_NE(contact.triangle_a, no_feature);
    EXPECT_NE(contact.triangle_b, no_feature);
  }
  EXPECT_EQ(corners, (std::set<std::pair<double, double>>{{0, -5e5}, {0, 5e5}, {5e5, -5e5}, {5e5, 5e5}}));
}

TEST(FlushContacts, AreTheSameWhicheverBodyIsFirst) {
  for (int i = 0; i < 200; ++i) {
    math::Random random(100 + static_cast<std::uint64_t>(i));
    math::Pose pose = below(5e-4, random.uniform(-3, 3), random.uniform(-5e-4, 5e-4));
    pose.translation.x() += random.uniform(-0.4, 0.4);
    pose.translation.y() += random.uniform(-0.4, 0.4);
    auto one = contacts_of(slab(), slab(5));
    auto other = contacts_of(slab(5), slab());
    const auto a = written(one, pose, Vec3(0.5 * pose.translation.x(), 0.5 * pose.translation.y(), -0.1));
    const math::Pose back = pose.inverse();
    other.move_to(back);
    other.note(other.explains_crossing(back * Vec3(0.5 * pose.translation.x(), 0.5 * pose.translation.y(), -0.1),
                                       Vec3::UnitZ(), back.rotation * -Vec3::UnitZ()),
               false);
    std::vector<Contact> b;
    for (int run = 0; run < 2000; ++run) {
      other.begin();
      other.move_to(back);
      b = other.serves() ? other.contacts() : std::vector<Contact>();
    }
    ASSERT_FALSE(a.empty());
    ASSERT_FALSE(b.empty());
    double deepest[2] = {0.0, 0.0};
    for (const Contact& contact : a) deepest[0] = std::max(deepest[0], contact.depth);
    for (const Contact& contact : b) deepest[1] = std::max(deepest[1], contact.depth);
    EXPECT_NEAR(deepest[0], deepest[1], 1e-12);
    EXPECT_LT((pose.rotation * b[0].normal + a[0].normal).norm(), 1e-12);
  }
}

// Of random rectangles on each other: what is deepest is found, and nothing lies outside either.
TEST(FlushContacts, LieInBothFacesAndReachTheDeepestPoint) {
  for (int i = 0; i < 300; ++i) {
    math::Random random(static_cast<std::uint64_t>(i));
    math::Pose pose = below(random.uniform(0.0, 2e-3), random.uniform(-3, 3), random.uniform(-4e-3, 4e-3));
    pose.translation.x() += random.uniform(-0.6, 0.6);
    pose.translation.y() += random.uniform(-0.6, 0.6);
    const math::Pose back = pose.inverse();
    // B's top over A's bottom, by sampling.
    double deepest = 0.0;
    Vec3 seen = Vec3::Zero();
    for (int k = 0; k < 4000; ++k) {
      const Vec3 on_a(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), -0.1);
      const Vec3 in_b = back * on_a;
      if (in_b.head<2>().cwiseAbs().maxCoeff() > 0.5) continue;
      if (0.1 - in_b.z() > deepest) {
        deepest = 0.1 - in_b.z();
        seen = on_a;
      }
    }
    if (deepest == 0.0) continue;
    auto flush = contacts_of(slab(), slab(2));
    const auto contacts = written(flush, pose, seen);
    ASSERT_FALSE(contacts.empty()) << i;
    double found = 0.0;
    for (const Contact& contact : contacts) {
      found = std::max(found, contact.depth);
      EXPECT_LE((contact.position.head<2>()).cwiseAbs().maxCoeff(), 0.5 + 1e-5);
      EXPECT_LE((back * contact.position).head<2>().cwiseAbs().maxCoeff(), 0.5 + 1e-4);
      EXPECT_GE(contact.depth, 0.0);
    }
    EXPECT_GE(found, deepest * (1.0 - 1e-4)) << i;
    EXPECT_LE(found, deepest + 2e-4) << i;
    EXPECT_GE(contacts.front().depth, 0.97 * found) << "the deepest first, or one as deep that is farther out";
  }
}

TEST(FlushContacts, EndWhereTheFacesTilt) {
  auto flush = contacts_of(slab(), slab());
  const double most = std::acos(tolerances::flush_faces);
  EXPECT_FALSE(written(flush, below(0.0, 0.0, 0.9 * most), Vec3(-0.49, 0, -0.1)).empty());
  flush.begin();
  flush.move_to(below(0.0, 0.0, 1.1 * most));
  EXPECT_FALSE(flush.serves());
}

TEST(FlushContacts, OfFacesOnFarSidesAreNone) {
  // A's left side and B's right side face each other through both bodies.
  auto flush = contacts_of(slab(), slab());
  math::Pose pose = below(0.05);
  flush.move_to(pose);
  EXPECT_FALSE(flush.explains_at(Vec3(-0.5, 0, -0.09))) << "deeper than faces that came to lie on each other";
  flush.move_to(below(1e-3));
  EXPECT_FALSE(flush.explains_at(Vec3(0, 0, 0))) << "in the middle of A";
  EXPECT_FALSE(flush.explains_crossing(under, Vec3::UnitX(), -Vec3::UnitZ())) << "by its normals of another side";
  EXPECT_TRUE(flush.explains_crossing(under, -Vec3::UnitX(), Vec3::UnitZ())) << "a wall of A in B's top";
}

TEST(FlushContacts, AGuessOnFacesHasTheirNormal) {
  auto flush = contacts_of(slab(), slab());
  Contact guess;
  guess.normal = Vec3(0.4, -0.3, 0.87).normalized();
  guess.position = under + Vec3(0, 0, 1e-3);
  flush.straighten(guess);
  EXPECT_LT(guess.normal.z(), 0.9) << "no run has begun that has no time for a patch";
  flush.move_to(below(-1e-4, 0.3));
  flush.straighten(guess);
  EXPECT_GT(guess.normal.z(), 0.999999);
  EXPECT_FALSE(flush.serves()) << "they are near, but apart";
  flush.move_to(below(1e-9));
  EXPECT_TRUE(flush.serves());
  EXPECT_FALSE(flush.is_certain()) << "that may be rounding";
  flush.move_to(below(1e-5));
  EXPECT_TRUE(flush.is_certain());
  Contact elsewhere = guess;
  elsewhere.normal = Vec3::UnitX();
  elsewhere.position = Vec3(0.5, 0, 0.05);
  flush.straighten(elsewhere);
  EXPECT_EQ(elsewhere.normal, Vec3(Vec3::UnitX()));
}

TEST(FlushContacts, OfThinPlatesAreOfTheSidesThatTouch) {
  // Their far sides face each other, too, through both.
  for (const double depth : {-1e-4, 1e-4, 1e-3}) {
    auto flush = contacts_of(made_mesh("made:box:x=1,y=1,z=0.004"), made_mesh("made:box:x=1,y=1,z=0.004,cells=3"));
    math::Pose pose;
    pose.translation.z() = -0.004 + depth;
    flush.move_to(pose);
    ASSERT_TRUE(flush.explains_at(Vec3(0.2, 0.1, -0.002)));
    flush.note(true, false);
    const auto contacts = flush.serves() ? flush.contacts() : std::vector<Contact>();
    EXPECT_EQ(contacts.size(), depth > 0.0 ? 4U : 0U);
    for (const Contact& contact : contacts) EXPECT_GT(contact.normal.z(), 0.999999);
    // A guess that points the other way is left as it is, and what would lie on each other through the plates is not.
    Contact guess;
    guess.position = Vec3(0.2, 0.1, -0.002);
    guess.normal = -Vec3::UnitZ();
    flush.straighten(guess);
    EXPECT_LT(guess.normal.z(), 0.0);
    EXPECT_FALSE(flush.explains_at(Vec3(0.2, 0.1, -0.002), -Vec3::UnitZ()));
  }
}

TEST(FlushContacts, WhatIsDeeperThanWideIsLeftByItsSide) {
  // A slab that has run into a lower one by less than its bottom lies below the other one's top: side against side.
  auto flush = contacts_of(slab(), slab());
  math::Pose pose = below(0.02);
  for (const double over : {0.005, 0.015, 0.025, 0.1}) {
    pose.translation.x() = 1.0 - over;
    flush.forget();
    flush.move_to(pose);
    flush.note(flush.explains_at(Vec3(0.5 - 0.5 * over, 0, -0.1)), true);
    const auto contacts = flush.contacts();
    ASSERT_FALSE(contacts.empty()) << over;
    for (const Contact& contact : contacts) {
      EXPECT_GT(over > 0.02 ? contact.normal.z() : -contact.normal.x(), 0.999) << over;
    }
  }
}

TEST(FlushContacts, OfAProofThatTheBodiesAreApartAreForgotten) {
  auto flush = contacts_of(slab(), slab());
  ASSERT_FALSE(written(flush, below(1e-3), under).empty());
  flush.note_clear();
  flush.begin();
  flush.move_to(below(1e-3));
  EXPECT_FALSE(flush.serves());
}

TEST(FlushContacts, OnePairOfFacesIsKnownOnce) {
  // Long beams across each other: what is seen lies far from where they overlap, but on both faces' sides.
  auto flush = contacts_of(made_mesh("made:box:x=1,y=0.1,z=0.1"), made_mesh("made:box:x=0.1,y=1,z=0.1"));
  math::Pose pose;
  pose.translation.z() = -0.1 + 1e-4;
  flush.move_to(pose);
  for (const double x : {0.0, 0.04, -0.04, 0.3, -0.4, 0.2}) {
    static_cast<void>(flush.explains_at(Vec3(x, 0.02, -0.05)));
  }
  flush.note(true, false);
  EXPECT_EQ(flush.contacts().size(), 4U);
  EXPECT_FALSE(flush.explains_at(Vec3(0.3, 0.0, -0.05))) << "beside B";
}

TEST(FlushContacts, OfUnevenGroundUnderASmallBodyAreNone) {
  // A dip of a few micrometres is flat for a floor of four metres, not for a cube of a centimetre.
  const mesh::TriangleMesh floor = made_mesh("made:box:x=4,y=4,z=0.2,cells=4");
  std::vector<Vec3> vertices(floor.vertices().begin(), floor.vertices().end());
  for (Vec3& v : vertices) {
    if ((v - Vec3(0, 0, 0.1)).norm() < 1e-6) v.z() -= 5e-6;
  }
  const auto dipped =
      std::move(mesh::TriangleMesh::make(
                    std::move(vertices),
                    std::vector<mesh::Triangle>(floor.triangles().begin(), floor.triangles().end()), "dip"))
          .value();
  const mesh::TriangleMesh cube = made_mesh("made:box:x=0.01,y=0.01,z=0.01");
  math::Pose pose;
  pose.translation.z() = -0.105;
  for (const bool dips : {false, true}) {
    auto flush = contacts_of(cube, dips ? dipped : floor);
    flush.move_to(pose, 0.0173);
    EXPECT_NE(flush.explains_at(Vec3(0, 0, -0.005)), dips);
  }
}

// A pin or a step beside a flat face is not the face, however little it stands out.
TEST(FlushContacts, WhatIsDeeperThanTheFacesIsNotExplained) {
  for (const double out : {4e-4, 1.5e-3}) {
    auto flush = contacts_of(
        testing::joined(slab(), made_mesh("made:box:x=0.02,y=0.02,z=0.05"), Vec3(0.2, 0.1, -0.075 - out)), slab());
    const math::Pose pose = below(5e-5);
    flush.move_to(pose);
    EXPECT_TRUE(flush.explains_at(under));
    EXPECT_FALSE(flush.explains_at(Vec3(0.21, 0.1, -0.1 - out))) << "where its rim is";
    Contact contact;
    contact.normal = Vec3::UnitZ();
    contact.position = Vec3(0.2, 0.1, -0.1 - 0.5 * out);
    contact.depth = out + 5e-5;
    EXPECT_FALSE(flush.explains(contact, pose));
    contact.depth = 5e-5;
    contact.position.z() = -0.1 + 2.5e-5;
    EXPECT_TRUE(flush.explains(contact, pose));
  }
}

TEST(FlushContacts, WhatWasMeasuredIsGivenInFull) {
  auto flush = contacts_of(slab(), slab());
  flush.move_to(below(1e-3));
  ASSERT_TRUE(flush.explains_at(under));
  EXPECT_FALSE(flush.gives_all());
  EXPECT_LT(flush.contacts().front().depth, 5e-4) << "what came deep unknown";
  flush.begin();
  flush.move_to(below(1e-3), size, true);
  EXPECT_TRUE(flush.gives_all());
  EXPECT_NEAR(flush.contacts().front().depth, 1e-3, 1e-12);
}

TEST(FlushContacts, AFootInTheAirHoldsNothingBack) {
  auto flush = contacts_of(slab(), testing::joined(made_mesh("made:box:x=0.2,y=1,z=0.2,cells=2"),
                                                   made_mesh("made:box:x=0.2,y=1,z=0.1999,cells=2"), Vec3(0.6, 0, 0)));
  math::Pose pose = below(1e-5);
  pose.translation.x() = -0.3;
  flush.move_to(pose, size, true);
  EXPECT_TRUE(flush.explains_at(Vec3(-0.3, 0, -0.1)));
  static_cast<void>(flush.explains_at(Vec3(0.3, 0, -0.1)));
  EXPECT_TRUE(flush.gives_all());
}

TEST(FlushContacts, AreOfTheCornersOfAllTilesTogether) {
  // A slab on the seams of four tiles: what bears it is as wide as the slab, however few contacts there are.
  const mesh::TriangleMesh row = testing::joined(made_mesh("made:box:x=2,y=2,z=0.2,cells=3"),
                                                 made_mesh("made:box:x=2,y=2,z=0.2,cells=3"), Vec3(2, 0, 0));
  auto flush = contacts_of(slab(), testing::joined(row, row, Vec3(0, 2, 0)));
  math::Pose pose = below(1e-4);
  pose.translation.x() = pose.translation.y() = -0.9;
  flush.move_to(pose, size, true);
  for (const double x : {-0.3, 0.3}) {
    for (const double y : {-0.3, 0.3}) EXPECT_TRUE(flush.explains_at(Vec3(x, y, -0.1)));
  }
  flush.note(true, true);
  for (const std::size_t room : {4U, 6U, 8U}) {
    const auto contacts = flush.contacts(room);
    ASSERT_EQ(contacts.size(), 4U);
    for (const Contact& contact : contacts) EXPECT_NEAR(contact.position.head<2>().cwiseAbs().minCoeff(), 0.5, 1e-9);
  }
}

TEST(FlushContacts, MorePairsThanAreKeptAreLookedForAgain) {
  mesh::TriangleMesh legs = slab();
  for (int leg = 0; leg < 5; ++leg) {
    legs = testing::joined(legs, made_mesh("made:box:x=0.1,y=0.1,z=0.1"), Vec3(-0.4 + 0.2 * leg, 0, -0.14));
  }
  auto flush = contacts_of(legs, made_mesh("made:box:x=4,y=4,z=0.2"));
  math::Pose pose;
  pose.translation.z() = -0.29 + 1e-4;
  flush.move_to(pose);
  for (int leg = 0; leg < 5; ++leg) static_cast<void>(flush.explains_at(Vec3(-0.4 + 0.2 * leg, 0, -0.19)));
  EXPECT_FALSE(flush.may_be());
  for (int run = 0; run < 1000; ++run) flush.begin();
  EXPECT_TRUE(flush.may_be());
}

TEST(FlushContacts, OfRoundFacesThatTiltAreNotAll) {
  // Beyond the polygon that stands for it a can's end is deeper there.
  const char* can = "made:peg:radius=0.3,length=0.4,chamfer=0.01,around=64";
  for (const double tilt : {0.0, 0.02}) {
    auto flush = contacts_of(made_mesh(can), made_mesh(can));
    math::Pose pose;
    pose.rotation = Eigen::AngleAxisd(tilt, Vec3::UnitY()).toRotationMatrix();
    const double low = made_mesh(can).lower().z();
    pose.translation.z() = -0.4 + 1e-4;
    flush.move_to(pose, 0.7);
    EXPECT_TRUE(flush.explains_at(Vec3(0, 0, low)));
    EXPECT_TRUE(flush.overlap()) << "they hold all the same";
    EXPECT_EQ(flush.serves(), tilt == 0.0);
  }
}

TEST(FlushContacts, WithoutTimeForAllDoNotServe) {
  // On two feet.
  auto flush = contacts_of(slab(), testing::joined(made_mesh("made:box:x=0.2,y=1,z=0.2,cells=2"),
                                                   made_mesh("made:box:x=0.2,y=1,z=0.2,cells=2"), Vec3(0.6, 0, 0)));
  math::Pose pose = below(1e-3);
  pose.translation.x() = -0.3;
  flush.move_to(pose);
  ASSERT_TRUE(flush.explains_at(Vec3(-0.3, 0, -0.1)) && flush.explains_at(Vec3(0.3, 0, -0.1)));
  flush.note(true, true);
  EXPECT_EQ(flush.contacts().size(), 4U) << "the outermost of both";
  flush.begin();
  flush.FlushContacts::move_to(pose, size, false, [] { return false; });
  EXPECT_FALSE(flush.serves()) << "where the other one stands is not known";
  flush.begin();
  flush.move_to(pose);
  EXPECT_TRUE(flush.serves());
  EXPECT_EQ(flush.contacts().size(), 4U) << "and is not forgotten";
}

TEST(FlushContacts, WhatCameDeepUnknownPushesSlowly) {
  auto flush = contacts_of(slab(), slab());
  const math::Pose pose = below(1e-2);
  flush.move_to(pose);
  flush.note(flush.explains_at(under), false);
  ASSERT_TRUE(flush.serves());
  std::vector<Contact> contacts = flush.contacts();
  ASSERT_FALSE(contacts.empty());
  EXPECT_NEAR(contacts[0].depth, tolerances::unmeasured_depth * size, 1e-12);
  flush.begin();
  flush.move_to(pose);
  contacts = flush.contacts();
  ASSERT_FALSE(contacts.empty());
  EXPECT_NEAR(contacts[0].depth, (tolerances::unmeasured_depth + tolerances::late_rise) * size, 1e-12);
  // What comes deeper against a push is given at once.
  flush.begin();
  flush.move_to(below(1.2e-2));
  contacts = flush.contacts();
  ASSERT_FALSE(contacts.empty());
  EXPECT_NEAR(contacts[0].depth, (tolerances::unmeasured_depth + 2 * tolerances::late_rise) * size + 2e-3, 1e-9);
  // What comes deeper while it does not push is not.
  const double given = contacts[0].depth;
  flush.begin();
  flush.move_to(below(1.2e-2));
  for (int run = 0; run < 50; ++run) {
    flush.begin();
    flush.move_to(below(1.6e-2));
  }
  contacts = flush.contacts();
  ASSERT_FALSE(contacts.empty());
  EXPECT_LE(contacts[0].depth, given + 2.0 * tolerances::late_rise * size);
}

TEST(FlushContacts, AHopIsNotForgotten) {
  auto flush = contacts_of(slab(), slab());
  ASSERT_FALSE(written(flush, below(1e-3), under).empty());
  flush.begin();
  flush.move_to(below(-1e-3));
  EXPECT_FALSE(flush.serves()) << "they are apart";
  flush.begin();
  flush.move_to(below(1e-4));
  EXPECT_TRUE(flush.serves());
  flush.begin();
  flush.move_to(below(-0.09 * size));
  flush.begin();
  flush.move_to(below(1e-4));
  EXPECT_TRUE(flush.serves());
  flush.begin();
  flush.move_to(below(-0.11 * size));
  flush.begin();
  flush.move_to(below(1e-4));
  EXPECT_FALSE(flush.serves()) << "far apart they are forgotten";
}

TEST(FlushContacts, WhatElseWasSeenIsNotLeftOut) {
  auto flush = contacts_of(slab(), slab());
  ASSERT_FALSE(written(flush, below(1e-3), under).empty());
  flush.note(false, false);
  EXPECT_FALSE(flush.serves());
  flush.note(true, false);
  EXPECT_FALSE(flush.serves()) << "a run that saw a part does not take that back";
  flush.note(true, true);
  EXPECT_TRUE(flush.serves());
  flush.note(false, false);
  int runs = 0;
  while (!flush.serves() && runs < 1000) {
    flush.move_to(below(1e-3));
    ++runs;
  }
  EXPECT_GT(runs, 20);
  EXPECT_LT(runs, 200) << "what only a part has seen is not doubted for ever";
  flush.note(false, true);
  for (int run = 0; run < 1000; ++run) flush.move_to(below(1e-3));
  flush.note(true, false);
  EXPECT_FALSE(flush.serves()) << "what all has shown is";
  flush.begin();
  flush.move_to(below(-1e-4));
  flush.note_clear();
  flush.begin();
  flush.move_to(below(1e-3));
  EXPECT_TRUE(flush.serves());
}

TEST(FlushContacts, OfManyPairsOfFacesAreLeftToAPatch) {
  // A round peg in a hole with facets as wide as its own.
  auto flush =
      contacts_of(made_mesh("made:peg:radius=0.01,length=0.02,around=16"),
                  made_mesh("made:plate_with_hole:peg_radius=0.01,thickness=0.02,around=16,clearance=-2.2e-4"));
  math::Pose pose;
  pose.translation.z() = 0.019;
  flush.move_to(pose, 0.03);
  int explained = 0;
  for (int i = 0; i < 16; ++i) {
    const double angle = (i + 0.5) * std::numbers::pi / 8.0;
    const Vec3 out(std::cos(angle), std::sin(angle), 0.0);
    explained += flush.explains_at(0.0098 * out + Vec3(0, 0, 0.01), -out) ? 1 : 0;
  }
  EXPECT_GT(explained, 0);
  EXPECT_LT(explained, 16);
  EXPECT_FALSE(flush.may_be());
  EXPECT_FALSE(flush.serves());
  flush.forget();
  EXPECT_TRUE(flush.may_be());
}

}  // namespace
}  // namespace odds::query
