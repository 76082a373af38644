// The safety stages: what leaves them is finite and within the limits, whatever went in.
#include "odds/haptics/safety.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>

namespace odds::haptics {
namespace {

constexpr double dt = 0.001;

DeviceCommand command(const Vec3& force, const Vec3& torque = Vec3::Zero()) { return {0, force, torque, 0}; }

TEST(Safety, LeavesAHarmlessForceAlone) {
  Safety safety({.max_force_n = 5.0, .max_torque_nm = 1.0});
  DeviceCommand c = command({1, 2, 3}, {0.1, 0, 0});
  safety.apply(c, dt, 0.0);
  EXPECT_EQ(c.force_n, Vec3(1, 2, 3));
  EXPECT_EQ(c.torque_nm, Vec3(0.1, 0, 0));
  EXPECT_EQ(c.flags, 0U);
}

TEST(Safety, ClampsTheMagnitudeAndKeepsTheDirection) {
  Safety safety({.max_force_n = 5.0, .max_torque_nm = 0.5});
  DeviceCommand c = command({30, 0, -40}, {0, 2, 0});
  safety.apply(c, dt, 0.0);
  EXPECT_LT((c.force_n - Vec3(3, 0, -4)).norm(), 1e-12);
  EXPECT_LT((c.torque_nm - Vec3(0, 0.5, 0)).norm(), 1e-12);
  EXPECT_EQ(c.flags, unsigned{safety_force_clamped | safety_torque_clamped});
}

// Rounding carried some beyond the limit, by parts in 1e16.
RC_GTEST_PROP(Safety, LeavesNothingBeyondTheLimit, ()) {
  const auto part = [] { return 1e-3 * *rc::gen::inRange(-1000000, 1000000); };
  const double limit = 1e-3 * *rc::gen::inRange(1, 20000);
  Safety safety({.max_force_n = limit, .max_torque_nm = limit});
  for (int i = 0; i < 20; ++i) {
    DeviceCommand c = command({part(), part(), part()}, {part(), part(), part()});
    safety.apply(c, dt, 0.0);
    RC_ASSERT(c.force_n.norm() <= limit);
    RC_ASSERT(c.torque_nm.norm() <= limit);
  }
}

TEST(Safety, LimitsTheChangePerSecond) {
  Safety safety({.max_force_slew_n_per_s = 500.0});
  for (int i = 1; i <= 10; ++i) {
    DeviceCommand c = command({0, 0, 3});
    safety.apply(c, dt, 0.0);
    EXPECT_NEAR(c.force_n.z(), std::min(3.0, 0.5 * i), 1e-12);
    EXPECT_EQ((c.flags & safety_force_slewed) != 0, i < 6) << i;
  }
  EXPECT_EQ(safety.counts().force_slewed, 5U);
}

TEST(Safety, RisesGentlyAfterTheStart) {
  Safety safety({.rise_s = 0.01});
  for (int i = 1; i <= 12; ++i) {
    DeviceCommand c = command({4, 0, 0});
    safety.apply(c, dt, 0.0);
    EXPECT_NEAR(c.force_n.x(), 4.0 * std::min(1.0, 0.1 * i), 1e-9) << i;
  }
  EXPECT_EQ(safety.counts().force_rise, 9U);
}

TEST(Safety, ReplacesWhatIsNotFiniteAndLatchesAFaultIfItStays) {
  Safety safety({.faulty_ticks = 3});
  for (int i = 1; i <= 4; ++i) {
    DeviceCommand c = command({std::nan(""), 0, 0}, {0, std::numeric_limits<double>::infinity(), 0});
    safety.apply(c, dt, 0.0);
    EXPECT_EQ(c.force_n.norm() + c.torque_nm.norm(), 0.0);
    EXPECT_NE(c.flags & safety_not_finite, 0U);
    EXPECT_EQ(safety.faulted(), i >= 3) << i;
  }
  DeviceCommand good = command({1, 0, 0});
  safety.apply(good, dt, 0.0);
  EXPECT_EQ(good.force_n.norm(), 0.0) << "a latched fault must hold";
  EXPECT_NE(good.flags & safety_faulted, 0U);
  safety.reset();
  good = command({1, 0, 0});
  safety.apply(good, dt, 0.0);
  EXPECT_EQ(good.force_n.x(), 1.0);
  EXPECT_EQ(safety.counts().not_finite, 4U);
  EXPECT_EQ(safety.counts().faulted, 3U);
}

TEST(Safety, ForgivesASingleNanTick) {
  Safety safety({.faulty_ticks = 3});
  for (int i = 0; i < 9; ++i) {
    DeviceCommand c = command({i % 3 == 0 ? 1.0 : std::nan(""), 0, 0});
    safety.apply(c, dt, 0.0);
  }
  EXPECT_FALSE(safety.faulted());
}

TEST(Safety, FadesAStaleForceAndComesBackWithoutAKick) {
  Safety safety({.max_force_slew_n_per_s = 1000.0, .stale_after_s = 0.005, .decay_s = 0.010});
  Vec3 last = Vec3::Zero();
  for (int i = 0; i < 60; ++i) {
    const bool lost = i >= 20 && i < 40;
    DeviceCommand c = command({2, 0, 0});
    safety.apply(c, dt, lost ? 0.010 : 0.0);
    EXPECT_EQ((c.flags & safety_stale) != 0, lost);
    EXPECT_LE((c.force_n - last).norm(), 1.0 + 1e-12) << i;
    if (i == 24) {
      EXPECT_NEAR(c.force_n.x(), 1.0, 1e-9);
    }
    if (i >= 30 && i < 40) {
      EXPECT_EQ(c.force_n.norm(), 0.0);
    }
    if (i >= 45) {
      EXPECT_NEAR(c.force_n.x(), 2.0, 1e-12);
    }
    last = c.force_n;
  }
}

TEST(Safety, ScalesForceAndTorqueBeforeItsLimits) {
  Safety safety({.max_force_n = 5.0, .max_torque_nm = 1.0}, 3.0);
  DeviceCommand c = command({1, 0, 0}, {0, 0.1, 0});
  safety.apply(c, dt, 0.0);
  EXPECT_EQ(c.force_n, Vec3(3, 0, 0));
  EXPECT_EQ(c.torque_nm, Vec3(0, 3.0 * 0.1, 0));
  EXPECT_EQ(c.flags, unsigned{safety_scaled});
  c = command({4, 0, 0});
  safety.apply(c, dt, 0.0);
  EXPECT_NEAR(c.force_n.x(), 5.0, 1e-12) << "the limit is the device's, not the scene's";
  EXPECT_EQ(c.flags, unsigned{safety_scaled | safety_force_clamped});
  c = command({0, 0, 0});
  safety.apply(c, dt, 0.0);
  EXPECT_EQ(safety.counts().scaled, 2U) << "nothing to scale is not counted";
}

TEST(Safety, TakesAForceThatItsScaleMakesEndlessForOneThatIsNotFinite) {
  Safety safety({.max_force_n = 5.0}, 1e6);
  DeviceCommand c = command({1e305, 0, 0});
  safety.apply(c, dt, 0.0);
  EXPECT_EQ(c.force_n.norm(), 0.0);
  EXPECT_EQ(c.flags, unsigned{safety_not_finite});
}

TEST(Safety, DecaysByTheTimeThatPassedAndNotByTheTicksServed) {
  // Five periods of 1 ms, served one by one or as a single one of 5 ms: the force is the same at the end.
  const SafetyLimits limits{.stale_after_s = 0.005, .decay_s = 0.010};
  Safety served(limits);
  Safety missed(limits);
  DeviceCommand a = command({2, 0, 0});
  DeviceCommand b = a;
  served.apply(a, dt, 0.0, dt);
  missed.apply(b, dt, 0.0, dt);
  for (int i = 1; i <= 10; ++i) {
    a = command({2, 0, 0});
    served.apply(a, dt, 0.001 * i, dt);
  }
  b = command({2, 0, 0});
  missed.apply(b, dt, 0.010, 0.010);
  EXPECT_NEAR(a.force_n.x(), 1.0, 1e-9);
  EXPECT_NEAR(b.force_n.x(), a.force_n.x(), 1e-9);
  b = command({2, 0, 0});
  missed.apply(b, dt, 0.030, 0.020);
  EXPECT_EQ(b.force_n.x(), 0.0);
}

TEST(Safety, GoesOnWithItsDecayWhileTheClockStandsStillOrRunsBackwards) {
  Safety safety({.stale_after_s = 0.005, .decay_s = 0.010});
  double last = 2.0;
  for (int i = 0; i < 10; ++i) {
    DeviceCommand c = command({2, 0, 0});
    const double passed = i % 3 == 0 ? 0.0 : i % 3 == 1 ? -7.0 : std::nan("");
    safety.apply(c, dt, 0.006, passed);
    EXPECT_NEAR(c.force_n.x(), last - 0.2, 1e-9) << i;
    last = c.force_n.x();
  }
  EXPECT_NEAR(last, 0.0, 1e-9);
}

TEST(Safety, StepsNoFartherAfterAGapThanAfterATick) {
  Safety safety({.max_force_slew_n_per_s = 500.0});
  for (int i = 1; i <= 4; ++i) {
    DeviceCommand c = command({0, 0, 3});
    safety.apply(c, dt, 0.0, 0.3);
    EXPECT_NEAR(c.force_n.z(), 0.5 * i, 1e-12);
  }
}

TEST(Safety, RisesAnewAfterAGapLongerThanAStateMayBeOld) {
  Safety safety({.rise_s = 0.01, .stale_after_s = 0.02});
  const auto served = [&](double passed_s) {
    DeviceCommand c = command({4, 0, 0});
    safety.apply(c, dt, 0.0, passed_s);
    return c;
  };
  EXPECT_EQ(served(1.0).flags, unsigned{safety_force_rise}) << "the first rise is no second one";
  for (int i = 1; i < 15; ++i) served(dt);
  EXPECT_EQ(served(0.019).flags, 0U) << "a short gap";
  const DeviceCommand first = served(0.021);
  EXPECT_EQ(first.flags, unsigned{safety_force_rise | safety_restarted});
  EXPECT_NEAR(first.force_n.x(), 0.4, 1e-9);
  for (int i = 2; i <= 10; ++i) EXPECT_NEAR(served(dt).force_n.x(), 0.4 * i, 1e-9);
  EXPECT_EQ(safety.counts().restarted, 1U);
  Safety without({.stale_after_s = 0.02});
  DeviceCommand c = command({4, 0, 0});
  for (int i = 0; i < 3; ++i) without.apply(c, dt, 0.0, 1.0);
  EXPECT_EQ(c.flags, 0U) << "a scene that asked for no rise gets none";
}

RC_GTEST_PROP(Safety, OutputIsAlwaysFiniteAndWithinItsLimits, ()) {
  const double scale = *rc::gen::element(1.0, 1e-6, 0.3, 1e6);
  Safety safety({.max_force_n = 5.0, .max_torque_nm = 0.3, .max_force_slew_n_per_s = 800.0}, scale);
  const auto inputs =
      *rc::gen::container<std::vector<std::array<double, 4>>>(rc::gen::arbitrary<std::array<double, 4>>());
  Vec3 last = Vec3::Zero();
  for (const auto& in : inputs) {
    DeviceCommand c = command({in[0], in[1], in[2]}, {in[3], in[0], 0});
    safety.apply(c, dt, 0.0, in[1]);
    RC_ASSERT(c.force_n.allFinite() && c.torque_nm.allFinite());
    RC_ASSERT(c.force_n.norm() <= 5.0 * (1 + 1e-12));
    RC_ASSERT(c.torque_nm.norm() <= 0.3 * (1 + 1e-12));
    RC_ASSERT(safety.faulted() || (c.force_n - last).norm() <= 0.8 * (1 + 1e-9));
    last = c.force_n;
  }
}

}  // namespace
}  // namespace odds::haptics
