// Strict reading of settings: the first error in the file is the one reported, with its place.
#include "odds/haptics/settings.hpp"

#include <gtest/gtest.h>

#include <array>

#include "haptics/settings_from.hpp"

namespace odds::haptics {
namespace {

using test::setting;

constexpr std::array<std::string_view, 4> names = {"stiffness_n_per_m", "damping_ns_per_m", "mu", "px_m"};

TEST(NearestName, FindsSlipsAndCutNamesAndNothingElse) {
  EXPECT_EQ(nearest_name("stifness_n_per_m", names), "stiffness_n_per_m");
  EXPECT_EQ(nearest_name("damping", names), "damping_ns_per_m");
  EXPECT_EQ(nearest_name("m", names), "mu");
  EXPECT_EQ(nearest_name("px", names), "px_m");
  EXPECT_EQ(nearest_name("conveyor", names), "");
}

TEST(SettingsReader, ReportsTheErrorThatStandsFirstInTheFile) {
  const Settings settings =
      test::table({setting("b", 5.0, 9), setting("unknown", 1.0, 3), setting("a", std::string("x"), 7)});
  SettingsReader reader(settings);
  double a = 1.0;
  double b = 1.0;
  EXPECT_FALSE(reader.number("b", Range::between(0.0, 1.0), b));
  EXPECT_FALSE(reader.number("a", Range::any(), a));
  const auto error = reader.finish();
  ASSERT_TRUE(error.has_value());
  EXPECT_EQ(error->place, "3:1");
  EXPECT_EQ(a, 1.0) << "a refused value must not be taken";
  EXPECT_EQ(b, 1.0);
}

TEST(SettingsReader, TakesGoodValues) {
  const Settings settings =
      test::table({setting("flag", true), setting("count", std::int64_t{7}), setting("mu", std::int64_t{1}),
                   setting("name", std::string("mu")), test::vector("v", 0, 3, 4),
                   setting("q", Value::List{test::number(0), test::number(1.0004), test::number(0), test::number(0)})});
  SettingsReader reader(settings);
  bool flag = false;
  std::int64_t count = 0;
  double mu = 0.0;
  std::size_t name = 0;
  Vec3 v = Vec3::Zero();
  Quat q = Quat::Identity();
  EXPECT_TRUE(reader.flag("flag", flag) && flag);
  EXPECT_TRUE(reader.integer("count", 0, 7, count) && count == 7);
  EXPECT_TRUE(reader.number("mu", Range::not_negative(), mu) && mu == 1.0) << "an integer is a number too";
  EXPECT_TRUE(reader.choice("name", names, name) && name == 2);
  EXPECT_TRUE(reader.direction("v", v) && v == Vec3(0, 0.6, 0.8));
  EXPECT_TRUE(reader.quaternion_wxyz("q", q) && q.x() == 1.0 && q.w() == 0.0);
  EXPECT_FALSE(reader.finish().has_value());
}

TEST(SettingsReader, RefusesWrongTypes) {
  const std::array<Value, 6> values = {Value{true, {}},          Value{std::int64_t{3}, {}},
                                       Value{0.5, {}},           Value{std::string("t"), {}},
                                       Value{Value::List{}, {}}, Value{Settings{}, {}}};
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Settings settings = test::table({{"key", {2, 1}, {values[i].data, {2, 7}}}});
    const auto refused = [&](auto&& read) {
      SettingsReader reader(settings);
      read(reader);
      const auto error = reader.finish();
      return error.has_value() && error->place == "2:7";
    };
    bool flag = false;
    std::int64_t integer = 0;
    double number = 0.0;
    std::string text;
    std::vector<std::string> texts;
    Vec3 v;
    EXPECT_EQ(refused([&](SettingsReader& r) { r.flag("key", flag); }), i != 0) << i;
    EXPECT_EQ(refused([&](SettingsReader& r) { r.integer("key", 0, 9, integer); }), i != 1) << i;
    EXPECT_EQ(refused([&](SettingsReader& r) { r.number("key", Range::any(), number); }), i != 1 && i != 2) << i;
    EXPECT_EQ(refused([&](SettingsReader& r) { r.text("key", text); }), i != 3) << i;
    EXPECT_EQ(refused([&](SettingsReader& r) { r.texts("key", texts); }), i != 4) << i;
    EXPECT_TRUE(refused([&](SettingsReader& r) { r.vector("key", v); })) << i;  // the list is empty
    EXPECT_EQ(refused([&](SettingsReader& r) { (void)r.table("key"); }), i != 5) << i;
    EXPECT_EQ(refused([&](SettingsReader& r) { (void)r.tables("key"); }), i != 4) << i;
  }
}

TEST(SettingsReader, ReportsAMissingKeyAtItsTable) {
  const Settings settings = test::table({});
  SettingsReader reader(settings);
  reader.require("mu");
  const auto error = reader.finish();
  ASSERT_TRUE(error.has_value());
  EXPECT_NE(error->what.find("'mu'"), std::string::npos);
  EXPECT_NE(error->what.find("[device.hand]"), std::string::npos);
}

}  // namespace
}  // namespace odds::haptics
