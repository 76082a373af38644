// Fifty bodies in a pit: what a frame costs.
#include <fmt/core.h>

#include <algorithm>
#include <numeric>

#include "odds/math/random.hpp"
#include "ode_scenes/picture.hpp"
#include "ode_scenes/scenes.hpp"

namespace odds::ode_scenes {
namespace {

constexpr int bodies = 50;
constexpr double seconds = 2.0;
constexpr double frame_us = 500.0;    // of all collisions together: a sixth of what ODE's own take
constexpr double most_of_odes = 0.2;  // a fifth
constexpr double below_all_m = -0.1;  // the ground is nowhere so low
constexpr Physics physics{"", 30, 0.0, 0.5, 0.6, 32};

std::ptrdiff_t fallen(const Arena& arena) {
  return std::count_if(arena.items().begin(), arena.items().end(), [](const Arena::Item& item) {
    const dBodyID body = dGeomGetBody(item.geom);
    return body != nullptr && !(position_of(body).z() > below_all_m);
  });
}

Run run_crowd(const Collider& collider, std::uint64_t seed) {
  Arena arena(collider, physics);
  arena.add(made("terrain:side=2,height=0.04,feature=0.3,depth=0.3,cells=64", false), {});
  for (int side = 0; side < 4; ++side) {  // walls
    const Mat3 turned = Eigen::AngleAxisd(1.5707963267948966 * side, Vec3::UnitZ()).toRotationMatrix();
    arena.add(made("box:x=0.2,y=1.4,z=0.8"), {turned, turned * Vec3(0.5, 0.0, 0.3)});
  }
  const std::vector<Mesh> kinds{made("torus:ring=0.05,tube=0.02,around=32,across=16"),
                                made("gear:module=0.006,teeth=16,width=0.04,bore=0.012"),
                                made("bumpy_sphere:radius=0.05,frequency=8"), made("box:x=0.08,y=0.1,z=0.06,cells=8")};
  math::Random random(seed, 1);
  for (int i = 0; i < bodies; ++i) {
    const Vec3 place(0.15 * (i % 5 - 2), 0.15 * (i / 5 % 5 - 2), 0.2 + 0.15 * (i / 25));
    arena.add(kinds[static_cast<std::size_t>(i) % kinds.size()], {random.rotation().toRotationMatrix(), place}, 1000.0);
  }
  arena.prepare();
  Run run{"50 bodies", collider.name(), {}, {{collider.name(), {}}}, {}, {}, collider.ours()};
  double fastest_late = 0.0;
  double sum_us = 0.0;
  for (int i = 0; i < static_cast<int>(1000.0 * seconds); ++i) {
    arena.step();
    sum_us += arena.frame_us.back();
    if (i % 20 == 19) {
      run.traces[0].points.emplace_back(arena.time_s(), sum_us / 20.0);
      sum_us = 0.0;
    }
    if (i < 1000) continue;
    for (const Arena::Item& item : arena.items()) {
      if (dGeomGetBody(item.geom) != nullptr) {
        fastest_late = std::max(fastest_late, velocity_of(dGeomGetBody(item.geom)).norm());
      }
    }
  }
  const double mean =
      std::accumulate(arena.frame_us.begin(), arena.frame_us.end(), 0.0) / static_cast<double>(arena.frame_us.size());
  run.figures.push_back({"frame, mean", mean, "µs"});
  run.figures.push_back({"frame, p50", percentile(arena.frame_us, 0.5), "µs"});
  run.figures.push_back({"frame, p99", percentile(arena.frame_us, 0.99), "µs"});
  run.figures.push_back({"fastest after 1 s", fastest_late, "m/s"});
  run.figures.push_back({"fallen through", static_cast<double>(fallen(arena)), "", 0.0});
  run.note = fmt::format("{:.0f} µs a frame", mean);
  add_common(run, arena);
  run.picture =
      picture_of(arena, {.centre = {0, 0, 0.1}, .from = {0.4, -1.2, 1.6}, .width_m = 1.3, .columns = 320, .rows = 260});
  return run;
}

}  // namespace

Section crowd(const Plan& plan) {
  Section section{"crowd",
                  "Fifty bodies",
                  "<p>Fifty tori, gears, bumpy balls and bricks of 768 to 1,536 triangles fall into a pit of hilly "
                  "ground and stay there for two seconds. A frame is everything: spaces, contacts, solver. With "
                  "fewer contacts the solver, too, is faster. With a limit for all collisions of a frame pairs take "
                  "turns, by importance, and bodies lie deeper in each other meanwhile; the bar is for that.</p>",
                  "s",
                  "µs a frame",
                  true,
                  {}};
  std::vector<Collider> all;
  for (const Collider& collider : colliders(plan, false)) {
    all.push_back(collider);
    // Work units do not count what contacts cost, and so bound no frame's time.
    if (!collider.ours() || collider.in_work || collider.budget_us < 100.0) continue;
    all.push_back(collider);
    all.back().frame_us = frame_us;
  }
  for (const Collider& collider : all) {
    section.runs.push_back(run_crowd(collider, plan.seed));
    fmt::print("crowd {:<18} {}\n", collider.name(), section.runs.back().note);
    std::fflush(stdout);
  }
  for (Run& run : section.runs) {
    for (const Run& other : section.runs) {
      if (!run.ours || other.collider != Collider{Collider::Kind::stock}.name()) continue;
      const bool judged = run.collider.find("a frame") != std::string::npos;
      run.figures.insert(run.figures.begin(),
                         Figure{"share of ODE's frame", run.figures[0].value / other.figures[0].value, "",
                                judged ? std::optional<double>(most_of_odes) : std::nullopt});
    }
  }
  return section;
}

}  // namespace odds::ode_scenes
