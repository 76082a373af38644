// Intervals, scores of probabilities, poses at their distances, and how answers become figures.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "odds/math/random.hpp"
#include "odds/mesh/made/by_name.hpp"
#include "odds/primitive/triangle_distance.hpp"
#include "odds/report/accuracy/report.hpp"

namespace odds::report {
namespace {

std::shared_ptr<const query::Shape> shape_of(const std::string& name, volume::Kind kind = volume::Kind::wide) {
  auto mesh = std::make_shared<const mesh::TriangleMesh>(mesh::made::make_shape(name).value());
  query::ShapeOptions options;
  options.volume = kind;
  return query::Shape::build(mesh, options).value();
}

TEST(Wilson, AgreesWithPublishedValues) {
  // Newcombe, Statistics in Medicine 17 (1998), table I: score method without continuity correction.
  const auto expect = [](std::uint64_t count, std::uint64_t total, double low, double high) {
    const Interval interval = wilson(count, total);
    EXPECT_NEAR(interval.low, low, 5e-5) << count << " of " << total;
    EXPECT_NEAR(interval.high, high, 5e-5) << count << " of " << total;
  };
  expect(81, 263, 0.2553, 0.3662);
  expect(15, 148, 0.0624, 0.1605);
  expect(0, 20, 0.0, 0.1611);
  expect(1, 29, 0.0061, 0.1718);
}

TEST(Wilson, EndsAreExactAndNothingSeenSaysNothing) {
  EXPECT_EQ(wilson(0, 7).low, 0.0);
  EXPECT_EQ(wilson(7, 7).high, 1.0);
  EXPECT_EQ(wilson(0, 0).low, 0.0);
  EXPECT_EQ(wilson(0, 0).high, 1.0);
  EXPECT_NEAR(wilson(3, 10).low, 1.0 - wilson(7, 10).high, 1e-15);
}

TEST(Forecasts, SmallExampleByHand) {
  // Bins [0.2, 0.3): 0.2, 0.25 with one event; [0.8, 0.9): 0.8, 0.8 with two.
  const std::vector<Forecast> f{{0.2, false}, {0.25, true}, {0.8, true}, {0.8, true}};
  const ForecastQuality q = judge_forecasts(f);
  EXPECT_EQ(q.count, 4u);
  EXPECT_EQ(q.happened, 3u);
  EXPECT_NEAR(q.mean_probability, 2.05 / 4, 1e-15);
  EXPECT_EQ(q.bins[2].count, 2u);
  EXPECT_EQ(q.bins[8].happened, 2u);
  EXPECT_NEAR(q.calibration_error, 0.5 * (0.5 - 0.225) + 0.5 * 0.2, 1e-15);
  EXPECT_NEAR(q.brier, (0.04 + 0.5625 + 0.04 + 0.04) / 4, 1e-15);
  EXPECT_NEAR(q.reliability, 0.5 * 0.275 * 0.275 + 0.5 * 0.04, 1e-15);
  EXPECT_NEAR(q.resolution, 0.0625, 1e-15);
  EXPECT_NEAR(q.uncertainty, 0.1875, 1e-15);
}

TEST(Forecasts, PartsAddUpToTheBrierScore) {
  math::Random random(7);
  for (int run = 0; run < 50; ++run) {
    std::vector<Forecast> f;
    const std::uint64_t count = 1 + random.below(200);
    for (std::uint64_t i = 0; i < count; ++i) {
      const double p = random.uniform();
      f.push_back({p, random.uniform() < p * p});
    }
    f.push_back({1.0, true});  // the last bin's end
    const ForecastQuality q = judge_forecasts(f);
    EXPECT_NEAR(q.brier, q.reliability - q.resolution + q.uncertainty + q.within_bins, 1e-13);
    EXPECT_LE(q.calibration_error * q.calibration_error, q.reliability + 1e-15) << "Jensen";
  }
}

TEST(Forecasts, TrueOddsHaveNoCalibrationErrorAndNoneMeansZeros) {
  std::vector<Forecast> f;
  for (int i = 0; i < 100; ++i) f.push_back({0.25, i % 4 == 0});
  const ForecastQuality q = judge_forecasts(f);
  EXPECT_NEAR(q.calibration_error, 0.0, 1e-12);
  EXPECT_NEAR(q.reliability, 0.0, 1e-12);
  EXPECT_NEAR(q.brier, q.uncertainty, 1e-12);
  EXPECT_EQ(judge_forecasts({}).brier, 0.0);
}

/// By brute force over all pairs of triangles.
double surface_distance(const query::Shape& a, const query::Shape& b, const math::Pose& pose) {
  double least = 1e300;
  const auto corners = [](const mesh::TriangleMesh& mesh, const mesh::Triangle& t, const math::Pose& at, Vec3 out[3]) {
    for (int k = 0; k < 3; ++k) out[k] = at * mesh.vertices()[t[static_cast<std::size_t>(k)]];
  };
  for (const mesh::Triangle& x : a.mesh().triangles()) {
    Vec3 of_x[3];
    corners(a.mesh(), x, {}, of_x);
    for (const mesh::Triangle& y : b.mesh().triangles()) {
      Vec3 of_y[3];
      corners(b.mesh(), y, pose, of_y);
      least = std::min(least, primitive::closest_points(of_x, of_y).squared_distance);
    }
  }
  return std::sqrt(least);
}

TEST(AccuracyPoses, SurfacesStandAtTheStatedDistance) {
  const auto a = shape_of("made:bumpy_sphere:frequency=3");
  const auto b = shape_of("made:torus:around=12,across=6");
  PoseMaker maker = PoseMaker::make(a, b, Procedure::distance, 3).value();
  query::Pair pair = query::Pair::make(a, b).value();
  const auto bands = pose_bands(Procedure::distance);
  for (std::uint64_t i = 0; i < 3 * bands.size(); ++i) {
    const MadePose made = maker.pose(i).value();
    ASSERT_EQ(made.band, i % bands.size());
    ASSERT_EQ(made.offset, bands[made.band].least);
    const bool hit = pair.run(made.pose(), {}).verdict == query::Verdict::hit;
    if (made.offset > 0.0) {
      const double distance = surface_distance(*a, *b, made.pose()) / maker.size();
      EXPECT_GE(distance, made.offset * (1 - 1e-6)) << bands[made.band].name;
      EXPECT_LE(distance, made.offset * 1.002) << bands[made.band].name;
      EXPECT_FALSE(hit);
    } else if (made.offset >= -1e-2) {
      EXPECT_TRUE(hit) << bands[made.band].name;
    }
  }
}

TEST(AccuracyPoses, DependOnSeedAndIndexAlone) {
  const auto a = shape_of("made:box:cells=3");
  for (const Procedure procedure : {Procedure::distance, Procedure::tumbling}) {
    PoseMaker forwards = PoseMaker::make(a, a, procedure, 11).value();
    PoseMaker jumping = PoseMaker::make(a, a, procedure, 11).value();
    PoseMaker other = PoseMaker::make(a, a, procedure, 12).value();
    for (std::uint64_t i = 0; i < 30; ++i) (void)forwards.pose(i);
    for (const std::uint64_t i : {29u, 3u, 17u}) {
      const MadePose one = forwards.pose(i).value();
      const MadePose two = jumping.pose(i).value();
      EXPECT_EQ(one.translation, two.translation);
      EXPECT_EQ(one.rotation.coeffs(), two.rotation.coeffs());
      EXPECT_NE(one.translation, other.pose(i).value().translation);
    }
  }
}

TEST(AccuracyPoses, TumblingTurnsAboutZAndMovesAlongX) {
  const auto a = shape_of("made:gear");
  PoseMaker maker = PoseMaker::make(a, a, Procedure::tumbling, 5).value();
  query::Pair pair = query::Pair::make(a, a).value();
  const auto bands = pose_bands(Procedure::tumbling);
  const Vec3 center = 0.5 * (a->mesh().lower() + a->mesh().upper());
  for (std::uint64_t i = 0; i < 5 * bands.size(); ++i) {
    const MadePose made = maker.pose(i).value();
    EXPECT_EQ(made.rotation.x(), 0.0);
    EXPECT_EQ(made.rotation.y(), 0.0);
    const Vec3 moved = made.pose() * center - center;
    EXPECT_GT(moved.x(), 0.0);
    EXPECT_NEAR(moved.y(), 0.0, 1e-12);
    EXPECT_NEAR(moved.z(), 0.0, 1e-12);
    EXPECT_GE(made.offset, bands[made.band].least);
    EXPECT_LT(made.offset, bands[made.band].greatest);
    EXPECT_TRUE(made.offset <= 0.0 || pair.run(made.pose(), {}).verdict == query::Verdict::clear);
  }
}

TEST(AccuracyFigures, APushThatGrowsStraightGoesNoDetour) {
  Study study;
  study.settings.trials = {{Trial::Kind::work, 64, 1.0}, {Trial::Kind::work, 64, 0.9}, {Trial::Kind::work, 128, 1.0}};
  PoseTruth hit;
  hit.hit = true;
  hit.contacts = 1;
  hit.deepest_contact.normal = Vec3::UnitX();
  hit.deepest_contact.depth = 2.0;
  study.poses = {hit, hit};
  study.samples.assign(3, std::vector<Sample>(2));
  study.samples[0][0].push = Vec3(0.5, 0, 0);
  study.samples[1][0].push = Vec3(0, 99, 0);  // with a threshold: another question
  study.samples[2][0].push = Vec3(1.5, 0, 0);
  study.samples[0][1].push = Vec3(0, 1, 0);  // aside, back, and to the truth: 1 + 1 + 2
  const std::vector<PushSweep> sweeps = push_sweeps(study);
  ASSERT_EQ(sweeps.size(), 1U);
  EXPECT_EQ(sweeps[0].kind, Trial::Kind::work);
  EXPECT_EQ(sweeps[0].count, 2U);
  EXPECT_DOUBLE_EQ(sweeps[0].p50, 1.0);
  EXPECT_DOUBLE_EQ(sweeps[0].p90, 2.0);
}

TEST(AccuracyPoses, NestedBeginInsideAndMoveOutwards) {
  const auto a = shape_of("made:bumpy_sphere:frequency=10");
  const auto b = shape_of("made:bumpy_sphere:frequency=10,scale=0.985");
  PoseMaker maker = PoseMaker::make(a, b, Procedure::nested, 5).value();
  query::Pair pair = query::Pair::make(a, b).value();
  const auto bands = pose_bands(Procedure::nested);
  for (std::uint64_t i = 0; i < 5 * bands.size(); ++i) {
    const MadePose made = maker.pose(i).value();
    EXPECT_LT(made.translation.norm(), 0.1 * maker.size());
    EXPECT_GT(made.rotation.w(), 1.0 - 1e-5);
    EXPECT_EQ(pair.run(made.pose(), {}).verdict == query::Verdict::hit, made.offset < 0.0) << bands[made.band].name;
  }
  EXPECT_FALSE(PoseMaker::make(a, a, Procedure::nested, 5).value().pose(0).ok());  // as large as its room
}

TEST(AccuracyPoses, RefuseOtherEnginesAndBodiesThatNeverMeet) {
  const auto boxes = shape_of("made:box", volume::Kind::obb);
  EXPECT_FALSE(PoseMaker::make(boxes, boxes, Procedure::distance, 1).ok());
}

Study two_poses() {
  Study study;
  study.settings.trials = {{Trial::Kind::work, 64, 1.0}, {Trial::Kind::exact, 0, 1.0}};
  study.settings.size_m = 2.0;
  PoseTruth hit;
  hit.pose.index = 6;
  hit.pose.band = 6;
  hit.hit = true;
  PoseTruth clear;
  clear.pose.index = 0;
  study.poses = {clear, hit};
  Sample right;
  Sample missed;
  missed.basis = query::Basis::budget;
  missed.probability = 0.25;
  Sample proved;
  proved.verdict = query::Verdict::hit;
  proved.probability = 1.0;
  study.samples = {{right, missed}, {right, proved}};
  return study;
}

TEST(AccuracyRows, CountEachKindOfAnswer) {
  const Study study = two_poses();
  const auto rows = accuracy_rows(study);
  ASSERT_EQ(rows.size(), 10u);  // 2 limits, each: all, 2 groups, 2 bands
  EXPECT_EQ(rows[0].scope, "all");
  EXPECT_EQ(rows[0].poses, 2u);
  EXPECT_EQ(rows[0].hits, 1u);
  EXPECT_EQ(rows[0].proved, 1u);
  EXPECT_EQ(rows[0].at_budget, 1u);
  EXPECT_EQ(rows[0].false_misses, 1u);
  EXPECT_EQ(rows[0].false_hits, 0u);
  EXPECT_EQ(rows[0].unproved.count, 1u) << "proofs state no probability that could be wrong";
  EXPECT_NEAR(rows[0].brier_all, 0.5 * 0.5625, 1e-15);
  EXPECT_EQ(rows[5].wrong(), 0u);
}

TEST(AccuracyRows, TheWorstPoseIsTheOneThatWasWrong) {
  const auto worst = worst_poses(two_poses(), 20);
  ASSERT_EQ(worst.size(), 1u);
  EXPECT_EQ(worst[0].pose, 1u);
  EXPECT_EQ(worst[0].trial, 0u);
  EXPECT_NEAR(worst[0].error, 0.5625, 1e-15);
}

/// Two boxes with edges of 1 m; B is 0.9 m from A along x and 0.5 m along y.
ContactRegion region_of_boxes(const query::Shape& box, query::Pair& pair) {
  const math::Pose pose{Mat3::Identity(), {0.9, 0.5, 0.01}};
  EXPECT_EQ(pair.run(pose, {.method = query::Method::exact, .max_contacts = 8}).verdict, query::Verdict::hit);
  return {box, box, pose, pair.crossings()};
}

// The note of the first shard, of a quiet machine, told that the machine was fit where times were called inconclusive.
TEST(AccuracyMerge, TellsWhyAMachineWasUnfit) {
  std::vector<Study> shards(3);
  for (std::uint64_t i = 0; i < shards.size(); ++i) {
    shards[i].settings.poses_per_band = 0;
    shards[i].shard = {i, shards.size()};
    shards[i].machine_fit = i == 0;
    shards[i].machine_note = i == 0 ? "fit" : "unfit " + std::to_string(i);
  }
  const Result<Study> merged = merge_studies(shards, {"a", "b", "c"});
  ASSERT_TRUE(merged.ok());
  EXPECT_FALSE(merged.value().machine_fit);
  EXPECT_EQ(merged.value().machine_note, "unfit 1");
  for (Study& shard : shards) shard.machine_fit = true;
  EXPECT_EQ(merge_studies(shards, {"a", "b", "c"}).value().machine_note, "fit");
}

TEST(ContactRegions, AreTheSpaceThatBothFillAndTheCurvesAroundIt) {
  const auto box = shape_of("made:box:x=1,y=1,z=1,cells=4");
  query::Pair pair = query::Pair::make(box, box).value();
  const ContactRegion region = region_of_boxes(*box, pair);
  EXPECT_EQ(region.distance({0.45, 0.25, 0.0}), 0.0);          // within 0.4 .. 0.5, 0 .. 0.5
  EXPECT_NEAR(region.distance({0.5, 0.0, 0.3}), 0.0, 1e-12);   // on a curve
  EXPECT_NEAR(region.distance({0.5, -0.2, 0.3}), 0.2, 1e-12);  // outside B, below the curve y = 0 in A's face
  EXPECT_NEAR(region.distance({3.5, 0.0, 0.3}), 3.0, 1e-12);
}

TEST(ContactRegions, OfNothingAreInfinitelyFar) {
  const auto box = shape_of("made:box:x=1,y=1,z=1,cells=1");
  const ContactRegion region(*box, *box, {Mat3::Identity(), {3.0, 0.0, 0.0}}, {});
  EXPECT_EQ(region.distance({1.5, 0.0, 0.0}), std::numeric_limits<double>::infinity());
}

TEST(AccuracyRows, ContactsAreComparedWithTheNearest) {
  const auto box = shape_of("made:box:x=1,y=1,z=1,cells=4");
  query::Pair pair = query::Pair::make(box, box).value();
  const ContactRegion region = region_of_boxes(*box, pair);
  query::Contact far;
  far.position = {5, 0, 0};
  query::Contact near;
  near.position = {1, 0, 0};
  near.normal = Vec3::UnitX();
  near.depth = 0.5;
  query::Contact given;
  given.position = {1.5, 0.0, 0.3};
  given.normal = Vec3::UnitY();
  given.depth = 0.1;
  const ContactError error = contact_error(given, std::vector<query::Contact>{far, near}, region, 2.0);
  EXPECT_NEAR(error.position, 0.5, 1e-12);
  EXPECT_NEAR(error.normal_deg, 90.0, 1e-12);
  EXPECT_NEAR(error.depth, 0.2, 1e-15);
}

}  // namespace
}  // namespace odds::report
