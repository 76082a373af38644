// odds_tick_counter: runs a scene's ticks in one function of its own, so that callgrind can count their instructions.
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "odds/haptics/effect_registry.hpp"
#include "odds/realtime/clock.hpp"
#include "odds/scene/simulation.hpp"

// Found by its name: callgrind --toggle-collect=odds_counted_ticks.
extern "C" __attribute__((noinline)) void odds_counted_ticks(odds::scene::Simulation* simulation, std::int64_t ticks) {
  for (std::int64_t i = 0; i < ticks; ++i) {
    odds::haptics::TickRecord record;
    simulation->renderer().tick(i * simulation->scene().loop.period_ns, record);
  }
}

int main(int argc, char** argv) {
  if (argc == 2 && std::string_view(argv[1]) == "--effects") {
    for (const odds::haptics::EffectType& type : odds::haptics::effect_types()) std::printf("%s\n", type.name.data());
    return 0;
  }
  const std::int64_t ticks = argc == 3 ? std::atoll(argv[2]) : 0;
  if (ticks < 1) {
    std::fprintf(stderr, "usage: odds_tick_counter SCENE TICKS\n       odds_tick_counter --effects\n");
    return 2;
  }
  auto scene = odds::scene::read_scene(argv[1]);
  if (!scene) {
    std::fprintf(stderr, "error: %s\n", scene.error().message().c_str());
    return 1;
  }
  odds::scene::SimulationOptions options;
  options.simulated_time = true;
  odds::realtime::ManualClock clock(10);  // a stall of the machine's would be booked by instructions of its own
  options.clock = clock.clock();
  auto simulation = odds::scene::Simulation::make(std::move(scene).value(), options);
  if (!simulation) {
    std::fprintf(stderr, "error: %s\n", simulation.error().message().c_str());
    return 1;
  }
  odds_counted_ticks(simulation.value().get(), ticks);
  return 0;
}
