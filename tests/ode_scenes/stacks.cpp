// Bricks on one another: they should stay where they are.
#include <fmt/core.h>

#include "ode_scenes/picture.hpp"
#include "ode_scenes/scenes.hpp"

namespace odds::ode_scenes {
namespace {

constexpr double width = 0.2;
constexpr double length = 0.5;
constexpr double height = 0.248;
constexpr double density = 1000.0;
constexpr double most_growth_mm = 0.1;
constexpr double anchor_slip_m = 1e-5;
constexpr double most_drift_mm = 1.0;
constexpr double fallen_m = 0.1;

struct Stack {
  int bricks;
  int cells;  ///< of a brick's side: 1, 8, 11 make 12, 768, 1452 triangles
  bool mesh_ground;
  double gap_mm;
  const Physics* physics;

  [[nodiscard]] std::string name() const {
    return fmt::format("{} bricks of {} triangles on a {}, gap {:g} mm, {}", bricks, 12 * cells * cells,
                       mesh_ground ? "mesh" : "plane", gap_mm, physics->name);
  }
};

std::string box(double x, double y, double z, int cells) {
  return fmt::format("box:x={},y={},z={},cells={}", x, y, z, cells);
}

void build(Arena& arena, const Stack& stack, std::vector<dBodyID>& bodies) {
  if (stack.mesh_ground) {
    arena.add(made(box(4.0, 4.0, 1.0, 8)), {Mat3::Identity(), {0.03, 0.02, -0.5}});
  } else {
    dCreatePlane(arena.space(), 0, 0, 1, 0);
  }
  const Mesh brick = made(box(width, length, height, stack.cells));
  for (int i = 0; i < stack.bricks; ++i) {
    const Vec3 place(0.0, 0.0, height * (i + 0.5) + 1e-3 * stack.gap_mm * (i + 1));
    dGeomID geom = nullptr;
    if (arena.collider().kind == Collider::Kind::primitive) {
      dMass mass;
      dMassSetBox(&mass, density, width, length, height);
      geom = arena.add(dCreateBox(arena.space(), width, length, height), mass, place);
    } else {
      geom = arena.add(brick, {Mat3::Identity(), place}, density);
    }
    bodies.push_back(dGeomGetBody(geom));
  }
  arena.prepare();
}

struct Watched {
  double drift_mm = 0.0;  ///< the farthest any brick ever was from where it began, across
  double sunk_mm = 0.0;   ///< of the top brick below its height, at most
  double tilt_deg = 0.0;
  double fell_s = -1.0;
  double energy_gain_j = 0.0;
  double fastest_later = 0.0;  ///< after two seconds
};

Watched watch(Arena& arena, const std::vector<dBodyID>& bodies, double seconds, Trace& trace) {
  Watched w;
  std::vector<Vec3> begun;
  for (const dBodyID body : bodies) begun.push_back(position_of(body));
  const double energy = arena.energy();
  const auto steps = static_cast<int>(1000.0 * seconds);
  const int every = std::max(1, steps / 240);
  double span_mm = 0.0;
  for (int i = 0; i < steps; ++i) {
    arena.step();
    for (std::size_t k = 0; k < bodies.size(); ++k) {
      const Vec3 moved = position_of(bodies[k]) - begun[k];
      span_mm = std::max(span_mm, 1e3 * moved.head<2>().norm());
      w.sunk_mm = std::max(w.sunk_mm, 1e3 * (height * (static_cast<double>(k) + 0.5) - position_of(bodies[k]).z()));
      w.tilt_deg =
          std::max(w.tilt_deg, std::acos(std::clamp(double{dBodyGetRotation(bodies[k])[10]}, -1.0, 1.0)) * 57.29577951);
      if (i > 2000) w.fastest_later = std::max(w.fastest_later, velocity_of(bodies[k]).norm());
      if (moved.head<2>().norm() > fallen_m || -moved.z() > fallen_m || !moved.allFinite()) w.fell_s = arena.time_s();
    }
    w.energy_gain_j = std::max(w.energy_gain_j, arena.energy() - energy);
    w.drift_mm = std::max(w.drift_mm, span_mm);
    if (i % every == every - 1) {
      trace.points.emplace_back(arena.time_s(), std::max(1e-6, span_mm));
      span_mm = 0.0;
    }
    if (w.fell_s >= 0.0) break;
  }
  return w;
}

Run run_stack(const Stack& stack, const Collider& collider, double seconds, bool picture) {
  Arena arena(collider, *stack.physics);
  std::vector<dBodyID> bodies;
  build(arena, stack, bodies);
  Run run{stack.name(), collider.name(), {}, {{stack.name() + ": " + collider.name(), {}}}, {}, {}, collider.ours()};
  const Watched w = watch(arena, bodies, seconds, run.traces[0]);
  const bool stands = w.fell_s < 0.0;
  run.note = stands ? "stands" : fmt::format("falls after {:.2f} s", w.fell_s);
  run.figures.push_back({"falls", stands ? 0.0 : 1.0, "", 0.0});
  run.figures.push_back({"drift", w.drift_mm, "mm", most_drift_mm});
  run.figures.push_back({"tilt", w.tilt_deg, "deg"});
  run.figures.push_back({"sideways", arena.counts.sideways_percent(), "%", 0.0});
  run.figures.push_back({"sunk", w.sunk_mm, "mm"});
  run.figures.push_back({"energy gained", w.energy_gain_j, "J"});
  run.figures.push_back({"fastest after 2 s", 1e3 * w.fastest_later, "mm/s"});
  add_common(run, arena);
  if (picture) {
    const double tall = height * stack.bricks;
    run.picture =
        picture_of(arena, {.centre = {0, 0, 0.5 * tall}, .width_m = 1.35 * tall + 0.4, .columns = 240, .rows = 240});
  }
  return run;
}

}  // namespace

Section stacks(const Plan& plan) {
  Section section{
      "stacks",
      "Stacks of bricks",
      fmt::format("<p>Bricks of {} × {} × {} m and {} kg/m³, put on one another with a gap, for {:g} "
                  "simulated seconds. Drift is the farthest that any brick ever was from its place, across; "
                  "a brick that is 10 cm from it has fallen, and the run ends. All true normals are "
                  "vertical: others count as sideways.</p>",
                  width, length, height, density, plan.seconds),
      "s",
      "drift, mm",
      true,
      {}};
  for (const Physics* physics : {&issue_3335, &ode_defaults}) {
    for (const int bricks : plan.bricks) {
      for (const int cells : {1, 8, 11}) {
        for (const bool ground : {false, true}) {
          for (const double gap : plan.gaps_mm) {
            const Stack stack{bricks, cells, ground, gap, physics};
            const bool first = gap == plan.gaps_mm.front();
            for (const Collider& collider : colliders(plan, cells == 1)) {
              const bool usual = collider.ours() && collider.budget_us >= 100.0;
              if (!usual && !first) continue;  // the others, and starved budgets, once for each stack
              const bool pictured =
                  first && ground && bricks == 5 && cells == 8 && (usual || collider.kind == Collider::Kind::stock);
              section.runs.push_back(run_stack(stack, collider, plan.seconds, pictured));
              fmt::print("{:<75} {:<18} {}\n", stack.name(), collider.name(), section.runs.back().note);
              std::fflush(stdout);
              if (!(first && ground && bricks == 5)) section.runs.back().traces.clear();
            }
          }
        }
      }
    }
  }
  return section;
}

namespace {

/// How much farther from their places bricks were in the last tenth of the time than in the first one.
Run run_soak(const Stack& stack, const Collider& collider, double seconds) {
  Run run = run_stack(stack, collider, seconds, false);
  const auto& points = run.traces[0].points;
  const std::size_t tenth = std::max<std::size_t>(1, points.size() / 10);
  double early = 0.0;
  double late = 0.0;
  for (std::size_t i = 0; i < tenth; ++i) {
    early = std::max(early, points[i].second);
    late = std::max(late, points[points.size() - 1 - i].second);
  }
  // Without anchors it is the solver that lets them creep.
  const bool held = collider.ours() && collider.anchored_m > 0.0;
  const std::optional<double> bar = held ? std::optional(most_growth_mm) : std::nullopt;
  run.figures.insert(run.figures.begin() + 2, Figure{"grown since the first tenth", late - early, "mm", bar});
  fmt::print("{:<75} {:<18} {} drift {:.4f} mm, of it after the first tenth {:.4f} mm\n", stack.name(), collider.name(),
             run.note, late, late - early);
  std::fflush(stdout);
  return run;
}

}  // namespace

Section soak(double seconds) {
  Section section{
      "soak",
      "Ten minutes",
      fmt::format("<p>A stack for {:g} simulated seconds: drift in the first tenth and in the whole. Anchored: with "
                  "friction anchors (oddsFrictionAnchorsHold), for ODE's friction holds speeds, not places. Beside it "
                  "the same stack of ODE's boxes: what they drift is the solver's.</p>",
                  seconds),
      "s",
      "drift, mm",
      false,
      {}};
  for (const int cells : {1, 8, 11}) {
    for (const Physics* physics : {&issue_3335, &ode_defaults}) {
      const Stack stack{5, cells, true, 0.1, physics};
      for (const double anchored_m : {anchor_slip_m, 0.0}) {
        section.runs.push_back(run_soak(stack, {.in_work = true, .anchored_m = anchored_m}, seconds));
        if (cells == 1) {
          section.runs.push_back(
              run_soak(stack, {.kind = Collider::Kind::primitive, .anchored_m = anchored_m}, seconds));
        }
      }
    }
  }
  return section;
}

}  // namespace odds::ode_scenes
