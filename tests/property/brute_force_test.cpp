// Searches against every triangle with every triangle: other places, scales, orders of arguments and of triangles.
#include <gtest/gtest.h>

#include <numbers>

#include "odds/query/pair.hpp"
#include "support/all_kinds.hpp"
#include "support/brute_force.hpp"
#include "support/by_queue.hpp"
#include "support/near_poses.hpp"
#include "support/shapes.hpp"

namespace odds::query {
namespace {

/// All orders of search.
constexpr Request requests[] = {
    {.method = Method::exact}, {.method = Method::time_critical}, {.method = Method::incremental}, testing::by_queue()};

using Mesh = std::shared_ptr<const mesh::TriangleMesh>;

Mesh changed(const mesh::TriangleMesh& mesh, double scale, const Vec3& offset, std::size_t rotate_triangles) {
  return testing::changed(mesh, scale, {Mat3::Identity(), offset}, rotate_triangles);
}

Pair pair_of(const Mesh& a, const Mesh& b, volume::Kind kind) {
  return std::move(Pair::make(Shape::build(a, {.volume = kind}).value(), Shape::build(b, {.volume = kind}).value()))
      .value();
}

class AgainstBruteForce : public ::testing::TestWithParam<volume::Kind> {
 protected:
  Mesh a_ = testing::wavy_sphere(8, 0.3);
  Mesh b_ = testing::wavy_sphere(6, 0.2);
  math::Random random_{42};

  /// Where to look may come from a search: what is right there is decided by brute force.
  Pair finder_ = pair_of(a_, b_, volume::Kind::aabb);

  testing::TouchingPose touching() {
    return testing::touching_pose(random_, Vec3::Zero(), Vec3::Zero(), 3.0, [&](const math::Pose& pose) {
      return finder_.run(pose, {.method = Method::exact}).verdict == Verdict::hit;
    });
  }
};

TEST_P(AgainstBruteForce, AgreesInEveryBandAndBothOrders) {
  Pair ab = pair_of(a_, b_, GetParam());
  Pair ba = pair_of(b_, a_, GetParam());
  int hits = 0;
  int queries = 0;
  for (int i = 0; i < 16; ++i) {
    const auto start = touching();
    for (const double band : {0.1, 1e-3, 1e-6, 1e-9, -1e-9, -1e-6, -1e-3, -0.1}) {
      math::Pose pose = start.pose;
      pose.translation += band * start.direction;
      const bool expected = testing::brute_force(*a_, *b_, pose);
      ++queries;
      hits += expected ? 1 : 0;
      for (const Request& request : requests) {
        ASSERT_EQ(ab.run(pose, request).verdict == Verdict::hit, expected) << i << " " << band;
        ASSERT_EQ(ba.run(pose.inverse(), request).verdict == Verdict::hit, expected) << i << " " << band;
      }
    }
  }
  EXPECT_GT(hits, queries / 4);
  EXPECT_LT(hits, queries * 3 / 4);
}

TEST_P(AgainstBruteForce, NothingChangesWithScaleOrOrderOfTriangles) {
  for (const double scale : {0x1p-140, 0x1p-100, 0x1p-40, 1.0, 0x1p40, 0x1p48}) {
    const Mesh big_a = changed(*a_, scale, Vec3::Zero(), 17);
    const Mesh big_b = changed(*b_, scale, Vec3::Zero(), 5);
    Pair pair = pair_of(big_a, big_b, GetParam());
    for (int i = 0; i < 10; ++i) {
      const auto start = touching();
      for (const double band : {1e-7, -1e-7}) {
        math::Pose pose = start.pose;
        pose.translation += band * start.direction;
        const bool expected = testing::brute_force(*a_, *b_, pose);
        pose.translation *= scale;
        for (const Request& request : requests) {
          ASSERT_EQ(pair.run(pose, request).verdict == Verdict::hit, expected) << scale << " " << band;
        }
      }
    }
  }
}

TEST_P(AgainstBruteForce, NoContactIsMissedFarFromTheOrigin) {
  // Coordinates of a map: 4.7e6 m away, where single precision resolves half a metre.
  const Vec3 offset_a(659531.25, 4751300.5, 809.0);
  const Vec3 offset_b(-312345.75, 100.5, 7e6);
  const Mesh far_a = changed(*a_, 1.0, offset_a, 0);
  const Mesh far_b = changed(*b_, 1.0, offset_b, 0);
  Pair pair = pair_of(far_a, far_b, GetParam());
  for (int i = 0; i < 10; ++i) {
    const auto start = touching();
    for (const double band : {1e-5, -1e-5}) {  // rounding of such coordinates is about 1e-9 m, of the rotation 1e-9 m
      math::Pose pose = start.pose;
      pose.translation += band * start.direction;
      const bool expected = testing::brute_force(*a_, *b_, pose);
      pose.translation += offset_a - pose.rotation * offset_b;
      for (const Request& request : requests) {
        ASSERT_EQ(pair.run(pose, request).verdict == Verdict::hit, expected) << i << " " << band;
      }
    }
  }
}

TEST_P(AgainstBruteForce, NoContactIsMissedAtThePoseThatIsOnlyJustRigid) {
  // Corner against corner, as far out as both bodies reach: B is longer there by half of what a pose may be off.
  const auto box = std::make_shared<const mesh::TriangleMesh>(
      std::move(mesh::TriangleMesh::make({{1, 1, 1}, {-1, -1, -1}, {-1, 1, -1}, {1, -1, -1}},
                                         {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}}))
          .value());
  Pair pair = pair_of(box, box, GetParam());
  const Vec3 corner(1, 1, 1);
  for (const double stretch : {4.9e-7, 1e-7, 0.0, -4.9e-7}) {
    math::Pose pose;
    pose.rotation =
        (1.0 + stretch) * Eigen::AngleAxisd(std::numbers::pi, Vec3(1, -1, 0).normalized()).toRotationMatrix();
    for (const double gap : {-4e-7, -2e-7, -1e-8, 1e-8, 2e-7, 6e-7}) {
      pose.translation = (1.0 + gap) * corner - pose.rotation * corner;
      const bool expected = testing::brute_force(*box, *box, pose);
      for (const Request& request : requests) {
        const Answer& answer = pair.run(pose, request);
        ASSERT_EQ(answer.verdict == Verdict::hit, expected) << stretch << " " << gap;
        ASSERT_EQ(answer.basis, Basis::proved);
      }
      if (!expected) continue;
      if (GetParam() == volume::Kind::wide) {
        ASSERT_EQ(pair.distance(pose).upper, 0.0);
      }
      ASSERT_EQ(pair.distance(pose, {.budget = Budget::work(1)}).lower, 0.0);
    }
  }
}

TEST_P(AgainstBruteForce, MoreBudgetNeverUndoesAProof) {
  Pair pair = pair_of(a_, b_, GetParam());
  for (int i = 0; i < 10; ++i) {
    auto start = touching();
    start.pose.translation -= 1e-4 * start.direction;
    bool proved = false;
    for (std::uint64_t units = 1; units <= 4096; units *= 2) {
      const Answer& answer = pair.run(start.pose, {.method = Method::time_critical, .budget = Budget::work(units)});
      EXPECT_FALSE(proved && answer.basis != Basis::proved);
      if (answer.basis == Basis::proved) {
        EXPECT_EQ(answer.verdict, Verdict::hit);
        proved = true;
      }
    }
    EXPECT_TRUE(proved);
  }
}

INSTANTIATE_TEST_SUITE_P(AllVolumes, AgainstBruteForce, ::testing::ValuesIn(testing::all_kinds()),
                         [](const auto& tested) { return std::string(volume::name(tested.param)); });

}  // namespace
}  // namespace odds::query
