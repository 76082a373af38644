// What all scenes share.
#include "ode_scenes/bullet.hpp"
#include "ode_scenes/scenes.hpp"

namespace odds::ode_scenes {

std::vector<Collider> colliders(const Plan& plan, bool primitive) {
  std::vector<Collider> list;
  for (const double budget : plan.budgets_us)
    list.push_back({Collider::Kind::odds, budget, plan.in_work, plan.look_ns});
  if (!plan.others) return list;
  list.push_back({Collider::Kind::stock});
  if (primitive) list.push_back({Collider::Kind::primitive});
  if (plan.gimpact && Bullet::available()) list.push_back({Collider::Kind::gimpact});
  return list;
}

void add_common(Run& run, Arena& arena) {
  const ContactCounts& counts = arena.counts;
  run.figures.push_back({"contacts, mean", counts.mean(), ""});
  run.figures.push_back(
      {"most", static_cast<double>(counts.most), "", run.ours ? std::optional<double>(8.0) : std::nullopt});
  run.figures.push_back({"deepest", 1e3 * counts.deepest_m, "mm"});
  run.figures.push_back({"truly deepest", 1e3 * arena.truly_deepest_m(), "mm"});
  run.figures.push_back({"true depth, mean", 1e3 * arena.mean_true_depth_m(), "mm"});
  run.figures.push_back({"most work of contacts", 1e3 * arena.most_work_of_contacts(), "mJ"});
  run.figures.push_back({"in all", 1e3 * arena.work_of_contacts(), "mJ"});
  run.figures.push_back({"collision, p50", percentile(arena.collide_us, 0.5), "µs"});
  run.figures.push_back({"p99", percentile(arena.collide_us, 0.99), "µs"});
  run.figures.push_back({"p99.9", percentile(arena.collide_us, 0.999), "µs"});
  run.figures.push_back({"step, p50", percentile(arena.frame_us, 0.5), "µs"});
}

}  // namespace odds::ode_scenes
