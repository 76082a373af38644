// Events where a frame has no time for all pairs.
#include <gtest/gtest.h>

#include <string>

#include "haptics/on_floor.hpp"

namespace odds::scene {
namespace {

std::string with_frame(std::string text, int units) {
  const std::string query = "[query]\n";
  return text.insert(text.find(query) + query.size(), "frame_work_units = " + std::to_string(units) + "\n");
}

TEST(Events, APairWithoutItsTurnHasNotParted) {
  // Sunk half into the floor, and drawn along it: each lies in it all the time, and has to be asked anew in each tick.
  std::string bodies;
  constexpr int count = 20;
  for (int i = 0; i < count; ++i) bodies += moving("ball" + std::to_string(i), "ball", -1.5 + 0.1 * i, 0.0);
  const std::string effects = "[effects.events]\n[effects.gravity]\ng_m_per_s2 = [0.5, 0, 0]\n";
  const auto simulation = simulate(with_frame(on_floor(bodies + effects, 0.5), 8));
  const RunOutcome outcome = simulation->run();
  EXPECT_GT(outcome.pairs_left_out, 100U) << "else nothing is tried";
  int begun = 0;
  for (const haptics::ContactEvent& event : outcome.events) {
    EXPECT_TRUE(event.begins) << event.b.index << " at " << 1e-6 * static_cast<double>(event.t_ns) << " ms";
    ++begun;
  }
  EXPECT_EQ(begun, count);
}

TEST(Events, APairThatHasGoneApartHasPartedThoughOthersWait) {
  // Falls through the floor while the others lie in it: once the boxes are apart, no turn is waited for.
  std::string bodies = moving("falling", "ball", 1.5, 0.05);
  for (int i = 0; i < 20; ++i) bodies += moving("ball" + std::to_string(i), "ball", -1.5 + 0.1 * i, -0.05);
  const std::string effects = "[effects.events]\n[effects.gravity]\ng_m_per_s2 = [0, 0, -0.5]\n";
  const auto simulation = simulate(with_frame(on_floor(bodies + effects, 1.0), 8));
  const RunOutcome outcome = simulation->run();
  double end_s = 0.0;
  for (const haptics::ContactEvent& event : outcome.events) {
    if (!event.begins && (event.a.index == 1 || event.b.index == 1)) end_s = 1e-9 * static_cast<double>(event.t_ns);
  }
  EXPECT_NEAR(end_s, std::sqrt(2.0 * (0.03 + 0.1 + 0.04) / 0.5), 0.03);
}

}  // namespace
}  // namespace odds::scene
