// ODE's own bodies on finely cut ground: do they stand, whatever the time that each collision has?
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "ode_scenes/scenes.hpp"

namespace odds::ode_scenes {
namespace {

constexpr double seconds = 10.0;
constexpr double settled_s = 2.0;
constexpr double radius = 0.1;
constexpr double height = 0.05;
constexpr double density = 500.0;
constexpr double gravity = 9.81;
constexpr double most_tilt = 10.0;    // degrees; a body that rolls, as a capsule on hills, may come to lie elsewhere
constexpr double falls_at_m = -0.15;  // the ground is nowhere so low
constexpr Physics smooth{"ODE's defaults", 50, 0.0, 0.5, 0.5, 8};

struct Ground {
  const char* name;
  const char* mesh;
  double top;  ///< metres; nowhere higher
};
constexpr std::array grounds{
    Ground{"flat ground of 43,200 triangles", "box:x=1,y=1,z=0.2,cells=60", 0.1},
    Ground{"hilly ground of 52,480 triangles", "terrain:side=1,height=0.01,feature=0.25,depth=0.2,cells=160", 0.01}};

struct Body {
  const char* name;
  dGeomID (*make)(dSpaceID space);
  void (*weigh)(dMass* mass);
  double lies_at;  ///< metres above the ground
  bool lies;       ///< with its axis along the ground
};
constexpr std::array bodies{
    Body{"box", [](dSpaceID space) { return dCreateBox(space, 2 * radius, 2 * radius, height); },
         [](dMass* mass) { dMassSetBox(mass, density, 2 * radius, 2 * radius, height); }, 0.5 * height, false},
    Body{"cylinder", [](dSpaceID space) { return dCreateCylinder(space, radius, height); },
         [](dMass* mass) { dMassSetCylinder(mass, density, 3, radius, height); }, 0.5 * height, false},
    Body{"capsule", [](dSpaceID space) { return dCreateCapsule(space, height, 2 * radius); },
         [](dMass* mass) { dMassSetCapsule(mass, density, 3, height, 2 * radius); }, height, true}};

Run run_partner(const Body& kind, const Ground& ground, const Collider& collider) {
  Arena arena(collider, smooth, -gravity);
  arena.add(made(ground.mesh, false), {});
  dMass mass;
  kind.weigh(&mass);
  const dGeomID geom = arena.add(kind.make(arena.space()), mass, Vec3(0.03, 0.02, ground.top + kind.lies_at + 1e-3));
  dMatrix3 turn;
  if (kind.lies) {
    dRFromAxisAndAngle(turn, 0.6, 0.8, 0, 0.5 * std::numbers::pi);
  } else {
    dRFromAxisAndAngle(turn, 0, 0, 1, 0.7);
  }
  dGeomSetRotation(geom, turn);
  arena.prepare();
  const dBodyID body = dGeomGetBody(geom);
  const auto axis = [&] {
    const dReal* const r = dBodyGetRotation(body);
    return Vec3(r[2], r[6], r[10]);
  };
  Run run{fmt::format("{} on {}", kind.name, ground.name), collider.name(), {}, {}, {}, {}, collider.ours()};
  Vec3 settled = Vec3::Zero();
  Vec3 settled_axis = Vec3::UnitZ();
  double fastest_spin = 0.0;
  double turned = 0.0;
  double least_j = std::numeric_limits<double>::infinity();
  double rise_j = 0.0;  // of the energy, which friction can only take
  for (int i = 0; i < static_cast<int>(1000.0 * seconds) && position_of(body).z() > falls_at_m; ++i) {
    arena.step();
    if (arena.time_s() < settled_s) continue;
    if (settled.isZero()) {
      settled = position_of(body);
      settled_axis = axis();
    }
    turned = std::max(turned, std::acos(std::clamp(settled_axis.dot(axis()), -1.0, 1.0)) * 180.0 / std::numbers::pi);
    fastest_spin = std::max(fastest_spin, spin_of(body).norm());
    const double energy_j = arena.energy();
    least_j = std::min(least_j, energy_j);
    rise_j = std::max(rise_j, energy_j - least_j);
  }
  const double moved = (position_of(body) - settled).norm();
  const bool falls = !(position_of(body).z() > falls_at_m);
  run.figures = {
      {"moved after 2 s", 1e3 * moved, "mm"},
      {"tilted since", turned, "°", run.ours && !kind.lies ? std::optional<double>(most_tilt) : std::nullopt},
      {"fastest turn since", fastest_spin, "rad/s"},
      {"energy rises since, over the weight", 1e3 * rise_j / (mass.mass * gravity), "mm"},
      {"off the ground", falls ? 1.0 : 0.0, "", kind.lies ? std::nullopt : std::optional<double>(0.0)}};
  add_common(run, arena);
  run.note = falls ? fmt::format("leaves the ground after {:.1f} s", arena.time_s())
                   : fmt::format("moves by {:.2f} mm, tilts by {:.2f}°", 1e3 * moved, turned);
  return run;
}

}  // namespace

Section partners(const Plan& plan) {
  Section section{
      "partners",
      "ODE's bodies on fine ground",
      "<p>A box and a cylinder, 20 cm wide and 5 cm high, stand on ground whose cells are a twelfth and a "
      "thirtieth of that, and a capsule lies on it. No short budget has time for all the triangles under them.</p>",
      "",
      "",
      false,
      {}};
  for (const Body& body : bodies) {
    for (const Ground& ground : grounds) {
      for (const Collider& collider : colliders(plan, false)) {
        if (collider.kind == Collider::Kind::gimpact) continue;  // it is there for meshes
        section.runs.push_back(run_partner(body, ground, collider));
        fmt::print("partners, {:<48} {:<18} {}\n", section.runs.back().variant, collider.name(),
                   section.runs.back().note);
        std::fflush(stdout);
      }
    }
  }
  return section;
}

}  // namespace odds::ode_scenes
