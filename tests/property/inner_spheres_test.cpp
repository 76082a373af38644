// Spheres within solids: inside, and the depth of two packings is one smooth function whose gradient the parts are.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "odds/mesh/enclosed_volume.hpp"
#include "odds/mesh/made/by_name.hpp"
#include "odds/query/inner_spheres.hpp"
#include "odds/query/pair.hpp"
#include "odds/query/ray.hpp"

namespace odds::query {
namespace {

std::shared_ptr<const Shape> made(const std::string& what, volume::Kind kind = volume::Kind::wide) {
  auto mesh = std::make_shared<const mesh::TriangleMesh>(std::move(mesh::made::make_shape("made:" + what)).value());
  return Shape::build(std::move(mesh), {.volume = kind}).value();
}

InnerSpheres packed(const std::string& what, std::uint32_t count = 128) {
  return InnerSpheres::pack(made(what), count).value();
}

Vec3 gradient(const DeepOverlap& overlap) {
  Vec3 sum = Vec3::Zero();
  for (std::uint32_t i = 0; i < overlap.count; ++i) sum += overlap.parts[i].push;
  return sum;
}

class Solids : public ::testing::TestWithParam<const char*> {};

// A speck in the middle of each sphere is as far from the surface as the sphere reaches, and a ray from there crosses
// the surface an odd number of times.
TEST_P(Solids, SpheresReachToTheSurfaceFromWithin) {
  const auto shape = made(GetParam());
  const InnerSpheres spheres = InnerSpheres::pack(shape).value();
  const double size = shape->mesh().size();
  const double speck = 1e-8 * size;
  auto mesh = mesh::TriangleMesh::make({Vec3::Zero(), Vec3(speck, 0, 0), Vec3(0, speck, 0)}, {{0, 1, 2}}).value();
  auto point = Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(mesh))).value();
  auto pair = Pair::make(shape, point).value();
  ASSERT_GE(spheres.radii().size(), 1U);
  EXPECT_LE(spheres.radii().size(), 128U);
  const Vec3 aside = Vec3(0.6, 0.48, 0.64).normalized();
  for (std::size_t i = 0; i < spheres.radii().size(); ++i) {
    const Vec3& center = spheres.centers()[i];
    const double distance = pair.distance({Mat3::Identity(), center}).upper;
    EXPECT_LT(spheres.radii()[i], distance + 1e-6 * size) << "sphere " << i;
    EXPECT_GT(spheres.radii()[i], 0.95 * distance) << "sphere " << i;
    int crossings = 0;
    double along = 0.0;
    while (const auto hit = cast_ray(*shape, center + along * aside, aside, 3.0 * size)) {
      ++crossings;
      along += hit->distance + 1e-9 * size;
    }
    EXPECT_EQ(crossings % 2, 1) << "sphere " << i << " is outside";
    double shares = 0.0;
    for (const double share : spheres.corner_shares()[i]) shares += share;
    EXPECT_NEAR(shares, 1.0, 1e-12);
  }
}

// How much of the solid they fill, by points spread over its box: what is left are corners and dips.
TEST_P(Solids, SpheresFillMostOfIt) {
  const auto shape = made(GetParam());
  const InnerSpheres spheres = InnerSpheres::pack(shape).value();
  const mesh::TriangleMesh& mesh = shape->mesh();
  std::mt19937_64 generator(11);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  constexpr int points = 40000;
  int within = 0;
  for (int i = 0; i < points; ++i) {
    const Vec3 at = mesh.lower() +
                    Vec3(unit(generator), unit(generator), unit(generator)).cwiseProduct(mesh.upper() - mesh.lower());
    for (std::size_t k = 0; k < spheres.radii().size(); ++k) {
      if ((at - spheres.centers()[k]).norm() >= spheres.radii()[k]) continue;
      ++within;
      break;
    }
  }
  const double filled = within * (mesh.upper() - mesh.lower()).prod() / points;
  const double share = filled / mesh::enclosed_volume(mesh).value();
  std::printf("  %s: %zu spheres fill %.1f %%\n", GetParam(), spheres.radii().size(), 100.0 * share);
  EXPECT_GT(share, 0.7);
  EXPECT_LT(share, 1.02);  // points are a sample
}

TEST_P(Solids, PartsAreTheGradientOfTheDepth) {
  const InnerSpheres own = packed(GetParam());
  const InnerSpheres other = packed("torus:ring=0.03,tube=0.012,around=24,across=12", 64);
  const double reach = own.groups().empty() ? 0.0 : own.thickness() + other.thickness();
  std::mt19937_64 generator(5);
  std::normal_distribution<double> normal;
  int overlapping = 0;
  std::vector<double> errors;
  for (int i = 0; i < 300; ++i) {
    // Around a sphere of each, so that they overlap.
    const auto pick = [&](const InnerSpheres& s) { return s.centers()[generator() % s.centers().size()]; };
    const Quat turn = Quat(normal(generator), normal(generator), normal(generator), normal(generator)).normalized();
    math::Pose pose{turn.toRotationMatrix(), Vec3::Zero()};
    pose.translation = pick(own) - pose.rotation * pick(other) +
                       0.3 * reach * Vec3(normal(generator), normal(generator), normal(generator));
    const DeepOverlap overlap = deep_overlap(own, other, pose);
    if (overlap.depth < 1e-3 * reach) continue;
    ++overlapping;
    const Vec3 pushes = gradient(overlap);
    const double step = 1e-6 * reach;
    for (int axis = 0; axis < 3; ++axis) {
      math::Pose there = pose;
      math::Pose back = pose;
      there.translation[axis] += step;
      back.translation[axis] -= step;
      const double slope =
          (deep_overlap(own, other, there).depth - deep_overlap(own, other, back).depth) / (2.0 * step);
      EXPECT_NEAR(pushes[axis], slope, 1e-5) << "B along an axis is A against it";
    }
    // Turning B about the middle of what pushes, which is turning A the other way.
    Vec3 middle = Vec3::Zero();
    Vec3 torque = Vec3::Zero();
    for (std::uint32_t k = 0; k < overlap.count; ++k) middle += overlap.parts[k].position / overlap.count;
    for (std::uint32_t k = 0; k < overlap.count; ++k) {
      torque += (overlap.parts[k].position - middle).cross(overlap.parts[k].push);
    }
    Vec3 slope = Vec3::Zero();
    for (int axis = 0; axis < 3; ++axis) {
      const auto turned_by = [&](double angle) {
        const Mat3 turning = Eigen::AngleAxisd(angle, Vec3::Unit(axis)).toRotationMatrix();
        const math::Pose about{turning, middle - turning * middle};
        return deep_overlap(own, other, about * pose).depth;
      };
      slope[axis] = (turned_by(1e-6) - turned_by(-1e-6)) / 2e-6;
    }
    if (slope.norm() > 0.02 * reach) errors.push_back((torque - slope).norm() / slope.norm());
    // The other way round: the same depth, the opposite push.
    const DeepOverlap turned = deep_overlap(other, own, pose.inverse());
    EXPECT_NEAR(turned.depth, overlap.depth, 1e-12 * reach);
    EXPECT_LT((pose.rotation * gradient(turned) + pushes).norm(), 1e-9);
  }
  EXPECT_GT(overlapping, 150);
  std::sort(errors.begin(), errors.end());
  std::printf("  %s: torques are off by %.2g in the median, %.2g at the 90th percentile\n", GetParam(),
              errors[errors.size() / 2], errors[errors.size() * 9 / 10]);
  EXPECT_LT(errors[errors.size() / 2], 0.05);
}

INSTANTIATE_TEST_SUITE_P(Made, Solids,
                         ::testing::Values("torus_knot", "icosphere:radius=0.02", "box:x=0.2,y=0.2,z=0.04,cells=4",
                                           "gear", "bumpy_sphere", "uv_sphere"));

Vec3 of_contacts(Pair& pair, const math::Pose& pose) {
  pair.reset();
  Vec3 sum = Vec3::Zero();
  const Answer& answer = pair.run(pose, {.method = Method::exact, .max_contacts = 8});
  for (const Contact& contact : answer.contacts) {
    sum += contact.depth / static_cast<double>(answer.contacts.size()) * contact.normal;
  }
  return sum;
}

// Where crossing triangles change their mind, the spheres do not: 0.1 mm of a body of 0.4 m.
TEST(InnerSpheres, TheForceChangesLessThanThatOfContacts) {
  const auto shape = made("torus_knot");
  const InnerSpheres knot = InnerSpheres::pack(shape).value();
  auto pair = Pair::make(shape, shape).value();
  std::mt19937_64 generator(9);
  std::normal_distribution<double> normal;
  std::vector<double> of_spheres;
  std::vector<double> of_patches;
  for (int i = 0; i < 200; ++i) {
    // As a hand draws one out of the other.
    const math::Pose pose{Mat3::Identity(),
                          Vec3(2e-4 * normal(generator), 2e-4 * normal(generator), 1.5e-4 * (1.0 + i))};
    math::Pose moved = pose;
    moved.translation += 1e-4 * Vec3(normal(generator), normal(generator), normal(generator)).normalized();
    const DeepOverlap before = deep_overlap(knot, knot, pose);
    const DeepOverlap after = deep_overlap(knot, knot, moved);
    EXPECT_LT(std::abs(before.depth - after.depth), 2e-4);
    const Vec3 push = before.depth * gradient(before);
    of_spheres.push_back((after.depth * gradient(after) - push).norm() / push.norm());
    const Vec3 patch = of_contacts(pair, pose);
    of_patches.push_back((of_contacts(pair, moved) - patch).norm() / patch.norm());
  }
  std::sort(of_spheres.begin(), of_spheres.end());
  std::sort(of_patches.begin(), of_patches.end());
  std::printf("  0.1 mm changes the force of spheres by %.2g %% (p90 %.2g), of 8 contacts by %.2g %% (p90 %.2g)\n",
              100.0 * of_spheres[100], 100.0 * of_spheres[180], 100.0 * of_patches[100], 100.0 * of_patches[180]);
  EXPECT_LT(of_spheres[180], 0.1);
  EXPECT_GT(of_patches[180], 3.0 * of_spheres[180]);
}

TEST(InnerSpheres, AShallowPairOfBallsIsNoDeeperThanItIs) {
  const InnerSpheres ball = packed("uv_sphere:radius=0.02", 8);
  const DeepOverlap overlap = deep_overlap(ball, ball, {Mat3::Identity(), Vec3(0.036, 0, 0)});
  EXPECT_GT(overlap.depth, 0.002) << "of some spheres that fill it, not of one";
  EXPECT_LT(overlap.depth, 0.004);
  EXPECT_LT(gradient(overlap).normalized().x(), -0.999) << "A goes away from B";
  EXPECT_EQ(deep_overlap(ball, ball, {Mat3::Identity(), Vec3(0.041, 0, 0)}).count, 0U);
}

// Each ball in a thin plate fills next to nothing of it: only the first was kept.
TEST(InnerSpheres, OfAThinPlateAreAsManyAsWereAskedFor) {
  for (const char* plate : {"box:x=1,y=1,z=0.02", "box:x=1,y=1,z=0.01", "box:x=1,y=1,z=0.001"}) {
    for (const std::uint32_t count : {8U, 128U, 512U}) {
      EXPECT_EQ(packed(plate, count).radii().size(), count) << plate;
    }
  }
}

// As in coordinates of a map: rounding is more than what a ray is lifted off the triangle that it starts from.
TEST(InnerSpheres, OfABodyFarFromItsOriginAreThere) {
  const mesh::TriangleMesh box = mesh::made::make_shape("made:box:x=0.005,y=0.005,z=0.005").value();
  std::vector<Vec3> vertices(box.vertices().begin(), box.vertices().end());
  for (Vec3& vertex : vertices) vertex += Vec3(5e7, -5e7, 4e7);
  auto mesh = mesh::TriangleMesh::make(vertices, {box.triangles().begin(), box.triangles().end()}).value();
  const auto far = Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(mesh))).value();
  const auto spheres = InnerSpheres::pack(far);
  ASSERT_TRUE(spheres.ok()) << spheres.error().message();
  EXPECT_NEAR(spheres.value().thickness(), packed("box:x=0.005,y=0.005,z=0.005").thickness(), 1e-4);
}

TEST(InnerSpheres, TheSameForEveryBoundingVolume) {
  const InnerSpheres wide = InnerSpheres::pack(made("gear")).value();
  const InnerSpheres boxes = InnerSpheres::pack(made("gear", volume::Kind::aabb)).value();
  ASSERT_EQ(wide.radii().size(), boxes.radii().size());
  for (std::size_t i = 0; i < wide.radii().size(); ++i) {
    EXPECT_EQ(wide.radii()[i], boxes.radii()[i]);
    EXPECT_EQ(wide.centers()[i], boxes.centers()[i]);
  }
}

TEST(InnerSpheres, RefusesWhatHasNoInside) {
  const auto terrain = InnerSpheres::pack(made("terrain"));
  ASSERT_FALSE(terrain.ok());
  EXPECT_NE(terrain.error().message().find("has no inside"), std::string::npos) << terrain.error().message();
  EXPECT_NE(terrain.error().message().find("odds inspect"), std::string::npos);
  EXPECT_FALSE(InnerSpheres::pack(made("gear")->without_polygons()).ok());
  EXPECT_FALSE(InnerSpheres::pack(nullptr).ok());
  EXPECT_FALSE(InnerSpheres::pack(made("gear"), 7).ok());
  EXPECT_FALSE(InnerSpheres::pack(made("gear"), 513).ok());
}

}  // namespace
}  // namespace odds::query
