// A round peg is led into its hole.
#include <fmt/core.h>

#include "ode_scenes/hand.hpp"
#include "ode_scenes/picture.hpp"
#include "ode_scenes/scenes.hpp"

namespace odds::ode_scenes {
namespace {

constexpr double radius = 0.01;
constexpr double length = 0.06;
constexpr double density = 7800.0;
constexpr double start_m = 0.005;
constexpr double goal_m = -0.018;
constexpr double seconds = 3.0;
constexpr Physics physics{"", 50, 1.0 / 11.0, 0.1, 0.1, 64};

struct Peg {
  double clearance_mm;
  double beside_mm;

  [[nodiscard]] std::string name() const {
    return fmt::format("clearance {:g} mm, begun {:g} mm beside the axis", clearance_mm, beside_mm);
  }
};

Run run_peg(const Peg& peg, const Collider& collider) {
  Arena arena(collider, physics, 0.0);
  arena.add(made(fmt::format("plate_with_hole:peg_radius={},clearance={}", radius, 1e-3 * peg.clearance_mm), false),
            {});
  double tip = 0.5 * length;  // below the centre of mass
  dGeomID geom = nullptr;
  const Vec3 beside = 1e-3 * peg.beside_mm * Vec3(std::cos(0.4), std::sin(0.4), 0.0);
  if (collider.kind == Collider::Kind::primitive) {
    dMass mass;
    dMassSetCylinder(&mass, density, 3, radius, length);
    geom = arena.add(dCreateCylinder(arena.space(), radius, length), mass, beside + (start_m + tip) * Vec3::UnitZ());
  } else {
    const Mesh mesh = made(fmt::format("peg:radius={},length={}", radius, length));
    tip = -mesh->lower().z();
    geom = arena.add(mesh, {Mat3::Identity(), beside + (start_m + tip) * Vec3::UnitZ()}, density);
  }
  arena.prepare();
  Hand hand{dGeomGetBody(geom), Vec3::Constant(2000.0), 2.0};
  hand.damp(0.7);
  Run run{peg.name(), collider.name(), {}, {{peg.name() + ": " + collider.name(), {}}}, {}, {}, collider.ours()};
  for (int i = 0; i < static_cast<int>(1000.0 * seconds); ++i) {
    const double share = std::min(1.0, 0.001 * i / (0.5 * seconds));
    const Vec3 target = beside + (start_m + share * (goal_m - start_m) + tip) * Vec3::UnitZ();
    hand.pull(target, share < 1.0 ? Vec3((goal_m - start_m) / (0.5 * seconds) * Vec3::UnitZ()) : Vec3(Vec3::Zero()),
              Mat3::Identity(), Vec3::Zero());
    arena.step();
    if (i % 10 == 0) run.traces[0].points.emplace_back(arena.time_s(), 1e3 * (position_of(hand.body).z() - tip));
  }
  const double missing_mm = 1e3 * std::abs(position_of(hand.body).z() - tip - goal_m);
  run.note = missing_mm < 1.0 ? "reaches the bottom" : fmt::format("stops {:.1f} mm before it", missing_mm);
  run.figures.push_back({"short of the goal", missing_mm, "mm", 0.5});
  run.figures.push_back({"greatest pull", hand.most_n, "N"});
  run.figures.push_back({"change of pull, p99", percentile(hand.change_n, 0.99), "N/ms"});
  add_common(run, arena);
  run.picture = picture_of(
      arena,
      {.centre = {0, 0, 0.01}, .from = {0.2, -2, 0.5}, .width_m = 0.09, .columns = 240, .rows = 200, .cut_y = 0.0});
  return run;
}

}  // namespace

Section peg_in_hole(const Plan& plan) {
  Section section{
      "peg",
      "A peg into its hole",
      fmt::format("<p>A steel peg of {:g} mm radius with a 1 mm chamfer hangs on a spring of 2000 N/m, which "
                  "leads it {:g} mm down into a plate 20 mm thick. Beside the axis, the chamfer has to lead "
                  "it in. ODE's own cylinder has no chamfer.</p>",
                  1e3 * radius, 1e3 * (start_m - goal_m)),
      "s",
      "height of the tip, mm",
      false,
      {}};
  for (const Peg& peg : {Peg{0.1, 0.05}, Peg{0.1, 0.3}, Peg{0.02, 0.01}, Peg{0.02, 0.15}}) {
    for (const Collider& collider : colliders(plan, peg.beside_mm < peg.clearance_mm)) {
      section.runs.push_back(run_peg(peg, collider));
      const Run& run = section.runs.back();
      fmt::print("peg, {:<50} {:<18} {}\n", peg.name(), collider.name(), run.note);
      std::fflush(stdout);
      const bool told = peg.clearance_mm == 0.1 && (!collider.ours() || collider.budget_us >= 100.0);
      if (!told) section.runs.back().picture.clear();
      if (!told) section.runs.back().traces.clear();
    }
  }
  return section;
}

}  // namespace odds::ode_scenes
