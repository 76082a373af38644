// Three gears, of which the first is driven and the last braked.
#include <fmt/core.h>

#include <array>
#include <numbers>

#include "ode_scenes/picture.hpp"
#include "ode_scenes/scenes.hpp"

namespace odds::ode_scenes {
namespace {

constexpr double module_m = 0.002;
constexpr double speed = 5.0;  // rad/s, of the first
constexpr double seconds = 5.0;
constexpr std::array<int, 3> teeth{24, 36, 24};
constexpr Physics soft{"soft contacts", 50, 1.0 / 11.0, 0.1, 0.1, 64};
constexpr Physics plain{"ODE's defaults", 50, 0.0, std::numeric_limits<double>::infinity(), 0.1, 64};

/// How far each gear has turned since the start.
struct Turned {
  std::array<double, 3> angle{};
  std::array<double, 3> last{};

  void follow(const std::array<dJointID, 3>& hinges) {
    for (std::size_t i = 0; i < 3; ++i) {
      const double now = dJointGetHingeAngle(hinges[i]);
      angle[i] += std::remainder(now - last[i], 2.0 * std::numbers::pi);
      last[i] = now;
    }
  }
};

Run run_gears(const Physics& physics, const Collider& collider) {
  Arena arena(collider, physics, 0.0);
  std::array<dJointID, 3> hinges{};
  double x = 0.0;
  double nominal_j = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    if (i > 0) x += 0.5 * module_m * (teeth[i - 1] + teeth[i]);
    const Mesh gear = made(fmt::format("gear:module={},teeth={},backlash=1e-4", module_m, teeth[i]));
    const double turned = i == 1 ? std::numbers::pi / teeth[1] : 0.0;  // a gap faces a tooth
    const dGeomID geom =
        arena.add(gear, {Eigen::AngleAxisd(turned, Vec3::UnitZ()).toRotationMatrix(), {x, 0, 0}}, 7800.0);
    hinges[i] = dJointCreateHinge(arena.world(), nullptr);
    dJointAttach(hinges[i], dGeomGetBody(geom), nullptr);
    dJointSetHingeAnchor(hinges[i], x, 0, 0);
    dJointSetHingeAxis(hinges[i], 0, 0, 1);
    dMass mass;
    dBodyGetMass(dGeomGetBody(geom), &mass);
    const double rate = speed * teeth[0] / teeth[i];
    nominal_j += 0.5 * mass.I[10] * rate * rate;
  }
  dJointSetHingeParam(hinges[0], dParamFMax, 0.05);
  dJointSetHingeParam(hinges[2], dParamVel, 0.0);
  dJointSetHingeParam(hinges[2], dParamFMax, 0.01);
  arena.prepare();
  Run run{std::string(physics.name),
          collider.name(),
          {},
          {{fmt::format("{}: {}", physics.name, collider.name()), {}}},
          {},
          {},
          collider.ours()};
  Turned turned;
  double most_j = 0.0;
  double lost = 0.0;
  for (int i = 0; i < static_cast<int>(1000.0 * seconds); ++i) {
    dJointSetHingeParam(hinges[0], dParamVel, speed * std::min(1.0, 0.002 * i));
    arena.step();
    turned.follow(hinges);
    const double energy = arena.kinetic_energy();
    most_j = std::max(most_j, energy);
    lost = std::max(lost, std::abs(turned.angle[2] - turned.angle[0]));
    if (i % 10 == 0) run.traces[0].points.emplace_back(arena.time_s(), energy / nominal_j);
  }
  const double wanted = speed * (seconds - 0.25);
  run.note = fmt::format("{:.0f} of {:.0f} degrees", 57.29577951 * std::abs(turned.angle[2]), 57.29577951 * wanted);
  run.figures.push_back({"first to last gear", 57.29577951 * lost, "deg", 2.0});
  run.figures.push_back({"not turned", 100.0 * std::max(0.0, 1.0 - std::abs(turned.angle[2]) / wanted), "%"});
  run.figures.push_back({"most energy over nominal", most_j / nominal_j, "", 1.5});
  add_common(run, arena);
  run.picture = picture_of(
      arena, {.centre = {0.5 * x, 0, 0}, .from = {0.2, -0.6, 2}, .width_m = 0.19, .columns = 320, .rows = 180});
  return run;
}

}  // namespace

Section gears(const Plan& plan) {
  Section section{
      "gears",
      "Gears",
      fmt::format("<p>Steel gears of 24, 36 and 24 teeth, module {:g} mm, 0.1 mm backlash, on fixed axes. The "
                  "first is driven at {:g} rad/s, the last is braked with 0.01 N m; nothing but contacts "
                  "joins them. At nominal speed the energy is 1.</p>",
                  1e3 * module_m, speed),
      "s",
      "energy over nominal",
      true,
      {}};
  for (const Physics* physics : {&soft, &plain}) {
    for (const Collider& collider : colliders(plan, false)) {
      section.runs.push_back(run_gears(*physics, collider));
      fmt::print("gears, {:<20} {:<18} {}\n", physics->name, collider.name(), section.runs.back().note);
      std::fflush(stdout);
      if (collider.ours() && collider.budget_us < 100.0) section.runs.back().traces.clear();
      if (physics == &plain || !section.runs.back().traces.empty()) continue;
      section.runs.back().picture.clear();
    }
  }
  return section;
}

}  // namespace odds::ode_scenes
