// Malformed scenes are refused at the right line and column, with what is wrong and what would be right.
#include <gtest/gtest.h>

#include <string>

#include "odds/scene/scene.hpp"

namespace odds::scene {
namespace {

// A good scene in pieces; each case replaces one line.
const std::vector<std::string> good = {
    "format = \"odds.scene/1\"",   // 1
    "[loop]",                      // 2
    "rate_hz = 1000",              // 3
    "seconds = 0.5",               // 4
    "[query]",                     // 5
    "budget_us = 100",             // 6
    "method = \"time-critical\"",  // 7
    "max_contacts = 8",            // 8
    "[[mesh]]",                    // 9
    "name = \"block\"",            // 10
    "file = \"made:box\"",         // 11
    "[[body]]",                    // 12
    "name = \"floor\"",            // 13
    "mesh = \"block\"",            // 14
    "position_m = [0, 0, 0]",      // 15
    "[[body]]",                    // 16
    "name = \"tool\"",             // 17
    "mesh = \"block\"",            // 18
    "motion = \"dynamic\"",        // 19
    "mass_kg = 0.1",               // 20
    "device = \"hand\"",           // 21
    "[device.hand]",               // 22
    "type = \"scripted\"",         // 23
    "position_m = [0, 0, 0.2]",    // 24
    "[[device.hand.motion]]",      // 25
    "kind = \"press\"",            // 26
    "duration_s = 1.0",            // 27
    "depth_m = 0.01",              // 28
    "[effects.contact]",           // 29
    "stiffness_n_per_m = 20000",   // 30
    "[effects.friction]",          // 31
    "mu = 0.3",                    // 32
    "[effects.virtual_coupling]",  // 33
    "k_t_n_per_m = 500",           // 34
};

std::string scene_with(std::size_t line, const std::string& replacement) {
  std::string text;
  for (std::size_t i = 0; i < good.size(); ++i) text += (i + 1 == line ? replacement : good[i]) + "\n";
  return text;
}

TEST(Scene, TheGoodOneIsTaken) {
  const auto scene = parse_scene(scene_with(0, ""), "good.toml", ".");
  ASSERT_TRUE(scene.ok()) << scene.error().message();
  EXPECT_EQ(scene.value().bodies.size(), 2U);
  EXPECT_EQ(scene.value().loop.period_ns, 1'000'000);
  ASSERT_EQ(scene.value().effects.size(), 3U);
  ASSERT_NE(scene.value().find_effect("friction"), nullptr);
  EXPECT_EQ(scene.value().find_effect("friction")->place.line, 31U);
  EXPECT_EQ(scene.value().find_effect("gravity"), nullptr);
  const ode::WorldOptions options = scene.value().world_options(*scene.value().make_effects());
  EXPECT_EQ(options.contact.friction, 0.3);
  EXPECT_EQ(options.gravity_m_per_s2.norm(), 0.0);
}

struct Malformed {
  const char* name;
  std::size_t line;  // replaced
  std::string text;
  const char* place;
  const char* says;
};

class MalformedScene : public testing::TestWithParam<Malformed> {};

TEST_P(MalformedScene, IsRefusedAtItsPlace) {
  const Malformed& c = GetParam();
  const auto scene = parse_scene(scene_with(c.line, c.text), "bad.toml", ".");
  ASSERT_FALSE(scene.ok());
  EXPECT_EQ(scene.error().file, "bad.toml");
  EXPECT_EQ(scene.error().place, c.place) << scene.error().message();
  EXPECT_NE(scene.error().message().find(c.says), std::string::npos) << scene.error().message();
  EXPECT_FALSE(scene.error().remedy.empty()) << scene.error().message();
}

INSTANTIATE_TEST_SUITE_P(
    Cases, MalformedScene,
    testing::Values(
        Malformed{"Syntax", 3, "rate_hz = ", "3:11", "TOML"},
        Malformed{"DuplicateKey", 4, "rate_hz = 900", "4:11", "TOML"},
        Malformed{"UnclosedText", 13, "name = \"floor", "13:14", "TOML"},
        Malformed{"FormatMissing", 1, "", "1:1", "'format'"},
        Malformed{"FormatUnknown", 1, "format = \"odds.scene/9\"", "1:1", "odds.scene/1"},
        Malformed{"FormatNumber", 1, "format = 1", "1:10", "an integer"},
        Malformed{"UnknownTable", 2, "[lop]", "2:2", "did you mean 'loop'"},
        Malformed{"UnknownKey", 3, "rate = 1000", "3:1", "did you mean 'rate_hz'"},
        Malformed{"RateText", 3, "rate_hz = \"fast\"", "3:11", "not a number"},
        Malformed{"RateZero", 3, "rate_hz = 0", "3:11", "out of range"},
        Malformed{"RateNan", 3, "rate_hz = nan", "3:11", "finite"},
        Malformed{"RateInfinite", 3, "rate_hz = inf", "3:11", "finite"},
        Malformed{"RateDate", 3, "rate_hz = 2020-01-01", "3:11", "dates"},
        Malformed{"SecondsNegative", 4, "seconds = -1", "4:11", "greater than 0"},
        Malformed{"PriorityTooHigh", 4, "realtime_priority = 100", "4:21", "1 to 99"},
        Malformed{"PriorityFraction", 4, "realtime_priority = 1.5", "4:21", "an integer"},
        Malformed{"LockText", 4, "lock_memory = \"yes\"", "4:15", "true or false"},
        Malformed{"BudgetZero", 6, "budget_us = 0", "6:13", "greater than 0"},
        Malformed{"WorkFraction", 6, "work_units = 0.5", "6:14", "an integer"},
        Malformed{"FrameZero", 6, "frame_us = 0", "6:12", "greater than 0"},
        Malformed{"FrameWorkFraction", 6, "frame_work_units = 0.5", "6:20", "an integer"},
        Malformed{"MethodUnknown", 7, "method = \"time_critical\"", "7:10", "did you mean 'time-critical'"},
        Malformed{"VolumeUnknown", 7, "bv = \"obbb\"", "7:6", "did you mean 'obb'"},
        Malformed{"EstimatorUnknown", 7, "estimator = \"book\"", "7:13", "cells or kinematic"},
        Malformed{"TooManyContacts", 8, "max_contacts = 9", "8:16", "0 to 8"},
        Malformed{"ContactWithoutPoints", 8, "max_contacts = 0", "29:1", "max_contacts"},
        Malformed{"PMinAboveOne", 8, "p_min = 1.5", "8:9", "at most 1"},
        Malformed{"PMinOfTheExactMethod", 7, "method = \"exact\"\np_min = 0.5", "8:1", "never ends on probability"},
        Malformed{"KMinWithoutPMin", 8, "k_min = 20", "8:1", "p_min"},
        Malformed{"CarryMotionAboveOne", 8, "carry_motion = 2", "8:16", "at most 1"},
        Malformed{"MeshWithoutFile", 11, "", "9:1", "'file'"},
        Malformed{"MeshFileEmpty", 11, "file = \"\"", "11:8", "empty"},
        Malformed{"MadeShapeScaled", 11, "file = \"made:box\"\nscale = 2", "12:1", "made shape"},
        Malformed{"BodyUnknownMesh", 14, "mesh = \"blok\"", "14:1", "did you mean 'block'"},
        Malformed{"BodyTwice", 17, "name = \"floor\"", "17:1", "second body named 'floor'"},
        Malformed{"PositionTooShort", 15, "position_m = [0, 0]", "15:14", "2 numbers, not 3"},
        Malformed{"PositionMixed", 15, "position_m = [0, 0, \"up\"]", "15:21", "not a number"},
        Malformed{"PositionNan", 15, "position_m = [0, nan, 0]", "15:18", "finite"},
        Malformed{"QuaternionLong", 15, "orientation_wxyz = [1, 1, 0, 0]", "15:20", "not a rotation"},
        Malformed{"QuaternionZero", 15, "orientation_wxyz = [0, 0, 0, 0]", "15:20", "not a rotation"},
        Malformed{"QuaternionWithoutOrder", 15, "orientation = [1, 0, 0, 0]", "15:1",
                  "did you mean 'orientation_wxyz'"},
        Malformed{"UnitMistyped", 20, "mass_g = 100", "16:1", "neither mass nor density"},
        Malformed{"MassNegative", 20, "mass_kg = -0.1", "20:11", "greater than 0"},
        Malformed{"MassAndDensity", 20, "mass_kg = 1\ndensity_kg_per_m3 = 1000", "21:1", "both given"},
        Malformed{"FixedWithMass", 15, "mass_kg = 1", "15:1", "fixed body"},
        Malformed{"MotionUnknown", 19, "motion = \"dynamc\"", "19:10", "did you mean 'dynamic'"},
        Malformed{"FixedFollows", 19, "", "20:1", "fixed body"},
        Malformed{"DeviceUnknown", 21, "device = \"hnd\"", "21:1", "did you mean 'hand'"},
        Malformed{"DeviceUnused", 21, "", "22:1", "no body follows"},
        Malformed{"FollowerPlaced", 21, "device = \"hand\"\nposition_m = [0, 0, 1]", "22:1",
                  "begins where the device is"},
        Malformed{"DeviceTypeUnknown", 23, "type = \"script\"", "23:8", "did you mean 'scripted'"},
        Malformed{"DeviceKeyUnknown", 24, "position = [0, 0, 0]", "24:1", "did you mean 'position_m'"},
        Malformed{"DeviceLimitMistyped", 24, "max_force_N = 5", "24:1", "did you mean 'max_force_n'"},
        Malformed{"DeviceLimitNegative", 24, "max_force_n = -5", "24:15", "at least 0"},
        Malformed{"MotionKindUnknown", 26, "kind = \"pres\"", "26:8", "did you mean 'press'"},
        Malformed{"MotionKeyOfAnotherKind", 28, "depth_m = 0.01\nradius_m = 0.1", "29:1", "unknown key 'radius_m'"},
        Malformed{"EffectUnknown", 31, "[effects.frction]", "31:10", "did you mean 'friction'"},
        Malformed{"FrictionWithoutMu", 32, "", "31:1", "'mu'"},
        Malformed{"FrictionNegative", 32, "mu = -0.3", "32:6", "greater than 0"},
        Malformed{"StiffnessZero", 30, "stiffness_n_per_m = 0", "30:21", "greater than 0"},
        Malformed{"StiffnessWithoutUnit", 30, "stiffness = 100", "30:1", "did you mean 'stiffness_n_per_m'"},
        Malformed{"KeyOfAnotherTable", 29, "[effects.damping]\n[physics]", "31:1", "unknown key 'stiffness_n_per_m'"},
        Malformed{"CouplingMissing", 33, "[effects.gravity]", "34:1", "unknown key"},
        Malformed{"SecondDevice", 22, "[device.other]\ntype = \"null\"\n[device.hand]", "24:9", "second device"}),
    [](const auto& tested) { return std::string(tested.param.name); });

TEST(Scene, RefusesEffectsThatHaveNothingToWorkOn) {
  const auto refused = [](const std::string& text) {
    const auto scene = parse_scene("format = \"odds.scene/1\"\n" + text, "bad.toml", ".");
    return scene.ok() ? std::string("taken") : scene.error().message();
  };
  const std::string fixed = "[[mesh]]\nname = \"m\"\nfile = \"made:box\"\n[[body]]\nname = \"b\"\nmesh = \"m\"\n";
  EXPECT_NE(refused("").find("no body"), std::string::npos);
  EXPECT_NE(refused(fixed + "[effects.gravity]\n").find("8:1"), std::string::npos)
      << refused(fixed + "[effects.gravity]\n");
  EXPECT_NE(refused(fixed + "[effects.friction]\nmu = 1\n").find("needs contact"), std::string::npos);
  EXPECT_NE(refused(fixed + "[effects.virtual_coupling]\n").find("no device"), std::string::npos);
  EXPECT_NE(refused(fixed + "[[mesh]]\nname = \"n\"\nfile = \"made:box\"\n").find("no body uses the mesh 'n'"),
            std::string::npos);
  EXPECT_EQ(refused(fixed + "[effects.contact]\n"), "taken");
}

TEST(Scene, NamesTheFileThatIsNotThere) {
  const auto scene = read_scene("no/such/scene.toml");
  ASSERT_FALSE(scene.ok());
  EXPECT_EQ(scene.error().file, "no/such/scene.toml");
}

}  // namespace
}  // namespace odds::scene
