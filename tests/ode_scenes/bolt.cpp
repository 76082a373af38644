// A bolt is turned in a nut; nothing but the thread draws it in.
#include <fmt/core.h>

#include <numbers>

#include "ode_scenes/hand.hpp"
#include "ode_scenes/picture.hpp"
#include "ode_scenes/scenes.hpp"

namespace odds::ode_scenes {
namespace {

constexpr double pitch = 0.00125;
constexpr double turns = 3.0;
constexpr double seconds = 4.0;
constexpr double turning_s = 3.0;
constexpr Physics soft{"soft contacts", 50, 1.0 / 11.0, 0.1, 0.1, 64};
constexpr Physics plain{"ODE's defaults", 50, 0.0, std::numeric_limits<double>::infinity(), 0.1, 64};

Run run_bolt(const Physics& physics, const Collider& collider) {
  Arena arena(collider, physics, 0.0);
  arena.add(made("nut", false), {});
  const Mesh bolt = made("bolt");
  const Vec3 start(0.0, 0.0, 0.0025 - bolt->lower().z());  // two threads are in
  const dGeomID geom = arena.add(bolt, {Mat3::Identity(), start}, 7800.0);
  arena.prepare();
  Hand hand{dGeomGetBody(geom), {1000.0, 1000.0, 0.0}, 0.5};
  hand.damp(0.7);
  dMass mass;
  dBodyGetMass(hand.body, &mass);
  const double rate = 2.0 * std::numbers::pi * turns / turning_s;
  const double nominal_j = 0.5 * mass.I[10] * rate * rate;
  Run run{std::string(physics.name),
          collider.name(),
          {},
          {{fmt::format("{}: {}", physics.name, collider.name()), {}}},
          {},
          {},
          collider.ours()};
  double most_j = 0.0;
  for (int i = 0; i < static_cast<int>(1000.0 * seconds); ++i) {
    const double t = std::min(0.001 * i, turning_s);
    const Mat3 turned = Eigen::AngleAxisd(-rate * t, Vec3::UnitZ()).toRotationMatrix();
    hand.pull(start, velocity_of(hand.body).z() * Vec3::UnitZ(), turned,
              t < turning_s ? Vec3(-rate * Vec3::UnitZ()) : Vec3(Vec3::Zero()));
    arena.step();
    most_j = std::max(most_j, arena.kinetic_energy());
    if (i % 10 == 0) run.traces[0].points.emplace_back(arena.time_s(), 1e3 * (start.z() - position_of(hand.body).z()));
  }
  const double advance_mm = 1e3 * (start.z() - position_of(hand.body).z());
  run.note = fmt::format("advanced {:.3f} of {:.3f} mm", advance_mm, 1e3 * pitch * turns);
  run.figures.push_back({"advance wrong by", std::abs(advance_mm - 1e3 * pitch * turns), "mm", 0.1});
  run.figures.push_back({"most energy over nominal", most_j / nominal_j, "", 3.0});
  run.figures.push_back({"change of pull, p99", percentile(hand.change_n, 0.99), "N/ms"});
  add_common(run, arena);
  run.picture = picture_of(
      arena,
      {.centre = {0, 0, 0.015}, .from = {0.3, -2, 0.5}, .width_m = 0.05, .columns = 200, .rows = 220, .cut_y = 0.0});
  return run;
}

}  // namespace

Section bolt_and_nut(const Plan& plan) {
  Section section{
      "bolt",
      "A bolt into its nut",
      fmt::format("<p>An M8 bolt (1.25 mm pitch, 0.03 mm clearance) is turned {:g} times about its axis by a "
                  "spring; along the axis nothing holds it, so that only the thread can draw it in.</p>",
                  turns),
      "s",
      "advance, mm",
      false,
      {}};
  for (const Physics* physics : {&soft, &plain}) {
    for (const Collider& collider : colliders(plan, false)) {
      section.runs.push_back(run_bolt(*physics, collider));
      fmt::print("bolt, {:<20} {:<18} {}\n", physics->name, collider.name(), section.runs.back().note);
      std::fflush(stdout);
      if (!collider.ours() || collider.budget_us >= 100.0) continue;
      section.runs.back().traces.clear();
      section.runs.back().picture.clear();
    }
  }
  return section;
}

}  // namespace odds::ode_scenes
