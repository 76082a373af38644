// Recorded tracks: what is written comes back bit for bit, and malformed files are refused with file and line.
#include "odds/haptics/device_track.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <filesystem>
#include <numbers>

#include "odds/haptics/recording_device.hpp"
#include "odds/haptics/replay_device.hpp"
#include "odds/haptics/scripted_device.hpp"

namespace odds::haptics {
namespace {

const std::string header = "t_ns,px_m,py_m,pz_m,qw,qx,qy,qz\n";

bool same_bits(const DeviceState& a, const DeviceState& b) {
  return a.t_ns == b.t_ns && std::memcmp(a.position_m.data(), b.position_m.data(), 24) == 0 &&
         std::memcmp(a.orientation.coeffs().data(), b.orientation.coeffs().data(), 32) == 0 &&
         std::memcmp(a.velocity_m_per_s.data(), b.velocity_m_per_s.data(), 24) == 0 &&
         std::memcmp(a.angular_velocity_rad_per_s.data(), b.angular_velocity_rad_per_s.data(), 24) == 0 &&
         a.buttons == b.buttons;
}

TEST(DeviceTrack, AByteOrderMarkAtItsBeginningIsPassedOver) {
  const std::string row = "0,0.1,0.2,0.3,1,0,0,0\n";
  const auto track = parse_track("\xEF\xBB\xBF" + header + row, "marked.csv");
  ASSERT_TRUE(track.ok()) << track.error().message();
  EXPECT_EQ(track.value().states.size(), 1U);
  EXPECT_FALSE(parse_track("\n\xEF\xBB\xBF" + header + row, "marked.csv").ok()) << "elsewhere it is no mark";
}

TEST(DeviceTrack, RecordedWrittenReadAndReplayedGivesTheSameBits) {
  Motion spiral;
  spiral.kind = MotionKind::spiral;
  spiral.duration_s = 0.3;
  spiral.radius_m = 0.0123;
  spiral.turns = 1.7;
  spiral.turn_rad = 0.9;
  RecordingDevice recording(std::make_unique<ScriptedDevice>(math::Pose{Mat3::Identity(), Vec3(0.1, 0.2, 0.3)},
                                                             std::vector<Motion>{spiral}, false),
                            1000);
  std::vector<DeviceState> seen(300);
  for (int i = 0; i < 300; ++i) ASSERT_TRUE(recording.read(i * 1'000'000, seen[static_cast<std::size_t>(i)]));
  const auto path = std::filesystem::path(testing::TempDir()) / "odds_track_test.csv";
  ASSERT_FALSE(write_track(path, recording.track()).has_value());
  Result<DeviceTrack> track = read_track(path);
  std::filesystem::remove(path);
  ASSERT_TRUE(track.ok()) << track.error().message();
  ReplayDevice replay(std::move(track).value());
  for (const DeviceState& expected : seen) {
    DeviceState state;
    ASSERT_TRUE(replay.read(expected.t_ns, state));
    EXPECT_TRUE(same_bits(state, expected)) << expected.t_ns;
    EXPECT_TRUE(state.fresh);
  }
}

TEST(DeviceTrack, RecordingStopsWhereItsMemoryEnds) {
  RecordingDevice recording(std::make_unique<ScriptedDevice>(math::Pose{}, std::vector<Motion>{}, false), 10);
  DeviceState state;
  for (int i = 0; i < 15; ++i) ASSERT_TRUE(recording.read(i, state));
  EXPECT_EQ(recording.track().states.size(), 10U);
  EXPECT_EQ(recording.lost(), 5U);
}

TEST(DeviceTrack, InterpolatesBetweenRowsAndHoldsAfterTheLast) {
  const auto track =
      parse_track("t_ms, px_mm, py_m, pz_m, qw, qx, qy, qz\n# comment\n10,0,0,0,1,0,0,0\n20,10,0,0,0,0,0,1\n", "a.csv");
  ASSERT_TRUE(track.ok()) << track.error().message();
  ReplayDevice device(track.value());
  DeviceState state;
  ASSERT_TRUE(device.read(5'000'000, state));  // times count from the first row
  EXPECT_NEAR(state.position_m.x(), 0.005, 1e-12);
  EXPECT_NEAR(state.orientation.angularDistance(Quat::Identity()), std::numbers::pi / 2, 1e-12);
  EXPECT_NEAR(state.velocity_m_per_s.x(), 1.0, 1e-9);
  EXPECT_NEAR(state.angular_velocity_rad_per_s.z(), std::numbers::pi / 0.01, 1e-6);
  EXPECT_TRUE(state.fresh);
  ASSERT_TRUE(device.read(30'000'000, state));
  EXPECT_NEAR(state.position_m.x(), 0.010, 1e-12);
  EXPECT_EQ(state.velocity_m_per_s.norm(), 0.0);
  EXPECT_FALSE(state.fresh);
  ASSERT_TRUE(device.read(0, state));  // and a second run begins again
  EXPECT_EQ(state.position_m.x(), 0.0);
  EXPECT_TRUE(state.fresh);
}

// Of a camera, say: the last row lies between two ticks, so that it is the next tick that brings it.
TEST(DeviceTrack, AnEndBetweenTwoTicksIsRecordedToo) {
  const auto track = parse_track("t_ms,px_mm,py_m,pz_m,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n2.5,10,0,0,1,0,0,0\n", "a.csv");
  ASSERT_TRUE(track.ok()) << track.error().message();
  RecordingDevice recording(std::make_unique<ReplayDevice>(track.value()), 10);
  std::vector<DeviceState> seen(6);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    ASSERT_TRUE(recording.read(static_cast<std::int64_t>(i) * 1'000'000, seen[i]));
  }
  EXPECT_EQ(seen[3].position_m.x(), 0.01);
  ASSERT_EQ(recording.track().states.size(), 6U);
  EXPECT_TRUE(recording.track().states[2].fresh);
  EXPECT_FALSE(recording.track().states[3].fresh) << "nothing new is said, though it is elsewhere";
  ReplayDevice again(recording.track());
  for (const DeviceState& expected : seen) {
    DeviceState state;
    ASSERT_TRUE(again.read(expected.t_ns, state));
    EXPECT_TRUE(same_bits(state, expected)) << expected.t_ns;
    EXPECT_EQ(state.fresh, expected.fresh) << expected.t_ns;
  }
}

TEST(DeviceTrack, SaysWhatIsNewsAndWhatIsNot) {
  const auto track = parse_track(
      "t_ms,px_m,py_m,pz_m,qw,qx,qy,qz,fresh\n0,0,0,0,1,0,0,0,1\n2,0,0,0,1,0,0,0,0\n4,0,0,0,1,0,0,0,1\n", "a.csv");
  ASSERT_TRUE(track.ok()) << track.error().message();
  ReplayDevice device(track.value());
  const std::array<bool, 6> fresh = {true, false, false, true, true, false};
  for (std::size_t i = 0; i < fresh.size(); ++i) {
    DeviceState state;
    ASSERT_TRUE(device.read(static_cast<std::int64_t>(i) * 1'000'000, state));
    EXPECT_EQ(state.fresh, fresh[i]) << i;
  }
}

// As people write them: few rows, far apart in time.
TEST(DeviceTrack, WithoutVelocitiesAHandThatRestsHasNoneAndOneThatMovesThoseOfItsWay) {
  const auto track = parse_track(
      "t_s,px_m,py_m,pz_m,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n1,0,0,0,1,0,0,0\n1.1,0.1,0,0,0,0,0,1\n2.1,0.1,0,0,0,0,0,1\n",
      "keys.csv");
  ASSERT_TRUE(track.ok()) << track.error().message();
  ReplayDevice device(track.value());
  DeviceState state;
  for (const std::int64_t at_ms : {0, 1, 500, 999, 1101, 1500, 2000, 2100}) {
    ASSERT_TRUE(device.read(at_ms * 1'000'000, state));
    EXPECT_EQ(state.velocity_m_per_s.norm(), 0.0) << at_ms;
    EXPECT_EQ(state.angular_velocity_rad_per_s.norm(), 0.0) << at_ms;
  }
  for (const std::int64_t at_ms : {1001, 1050, 1099}) {
    ASSERT_TRUE(device.read(at_ms * 1'000'000, state));
    EXPECT_NEAR(state.velocity_m_per_s.x(), 1.0, 1e-9) << at_ms;
    EXPECT_NEAR(state.angular_velocity_rad_per_s.z(), std::numbers::pi / 0.1, 1e-6) << at_ms;
  }
  ASSERT_TRUE(device.read(1'000'000'000, state));  // between rest and motion
  EXPECT_NEAR(state.velocity_m_per_s.x(), 0.5, 1e-9);
}

TEST(DeviceTrack, RecordsOnlyWhatCanBeReplayed) {
  class Odd final : public Device {
   public:
    [[nodiscard]] std::optional<Error> open() override { return std::nullopt; }
    void close() noexcept override {}
    [[nodiscard]] const DeviceSpec& spec() const noexcept override { return spec_; }
    [[nodiscard]] bool read(std::int64_t now_ns, DeviceState& state) noexcept override {
      state = {};
      state.t_ns = now_ns;
      state.fresh = true;
      state.orientation = now_ns == 1 ? Quat(0, 0, 0, 0) : now_ns == 2 ? Quat(1.0005, 0, 0, 0) : Quat::Identity();
      return true;
    }
    bool write(const DeviceCommand&) noexcept override { return true; }
    bool enable_forces(bool) noexcept override { return true; }
    [[nodiscard]] std::string_view last_error() const noexcept override { return {}; }

   private:
    DeviceSpec spec_;
  };
  RecordingDevice recording(std::make_unique<Odd>(), 10);
  DeviceState state;
  for (int i = 0; i < 4; ++i) ASSERT_TRUE(recording.read(i, state));
  const DeviceTrack track = recording.track();
  ASSERT_EQ(track.states.size(), 4U);
  for (const DeviceState& row : track.states) EXPECT_EQ(row.orientation.w(), 1.0) << row.t_ns;
  EXPECT_EQ(track.states[1].t_ns, 1) << "where a loop that could not use what it read went on with the state before";
  EXPECT_EQ(track.states[2].t_ns, 2);
}

struct Malformed {
  const char* name;
  std::string text;
  const char* place;
  const char* says;
};

class MalformedTrack : public testing::TestWithParam<Malformed> {};

TEST_P(MalformedTrack, IsRefusedWithItsLine) {
  const Malformed& c = GetParam();
  const auto track = parse_track(c.text, "track.csv");
  ASSERT_FALSE(track.ok());
  EXPECT_EQ(track.error().file, "track.csv");
  EXPECT_EQ(track.error().place, c.place) << track.error().message();
  EXPECT_NE(track.error().message().find(c.says), std::string::npos) << track.error().message();
  EXPECT_FALSE(track.error().remedy.empty());
}

INSTANTIATE_TEST_SUITE_P(
    Cases, MalformedTrack,
    testing::Values(Malformed{"Empty", "", "", "no line of column names"},
                    Malformed{"OnlyComments", "# a\n\n", "", "no line of column names"},
                    Malformed{"NoRow", header, "1", "no row"},
                    Malformed{"ColumnWithoutUnit", "t_ns,px,py_m,pz_m,qw,qx,qy,qz\n", "1", "px_m"},
                    Malformed{"ColumnMissing", "t_ns,px_m,py_m,pz_m,qx,qy,qz\n", "1", "'qw' is missing"},
                    Malformed{"ColumnTwice", "t_ns,px_m,px_mm,py_m,pz_m,qw,qx,qy,qz\n", "1", "second column"},
                    Malformed{"SomeVelocities", "t_ns,px_m,py_m,pz_m,qw,qx,qy,qz,vx_m_per_s\n", "1", "1 of the six"},
                    Malformed{"TooFewValues", header + "0,0,0,0,1,0,0\n", "2", "7 values"},
                    Malformed{"TooManyValues", header + "0,0,0,0,1,0,0,0,9\n", "2", "9 values"},
                    Malformed{"NotANumber", header + "0,0,zero,0,1,0,0,0\n", "2", "'zero'"},
                    Malformed{"NumberWithTail", header + "0,0,1.5m,0,1,0,0,0\n", "2", "'1.5m'"},
                    Malformed{"Nan", header + "0,nan,0,0,1,0,0,0\n", "2", "finite"},
                    Malformed{"Infinity", header + "0,0,0,inf,1,0,0,0\n", "2", "finite"},
                    Malformed{"Overflow", header + "0,0,0,1e999,1,0,0,0\n", "2", "finite"},
                    Malformed{"BeyondReason", header + "0,0,1e308,0,1,0,0,0\n", "2", "beyond 1e12"},
                    Malformed{"FractionOfANanosecond", header + "0.5,0,0,0,1,0,0,0\n", "2", "nanoseconds"},
                    Malformed{"TimeTooLarge", header + "99999999999999999999,0,0,0,1,0,0,0\n", "2", "nanoseconds"},
                    Malformed{"TimeStandsStill", header + "5,0,0,0,1,0,0,0\n5,0,0,0,1,0,0,0\n", "3", "not later"},
                    Malformed{"TimeRunsBack", header + "# c\n5,0,0,0,1,0,0,0\n4,0,0,0,1,0,0,0\n", "4", "not later"},
                    Malformed{"NoRotation", header + "0,0,0,0,0,0,0,0\n", "2", "not a rotation"},
                    Malformed{"LongQuaternion", header + "0,0,0,0,2,0,0,0\n", "2", "not a rotation"},
                    Malformed{"NegativeButtons", "t_ns,px_m,py_m,pz_m,qw,qx,qy,qz,buttons\n0,0,0,0,1,0,0,0,-1\n", "2",
                              "buttons"},
                    Malformed{"HalfFresh", "t_ns,px_m,py_m,pz_m,qw,qx,qy,qz,fresh\n0,0,0,0,1,0,0,0,0.5\n", "2", "news"},
                    Malformed{"EmptyValue", header + "0,,0,0,1,0,0,0\n", "2", "''"}),
    [](const auto& tested) { return tested.param.name; });

TEST(DeviceTrack, NamesTheFileThatIsNotThere) {
  const auto track = read_track("no/such/track.csv");
  ASSERT_FALSE(track.ok());
  EXPECT_EQ(track.error().file, "no/such/track.csv");
}

}  // namespace
}  // namespace odds::haptics
