// What every bounding volume promises: it encloses, it never calls touching things apart, its volumes are sane.
#include <gtest/gtest.h>

#include <random>

#include "odds/volume/kind.hpp"
#include "support/all_kinds.hpp"

namespace odds::volume {
namespace {

template <class V>
class Volumes : public ::testing::Test {
 protected:
  std::mt19937 generator_{3};
  std::normal_distribution<double> normal_;

  Vec3 vector() { return {normal_(generator_), normal_(generator_), normal_(generator_)}; }
  Mat3 rotation() {
    return Quat(normal_(generator_), normal_(generator_), normal_(generator_), normal_(generator_))
        .normalized()
        .toRotationMatrix();
  }
  std::vector<Vec3> cloud(const Vec3& center, const Vec3& extents, std::size_t size) {
    std::vector<Vec3> points(size);
    for (Vec3& point : points) point = center + vector().cwiseProduct(extents);
    return points;
  }
};

struct VolumeNames {
  template <class>
  static std::string GetName(int i) {
    return testing::name_of(static_cast<Kind>(i));
  }
};
TYPED_TEST_SUITE(Volumes, testing::AllVolumes, VolumeNames);

TYPED_TEST(Volumes, SharedPointsAlwaysOverlap) {
  for (int i = 0; i < 3000; ++i) {
    // Two clouds that share one point, in the pose of the second; sizes from needles to boxes.
    const Vec3 extents_a = this->vector().cwiseAbs() * std::pow(10.0, i % 7 - 5);
    const Vec3 extents_b = this->vector().cwiseAbs() * std::pow(10.0, i % 5 - 4);
    const math::Pose b_in_a{this->rotation(), 0.3 * this->vector()};
    std::vector<Vec3> a = this->cloud(this->vector(), extents_a, 12);
    std::vector<Vec3> b = this->cloud(b_in_a.inverse() * a[3], extents_b, 12);
    b[5] = b_in_a.inverse() * a[3];
    const TypeParam va = TypeParam::fit(a, this->rotation());
    const TypeParam vb = TypeParam::fit(b, this->rotation());
    double reach = b_in_a.translation.norm();
    for (const Vec3& p : a) reach = std::max(reach, p.norm());
    for (const Vec3& p : b) reach = std::max(reach, p.norm());
    ASSERT_TRUE(overlap(va, vb, TypeParam::PreparedPose::make(b_in_a, 2.0 * reach))) << i;
  }
}

TYPED_TEST(Volumes, FarThingsAreApart) {
  for (int i = 0; i < 200; ++i) {
    const TypeParam va = TypeParam::fit(this->cloud(Vec3::Zero(), Vec3::Ones(), 20), this->rotation());
    const TypeParam vb = TypeParam::fit(this->cloud(Vec3::Zero(), Vec3::Ones(), 20), this->rotation());
    EXPECT_FALSE(
        overlap(va, vb, TypeParam::PreparedPose::make({this->rotation(), 40.0 * this->vector().normalized()}, 100.0)));
  }
}

TYPED_TEST(Volumes, CommonVolumeIsWithinBoth) {
  for (int i = 0; i < 1000; ++i) {
    const Vec3 flat(1.0, 0.5, i % 3 == 0 ? 0.0 : 0.2);
    const TypeParam va = TypeParam::fit(this->cloud(Vec3::Zero(), flat, 20), Mat3::Identity());
    const TypeParam vb = TypeParam::fit(this->cloud(Vec3::Zero(), flat, 20), this->rotation());
    const auto pose = TypeParam::PreparedPose::make({this->rotation(), this->vector()}, 20.0);
    const double common = overlap_volume(va, vb, pose);
    EXPECT_GE(common, 0.0);
    EXPECT_GT(va.volume(), 0.0);
    EXPECT_LE(common, va.volume() * (1 + 1e-12));
    EXPECT_LE(common, vb.volume() * (1 + 1e-12));
  }
}

TYPED_TEST(Volumes, CommonVolumeOfOneVolumeWithItselfIsWhole) {
  const TypeParam v = TypeParam::fit(this->cloud(Vec3::Zero(), Vec3(1, 0.5, 0.2), 50), Mat3::Identity());
  EXPECT_NEAR(overlap_volume(v, v, TypeParam::PreparedPose::make({}, 10.0)) / v.volume(), 1.0, 1e-3);
}

TYPED_TEST(Volumes, SegmentsThroughTheirPointsMeetThem) {
  for (int i = 0; i < 2000; ++i) {
    const Vec3 extents = this->vector().cwiseAbs() * std::pow(10.0, i % 6 - 5);
    const std::vector<Vec3> points = this->cloud(this->vector(), extents, 9);
    const TypeParam v = TypeParam::fit(points, this->rotation());
    const Vec3 direction = i % 4 == 0 ? Vec3(Vec3::UnitY()) : this->vector().normalized();
    const Vec3 origin = points[4] - 2.5 * direction;
    double reach = 0.0;
    for (const Vec3& p : points) reach = std::max(reach, p.norm());
    EXPECT_TRUE(met_by(v, RaySegment::make(origin, direction, 2.5, reach))) << i;
    EXPECT_FALSE(met_by(v, RaySegment::make(points[4] + 100.0 * direction, direction, 2.5, reach))) << i;
  }
}

TYPED_TEST(Volumes, APointIsAVolumeToo) {
  const std::vector<Vec3> point(3, Vec3(1, 2, 3));
  const TypeParam v = TypeParam::fit(point, Mat3::Identity());
  EXPECT_TRUE(std::isfinite(v.volume()));
  EXPECT_GT(v.volume(), 0.0);
  EXPECT_TRUE(overlap(v, v, TypeParam::PreparedPose::make({}, 10.0)));
}

TEST(Sphere, LensVolumeIsExact) {
  // Two unit balls at distance 1: 5 pi / 12.
  const Sphere ball{Vec3f::Zero(), 1.0F};
  EXPECT_NEAR(overlap_volume(ball, ball, RelativePose::make({Mat3::Identity(), {1, 0, 0}}, 4.0)), 5.0 * M_PI / 12.0,
              1e-6);
}

TEST(Obb, CommonVolumeOfShiftedCubes) {
  const Obb cube{Vec3f::Zero(), Mat3f::Identity(), Vec3f::Constant(0.5F)};
  EXPECT_NEAR(overlap_volume(cube, cube, RelativePose::make({Mat3::Identity(), {0.5, 0.25, 0}}, 4.0)), 0.375, 1e-4);
}

TEST(Kind, NamesAndKindsAgree) {
  for (std::size_t i = 0; i < kind_names.size(); ++i) {
    EXPECT_EQ(kind_from_name(kind_names[i]), static_cast<Kind>(i));
  }
  for (const auto& [alias, kind] : kind_aliases) EXPECT_EQ(kind_from_name(alias), kind);
  EXPECT_FALSE(kind_from_name("box"));
}

}  // namespace
}  // namespace odds::volume
