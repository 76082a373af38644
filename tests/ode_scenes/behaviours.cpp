// What a program sees of each collider in short: the rows of the table in docs/ode.md.
#include <fmt/core.h>

#include <cmath>
#include <limits>
#include <optional>

#include "ode_scenes/scenes.hpp"

namespace odds::ode_scenes {
namespace {

constexpr Physics plain{"ODE's defaults", 50, 0.0, std::numeric_limits<double>::infinity(), 1.0, 64};

Run run_of(const char* variant, const Collider& collider) {
  return {variant, collider.name(), {}, {}, {}, {}, collider.ours()};
}

Run bricks(const Collider& collider) {
  Arena arena(collider, plain);
  constexpr double height = 0.248;
  arena.add(made("box:x=4,y=4,z=1,cells=8"), {Mat3::Identity(), {0.03, 0.02, -0.5}});
  const Mesh brick = made("box:x=0.2,y=0.5,z=0.248");
  std::vector<dBodyID> bodies;
  for (int i = 0; i < 2; ++i) {
    bodies.push_back(dGeomGetBody(arena.add(brick, {Mat3::Identity(), {0.0, 0.0, height * (i + 0.5)}}, 1000.0)));
  }
  arena.prepare();
  for (int i = 0; i < 1000; ++i) arena.step();
  double moved = 0.0;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Vec3 place(0.0, 0.0, height * (static_cast<double>(i) + 0.5));
    moved = std::max(moved, (position_of(bodies[i]) - place).norm());
  }
  Run run = run_of("two bricks of 12 triangles on a mesh, 1 s", collider);
  run.figures = {{"moved", 1e3 * moved, "mm", 1.0},
                 {"contacts of a collision", arena.counts.mean(), ""},
                 {"sideways", arena.counts.sideways_percent(), "%", 0.0}};
  run.note = fmt::format("moved {:.4g} mm, {:.3g} % sideways", 1e3 * moved, arena.counts.sideways_percent());
  return run;
}

Run within(const Collider& collider) {
  Arena arena(collider, plain, 0.0);
  arena.add(made("box:x=0.5,y=0.5,z=0.5,cells=8"), {});
  const dGeomID ball =
      arena.add(made("icosphere:radius=0.05,frequency=6"), {Mat3::Identity(), {0.12, 0.03, 0.02}}, 1000.0);
  arena.prepare();
  arena.step();
  const auto first = static_cast<double>(arena.counts.contacts);
  for (int i = 1; i < 2000; ++i) arena.step();
  const bool inside = position_of(dGeomGetBody(ball)).cwiseAbs().maxCoeff() < 0.25;
  Run run = run_of("a ball wholly within a block, 2 s", collider);
  run.figures = {{"contacts of the first step", first, ""}, {"still within", inside ? 1.0 : 0.0, "", 0.0}};
  run.note = fmt::format("{:.0f} contacts, {} after 2 s", first, inside ? "within" : "out");
  return run;
}

Run slide(const Collider& collider) {
  Physics smooth = plain;
  smooth.friction = 0.0;
  Arena arena(collider, smooth);
  arena.add(made("box:x=4,y=4,z=1,cells=40"), {Mat3::Identity(), {0.03, 0.02, -0.5}});
  const dGeomID slab =
      arena.add(made("box:x=0.3,y=0.2,z=0.05,cells=8"), {Mat3::Identity(), {-0.5, 0.0, 0.025}}, 1000.0);
  arena.prepare();
  for (int i = 0; i < 200; ++i) arena.step();
  constexpr double speed = 0.5;
  dBodySetLinearVel(dGeomGetBody(slab), speed, 0, 0);
  for (int i = 0; i < 2000; ++i) arena.step();
  const double lost = 100.0 * std::abs(velocity_of(dGeomGetBody(slab)).x() - speed) / speed;
  Run run = run_of("a slab of 768 triangles slides over 19,200 without friction, 2 s", collider);
  run.figures = {{"speed changed", lost, "%", 1.0},
                 {"contacts of a collision", arena.counts.mean(), ""},
                 {"sideways", arena.counts.sideways_percent(), "%", 0.0}};
  run.note = fmt::format("speed changed by {:.3g} %, {:.3g} % sideways", lost, arena.counts.sideways_percent());
  return run;
}

Run deep(const Collider& collider) {
  Arena arena(collider, plain, 0.0);
  const Mesh knot = made("torus_knot:along=768,across=32");
  const double size = (knot->upper() - knot->lower()).norm();
  arena.add(knot, {});
  // Held where it is: every step asks anew.
  const dGeomID other = arena.add(knot, {}, 1000.0);
  arena.prepare();
  for (int i = 0; i < 40; ++i) {
    const dBodyID body = dGeomGetBody(other);
    dBodySetPosition(body, 0.05 * size, 0.03 * size, 0.002 * size * i);
    dBodySetLinearVel(body, 0, 0, 0);
    dBodySetAngularVel(body, 0, 0, 0);
    arena.step();
  }
  const int most = arena.counts.most;
  const double median = percentile(arena.collide_us, 0.5);
  const double slowest = percentile(arena.collide_us, 1.0);
  Run run = run_of("two knots of 49,152 triangles deep in each other", collider);
  run.figures = {{"collision, p50", median, "µs"},
                 {"slowest of 40", slowest, "µs"},
                 {"most contacts", static_cast<double>(most), "", collider.ours() ? std::optional(8.0) : std::nullopt}};
  run.note = fmt::format("{:.0f} µs, at most {:.0f} µs; {} contacts", median, slowest, most);
  return run;
}

}  // namespace

Section behaviours(const Plan& plan) {
  Section section{"behaviours",
                  "Behaviours",
                  "<p>What a program sees of each collider. All are asked for up to 64 contacts of a pair.</p>",
                  "",
                  "",
                  false,
                  {}};
  for (const auto scene : {&bricks, &within, &slide, &deep}) {
    for (const Collider& collider : colliders(plan, false)) {
      section.runs.push_back(scene(collider));
      const Run& run = section.runs.back();
      fmt::print("{:<70} {:<18} {}\n", run.variant, collider.name(), run.note);
      std::fflush(stdout);
    }
  }
  return section;
}

}  // namespace odds::ode_scenes
