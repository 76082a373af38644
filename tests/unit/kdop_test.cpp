// k-DOPs: the blends that turn them, and what they separate that boxes do not.
#include "odds/volume/kdop.hpp"

#include <gtest/gtest.h>

#include "odds/math/random.hpp"
#include "odds/volume/aabb.hpp"

namespace odds::volume {
namespace {

template <class V>
class Kdops : public ::testing::Test {};
using AllKdops = ::testing::Types<Kdop14, Kdop18, Kdop26>;
TYPED_TEST_SUITE(Kdops, AllKdops);

template <int K>
void expect_blend_of(const Vec3& direction) {
  const SlabBlend blend = blend_of<K>(direction, 0.0);
  Vec3 sum = Vec3::Zero();
  double length = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const SlabNormal& n = Kdop<K>::normals[blend.slab[i]];
    const Vec3 part = static_cast<double>(blend.weight[i]) * Vec3(n[0], n[1], n[2]);
    sum += part;
    length += part.norm();
  }
  EXPECT_LT((sum - direction).norm(), 1e-6 * direction.norm());
  EXPECT_LT(length, 1.3 * direction.norm()) << "the margin counts on it: " << direction.transpose();
}

TYPED_TEST(Kdops, EveryDirectionIsABlendOfThreeNearbyNormals) {
  constexpr int k = 2 * static_cast<int>(TypeParam::slabs);
  math::Random random(5);
  for (int i = 0; i < 20000; ++i) expect_blend_of<k>(std::pow(3.0, i % 3 - 1) * random.direction());
  for (const SlabNormal& n : slab_normals<26>()) {  // ties and zeros among the components, of either sign
    expect_blend_of<k>(Vec3(n[0], n[1], n[2]));
    expect_blend_of<k>(-Vec3(n[0], n[1], n[2]));
  }
}

TYPED_TEST(Kdops, OwnNormalsAreBlendsOfThemselves) {
  constexpr int k = 2 * static_cast<int>(TypeParam::slabs);
  for (std::size_t i = 0; i < TypeParam::slabs; ++i) {
    const SlabNormal& n = TypeParam::normals[i];
    const SlabBlend blend = blend_of<k>(Vec3(n[0], n[1], n[2]), 0.0);
    for (std::size_t j = 0; j < 3; ++j) {
      EXPECT_EQ(blend.weight[j], blend.slab[j] == i ? 1.0F : 0.0F) << "unturned DOPs lose nothing";
    }
  }
}

std::vector<Vec3> ball(math::Random& random, std::size_t size) {
  std::vector<Vec3> points(size);
  for (Vec3& point : points) point = random.direction();
  return points;
}

TYPED_TEST(Kdops, SeparateMoreBallsThanBoxesDo) {
  math::Random random(6);
  const std::vector<Vec3> points = ball(random, 500);
  const TypeParam dop = TypeParam::fit(points, Mat3::Identity());
  const Aabb box = Aabb::fit(points, Mat3::Identity());
  int by_dops = 0;
  int by_boxes = 0;
  constexpr int poses = 1000;
  for (int i = 0; i < poses; ++i) {
    const math::Pose b_in_a{random.rotation().toRotationMatrix(), 2.5 * random.direction()};
    by_dops += overlap(dop, dop, TypeParam::PreparedPose::make(b_in_a, 8.0)) ? 0 : 1;
    by_boxes += overlap(box, box, RelativePose::make(b_in_a, 8.0)) ? 0 : 1;
  }
  EXPECT_GT(by_dops, poses / 2);
  EXPECT_GT(by_dops, by_boxes + poses / 10) << "else slabs cost without a gain";
}

TYPED_TEST(Kdops, VolumeOfABallIsBetweenTheBallsAndTheBoxs) {
  math::Random random(7);
  const TypeParam dop = TypeParam::fit(ball(random, 5000), Mat3::Identity());
  EXPECT_GT(dop.volume(), 4.0 / 3.0 * M_PI);
  EXPECT_LT(dop.volume(), 0.9 * 8.0);
}

TEST(Kdop14, VolumeOfAnOctahedronIsASixthOfItsBox) {
  const std::vector<Vec3> points = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  EXPECT_NEAR(Kdop14::fit(points, Mat3::Identity()).volume() / 8.0, 1.0 / 6.0, 0.03);
  EXPECT_NEAR(Kdop14::fit(points, Mat3::Identity()).volume() / Kdop26::fit(points, Mat3::Identity()).volume(), 1.0,
              1e-6);
}

}  // namespace
}  // namespace odds::volume
