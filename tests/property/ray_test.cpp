// Rays against every triangle in turn.
#include "odds/query/ray.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "odds/math/random.hpp"
#include "odds/mesh/made/by_name.hpp"
#include "odds/primitive/ray_triangle.hpp"
#include "query/counted_ray.hpp"
#include "support/all_kinds.hpp"
#include "support/brute_force.hpp"
#include "support/shapes.hpp"

namespace odds::query {
namespace {

std::optional<double> brute_force(const mesh::TriangleMesh& mesh, const Vec3& origin, const Vec3& direction) {
  std::optional<double> nearest;
  for (const mesh::Triangle& t : mesh.triangles()) {
    const Vec3 a = mesh.vertices()[t[0]];
    const Vec3 n = (mesh.vertices()[t[1]] - a).cross(mesh.vertices()[t[2]] - a);
    const double slope = n.dot(direction);
    if (slope == 0.0) continue;
    const double distance = n.dot(a - origin) / slope;
    if (distance < 0.0) continue;
    const Vec3 x = origin + distance * direction;
    bool inside = true;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 p = mesh.vertices()[t[i]];
      const Vec3 q = mesh.vertices()[t[(i + 1) % 3]];
      inside = inside && n.dot((q - p).cross(x - p)) >= -1e-12;
    }
    if (inside && (!nearest || distance < *nearest)) nearest = distance;
  }
  return nearest;
}

/// A point that the ray is at when it is said to meet the mesh, from the nearest triangle's plane and outline; metres.
double off_the_box(const Vec3& point, const Mat3& turn, const Vec3& center) {
  const Vec3 local = turn.transpose() * (point - center);
  return (local.cwiseAbs() - Vec3::Constant(0.5)).maxCoeff();
}

class Rays : public ::testing::TestWithParam<volume::Kind> {};

// In the plane of a face, askew to the axes, and past the box: there determinants are nothing but rounding.
TEST_P(Rays, InThePlaneOfAFaceMeetNothingBesideIt) {
  math::Random random(11);
  const auto box = mesh::made::make_shape("made:box:x=1,y=1,z=1").value();
  for (int turn = 0; turn < 30; ++turn) {
    const Mat3 rotation = random.rotation().toRotationMatrix();
    const Vec3 center(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    const auto shape = Shape::build(testing::changed(box, 1.0, {rotation, center}, 0), {.volume = GetParam()}).value();
    for (int i = 0; i < 300; ++i) {
      const double beside = random.uniform(0.05, 0.5);
      const double angle = random.uniform(-0.5, 0.5);
      // Past the corner (0.5, 0.5), by `beside` at the nearest.
      const Vec3 along(-std::sin(std::numbers::pi / 4 + angle), std::cos(std::numbers::pi / 4 + angle), 0.0);
      const Vec3 out(along.y(), -along.x(), 0.0);
      const Vec3 past = Vec3(0.5, 0.5, i % 2 == 0 ? 0.5 : -0.5) + beside * out - random.uniform(1, 5) * along;
      const auto hit = cast_ray(*shape, rotation * past + center, (rotation * along).normalized(), 20.0);
      ASSERT_FALSE(hit) << "beside by " << beside << ", met at " << hit->distance << ", off by "
                        << off_the_box(rotation * (past + hit->distance * along) + center, rotation, center);
    }
  }
}

TEST(RayTriangle, MeetsSlivers) {
  math::Random random(5);
  int met = 0;
  constexpr int rays = 20000;
  for (int i = 0; i < rays; ++i) {
    const Mat3 turn = random.rotation().toRotationMatrix();
    const double thin = std::pow(10.0, random.uniform(-12, 0));
    const Vec3 corners[3] = {Vec3::Zero(), turn * Vec3(1, 0, 0), turn * Vec3(0.5, thin, 0)};
    const Vec3 direction = random.direction();
    const Vec3 on = random.uniform(0, 0.5) * corners[1] + random.uniform(0, 0.5) * corners[2];
    met += primitive::distance_along_ray(corners, on - random.uniform(0, 3) * direction, direction) >= 0.0 ? 1 : 0;
  }
  EXPECT_GT(met, rays * 999 / 1000);
}

TEST_P(Rays, MeetWhatBruteForceMeets) {
  const auto mesh = testing::wavy_sphere(16);
  const auto shape = Shape::build(mesh, {.volume = GetParam()}).value();
  std::mt19937 generator(7);
  std::normal_distribution<double> normal;
  int met = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 origin = 0.9 * Vec3(normal(generator), normal(generator), normal(generator));
    const Vec3 direction = Vec3(normal(generator), normal(generator), normal(generator)).normalized();
    const auto expected = brute_force(*mesh, origin, direction);
    const auto found = cast_ray(*shape, origin, direction, INFINITY);
    ASSERT_EQ(expected.has_value(), found.has_value()) << i;
    if (!expected) continue;
    ++met;
    EXPECT_NEAR(*expected, found->distance, 1e-9) << i;
    EXPECT_FALSE(cast_ray(*shape, origin, direction, *expected - 1e-6)) << "a shorter ray must not meet it";
  }
  EXPECT_GT(met, 500);
  EXPECT_LT(met, 1800);
}

/// With the very kernel and frame of the search, so that even grazing rays must agree.
std::optional<double> every_triangle(const mesh::TriangleMesh& mesh, const Vec3& origin, const Vec3& direction) {
  const Vec3 frame = 0.5 * mesh.lower() + 0.5 * mesh.upper();
  std::optional<double> nearest;
  for (const mesh::Triangle& t : mesh.triangles()) {
    const Vec3 corners[3] = {mesh.vertices()[t[0]] - frame, mesh.vertices()[t[1]] - frame,
                             mesh.vertices()[t[2]] - frame};
    const double distance = primitive::distance_along_ray(corners, origin - frame, direction);
    if (distance >= 0.0 && (!nearest || distance < *nearest)) nearest = distance;
  }
  return nearest;
}

TEST_P(Rays, GrazeNothingAwayAtAnySizeInAnyDirection) {
  math::Random random(3);
  for (const double scale : {0x1p-100, 0x1p-40, 1.0, 0x1p40}) {
    for (const auto& mesh : {testing::changed(*testing::wavy_sphere(10, 0.3), scale, {}, 0),
                             testing::changed(*testing::wavy_sphere(9, 0.0), scale,
                                              {Vec3(1.0, 1.0, 0.0).asDiagonal(), Vec3::Zero()}, 0)}) {  // flat: a sheet
      const auto shape = Shape::build(mesh, {.volume = GetParam()}).value();
      int met = 0;
      for (int i = 0; i < 400; ++i) {
        Vec3 direction = i % 3 == 0 ? Vec3(random.direction()) : Vec3(Vec3::Unit(i % 4 % 3));
        if (i % 3 == 1)
          direction = (direction + std::pow(10.0, -random.uniform(3.0, 12.0)) * random.direction()).normalized();
        const Vec3 through = mesh->vertices()[static_cast<std::size_t>(random.uniform() * 0.999 *
                                                                       static_cast<double>(mesh->vertices().size()))];
        const Vec3 aside = scale * std::pow(10.0, -random.uniform(0.0, 12.0)) * random.direction();
        const Vec3 origin = through + aside - scale * random.uniform(0.0, 50.0) * direction;
        const auto expected = every_triangle(*mesh, origin, direction);
        const auto found = cast_ray(*shape, origin, direction, INFINITY);
        ASSERT_EQ(expected.has_value(), found.has_value()) << scale << " ray " << i;
        if (!expected) continue;
        ASSERT_EQ(*expected, found->distance) << scale << " ray " << i;
        ++met;
      }
      EXPECT_GT(met, 100);
      EXPECT_LT(met, 390);
    }
  }
}

// Through points of edges, which belong to two triangles: one of them is met however far off the ray begins.
TEST_P(Rays, FromAfarPassBetweenNoTrianglesAndSeeNoMoreNodes) {
  const auto mesh = testing::wavy_sphere(60, 0.0);
  const auto shape = Shape::build(mesh, {.volume = GetParam()}).value();
  double nodes_near = 0.0;
  for (const double way : {2.0, 60.0, 70.0, 1e3, 1e4, 1e6, 1e9, 1e12}) {
    math::Random random(5);
    double nodes = 0.0;
    constexpr int rays = 500;
    for (int i = 0; i < rays; ++i) {
      const mesh::Triangle& t = mesh->triangles()[random.below(mesh->triangles().size())];
      const double share = random.uniform();
      const Vec3 on = share * mesh->vertices()[t[0]] + (1.0 - share) * mesh->vertices()[t[1]];
      Vec3 direction = random.direction();
      if (direction.dot(on) > -0.3) direction = -(on + 0.5 * direction).normalized();
      direction *= 1.0 + random.uniform(-4e-7, 4e-7);  // unit, as single precision would have it and more
      RayEffort effort;
      const auto hit = cast_counted_ray(*shape, on - way * direction, direction, INFINITY, {UINT64_MAX}, effort);
      ASSERT_TRUE(hit) << way << " ray " << i;
      const double rounding = 1e-12 + 1e-14 * way;  // of the origin: as far off is where the ray meets the surface
      ASSERT_NEAR(hit->distance, way, 10.0 * rounding) << i;
      ASSERT_FALSE(cast_ray(*shape, on - way * direction, -direction, INFINITY)) << way << " ray " << i;
      ASSERT_FALSE(cast_ray(*shape, on - way * direction, direction, way - 10.0 * rounding)) << way << " ray " << i;
      nodes += static_cast<double>(effort.nodes) / rays;
    }
    if (way == 2.0) nodes_near = nodes;
    EXPECT_LT(nodes, 1.2 * nodes_near) << way;
  }
}

// A deadline that passes at some look ends a ray there, as so many nodes would have; one that never does changes nothing.
TEST_P(Rays, EndWhereALookFindsTheTimeUp) {
  const auto shape = Shape::build(testing::wavy_sphere(40), {.volume = GetParam()}).value();
  math::Random random(3);
  int ended = 0;
  for (int i = 0; i < 200; ++i) {
    const Vec3 origin = 2.0 * random.direction();
    const Vec3 direction = (0.5 * random.direction() - origin).normalized();
    RayEffort whole;
    const auto hit = cast_counted_ray(*shape, origin, direction, 5.0, {UINT64_MAX}, whole);
    ASSERT_TRUE(whole.finished);
    for (int passes_at = 1; passes_at <= 8; ++passes_at) {
      int looks_left = passes_at;
      const Deadline deadline{[](void* left) noexcept { return --*static_cast<int*>(left) == 0; }, &looks_left};
      RayEffort timed;
      const auto seen = cast_counted_ray(*shape, origin, direction, 5.0, {UINT64_MAX, deadline}, timed);
      const std::uint64_t nodes = RayAllowance::between_looks * static_cast<std::uint64_t>(passes_at) - 1;
      RayEffort counted;
      const auto expected = cast_counted_ray(*shape, origin, direction, 5.0, {nodes}, counted);
      ASSERT_EQ(timed.nodes, std::min(nodes, whole.nodes)) << i << " " << passes_at;
      ASSERT_EQ(timed.finished, counted.finished) << i << " " << passes_at;
      ASSERT_EQ(seen ? seen->distance : -1.0, expected ? expected->distance : -1.0) << i << " " << passes_at;
      if (timed.finished) {
        ASSERT_EQ(seen ? seen->distance : -1.0, hit ? hit->distance : -1.0) << i << " " << passes_at;
      }
      ended += timed.finished ? 0 : 1;
    }
  }
  EXPECT_GT(ended, 200);
}

/// Two shapes of one volume, two of which one is of the default's.
TEST_P(Rays, CastTwoAtATimeMeetWhatEachMeets) {
  const auto shape = Shape::build(testing::wavy_sphere(16), {.volume = GetParam()}).value();
  const auto other = Shape::build(testing::wavy_sphere(9, 0.3)).value();
  math::Random random(8);
  int met = 0;
  for (int i = 0; i < 1000; ++i) {
    const std::uint64_t nodes = i % 4 == 0 ? random.below(12) : UINT64_MAX;
    const auto ray = [&random, i](const Shape& of) {
      CountedRay made{of, 1.5 * random.uniform() * random.direction(), random.direction(), random.uniform(0.0, 3.0)};
      if (i % 50 == 0) made.max_distance = INFINITY;
      if (i % 50 == 1 && random.below(2) == 0) made.max_distance = NAN;
      if (i % 50 == 2 && random.below(2) == 0) made.direction *= 2.0;
      if (i % 5 == 3) made.origin -= 1e3 * made.direction;  // from afar
      if (i % 5 == 3) made.max_distance += 1e3;
      return made;
    };
    const CountedRay first = ray(*shape);
    const CountedRay second = ray(i % 2 == 0 ? *shape : *other);
    const auto found = cast_two_rays(first, second, nodes);
    for (std::size_t k = 0; k < 2; ++k) {
      const CountedRay& one = k == 0 ? first : second;
      const auto expected = cast_ray(one.shape, one.origin, one.direction, one.max_distance, nodes);
      ASSERT_EQ(found[k].has_value(), expected.has_value()) << i;
      if (!expected) continue;
      ++met;
      ASSERT_EQ(found[k]->distance, expected->distance) << i;
      ASSERT_EQ(found[k]->triangle, expected->triangle) << i;
    }
  }
  EXPECT_GT(met, 500);
  EXPECT_LT(met, 1800);
}

TEST_P(Rays, RefuseWhatIsNoRay) {
  const auto shape = Shape::build(testing::wavy_sphere(6), {.volume = GetParam()}).value();
  EXPECT_FALSE(cast_ray(*shape, {NAN, 0, 0}, Vec3::UnitX(), 10));
  EXPECT_FALSE(cast_ray(*shape, {0, 0, 0}, {2, 0, 0}, 10));
  EXPECT_FALSE(cast_ray(*shape, {0, 0, 0}, Vec3::UnitX(), NAN));
  EXPECT_FALSE(cast_ray(*shape, {0, 0, 0}, Vec3::UnitX(), -1));
  EXPECT_FALSE(cast_ray(*shape, {0, 0, 0}, Vec3::UnitX(), 10, 0));
}

INSTANTIATE_TEST_SUITE_P(AllVolumes, Rays, ::testing::ValuesIn(testing::all_kinds()),
                         [](const auto& tested) { return std::string(volume::name(tested.param)); });

}  // namespace
}  // namespace odds::query
