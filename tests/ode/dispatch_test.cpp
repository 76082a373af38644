// How collisions reach the class: both orders, all spaces, offsets, transforms, bodies, nested spaces.
#include <cmath>
#include <set>

#include "ode/ode_fixture.hpp"

namespace odds::test {
namespace {

class Dispatch : public OdeTest {
 protected:
  // Two unit spheres that overlap by 0.1 along x.
  void make_two_spheres(dSpaceID where) {
    const auto shape = sphere_shape(1.0);
    left = mesh_geom(shape, where);
    right = mesh_geom(shape, where);
    dGeomSetPosition(right, 1.9, 0.05, 0.02);
  }
  dGeomID left = nullptr;
  dGeomID right = nullptr;
};

// Collects what dSpaceCollide brings together.
struct Meetings {
  std::vector<dContactGeom> contacts;
  int calls = 0;
  static void near(void* data, dGeomID a, dGeomID b) {
    auto* self = static_cast<Meetings*>(data);
    if (dGeomIsSpace(a) != 0 || dGeomIsSpace(b) != 0) {
      dSpaceCollide2(a, b, data, &near);
      return;
    }
    ++self->calls;
    const auto found = collide(a, b);
    expect_sound(found, a, b);
    self->contacts.insert(self->contacts.end(), found.begin(), found.end());
  }
};

std::vector<dSpaceID> all_spaces() {
  dVector3 center = {0, 0, 0};
  dVector3 extents = {10, 10, 10};
  return {dSimpleSpaceCreate(nullptr), dHashSpaceCreate(nullptr), dSweepAndPruneSpaceCreate(nullptr, dSAP_AXES_XYZ),
          dQuadTreeSpaceCreate(nullptr, center, extents, 4)};
}

TEST_F(Dispatch, NormalsPointIntoTheFirstGeomInBothOrdersAndAgree) {
  make_two_spheres(space);
  for (int repeat = 0; repeat < 3; ++repeat) {  // ODE swaps calls of one class with itself from the second on
    const auto forward = collide(left, right);
    const auto backward = collide(right, left);
    ASSERT_FALSE(forward.empty());
    ASSERT_EQ(forward.size(), backward.size());
    expect_sound(forward, left, right);
    expect_sound(backward, right, left);
    EXPECT_LT(forward[0].normal[0], -0.5) << "into the left sphere is -x";
    EXPECT_GT(backward[0].normal[0], 0.5) << "into the right sphere is +x";
  }
}

TEST_F(Dispatch, SwappedCallsOfUntouchedPairsMirrorEachOther) {
  make_two_spheres(space);
  dGeomOddsMeshSetMethod(left, ODDS_METHOD_EXACT);  // no coherence between two runs
  collide(left, right);
  const auto forward = collide(left, right);
  const auto backward = collide(right, left);
  ASSERT_EQ(forward.size(), backward.size());
  for (std::size_t i = 0; i < forward.size(); ++i) {
    EXPECT_EQ(position_of(forward[i]), position_of(backward[i]));
    EXPECT_EQ(normal_of(forward[i]), -normal_of(backward[i]));
    EXPECT_EQ(forward[i].depth, backward[i].depth);
    EXPECT_EQ(forward[i].side1, backward[i].side2);
    EXPECT_EQ(forward[i].side2, backward[i].side1);
  }
}

TEST_F(Dispatch, SidesAreTrianglesOfTheirOwnMesh) {
  const auto few = box_shape(1, 1, 1);     // 12 triangles
  const auto many = sphere_shape(0.5, 8);  // 1280 triangles
  const dGeomID box = mesh_geom(few, space);
  const dGeomID ball = mesh_geom(many, space);
  dGeomSetPosition(ball, 0.1, 0.03, 0.98);
  const auto contacts = collide(ball, box);
  ASSERT_FALSE(contacts.empty());
  for (const dContactGeom& contact : contacts) {
    EXPECT_GE(contact.side1, -1);
    EXPECT_LT(contact.side1, 1280);
    EXPECT_GE(contact.side2, -1);
    EXPECT_LT(contact.side2, 12) << "side2 is a triangle of the box";
  }
  const auto swapped = collide(box, ball);
  ASSERT_FALSE(swapped.empty());
  for (const dContactGeom& contact : swapped) EXPECT_LT(contact.side1, 12);
}

TEST_F(Dispatch, EverySpaceBringsThemTogether) {
  for (const dSpaceID each : all_spaces()) {
    make_two_spheres(each);
    dCreatePlane(each, 0, 0, 1, -0.9);
    Meetings meetings;
    dSpaceCollide(each, &meetings, &Meetings::near);
    EXPECT_EQ(meetings.calls, 3) << "class of space " << dSpaceGetClass(each);
    std::set<std::pair<dGeomID, dGeomID>> pairs;
    for (const dContactGeom& contact : meetings.contacts) pairs.insert(std::minmax(contact.g1, contact.g2));
    EXPECT_EQ(pairs.size(), 3u);
    dSpaceDestroy(each);
  }
}

TEST_F(Dispatch, SpaceAgainstGeomAndSpaceAgainstSpace) {
  for (const dSpaceID each : all_spaces()) {
    make_two_spheres(each);
    const dGeomID probe = mesh_geom(sphere_shape(0.5), space);
    dGeomSetPosition(probe, -1.4, 0, 0);
    Meetings with_geom;
    dSpaceCollide2(reinterpret_cast<dGeomID>(each), probe, &with_geom, &Meetings::near);
    EXPECT_EQ(with_geom.calls, 1);
    EXPECT_FALSE(with_geom.contacts.empty());
    Meetings with_space;
    dSpaceCollide2(reinterpret_cast<dGeomID>(space), reinterpret_cast<dGeomID>(each), &with_space, &Meetings::near);
    EXPECT_EQ(with_space.calls, 1);
    EXPECT_FALSE(with_space.contacts.empty());
    dSpaceDestroy(each);
    dGeomDestroy(probe);
  }
}

TEST_F(Dispatch, DCollideOfASpaceRecurses) {
  make_two_spheres(space);
  const dGeomID probe = mesh_geom(sphere_shape(0.5));
  dGeomSetPosition(probe, -1.4, 0, 0);
  EXPECT_FALSE(collide(reinterpret_cast<dGeomID>(space), probe).empty());
  EXPECT_FALSE(collide(probe, reinterpret_cast<dGeomID>(space)).empty());
  dGeomDestroy(probe);
}

TEST_F(Dispatch, NestedSpaces) {
  const dSpaceID inner = dHashSpaceCreate(space);
  const auto shape = sphere_shape(1.0);
  mesh_geom(shape, inner);
  const dGeomID outside = mesh_geom(shape, space);
  dGeomSetPosition(outside, 1.9, 0, 0);
  Meetings meetings;
  dSpaceCollide(space, &meetings, &Meetings::near);
  EXPECT_EQ(meetings.calls, 1);
  EXPECT_FALSE(meetings.contacts.empty());
}

TEST_F(Dispatch, AnOffsetGeomCollidesWhereItIs) {
  const dWorldID world = dWorldCreate();
  make_two_spheres(space);
  const dBodyID body = dBodyCreate(world);
  dGeomSetBody(right, body);
  dGeomSetOffsetPosition(right, 0, 0, 3);
  dBodySetPosition(body, 1.9, 0, 0);
  EXPECT_TRUE(collide(left, right).empty()) << "the offset moved it 3 m up";
  dBodySetPosition(body, 1.9, 0, -3);
  const auto contacts = collide(left, right);
  ASSERT_FALSE(contacts.empty());
  EXPECT_NEAR(contacts[0].pos[2], 0.0, 0.5);
  EXPECT_LT(contacts[0].normal[0], -0.5);
  dWorldDestroy(world);
}

TEST_F(Dispatch, TwoBodiesCollideOneBodyNeverWithItself) {
  const dWorldID world = dWorldCreate();
  make_two_spheres(space);
  const dBodyID body = dBodyCreate(world);
  const dBodyID other = dBodyCreate(world);
  dGeomSetBody(left, body);
  dGeomSetBody(right, other);
  dBodySetPosition(other, 1.9, 0, 0);
  EXPECT_FALSE(collide(left, right).empty());
  const auto before = stats().queries;
  dGeomSetBody(right, body);
  dGeomSetOffsetPosition(right, 1.9, 0, 0);
  EXPECT_TRUE(collide(left, right).empty());
  EXPECT_TRUE(collide(left, left).empty());
  EXPECT_EQ(stats().queries, before) << "ODE must not even ask";
  dWorldDestroy(world);
}

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wdeprecated-declarations"  // transforms are old, and still used
TEST_F(Dispatch, InsideATransform) {
  make_two_spheres(nullptr);
  dGeomSetPosition(right, 0, 0, 1.9);  // the pose inside the transform
  const dGeomID transform = dCreateGeomTransform(space);
  dGeomTransformSetGeom(transform, right);
  dGeomTransformSetCleanup(transform, 1);
  EXPECT_EQ(oddsPreparePair(left, transform), 1);
  dGeomSetPosition(transform, 0, 0, 10);
  EXPECT_TRUE(collide(left, transform).empty());
  dGeomSetPosition(transform, 0, 0, 0);
  for (const auto& contacts : {collide(left, transform), collide(transform, left)}) {
    ASSERT_FALSE(contacts.empty());
    const double sign = contacts[0].g1 == left ? -1.0 : 1.0;
    EXPECT_GT(sign * contacts[0].normal[2], 0.5);
    EXPECT_NEAR(contacts[0].pos[2], 0.95, 0.2);
  }
  EXPECT_EQ(stats().lazy_pairs, 0u) << "preparing through the transform prepares the geom inside";
  const dGeomID plane = dCreatePlane(space, 0, 0, 1, 1.0);
  EXPECT_FALSE(collide(transform, plane).empty());
  EXPECT_FALSE(collide(plane, transform).empty());
  dGeomDestroy(left);
}
#pragma GCC diagnostic pop

TEST_F(Dispatch, ADisabledGeomAndForeignCategoriesAreNotAsked) {
  make_two_spheres(space);
  dGeomSetCategoryBits(left, 1);
  dGeomSetCollideBits(left, 0);
  dGeomSetCategoryBits(right, 2);
  dGeomSetCollideBits(right, 0);
  Meetings meetings;
  dSpaceCollide(space, &meetings, &Meetings::near);
  EXPECT_EQ(meetings.calls, 0);
  dGeomSetCollideBits(left, 2);
  dSpaceCollide(space, &meetings, &Meetings::near);
  EXPECT_EQ(meetings.calls, 1);
  dGeomDisable(left);
  dSpaceCollide(space, &meetings, &Meetings::near);
  EXPECT_EQ(meetings.calls, 1);
}

TEST_F(Dispatch, CollidingInsideANearCallbackIsAllowed) {
  make_two_spheres(space);
  struct Both {
    dGeomID left, right;
    std::size_t inner = 0;
  } both = {left, right};
  dSpaceCollide(space, &both, [](void* data, dGeomID a, dGeomID b) {
    auto* self = static_cast<Both*>(data);
    self->inner = collide(self->left, self->right).size() + collide(a, b).size();
  });
  EXPECT_GE(both.inner, 2u);
  dGeomSetPosition(left, 0, 0, 0.001);  // would abort if a callback had left the space locked
}

}  // namespace
}  // namespace odds::test
