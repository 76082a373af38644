// Where the most probable pair of cells says that surfaces meet, when a query ends before it is decided.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "odds/mesh/made/by_name.hpp"
#include "odds/query/pair.hpp"
#include "query/answer_odds/way_apart.hpp"
#include "query/node_odds/met_place.hpp"

namespace odds::query {
namespace {

std::shared_ptr<const Shape> made(const std::string& name) {
  auto mesh = mesh::made::make_shape("made:" + name);
  EXPECT_TRUE(mesh.ok());
  return std::move(Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(mesh).value()))).value();
}

/// Bricks that lie on each other with faces in one plane and edges flush: no box parts them, and no triangle crosses.
TEST(LikeliestPlace, OfABrickOnABrickPushesStraight) {
  int guessed = 0;
  int sideways = 0;  // where little but pairs of walls is left open, which are judged to be apart
  for (const int cells : {8, 11}) {
    const auto brick = made("box:x=0.203,y=0.1,z=0.057,cells=" + std::to_string(cells));
    for (const double apart : {1e-16, 1e-15, 1e-12}) {
      for (std::uint64_t units = 100; units <= 3000; units += 50) {
        auto pair = std::move(Pair::make(brick, brick)).value();
        const math::Pose above{Mat3::Identity(), Vec3(0, 0, 0.057 + apart)};
        const Answer& answer =
            pair.run(above, {.method = Method::incremental, .budget = Budget::work(units), .max_contacts = 8});
        if (answer.basis == Basis::proved || !answer.has_cell_pair) continue;
        ++guessed;
        if (answer.cell_pair.normal.z() < -0.9) continue;
        ++sideways;
        EXPECT_EQ(answer.verdict, Verdict::clear) << cells << " cells, " << units << " units, " << apart << " m";
      }
    }
  }
  EXPECT_GT(guessed, 300);
  EXPECT_LT(sideways, guessed / 10);
}

/// From centre to centre, a brick on the end of a slab lies aside.
TEST(LikeliestPlace, OfABrickOnTheEndOfASlabPushesStraight) {
  int guessed = 0;
  int sideways = 0;
  int guessed_coarsely = 0;
  int sideways_coarsely = 0;
  for (const char* const name :
       {"box:x=4,y=1,z=0.1,cells=2", "box:x=1,y=0.4,z=0.05,cells=8", "box:x=1,y=0.4,z=0.05,cells=32"}) {
    const auto slab = made(name);
    const Vec3 corner = slab->mesh().upper();
    for (const int cells : {8, 11}) {
      const auto brick = made("box:x=0.2,y=0.1,z=0.057,cells=" + std::to_string(cells));
      for (const double apart : {1e-16, 1e-12}) {
        for (const std::uint64_t units : {20U, 60U, 100U, 200U, 400U, 700U, 1000U, 1500U, 2000U}) {
          for (const double aside : {0.0, 1.0}) {
            auto pair = std::move(Pair::make(slab, brick)).value();
            const Vec3 place(corner.x() - 0.1, aside * (corner.y() - 0.05), corner.z() + 0.0285 + apart);
            const Answer& answer =
                pair.run({Mat3::Identity(), place},
                         {.method = Method::incremental, .budget = Budget::work(units), .max_contacts = 8});
            if (answer.basis == Basis::proved || answer.verdict == Verdict::clear || !answer.has_cell_pair) continue;
            // A slab of 48 triangles has leaves of half its length. While these are open, half of the guesses may push
            // sideways: a limit, not a wish.
            if (slab->mesh().triangles().size() < 50) {
              ++guessed_coarsely;
              sideways_coarsely += answer.cell_pair.normal.z() > -0.9 ? 1 : 0;
              continue;
            }
            ++guessed;
            // Of 20 units, two pairs of nodes opened, what is left open is as coarse as a quarter of the slab.
            sideways += answer.cell_pair.normal.z() > (units == 20 ? -0.75 : -0.9) ? 1 : 0;
          }
        }
      }
    }
  }
  EXPECT_GE(guessed, 10);
  EXPECT_EQ(sideways, 0) << "of " << guessed;
  EXPECT_LE(2 * sideways_coarsely, guessed_coarsely);
}

/// What a node says of a cap of a ball: all points within an angle about an axis.
struct Cap {
  Vec3 axis;  ///< unit
  double radius;
  double angle;

  [[nodiscard]] double flatness() const { return 0.5 * (1.0 + std::cos(angle)); }
  [[nodiscard]] Vec3 mean_normal() const { return flatness() * axis; }
  [[nodiscard]] double area() const { return 2.0 * std::numbers::pi * radius * radius * (1.0 - std::cos(angle)); }
};

FourVectors four(const Vec3& v) { return FourVectors::all(v.cast<float>()); }
/// Four patches that are the same.
FourPatches same(const Vec3& mean_normal, double area, const Vec3& centroid) {
  return {Four::all(static_cast<float>(area)), four(centroid), four(mean_normal)};
}

/// Two balls touch on z, B above A; the patches of both lie aside of that.
TEST(FacingWhereTheyTouch, IsNearerToThatOfTwoBallsThanTheNormalsOfPatchesAside) {
  const auto off = [](const Vec3& direction) { return std::acos(std::min(1.0, -direction.normalized().z())); };
  for (const double radius_b : {0.2, 1.0, 3.0}) {
    for (const double aside_a : {-0.3, 0.0, 0.4}) {
      for (const double aside_b : {-0.4, 0.2, 0.5}) {
        const Cap a{{std::sin(aside_a), 0.0, std::cos(aside_a)}, 1.0, 0.6};
        const Cap b{{0.0, std::sin(aside_b), -std::cos(aside_b)}, radius_b, 0.5};
        const Vec3 centroid_a = a.mean_normal() * a.radius;
        const Vec3 centroid_b = Vec3(0, 0, 1.0 + radius_b) + b.mean_normal() * b.radius;
        const Vec3 facing = facing_where_they_touch(same(a.mean_normal(), a.area(), centroid_a),
                                                    same(b.mean_normal(), b.area(), centroid_b))[2];
        EXPECT_LT(off(facing), 0.75 * off(b.mean_normal() - a.mean_normal()))
            << radius_b << " " << aside_a << " " << aside_b;
      }
    }
  }
}

TEST(FacingWhereTheyTouch, OfFlatAndOfUnknownPatchesIsTheDifferenceOfTheNormals) {
  const Vec3 up = Vec3::UnitZ();
  const Vec3 aside = Vec3(0.3, 0.0, -1.0).normalized();
  const Vec3 zero = Vec3::Zero();
  const Vec3 flat = facing_where_they_touch(same(up, 0.01, Vec3(0.05, 0.0, 0.0)), same(aside, 0.01, zero))[0];
  EXPECT_LT(flat.normalized().cross((aside - up).normalized()).norm(), 1e-3);
  for (const double area : {0.0, 1e-44, std::numeric_limits<double>::infinity()}) {
    const Vec3 facing = facing_where_they_touch(same(up, area, Vec3(1.0, 0.0, 0.0)), same(0.5 * aside, 0.01, zero))[3];
    EXPECT_LT((facing - (0.5 * aside - up)).norm(), 1e-6) << area;
  }
}

/// Discs: thin, about a point.
PatchSpreads discs(const Vec3& normal, double thickness) {
  return PatchSpreads::of(Four::all(static_cast<float>(thickness)), Four::all(0.5F), Four::all(1.0F), four(normal));
}

TEST(WhereTheyMeet, OfTwoPlanesIsOnBoth) {
  const Vec3 up = Vec3::UnitZ();
  for (const double angle : {0.3, 1.0, 1.57}) {
    const Vec3 aslant(std::sin(angle), 0.0, std::cos(angle));
    const Vec3 beyond(0.05, 0.2, 0.03);
    const Meetings met = where_they_meet(discs(up, 0.0), discs(aslant, 0.0), four(beyond));
    const Vec3 from_a = met.from_a[0];
    EXPECT_NEAR(up.dot(from_a), 0.0, 5e-3);
    EXPECT_NEAR(aslant.dot(from_a - beyond), 0.0, 5e-3);
    EXPECT_NEAR(from_a.y(), 0.1, 1e-3) << "half-way along the line in which they meet";
    const Meetings back = where_they_meet(discs(aslant, 0.0), discs(up, 0.0), four(-beyond));
    EXPECT_LT((beyond + back.from_a[3] - from_a).norm(), 1e-6);
    EXPECT_NEAR(back.log_likelihood(3), met.log_likelihood(0), 1e-4);
  }
}

TEST(WhereTheyMeet, OfParallelSheetsIsBetweenAndTheLessLikelyTheFartherTheyAreApart) {
  const Vec3 up = Vec3::UnitZ();
  float last = std::numeric_limits<float>::infinity();
  for (const double apart : {0.0, 0.01, 0.03, 0.1}) {
    const Meetings met = where_they_meet(discs(up, 0.02), discs(up, 0.02), four(apart * up));
    EXPECT_NEAR(met.from_a[1].z(), 0.5 * apart, 1e-4 * apart);
    EXPECT_LT(met.log_likelihood(1), last);
    last = met.log_likelihood(1);
  }
}

/// Nearly parallel sheets, of which nothing but the roots was looked at: their planes cross far away.
TEST(LikeliestPlace, OfNearlyParallelSheetsLiesInTheirBoxes) {
  auto quad =
      mesh::TriangleMesh::make({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}, "quad");
  ASSERT_TRUE(quad.ok());
  const auto sheet = Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(quad).value())).value();
  auto pair = std::move(Pair::make(sheet, sheet)).value();
  int guessed = 0;
  for (const double tilt : {1e-3, 0.01, 0.03, 0.1}) {
    for (const double height : {0.001, 0.01, 0.05}) {
      const Mat3 turned = Eigen::AngleAxisd(tilt, Vec3(1.0, 0.3, 0.0).normalized()).toRotationMatrix();
      const Answer& answer = pair.run({turned, Vec3(0.1, 0.2, height)}, {.budget = Budget::work(1)});
      if (answer.basis == Basis::proved || !answer.has_cell_pair) continue;
      ++guessed;
      EXPECT_LT(answer.cell_pair.position.cwiseAbs().maxCoeff(), 1.5) << tilt << " " << height;
    }
  }
  EXPECT_GT(guessed, 3);
}

TEST(WayApart, IsAlongTheSideOfLeastOverlap) {
  const auto slab = made("box:x=4,y=1,z=0.1,cells=1");
  const auto brick = made("box:x=0.2,y=0.1,z=0.057,cells=1");
  const Mat3 turned = Eigen::AngleAxisd(0.5, Vec3::UnitX()).toRotationMatrix();
  const auto direction = [](const auto& a, const auto& b, const math::Pose& pose) -> Vec3 {
    return way_apart(a->mesh(), b->mesh(), pose).direction;
  };
  EXPECT_EQ(direction(slab, brick, {Mat3::Identity(), Vec3(1.9, 0.4, 0.07)}), -Vec3::UnitZ());
  EXPECT_EQ(direction(slab, brick, {Mat3::Identity(), Vec3(1.9, 0.4, -0.07)}), Vec3::UnitZ());
  EXPECT_EQ(direction(brick, slab, {turned, turned * Vec3(1.9, 0.4, 0.07)}), -turned.col(2));
  EXPECT_TRUE(direction(slab, slab, {}).allFinite()) << "of bodies in each other";
}

TEST(WayApart, IsWorthMoreTheLessTheBoxesOverlap) {
  const auto slab = made("box:x=4,y=1,z=0.1,cells=1");
  const auto brick = made("box:x=0.2,y=0.1,z=0.06,cells=1");
  const auto worth = [&](double height) {
    const math::Pose pose{Mat3::Identity(), Vec3(0.3, 0.1, height)};
    const WayApart way = way_apart(slab->mesh(), brick->mesh(), pose);
    EXPECT_EQ(way.worth, way_apart(brick->mesh(), slab->mesh(), pose.inverse()).worth);
    return way.worth;
  };
  EXPECT_NEAR(worth(0.08), 1.0, 1e-9);
  EXPECT_NEAR(worth(0.077), 0.5, 1e-9);
  EXPECT_EQ(worth(0.07), 0.0);
  EXPECT_EQ(worth(0.0), 0.0);
}

// Of corners and sides beside the faces that lie on each other, a search without time sees as much as of these.
TEST(LikeliestPlace, OfFacesOnEachOtherPushesAcrossThem) {
  for (const char* const name : {"box:x=0.2,y=0.5,z=0.248,cells=1", "box:x=0.2,y=0.5,z=0.248,cells=8"}) {
    const auto brick = made(name);
    int guessed = 0;
    for (const double aside : {0.0, 0.03}) {
      for (const double overlap : {0.0, 1e-4}) {
        for (const std::uint64_t units : {1U, 8U, 16U, 24U, 40U}) {
          auto pair = std::move(Pair::make(brick, brick)).value();
          const math::Pose pose{Mat3::Identity(), Vec3(aside, aside, 0.248 - overlap)};
          const Answer& answer = pair.run(pose, {.budget = Budget::work(units)});
          if (answer.basis == Basis::proved || !answer.has_cell_pair) continue;
          ++guessed;
          EXPECT_LT(answer.cell_pair.normal.z(), -0.9) << name << " " << aside << " " << overlap << " " << units;
        }
      }
    }
    EXPECT_GT(guessed, 10);
  }
}

}  // namespace
}  // namespace odds::query
