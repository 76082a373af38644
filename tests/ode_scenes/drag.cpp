// A tool is dragged over hilly ground by a spring, as a hand drags it through a haptic device.
#include <fmt/core.h>

#include "odds/query/ray.hpp"
#include "odds/query/shape.hpp"
#include "ode_scenes/hand.hpp"
#include "ode_scenes/picture.hpp"
#include "ode_scenes/scenes.hpp"

namespace odds::ode_scenes {
namespace {

constexpr double seconds = 6.0;
constexpr double from_x = -0.15;
constexpr double to_x = 0.15;
constexpr double press_m = 0.003;
constexpr double tube = 0.008;
constexpr double margin_m = 0.0002;  // four steps of the tool
constexpr double most_change_n = 0.1;
constexpr double ball_density = 0.05 / (4.0 / 3.0 * 3.14159265 * tube * tube * tube);  // 50 g, as ODE's sphere
constexpr Physics physics{"", 50, 1.0 / 11.0, 0.1, 0.3, 64};

/// Height of the ground along the path, every millimetre.
std::vector<double> heights(const Mesh& ground) {
  const auto shape = query::Shape::build(ground);
  std::vector<double> found;
  for (double x = from_x; x <= to_x + 1e-3; x += 1e-3) {
    const auto hit = query::cast_ray(*shape.value(), {x, 0.013, 1.0}, -Vec3::UnitZ(), 2.0);
    found.push_back(hit ? 1.0 - hit->distance : 0.0);
  }
  return found;
}

Run run_drag(const std::string& tool, const Mesh& ground, const std::vector<double>& path, const Collider& collider) {
  Arena arena(collider, physics, -9.81);
  arena.add(ground, {});
  dGeomID geom = nullptr;
  const auto height = [&path](double x) {
    const double at = std::clamp((x - from_x) * 1e3, 0.0, static_cast<double>(path.size()) - 1.001);
    const auto i = static_cast<std::size_t>(at);
    return path[i] + (at - static_cast<double>(i)) * (path[i + 1] - path[i]);
  };
  const Vec3 start(from_x, 0.013, height(from_x) + 3.0 * tube);
  if (collider.kind == Collider::Kind::primitive) {
    dMass mass;
    dMassSetSphereTotal(&mass, 0.05, tube);
    geom = arena.add(dCreateSphere(arena.space(), tube), mass, start);
  } else {
    geom = arena.add(made(tool), {Mat3::Identity(), start}, tool[0] == 'i' ? ball_density : 2000.0);
  }
  arena.prepare();
  Hand hand{dGeomGetBody(geom), Vec3::Constant(2000.0), 0.5};
  hand.damp(0.7);
  Run run{tool.substr(0, tool.find(':')),
          collider.name(),
          {},
          {{fmt::format("{}: {}", tool.substr(0, tool.find(':')), collider.name()), {}}},
          {},
          {},
          collider.ours()};
  constexpr double speed = (to_x - from_x) / seconds;
  for (int i = 0; i < static_cast<int>(1000.0 * (seconds + 0.5)); ++i) {
    const double t = std::max(0.0, 0.001 * i - 0.5);  // half a second to set it down
    const double x = from_x + speed * t;
    const double lowering = std::max(0.0, 1.0 - 0.001 * i / 0.4) * 2.0 * tube;
    const Vec3 target(x, 0.013, height(x) + tube - press_m + lowering);
    hand.pull(target, t > 0.0 ? Vec3(speed * Vec3::UnitX()) : Vec3(Vec3::Zero()), Mat3::Identity(), Vec3::Zero());
    arena.step();
    if (i == 500) hand.change_n.clear();
    if (i % 10 == 0) run.traces[0].points.emplace_back(arena.time_s(), hand.felt_n());
  }
  const bool judged = collider.margin_m > 0.0;
  run.figures.push_back({"change of force, p99", percentile(hand.change_n, 0.99), "N/ms",
                         judged ? std::optional<double>(most_change_n) : std::nullopt});
  run.figures.push_back({"p99.9", percentile(hand.change_n, 0.999), "N/ms"});
  run.figures.push_back({"greatest change", percentile(hand.change_n, 1.0), "N/ms"});
  run.figures.push_back({"greatest force", hand.most_n, "N"});
  run.note = fmt::format("p99 {:.3f} N/ms", run.figures[0].value);
  add_common(run, arena);
  run.picture =
      picture_of(arena, {.centre = {0, 0, 0}, .from = {0.5, -2, 1.2}, .width_m = 0.5, .columns = 320, .rows = 200});
  return run;
}

}  // namespace

Section drag(const Plan& plan) {
  Section section{
      "drag",
      "A tool over hilly ground",
      "<p>A torus of 1,024 triangles, a gear of 1,536 and a ball of 1,280 are dragged at 50 mm/s over ground of 8,192 "
      "triangles and pressed 3 mm into it, by a spring of 2000 N/m: how much does the spring's force change "
      "within a millisecond? For ODE's sphere, 0.05 N. A tool that rests on points without depth loses one now and "
      "then "
      "by some nanometres, and drops for a tick: with a margin, surfaces that are near have contacts that let them "
      "come "
      "nearer by their gap and no faster. The bar is for runs with a margin.</p>",
      "s",
      "force of the spring, N",
      false,
      {}};
  const Mesh ground = made("terrain:side=0.5,height=0.02,feature=0.3,depth=0.05,cells=64", false);
  const std::vector<double> path = heights(ground);
  for (const char* tool : {"torus:ring=0.02,tube=0.008,around=32,across=16",
                           "gear:module=0.002,teeth=16,flank=8,root=3", "icosphere:radius=0.008,frequency=8"}) {
    const bool first = tool[0] == 't';
    std::vector<Collider> all;
    for (const Collider& collider : colliders(plan, first)) {
      if (collider.ours()) {
        all.push_back(collider);
        all.back().margin_m = margin_m;
      }
      if (!collider.ours() || collider.budget_us >= 100.0) all.push_back(collider);
    }
    for (const Collider& collider : all) {
      section.runs.push_back(run_drag(tool, ground, path, collider));
      fmt::print("drag {:<20} {:<32} {}\n", std::string(tool).substr(0, 5), collider.name(), section.runs.back().note);
      std::fflush(stdout);
      const bool told = first && (!collider.ours() || collider.budget_us >= 100.0);
      if (!told) section.runs.back().traces.clear();
      if (!told) section.runs.back().picture.clear();
    }
  }
  return section;
}

}  // namespace odds::ode_scenes
