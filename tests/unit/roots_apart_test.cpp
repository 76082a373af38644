// Bodies whose own boxes are apart, though boxes along the world's axes are not: no search is needed.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "odds/math/random.hpp"
#include "odds/mesh/made/box.hpp"
#include "odds/query/pair.hpp"
#include "query/shape_data.hpp"
#include "query/wide/encounter.hpp"

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

/// How far two boxes about their origins are apart along the best of the fifteen axes, metres: negative if along none.
/// Those across two edges are no longer than 1. `by_face`: along the best of the faces' own.
double widest_gap(const Vec3& half_a, const Vec3& half_b, const math::Pose& b_in_a, double& by_face) {
  double widest = -1e300;
  const auto look_along = [&](const Vec3& axis) {
    const double reach = half_a.dot(axis.cwiseAbs()) + half_b.dot((b_in_a.rotation.transpose() * axis).cwiseAbs());
    widest = std::max(widest, std::abs(axis.dot(b_in_a.translation)) - reach);
  };
  for (int i = 0; i < 3; ++i) {
    look_along(Vec3::Unit(i));
    look_along(b_in_a.rotation.col(i));
  }
  by_face = widest;
  for (int k = 0; k < 9; ++k) look_along(Vec3::Unit(k / 3).cross(b_in_a.rotation.col(k % 3)));
  return widest;
}

// Along every axis.
TEST(RootsApart, AreSaidWhereverThereIsAGap) {
  math::Random random(7, 1);
  const std::array<Vec3, 3> sides = {Vec3(1.0, 0.8, 1.2), Vec3(2.0, 0.3, 0.05), Vec3(0.1, 0.2, 3.0)};
  const std::array shapes = {rod(sides[0]), rod(sides[1]), rod(sides[2])};
  const auto tree = [](const Shape& shape) -> const auto& { return std::get<tree::WideTree>(shape.data().tree); };
  int said = 0;
  int by_edges = 0;
  constexpr int poses = 30'000;
  for (std::size_t k = 0; k < poses; ++k) {
    math::Pose pose;
    const double distance = 1.5 * random.uniform();
    pose.translation = distance * random.direction();
    const double angle = k % 5 != 0 ? 6.3 * random.uniform() : 0.0;
    pose.rotation = Quat(Eigen::AngleAxisd(angle, random.direction())).toRotationMatrix();
    const std::size_t i = k % 3;
    const std::size_t j = k / 3 % 3;
    double by_face = 0.0;
    const double gap = widest_gap(0.5 * sides[i], 0.5 * sides[j], pose, by_face);
    if (std::abs(gap - 2e-4) <= 2e-4) continue;
    EXPECT_EQ(wide::Encounter::are_roots_apart(tree(*shapes[i]), tree(*shapes[j]), pose), gap > 0.0)
        << k << ": " << gap;
    if (gap > 0.0) ++said;
    if (gap > 0.0 && by_face < 0.0) ++by_edges;
  }
  EXPECT_GT(said, poses / 4);
  EXPECT_LT(said, poses * 3 / 4);
  EXPECT_GT(by_edges, 100);
}

}  // namespace
}  // namespace odds::query
