// Figures of runs whose differences are known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

#include "odds/report/force_comparison.hpp"
#include "support/temporary_folder.hpp"

namespace odds::report {
namespace {

constexpr double rate_hz = 1000.0;

/// A slow swing between 1 and 3 N along z, in contact throughout; `extra` is added.
template <class Extra>
std::vector<ForceSample> swing(const Extra& extra) {
  std::vector<ForceSample> samples;
  for (int i = 0; i < 4000; ++i) {
    const double t = i / rate_hz;
    samples.push_back({t, Vec3(0, 0, 2.0 + std::sin(2.0 * std::numbers::pi * t)) + extra(t), 1});
  }
  return samples;
}

Vec3 nothing(double) { return Vec3::Zero(); }

TEST(ForceComparison, ARunIsLikeItself) {
  const auto exact = swing(nothing);
  const ForceDifference d = compare_forces(exact, exact, 0.05, rate_hz);
  EXPECT_EQ(d.ticks, 4000U);
  EXPECT_NEAR(d.mean_force_n, 2.0, 1e-3);
  EXPECT_EQ(d.error_p95, 0.0);
  EXPECT_LT(d.angle_p95_deg, 1e-9);
  EXPECT_EQ(d.added_noise_share, 0.0);
  EXPECT_EQ(d.onsets, 1U);
  EXPECT_EQ(d.onsets_missed, 0U);
  ASSERT_TRUE(d.onset_p99_ticks);
  EXPECT_EQ(*d.onset_p99_ticks, 0.0);
}

TEST(ForceComparison, NoiseCountsAbove50HzOnly) {
  const auto exact = swing(nothing);
  const auto with = [&](double frequency_hz) {
    const auto run =
        swing([&](double t) { return Vec3(0.1 * std::sin(2.0 * std::numbers::pi * frequency_hz * t), 0, 0); });
    return compare_forces(exact, run, 0.05, rate_hz).added_noise_share;
  };
  const double whole = 0.1 / std::numbers::sqrt2 / 2.0;  // of the mean force
  EXPECT_NEAR(with(200.0) / whole, 1.0, 0.02);
  EXPECT_NEAR(with(400.0) / whole, 1.0, 0.02);
  EXPECT_NEAR(with(50.0) / whole, 1.0 / std::numbers::sqrt2, 0.05);
  EXPECT_LT(with(10.0) / whole, 0.06);
}

TEST(ForceComparison, ErrorsAreSharesAndAngles) {
  const auto exact = swing(nothing);
  auto run = exact;
  for (ForceSample& sample : run) {
    sample.force_n = 1.1 * (Eigen::AngleAxisd(0.1, Vec3::UnitX()) * sample.force_n);
  }
  const ForceDifference d = compare_forces(exact, run, 0.05, rate_hz);
  EXPECT_NEAR(d.error_p50, 0.1, 1e-9);
  EXPECT_NEAR(d.error_p95, 0.1, 1e-9);
  EXPECT_NEAR(d.angle_p95_deg, 0.1 * 180.0 / std::numbers::pi, 1e-6);
  run[10].force_n.setZero();
  EXPECT_LT(compare_forces(exact, run, 0.05, rate_hz).error_p95, 0.11);
  EXPECT_EQ(compare_forces(exact, run, 100.0, rate_hz).ticks, 0U);
  EXPECT_EQ(compare_forces({}, {}, 0.05, rate_hz).ticks, 0U);
}

TEST(ForceComparison, OnsetsAreFoundLateEarlyOrNotAtAll) {
  const auto taps = [](int shift, bool last) {
    std::vector<ForceSample> samples(1000);
    for (int tap = 0; tap < (last ? 5 : 4); ++tap) {
      for (int i = 0; i < 50; ++i) samples[static_cast<std::size_t>(100 + 150 * tap + shift + i)].contacts = 1;
    }
    return samples;
  };
  EXPECT_EQ(*compare_forces(taps(0, true), taps(3, true), 0.05, rate_hz).onset_p99_ticks, 3.0);
  EXPECT_EQ(*compare_forces(taps(0, true), taps(-2, true), 0.05, rate_hz).onset_p99_ticks, 2.0);
  const ForceDifference missed = compare_forces(taps(0, true), taps(0, false), 0.05, rate_hz);
  EXPECT_EQ(missed.onsets, 5U);
  EXPECT_EQ(missed.onsets_missed, 1U);
}

TEST(ForceComparison, TicksWithoutContactCountFromTheSecondInARowOn) {
  const auto exact = swing(nothing);
  auto run = exact;
  for (const std::size_t at : {10UL, 20UL, 21UL, 30UL, 31UL, 32UL}) run[at].contacts = 0;
  EXPECT_EQ(compare_forces(exact, run, 0.05, rate_hz).missed_in_row, 3U);
  EXPECT_EQ(compare_forces(exact, run, 100.0, rate_hz).missed_in_row, 0U);
  auto free = exact;  // a hand that moves its tool through the air feels it
  for (ForceSample& sample : free) sample.contacts = 0;
  EXPECT_EQ(compare_forces(free, free, 0.05, rate_hz).missed_in_row, 0U);
}

TEST(ForceComparison, AForceWhereNothingTouchesIsSeen) {
  std::vector<ForceSample> exact(100);
  for (std::size_t i = 50; i < 100; ++i) exact[i].force_n = Vec3(0, 0, 1);
  auto run = exact;
  run[10].force_n = Vec3(0, 0.3, 0);
  run[60].force_n = Vec3(0, 9, 0);
  EXPECT_DOUBLE_EQ(compare_forces(exact, run, 0.05, rate_hz).largest_false_n, 0.3);
}

TEST(ForceComparison, ThePageShowsEveryRunAndEscapesNames) {
  testing::TemporaryFolder folder;
  Comparison comparison;
  comparison.scene = "<script>x</script>";
  for (const char* name : {"no limit", "20 us", "<b>"}) {
    ComparedRun run;
    run.name = name;
    run.samples = swing(nothing);
    run.difference = compare_forces(run.samples, run.samples, 0.05, rate_hz);
    if (!comparison.runs.empty()) run.at_same_poses = run.difference;
    if (run.name != "20 us") run.proved_share = 0.25;  // in that there was no query
    comparison.runs.push_back(std::move(run));
  }
  ASSERT_FALSE(write_comparison(folder.path(), comparison));
  const std::string page = testing::contents_of(folder / "comparison.html");
  EXPECT_EQ(page.find("<script>x"), std::string::npos);
  EXPECT_EQ(page.find("<b>"), std::string::npos);
  std::size_t pictures = 0;
  for (std::size_t at = page.find("<svg"); at != std::string::npos; at = page.find("<svg", at + 1)) ++pictures;
  EXPECT_EQ(pictures, 3U);
  EXPECT_NE(page.find("At the poses of the exact run"), std::string::npos);
  EXPECT_NE(page.find("4,000 ticks with a force of at least 0.05 N"), std::string::npos);
  const std::string csv = testing::contents_of(folder / "comparison.csv");
  EXPECT_EQ(csv.find("run,poses,proved_share"), 0U);
  EXPECT_NE(csv.find("\nno limit,own,0.25,"), std::string::npos);
  EXPECT_NE(csv.find("\n20 us,own,,"), std::string::npos) << "nothing was proved where nothing was asked";
  const auto columns = [](const std::string& line) { return std::count(line.begin(), line.end(), ','); };
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  const auto wanted = columns(line);
  int rows = 0;
  for (; std::getline(lines, line); ++rows) EXPECT_EQ(columns(line), wanted) << line;
  EXPECT_EQ(rows, 5);
  EXPECT_TRUE(write_comparison(folder.path(), {}));
}

}  // namespace
}  // namespace odds::report
