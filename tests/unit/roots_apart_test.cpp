// Bodies whose own boxes are apart, though boxes along the world's axes are not: no search is needed.
#include <gtest/gtest.h>

#include <memory>

#include "odds/math/random.hpp"
#include "odds/mesh/made/box.hpp"
#include "odds/query/pair.hpp"

namespace odds::query {
namespace {

std::shared_ptr<const Shape> rod(const Vec3& sides, volume::Kind kind = volume::Kind::wide) {
  auto mesh = mesh::made::make(mesh::made::Box{.x = sides.x(), .y = sides.y(), .z = sides.z(), .cells = 3}).value();
  return Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(mesh)), {.volume = kind}).value();
}

// Two rods along x, tilted out of the plane either way and crossed: only the axis across both of their edges parts
// them.
TEST(RootsApart, AreTheWholeAnswerOfCrossedRods) {
  const auto a = rod({2.0, 0.1, 0.1});
  Pair pair = Pair::make(a, a).value();
  const Mat3 turned =
      (Eigen::AngleAxisd(1.0, Vec3::UnitZ()) * Eigen::AngleAxisd(0.785, Vec3::UnitX())).toRotationMatrix();
  const auto at = [&](double height) { return math::Pose{turned, Vec3(0.01, 0.02, height)}; };
  for (const bool exchanged : {false, true}) {
    const auto run = [&](double height) { return pair.run(exchanged ? at(height).inverse() : at(height), {}); };
    const Answer clear = run(0.13);
    EXPECT_EQ(clear.verdict, Verdict::clear);
    EXPECT_EQ(clear.basis, Basis::proved);
    EXPECT_EQ(clear.cost.node_pairs, 0U);
    EXPECT_EQ(run(0.11).verdict, Verdict::hit);
  }
}

// Also of rotations that are only just ones, and of rods that just touch.
TEST(RootsApart, AreNeverSaidOfRodsThatMeet) {
  math::Random random(5, 1);
  for (int body = 0; body < 6; ++body) {
    const auto side = [&random] { return std::pow(10.0, -2.0 + 2.0 * random.uniform()); };
    const Vec3 of_a(side(), side(), side());
    const Vec3 of_b(side(), side(), side());
    Pair wide = Pair::make(rod(of_a), rod(of_b)).value();
    Pair plain = Pair::make(rod(of_a, volume::Kind::aabb), rod(of_b, volume::Kind::aabb)).value();
    int without_search = 0;
    int hits = 0;
    for (int i = 0; i < 1500; ++i) {
      math::Pose pose;
      pose.rotation = Quat(Eigen::AngleAxisd(6.3 * random.uniform(), random.direction())).toRotationMatrix() *
                      (1.0 + 4e-7 * (random.uniform() - 0.5));
      const Vec3 way = random.direction();
      // Near the first touch along a line: bisection, then a trifle to either side.
      double near = 0.0;
      double far = 4.0;
      for (int k = 0; k < 30; ++k) {
        pose.translation = 0.5 * (near + far) * way;
        (plain.run(pose, {}).verdict == Verdict::hit ? near : far) = 0.5 * (near + far);
      }
      pose.translation = (near + (random.uniform() - 0.5) * std::pow(10.0, -9.0 * random.uniform())) * way;
      const Answer truth = plain.run(pose, {});
      const Answer answer = wide.run(pose, {});
      ASSERT_EQ(answer.verdict, truth.verdict) << body << ' ' << i;
      hits += truth.verdict == Verdict::hit ? 1 : 0;
      without_search += answer.cost.node_pairs == 0 && answer.verdict == Verdict::clear ? 1 : 0;
    }
    EXPECT_GT(hits, 300);
    EXPECT_GT(without_search, 300);
  }
}

}  // namespace
}  // namespace odds::query
