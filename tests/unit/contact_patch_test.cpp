#include "odds/query/contact_patch.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "support/contact_scene.hpp"

namespace odds::query {
namespace {

using test::Body;
using test::ContactScene;
using test::degrees_between;
using test::shift;
using test::turn;
using test::WorldScene;

const Vec3 up = Vec3::UnitZ();

double deepest(const std::vector<Contact>& contacts) {
  double depth = 0.0;
  for (const Contact& c : contacts) depth = std::max(depth, c.depth);
  return depth;
}

/// Area of the convex hull of the contacts' places seen from above (gift wrapping over at most eight points).
double hull_area(const std::vector<Contact>& contacts) {
  double area = 0.0;
  for (const Contact& c : contacts) {
    for (const Contact& d : contacts) {
      const Vec3 p = c.position;
      const Vec3 q = d.position;
      const bool side = std::all_of(contacts.begin(), contacts.end(),
                                    [&](const Contact& e) { return (q - p).cross(e.position - p).z() >= -1e-12; });
      if (side) area += 0.5 * (p.x() * q.y() - p.y() * q.x());
    }
  }
  return area;
}

void expect_upright(const std::vector<Contact>& contacts, double depth, double within_degrees = 1.0) {
  ASSERT_FALSE(contacts.empty());
  EXPECT_LE(contacts.size(), 8u);
  EXPECT_NEAR(contacts[0].depth, depth, 0.05 * depth + 1e-9);
  for (const Contact& c : contacts) {
    EXPECT_LE(degrees_between(c.normal, up), within_degrees);
    EXPECT_GE(c.depth, 0.0);
    EXPECT_LE(c.depth, 1.05 * depth + 1e-9);
  }
}

TEST(ContactPatch, BoxOnBoxInManyRotations) {
  for (const int cells_a : {1, 8}) {
    for (const int cells_b : {1, 8}) {
      const Body brick = Body::box(0.2, 0.5, 0.248, cells_a);
      const Body ground = Body::box(1.0, 1.2, 0.3, cells_b);
      for (const double angle : {0.0, 0.3, 0.785, 1.2, 1.5707963, 2.5}) {
        for (const double depth : {1e-6, 1e-4, 1e-3}) {
          SCOPED_TRACE(testing::Message() << cells_a << " and " << cells_b << " cells, " << angle << " rad, " << depth);
          WorldScene scene{brick, turn(up, angle, {0.03, 0.02, 0.124 - depth}), ground, shift(0, 0, -0.15)};
          for (const bool probes : {false, true}) {
            scene.probes = probes;
            const auto contacts = scene.contacts();
            expect_upright(contacts, depth);
            EXPECT_NEAR(hull_area(contacts), 0.1, 0.001);  // the corners of the brick's base
            scene.max_contacts = 4;
            const auto four = scene.contacts();
            EXPECT_EQ(four.size(), 4u);
            EXPECT_NEAR(hull_area(four), 0.1, 0.001);
            scene.max_contacts = 8;
          }
        }
      }
    }
  }
}

TEST(ContactPatch, BoxTurnedInAnyWayGivesTheSameContactsInTheWorld) {
  const Body brick = Body::box(0.2, 0.5, 0.248, 8);
  const Body ground = Body::box(1.0, 1.2, 0.3, 8);
  for (int i = 0; i < 12; ++i) {
    const math::Pose world = turn(Vec3(1, i, 2 - i), 0.5 * i, Vec3(0.3 * i, 1, -2));
    const WorldScene scene{brick, world * turn(up, 0.3, {0, 0, 0.1239}), ground, world * shift(0, 0, -0.15)};
    auto contacts = scene.contacts();
    for (Contact& c : contacts) {
      c.position = world.inverse() * c.position;
      c.normal = world.rotation.transpose() * c.normal;
    }
    expect_upright(contacts, 1e-4, 0.01);
    EXPECT_NEAR(hull_area(contacts), 0.1, 0.001);
  }
}

TEST(ContactPatch, FlushBoxesMakeOnePatch) {
  for (const int cells : {1, 8}) {
    for (const double depth : {0.0, 1e-6, 1e-4}) {
      const Body brick = Body::box(0.2, 0.5, 0.248, cells);
      const WorldScene scene{brick, shift(0, 0, 0.248 - depth), brick, shift(0, 0, 0)};
      const auto contacts = scene.contacts();
      SCOPED_TRACE(testing::Message() << cells << " cells, depth " << depth);
      expect_upright(contacts, depth, 0.01);
      EXPECT_EQ(contacts.size(), 4u);
      EXPECT_NEAR(hull_area(contacts), 0.1, 0.001);
    }
  }
}

TEST(ContactPatch, NearlyFlushBoxesKeepTheNormal) {
  const Body brick = Body::box(0.2, 0.5, 0.248, 8);
  for (int i = 0; i < 40; ++i) {
    const double tiny = std::pow(10.0, -3.0 - 0.3 * i);
    const math::Pose top = turn(Vec3(0.3, -0.2, 1.0), tiny, {tiny, -0.5 * tiny, 0.248 - 1e-4});
    const WorldScene scene{brick, top, brick, shift(0, 0, 0)};
    const auto contacts = scene.contacts();
    SCOPED_TRACE(testing::Message() << "off by " << tiny);
    ASSERT_FALSE(contacts.empty());
    for (const Contact& c : contacts) EXPECT_LE(degrees_between(c.normal, up), 0.1);
    EXPECT_NEAR(contacts[0].depth, 1e-4, 0.4 * tiny + 1e-9);
  }
}

TEST(ContactPatch, CoplanarTouchingFacesHaveDepthZero) {
  for (const int cells : {1, 8}) {
    const Body brick = Body::box(0.25, 0.5, 0.25, cells);
    const Body ground = Body::box(1.0, 1.5, 0.5, cells);
    const WorldScene scene{brick, shift(0, 0, 0.125), ground, shift(0, 0, -0.25)};
    const auto contacts = scene.contacts();
    expect_upright(contacts, 0.0, 1e-6);
    EXPECT_NEAR(hull_area(contacts), 0.125, 1e-9);
    EXPECT_LE(deepest(contacts), 1e-12);
  }
}

TEST(ContactPatch, BoxOverALedgeKeepsTheFaceNormal) {
  const Body brick = Body::box(0.2, 0.2, 0.2, 8);
  const Body table = Body::box(1.0, 1.0, 0.5, 8);
  for (const double depth : {1e-4, 1e-3, 5e-3}) {
    const WorldScene scene{brick, shift(0.55, 0.0, 0.1 - depth), table, shift(0, 0, -0.25)};
    const auto contacts = scene.contacts();
    expect_upright(contacts, depth);
    EXPECT_NEAR(hull_area(contacts), 0.05 * 0.2, 0.001);
  }
}

TEST(ContactPatch, BoxOnAnOpenSheet) {
  const Body sheet = Body::made("terrain:side=2,height=0,cells=20", false);
  const Body brick = Body::box(0.2, 0.5, 0.248, 8);
  const WorldScene scene{brick, turn(up, 0.4, {0.11, 0.07, 0.124 - 1e-4}), sheet, {}};
  const auto contacts = scene.contacts();
  expect_upright(contacts, 1e-4, 0.01);
  EXPECT_NEAR(hull_area(contacts), 0.1, 0.001);
}

TEST(ContactPatch, SheetPushesTowardsTheBody) {
  Body sheet = Body::made("terrain:side=2,height=0,cells=20", false);
  const Body brick = Body::box(0.2, 0.2, 0.2, 1);
  const WorldScene above{brick, shift(0.1, 0.1, 0.09), sheet, {}};
  const WorldScene below{brick, shift(0.1, 0.1, -0.09), sheet, {}};
  expect_upright(above.contacts(), 0.01, 0.01);
  ASSERT_FALSE(below.contacts().empty());
  EXPECT_LE(degrees_between(below.contacts()[0].normal, -up), 0.01);
  EXPECT_NEAR(below.contacts()[0].depth, 0.01, 1e-9);
  for (mesh::Triangle& t : sheet.triangles) std::swap(t[1], t[2]);  // a sheet has no outside
  expect_upright(WorldScene{brick, shift(0.1, 0.1, 0.09), sheet, {}}.contacts(), 0.01, 0.01);
}

TEST(ContactPatch, SphereOnPlaneHasOneDeepContact) {
  const Body ball = Body::made("icosphere:radius=0.05,frequency=24");
  const Body ground = Body::box(1.0, 1.0, 0.2, 16);
  for (const double depth : {1e-3, 2e-3, 5e-3}) {
    const math::Pose rolled = turn({1, 2, 3}, 0.7);
    double lowest = 0.0;  // of the polyhedron
    for (const Vec3& v : ball.vertices) lowest = std::min(lowest, (rolled * v).z());
    const WorldScene scene{ball, shift(0.013, 0.021, -lowest - depth) * rolled, ground, shift(0, 0, -0.1)};
    const auto contacts = scene.contacts();
    SCOPED_TRACE(depth);
    expect_upright(contacts, depth, 0.1);
    EXPECT_EQ(contacts.size(), 1u);
    EXPECT_NEAR(contacts[0].position.x(), 0.013, 1e-3);
    EXPECT_NEAR(contacts[0].position.y(), 0.021, 1e-3);
  }
}

TEST(ContactPatch, SphereOnSphereAlongTheCentres) {
  const Body ball = Body::made("icosphere:radius=0.05,frequency=20");
  for (const Vec3& direction : {Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(1, 2, 3), Vec3(-3, 1, 0.5)}) {
    for (const double depth : {5e-4, 2e-3, 1e-2}) {
      const Vec3 apart = direction.normalized() * (0.1 - depth);
      const WorldScene scene{ball, {Mat3::Identity(), apart}, ball, turn({1, 1, 0}, 0.3)};
      const auto contacts = scene.contacts();
      ASSERT_FALSE(contacts.empty());
      EXPECT_LE(degrees_between(contacts[0].normal, direction), 2.0);
      EXPECT_NEAR(contacts[0].depth, depth, 0.05 * depth + 1e-4);  // the polyhedra are 6e-5 smaller
      EXPECT_LE((contacts[0].position - 0.5 * apart).norm(), 2e-3);
    }
  }
}

TEST(ContactPatch, CrossedEdgesGiveTheirCrossProduct) {
  const Body bar = Body::box(1.0, 0.1, 0.1, 1);
  const double half_diagonal = 0.05 * std::numbers::sqrt2;
  for (const double yaw : {1.5707963267948966, 1.2, 0.8}) {
    const math::Pose lower = turn(Vec3::UnitX(), 0.7853981633974483);
    const math::Pose upper = math::Pose{Mat3::Identity(), {0.013, 0, 2.0 * half_diagonal - 1e-3}} * turn(up, yaw) *
                             turn(Vec3::UnitX(), 0.7853981633974483);
    const auto contacts = WorldScene{bar, upper, bar, lower}.contacts();
    expect_upright(contacts, 1e-3, 0.01);
    EXPECT_LE((contacts[0].position - Vec3(0.013, 0, half_diagonal - 5e-4)).norm(), 1e-6);
  }
}

TEST(ContactPatch, CornerIntoFace) {
  const Body cube = Body::box(0.1, 0.1, 0.1, 1);
  const Body ground = Body::box(1.0, 1.0, 0.2, 10);
  const math::Pose on_corner = turn(Vec3(1, -1, 0), std::atan(std::numbers::sqrt2));
  double lowest = 0.0;
  for (const Vec3& v : cube.vertices) lowest = std::min(lowest, (on_corner * v).z());
  const math::Pose pose = shift(0.021, 0.033, -lowest - 2e-3) * on_corner;
  const auto contacts = WorldScene{cube, pose, ground, shift(0, 0, -0.1)}.contacts();
  expect_upright(contacts, 2e-3, 0.01);
  EXPECT_EQ(contacts.size(), 1u);
  EXPECT_LE((contacts[0].position - Vec3(0.021, 0.033, -1e-3)).norm(), 1e-4);
}

TEST(ContactPatch, NeedleIntoFaceIsPushedOutAlongTheFaceNormal) {
  Body needle;
  needle.vertices = {{0, 0, 0}, {0.001, 0, 0.1}, {-0.0005, 0.00087, 0.1}, {-0.0005, -0.00087, 0.1}};
  needle.triangles = {{0, 2, 1}, {0, 3, 2}, {0, 1, 3}, {1, 2, 3}};
  needle.centre = {0, 0, 0.075};
  const Body ground = Body::box(1.0, 1.0, 0.2, 50);
  const auto contacts = WorldScene{needle, shift(0.011, 0.012, -0.01), ground, shift(0, 0, -0.1)}.contacts();
  expect_upright(contacts, 0.01, 0.1);
}

TEST(ContactPatch, EdgeTouchingAFaceHasTheFaceNormal) {
  Body wedge;  // its lower edge lies in z = 0, and its faces rise unequally
  wedge.vertices = {{-0.25, 0, 0},       {0.25, 0, 0},        {0.25, 0.5, 0.125},
                    {-0.25, 0.5, 0.125}, {-0.25, -0.25, 0.5}, {0.25, -0.25, 0.5}};
  wedge.triangles = {{0, 2, 1}, {0, 3, 2}, {0, 1, 5}, {0, 5, 4}, {3, 5, 2}, {3, 4, 5}, {0, 4, 3}, {1, 2, 5}};
  wedge.centre = {0, 0.1, 0.25};
  const Body ground = Body::box(2.0, 2.0, 0.5, 1);
  const auto contacts = WorldScene{wedge, {}, ground, shift(0, 0, -0.25)}.contacts();
  expect_upright(contacts, 0.0, 1e-6);
  EXPECT_EQ(contacts.size(), 2u);
}

TEST(ContactPatch, FourLegsGiveFourPatches) {
  Body table = Body::box(1.0, 1.0, 0.1, 4).moved(shift(0, 0, 0.55));
  for (const double x : {-0.4, 0.4}) {
    for (const double y : {-0.4, 0.4}) table = table.with(Body::box(0.1, 0.1, 0.5, 3).moved(shift(x, y, 0.25)));
  }
  table.centre = {0, 0, 0.5};
  const Body floor = Body::box(3.0, 3.0, 0.2, 1);
  const WorldScene scene{table, turn(up, 0.2, {0, 0, -1e-4}), floor, shift(0, 0, -0.1)};
  auto contacts = scene.contacts();
  expect_upright(contacts, 1e-4, 0.01);
  EXPECT_EQ(contacts.size(), 8u);
  for (const double x : {-1.0, 1.0}) {
    for (const double y : {-1.0, 1.0}) {
      const auto in_first_four = std::count_if(contacts.begin(), contacts.begin() + 4, [&](const Contact& c) {
        const Vec3 p = turn(up, 0.2).inverse() * c.position;
        return p.x() * x > 0.0 && p.y() * y > 0.0;
      });
      EXPECT_EQ(in_first_four, 1) << "leg at " << x << ", " << y;
    }
  }
}

TEST(ContactPatch, PipeStandsOnItsEnd) {
  const Body pipe = Body::made("plate_with_hole:side=0.08,thickness=0.04,peg_radius=0.02,clearance=0");
  const Body ground = Body::box(1.0, 1.0, 0.2, 7);
  const auto contacts = WorldScene{pipe, shift(0.01, 0.02, 0.04 - 1e-4), ground, shift(0, 0, -0.1)}.contacts();
  expect_upright(contacts, 1e-4, 0.01);
  EXPECT_NEAR(hull_area(contacts), 0.0064, 1e-4);
}

TEST(ContactPatch, InnerRimOfARingDoesNotPullWhereTheOuterIsMissing) {
  // Of a torus that lies on the ground the search has found the inner rim only, or parts of the outer beside it.
  const Body torus = Body::made("torus:ring=0.1,tube=0.03,around=48,across=24");
  const Body ground = Body::box(1.0, 1.0, 0.2, 16);
  ContactScene scene{torus, ground, shift(0.01, 0.02, -0.13 + 1e-3)};
  scene.find_hits();
  const std::vector<TrianglePair> all = scene.hits;
  const auto is_inner = [&](const TrianglePair& hit) {
    const mesh::Triangle& t = torus.triangles[hit.a];
    const Vec3 middle = (torus.vertices[t[0]] + torus.vertices[t[1]] + torus.vertices[t[2]]) / 3.0;
    return middle.head<2>().norm() < 0.1;
  };
  for (const std::size_t every : {1000000U, 40U, 7U}) {
    scene.hits.clear();
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (is_inner(all[i]) || i % every == every - 1) scene.hits.push_back(all[i]);
    }
    ASSERT_LT(scene.hits.size(), all.size());
    ASSERT_GT(scene.hits.size(), 40u);
    for (const Contact& c : scene.builder->build(scene.input())) {
      EXPECT_LE(degrees_between(c.normal, up), 10.0) << "one of the outer in " << every;
      EXPECT_LE(c.depth, 2e-3);
    }
  }
}

TEST(ContactPatch, CrossedPlatesPartTheShortWay) {
  const Body plate = Body::box(0.4, 0.3, 0.01, 4);
  // Upright plate stuck through the flat one, most of it above: out it goes upwards.
  const math::Pose upright = shift(0.02, 0.01, 0.17) * turn(Vec3::UnitY(), 1.5707963267948966);
  const auto contacts = WorldScene{plate, upright, plate, {}}.contacts();
  ASSERT_FALSE(contacts.empty());
  for (const Contact& c : contacts) {
    EXPECT_LE(degrees_between(c.normal, up), 1.0);
    EXPECT_LE(c.depth, 0.2 - 0.17 + 0.005 + 1e-9);
  }
  EXPECT_NEAR(contacts[0].depth, 0.035, 1e-3);
}

TEST(ContactPatch, PegTouchingBothWallsKeepsBothNormals) {
  const Body peg = Body::box(0.1, 0.1, 0.3, 4);
  const Body left = Body::box(0.1, 0.5, 0.5, 4).moved(shift(-0.0999, 0, 0));
  const Body right = Body::box(0.1, 0.5, 0.5, 4).moved(shift(0.0999, 0, 0));
  const auto contacts = WorldScene{peg, {}, left.with(right), turn(up, 0.6).inverse() * turn(up, 0.6)}.contacts();
  int to_left = 0;
  int to_right = 0;
  for (const Contact& c : contacts) {
    EXPECT_GE(std::abs(c.normal.x()), 0.9999);
    EXPECT_NEAR(c.depth, 1e-4, 1e-5);
    ++(c.normal.x() < 0.0 ? to_left : to_right);
  }
  EXPECT_GE(to_left, 3);
  EXPECT_GE(to_right, 3);
}

TEST(ContactPatch, DeepBoxIsMeasuredByProbes) {
  const Body brick = Body::box(0.2, 0.5, 0.248, 8);
  const Body ground = Body::box(1.0, 1.2, 1.0, 16);
  for (const double depth : {0.01, 0.05, 0.1, 0.2}) {
    const WorldScene scene{brick, turn(up, 0.3, {0.03, 0.02, 0.124 - depth}), ground, shift(0, 0, -0.5)};
    SCOPED_TRACE(depth);
    expect_upright(scene.contacts(), depth, 0.1);
  }
}

TEST(ContactPatch, RingIsMeasuredAtItsSummit) {
  // A tilted torus dips into the ground along a crescent, which is deepest on a line that the centre of its rim misses.
  const Body torus = Body::made("torus:ring=0.1,tube=0.03,around=96,across=48");
  const Body ground = Body::box(1.0, 1.0, 0.2, 16);
  const math::Pose tilted = turn(Vec3(1, 2, 0), 0.03);
  double lowest = 0.0;
  for (const Vec3& v : torus.vertices) lowest = std::min(lowest, (tilted * v).z());
  for (const double depth : {1e-3, 3e-3, 6e-3}) {
    const math::Pose pose = shift(0.01, 0.02, -lowest - depth) * tilted;
    ContactScene scene{torus, ground, pose.inverse() * shift(0, 0, -0.1)};
    scene.find_hits();
    SCOPED_TRACE(depth);
    double before = 0.0;
    for (int run = 0; run < 6; ++run) {  // each run goes on from the last one's summit
      const auto contacts = scene.builder->build(scene.input());
      ASSERT_FALSE(contacts.empty());
      EXPECT_LE(degrees_between(pose.rotation * contacts[0].normal, up), 0.1);
      EXPECT_GE(contacts[0].depth, (run == 0 ? 0.65 : 0.999) * (run == 0 ? depth : before));
      EXPECT_LE(contacts[0].depth, depth + 1e-9);
      before = contacts[0].depth;
      scene.previous = contacts[0].normal;
      scene.previous_position = contacts[0].position;
    }
    EXPECT_NEAR(before, depth, 0.05 * depth);
  }
}

/// How far A must move along `direction` until no triangles meet any more.
double way_out(ContactScene scene, const Vec3& direction) {
  const Vec3 start = scene.pose_b_in_a.translation;
  double near = 0.0;
  double far = 0.01;
  for (int i = 0; i < 24; ++i) {
    const double middle = 0.5 * (near + far);
    scene.pose_b_in_a.translation = start - middle * direction;  // B moves the other way
    scene.find_hits();
    (scene.hits.empty() ? far : near) = middle;
  }
  return far;
}

TEST(ContactPatch, CrescentIsAsDeepAsItsWayOutNotAsWideAsItsRim) {
  // A peg beside the axis of its hole touches the hole's edge with its chamfer: the rim is a crescent of some
  // millimetres around an overlap of some hundredths.
  const Body peg = Body::made("peg:radius=0.01,length=0.06,along=2");
  for (const double clearance : {1e-4, 2e-4}) {
    const Body plate = Body::made("plate_with_hole:across=2,along=2,clearance=" + std::to_string(clearance));
    for (const double beside : {1.5e-4, 3e-4, 5e-4}) {
      for (const double press : {3e-5, 6e-5, 1e-4}) {  // radially
        for (const double around : {0.0, 0.03, 0.7}) {
          const Vec3 outwards(std::cos(around), std::sin(around), 0.0);
          ContactScene scene{peg, plate, shift(0, 0, 0)};
          scene.pose_b_in_a.translation = -beside * outwards + (0.001 - (beside - clearance) + press) * up;
          if (scene.pose_b_in_a.translation.z() > 0.00099) continue;  // beyond the chamfer
          const auto contacts = scene.contacts();
          SCOPED_TRACE(testing::Message()
                       << beside << " beside, clearance " << clearance << ", pressed " << press << ", at " << around);
          ASSERT_FALSE(contacts.empty());
          const Vec3 out_of_edge = (up - outwards).normalized();
          EXPECT_LE(degrees_between(contacts[0].normal, out_of_edge), 6.0);
          EXPECT_NEAR(contacts[0].depth, way_out(scene, contacts[0].normal), 0.1 * contacts[0].depth);
        }
      }
    }
  }
}

TEST(ContactPatch, FewHitsStillGiveTheNormal) {
  ContactScene scene{Body::box(0.2, 0.5, 0.248, 8), Body::box(1.0, 1.2, 0.3, 8), shift(-0.03, 0.02, -0.274 + 1e-4)};
  scene.find_hits();
  const std::vector<TrianglePair> all = scene.hits;
  ASSERT_GT(all.size(), 50u);
  for (std::size_t first = 0; first < all.size(); ++first) {
    for (const std::size_t count : {std::size_t{1}, std::size_t{3}, std::size_t{10}}) {
      scene.hits.assign(all.begin() + static_cast<std::ptrdiff_t>(first),
                        all.begin() + static_cast<std::ptrdiff_t>(std::min(all.size(), first + count)));
      const auto contacts = scene.builder->build(scene.input());
      ASSERT_FALSE(contacts.empty());
      EXPECT_LE(degrees_between(contacts[0].normal, up), 1.0) << first << " " << count;
      EXPECT_LE(contacts[0].depth, 1.05e-4);
    }
  }
}

TEST(ContactPatch, PreviousNormalBreaksTies) {
  // A rod through the middle of a plate: both ways out are equally long.
  ContactScene scene{Body::box(0.02, 0.02, 0.4, 1), Body::box(0.4, 0.3, 0.01, 1), shift(0, 0, 1e-7)};
  for (const double sign : {1.0, -1.0}) {
    scene.previous = sign * up;
    const auto contacts = scene.contacts();
    ASSERT_FALSE(contacts.empty());
    EXPECT_LE(degrees_between(contacts[0].normal, sign * up), 1.0);
  }
}

TEST(ContactPatch, OneContactIsAtTheMiddle) {
  WorldScene scene{Body::box(0.2, 0.5, 0.248, 8), shift(0.03, 0.02, 0.124 - 1e-4), Body::box(1.0, 1.2, 0.3, 8),
                   shift(0, 0, -0.15)};
  scene.max_contacts = 1;
  const auto contacts = scene.contacts();
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_NEAR(contacts[0].depth, 1e-4, 1e-9);
  EXPECT_LE((contacts[0].position - Vec3(0.03, 0.02, -5e-5)).norm(), 1e-3);
}

TEST(ContactPatch, TessellationDoesNotMoveTheContacts) {
  std::vector<std::vector<Contact>> made;
  for (const int cells : {1, 3, 8}) {
    for (const int ground : {1, 5, 16}) {
      const WorldScene scene{Body::box(0.2, 0.5, 0.248, cells), turn(Vec3(0.001, 0.0007, 1), 0.3, {0.03, 0.02, 0.1239}),
                             Body::box(1.0, 1.2, 0.3, ground), shift(0, 0, -0.15)};
      made.push_back(scene.contacts());
      ASSERT_EQ(made.back().size(), made.front().size());
      for (std::size_t i = 0; i < made.back().size(); ++i) {
        EXPECT_LE((made.back()[i].position - made.front()[i].position).norm(), 1e-3);
        EXPECT_NEAR(made.back()[i].depth, made.front()[i].depth, 1e-6);
        EXPECT_LE(degrees_between(made.back()[i].normal, made.front()[i].normal), 0.01);
      }
    }
  }
}

// Where the ground was the first, contacts counted as one by how far its own middle is: a crate stood on one of them.
TEST(ContactPatch, StandsOnAllCornersFarFromTheMiddleOfTheGround) {
  const Body crate = Body::box(0.4, 0.4, 0.4, 2);
  const Body ground = Body::box(2000.0, 2000.0, 1.0);
  const math::Pose there = shift(900.0, 90.0, 0.699);
  EXPECT_NEAR(hull_area(WorldScene{crate, there, ground, {}}.contacts()), 0.16, 1e-6);
  EXPECT_NEAR(hull_area(WorldScene{ground, {}, crate, there}.contacts()), 0.16, 1e-6);
}

TEST(ContactPatch, AnExpiredDeadlineStillGivesAContact) {
  ContactScene scene{Body::box(0.2, 0.5, 0.248, 8), Body::box(1.0, 1.2, 0.3, 8), shift(-0.03, 0.02, -0.274 + 1e-4)};
  scene.find_hits();
  for (int polls = 0; polls < 60; ++polls) {
    int left = polls;
    const Deadline deadline{[](void* self) noexcept { return --*static_cast<int*>(self) < 0; }, &left};
    const auto contacts = scene.builder->build(scene.input(), deadline);
    ASSERT_FALSE(contacts.empty()) << "after " << polls << " polls";
    EXPECT_LE(degrees_between(contacts[0].normal, up), 1.0) << "after " << polls << " polls";
    EXPECT_LE(contacts[0].depth, 1.05e-4);
  }
}

TEST(ContactPatch, NoHitsGiveNoContacts) {
  const ContactScene scene{Body::box(1, 1, 1), Body::box(1, 1, 1), shift(5, 0, 0)};
  EXPECT_TRUE(scene.builder->build(scene.input()).empty());
}

}  // namespace
}  // namespace odds::query
