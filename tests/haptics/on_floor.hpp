// Scenes on a floor, run by hand.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>

#include "odds/scene/simulation.hpp"

namespace odds::scene {

// A floor whose top is at z = 0, and whatever the case adds.
inline std::string on_floor(const std::string& rest, double seconds = 1.0, int rate_hz = 1000) {
  return "format = \"odds.scene/1\"\n[loop]\nrate_hz = " + std::to_string(rate_hz) +
         "\nseconds = " + std::to_string(seconds) +
         "\n[query]\nwork_units = 20000\n"
         "[[mesh]]\nname = \"slab\"\nfile = \"made:box:x=4,y=1,z=0.1,cells=2\"\n"
         "[[mesh]]\nname = \"ball\"\nfile = \"made:icosphere:radius=0.02\"\n"
         "[[mesh]]\nname = \"cube\"\nfile = \"made:box:x=0.04,y=0.04,z=0.04\"\n"
         "[[mesh]]\nname = \"bar\"\nfile = \"made:box:x=0.2,y=0.05,z=0.1\"\n"
         "[[body]]\nname = \"floor\"\nmesh = \"slab\"\nposition_m = [0, 0, -0.05]\n" +
         rest;
}

inline std::string moving(const std::string& name, const std::string& mesh, double x, double z, double mass = 0.1) {
  return "[[body]]\nname = \"" + name + "\"\nmesh = \"" + mesh +
         "\"\nmotion = \"dynamic\"\nmass_kg = " + std::to_string(mass) + "\nposition_m = [" + std::to_string(x) +
         ", 0, " + std::to_string(z) + "]\n";
}

// Meshes that no body uses are refused: the unused ones are taken out.
inline std::string trimmed(std::string text) {
  for (const std::string name : {"ball", "cube", "bar", "slab"}) {
    if (text.find("mesh = \"" + name + "\"") != std::string::npos) continue;
    const std::size_t begin = text.find("[[mesh]]\nname = \"" + name + "\"");
    if (begin == std::string::npos) continue;
    const std::size_t end = text.find("[[", begin + 2);
    text.erase(begin, end - begin);
  }
  return text;
}

inline std::unique_ptr<Simulation> simulate(const std::string& text) {
  Result<Scene> parsed = parse_scene(trimmed(text), "test.toml", ".");
  EXPECT_TRUE(parsed.ok()) << (parsed.ok() ? "" : parsed.error().message());
  if (!parsed) return nullptr;
  SimulationOptions options;
  options.simulated_time = true;
  auto made = Simulation::make(std::move(parsed).value(), options);
  EXPECT_TRUE(made.ok()) << (made.ok() ? "" : made.error().message());
  return made.ok() ? std::move(made).value() : nullptr;
}

inline std::string refusal(const std::string& text) {
  const Result<Scene> parsed = parse_scene(trimmed(text), "test.toml", ".");
  return parsed.ok() ? "taken" : parsed.error().message();
}

// Runs ticks by hand; `each` sees the world after every one.
template <class Each>
void run_ticks(Simulation& simulation, int ticks, Each each) {
  for (int i = 0; i < ticks; ++i) {
    haptics::TickRecord record;
    simulation.renderer().tick(std::int64_t{i} * simulation.scene().loop.period_ns, record);
    each(i, record);
  }
}
inline void run_ticks(Simulation& simulation, int ticks) {
  run_ticks(simulation, ticks, [](int, const haptics::TickRecord&) {});
}

inline void throw_body(Simulation& simulation, std::uint32_t body, const Vec3& velocity,
                       const Vec3& spin = Vec3::Zero()) {
  ode::BodyState state = simulation.world().state({body});
  state.velocity_m_per_s = velocity;
  state.angular_velocity_rad_per_s = spin;
  simulation.world().set_state({body}, state);
}

inline const std::string contact = "[effects.contact]\n";
inline const std::string gravity = "[effects.gravity]\n";

}  // namespace odds::scene
