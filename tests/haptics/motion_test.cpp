// Scripted motions: velocities are the derivatives of the positions, pieces begin and end at rest.
#include "odds/haptics/motion.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

namespace odds::haptics {
namespace {

Motion motion_of(MotionKind kind) {
  Motion m;
  m.kind = kind;
  m.duration_s = 1.7;
  m.direction = Vec3(1.0, -2.0, 0.5).normalized();
  m.depth_m = 0.012;
  m.rise_s = 0.4;
  m.by_m = Vec3(0.02, -0.01, 0.03);
  m.taps = 3;
  m.amplitude_m = 0.01;
  m.frequency_hz = 2.5;
  m.normal = Vec3(0.2, 0.3, 0.9).normalized();
  m.radius_m = 0.015;
  m.turns = 2.5;
  m.turn_axis = Vec3(0.0, 0.6, 0.8);
  m.turn_rad = 1.1;
  return m;
}

class EveryMotion : public testing::TestWithParam<MotionKind> {};

TEST_P(EveryMotion, VelocityIsTheDerivativeOfThePosition) {
  const Motion m = motion_of(GetParam());
  const double h = 1e-6;
  double fastest = 0.0;
  for (double t = 2 * h; t < m.duration_s - 2 * h; t += 0.0037) {
    const MotionSample before = sample(m, t - h);
    const MotionSample at = sample(m, t);
    const MotionSample after = sample(m, t + h);
    const Vec3 slope = (after.offset_m - before.offset_m) / (2 * h);
    EXPECT_LT((slope - at.velocity_m_per_s).norm(), 1e-8) << "at " << t;
    EXPECT_NEAR((after.turned_rad - before.turned_rad) / (2 * h), at.turn_rate_rad_per_s, 1e-7) << "at " << t;
    fastest = std::max(fastest, at.velocity_m_per_s.norm());
  }
  EXPECT_EQ(fastest > 0.0, GetParam() != MotionKind::hold);
}

TEST_P(EveryMotion, BeginsAndEndsAtRest) {
  const Motion m = motion_of(GetParam());
  EXPECT_LT(sample(m, 0.0).offset_m.norm(), 1e-15);
  for (const double t : {0.0, m.duration_s, m.duration_s + 1.0, -1.0}) {
    EXPECT_LT(sample(m, t).velocity_m_per_s.norm(), 1e-12) << "at " << t;
    EXPECT_LT(std::abs(sample(m, t).turn_rate_rad_per_s), 1e-12) << "at " << t;
  }
  EXPECT_EQ(sample(m, m.duration_s + 5.0).offset_m, sample(m, m.duration_s).offset_m);
}

INSTANTIATE_TEST_SUITE_P(Kinds, EveryMotion,
                         testing::Values(MotionKind::hold, MotionKind::press, MotionKind::slide, MotionKind::tap,
                                         MotionKind::sine, MotionKind::spiral),
                         [](const auto& tested) {
                           return std::string(motion_names[static_cast<std::size_t>(tested.param)]);
                         });

TEST(Motion, PressReachesItsDepthStaysAndComesBack) {
  const Motion m = motion_of(MotionKind::press);
  EXPECT_LT((sample(m, m.rise_s).offset_m - m.depth_m * m.direction).norm(), 1e-12);
  EXPECT_LT((sample(m, m.duration_s - m.rise_s).offset_m - m.depth_m * m.direction).norm(), 1e-12);
  EXPECT_LT(sample(m, m.duration_s).offset_m.norm(), 1e-12);
}

TEST(Motion, SlideArrives) {
  const Motion m = motion_of(MotionKind::slide);
  EXPECT_LT((sample(m, m.duration_s).offset_m - m.by_m).norm(), 1e-15);
}

TEST(Motion, TapTouchesItsDepthAsOftenAsAsked) {
  const Motion m = motion_of(MotionKind::tap);
  int peaks = 0;
  double before = 0.0;
  double last = 0.0;
  for (int i = 1; i <= 1700; ++i) {
    const double depth = sample(m, 0.001 * i).offset_m.dot(m.direction);
    if (last > before && last >= depth && last > 0.99 * m.depth_m) ++peaks;
    EXPECT_LE(depth, m.depth_m * (1 + 1e-12));
    before = last;
    last = depth;
  }
  EXPECT_EQ(peaks, 3);
}

TEST(Motion, SpiralStaysInItsPlaneAndRadius) {
  const Motion m = motion_of(MotionKind::spiral);
  double farthest = 0.0;
  for (double t = 0.0; t < m.duration_s; t += 0.001) {
    const Vec3 offset = sample(m, t).offset_m;
    EXPECT_NEAR(offset.dot(m.normal), 0.0, 1e-15);
    farthest = std::max(farthest, offset.norm());
  }
  EXPECT_NEAR(farthest, m.radius_m, 1e-6);
}

}  // namespace
}  // namespace odds::haptics
