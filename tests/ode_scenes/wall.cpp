// Crates that slide over a floor into a wall, both of one mesh: what holds them there is new while they rest on what is
// known.
#include <fmt/core.h>

#include <cmath>
#include <optional>

#include "odds/math/random.hpp"
#include "ode_scenes/scenes.hpp"
#include "support/slabs.hpp"

namespace odds::ode_scenes {
namespace {

constexpr int crates = 24;
constexpr double seconds = 1.5;
constexpr double wall_at = 0.55;
struct Crate {
  double side;
  double speed;
  int cells;  ///< along an edge
  int cells_of_room;
};
constexpr Physics smooth{"ODE's defaults", 50, 0.0, 0.5, 0.1, 8};

/// A floor of 2 m by 1 m whose top is at 0.1 m, and a wall on it.
Mesh room(int cells) {
  return std::make_shared<const mesh::TriangleMesh>(testing::joined(
      testing::made_mesh(fmt::format("made:box:x=2,y=1,z=0.2,cells={}", cells)),
      testing::made_mesh(fmt::format("made:box:x=0.1,y=1,z=0.6,cells={}", cells)), Vec3(wall_at + 0.05, 0.0, 0.25)));
}

Run run_wall(const Crate& thrown, const Collider& collider) {
  const double side = thrown.side;
  const Mesh ground = room(thrown.cells_of_room);
  const Mesh crate = made(fmt::format("box:x={0},y={0},z={0},cells={1}", side, thrown.cells));
  int fell = 0;
  int went_in = 0;
  double fastest = 0.0;
  double deepest = 0.0;
  int most = 0;
  Run run{fmt::format("crates of {:g} m and {} triangles at {:g} m/s", side, 12 * thrown.cells * thrown.cells,
                      thrown.speed),
          collider.name(),
          {},
          {},
          {},
          {},
          collider.ours()};
  for (int k = 0; k < crates; ++k) {
    math::Random random(static_cast<std::uint64_t>(k + 1));
    Arena arena(collider, smooth);
    arena.add(ground, {});
    const Vec3 start(0.2, random.uniform(-0.1, 0.1), 0.1 + 0.5 * side);
    const dBodyID body = dGeomGetBody(arena.add(crate, {Mat3::Identity(), start}, 125.0));
    dBodySetLinearVel(body, thrown.speed, 0.0, 0.0);
    dBodySetAngularVel(body, 0.0, 0.0, random.uniform(1.0, 3.0));
    arena.prepare();
    bool falls = false;
    bool goes_in = false;
    for (int i = 0; i < static_cast<int>(1000.0 * seconds) && !falls && !goes_in; ++i) {
      arena.step();
      const Vec3 at = position_of(body);
      falls = at.z() < start.z() - 0.01 && std::abs(at.x()) < 0.95 && std::abs(at.y()) < 0.45;
      goes_in = at.x() > wall_at - 0.5 * side + 0.07 && at.x() < wall_at + 0.1;
      if (i > 0) fastest = std::max(fastest, velocity_of(body).norm());
    }
    fell += falls ? 1 : 0;
    went_in += goes_in ? 1 : 0;
    deepest = std::max(deepest, arena.truly_deepest_m());
    most = std::max(most, arena.counts.most);
  }
  run.figures = {{"fell through the floor", static_cast<double>(fell), "", 0.0},
                 {"in the wall by 7 cm", static_cast<double>(went_in), "", 0.0},
                 {"fastest", fastest, "m/s", 1.5 * thrown.speed},
                 {"truly deepest", 1e3 * deepest, "mm"},
                 {"most", static_cast<double>(most), "", run.ours ? std::optional<double>(8.0) : std::nullopt}};
  run.note = fmt::format("{} of {} fell through the floor, {} went into the wall", fell, crates, went_in);
  return run;
}

}  // namespace

Section wall(const Plan& plan) {
  Section section{"wall",
                  "Crates into a wall",
                  fmt::format("<p>{} crates, one after the other, slide and turn over a floor into a wall, both of one "
                              "mesh: floor and wall are to hold at once.</p>",
                              crates),
                  "",
                  "",
                  false,
                  {}};
  for (const Crate& thrown :
       {Crate{0.2, 1.0, 4, 4}, Crate{0.15, 2.0, 4, 4}, Crate{0.15, 2.0, 11, 16}, Crate{0.15, 3.0, 4, 4}}) {
    for (const Collider& collider : colliders(plan, false)) {
      section.runs.push_back(run_wall(thrown, collider));
      fmt::print("wall, {:<48} {:<18} {}\n", section.runs.back().variant, collider.name(), section.runs.back().note);
      std::fflush(stdout);
    }
  }
  return section;
}

}  // namespace odds::ode_scenes
