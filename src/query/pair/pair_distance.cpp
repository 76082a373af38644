// The distance of a pair.
#include <algorithm>
#include <cmath>

#include "odds/math/tolerances.hpp"
#include "query/memory/pair_memory.hpp"
#include "query/shape_data.hpp"

namespace odds::query {
namespace {

bool usable(const math::Pose& pose, const DistanceRequest& request) noexcept {
  return pose.is_rigid(tolerances::pose_orthonormality) && request.within >= 0.0 && request.budget.microseconds > 0.0 &&
         request.budget.work_units > 0;
}

/// `answer.lower` holds what the enclosing balls say; `farthest`: no two points are farther apart, metres.
void search_nearest(const Pair::Implementation& pair, const wide::Encounter& encounter, double farthest,
                    const DistanceRequest& request, Spending& spending, DistanceAnswer& answer) noexcept {
  wide::NearestTask task{encounter, spending, std::min(request.within, farthest)};
  pair.wide->nearest(task);
  answer.proved = task.finished;
  if (task.found) {
    answer.upper = task.bound;
    answer.on_a = task.points.on_a + encounter.a().origin();
    answer.on_b = task.points.on_b + encounter.a().origin();
    answer.triangle_a = task.triangles.a;
    answer.triangle_b = task.triangles.b;
  }
  answer.lower = std::max(answer.lower, task.finished ? task.bound : std::min(task.lower, task.bound));
  answer.lower = std::min(answer.lower, answer.upper);
}

}  // namespace

DistanceAnswer Pair::distance(const math::Pose& pose_b_in_a, const DistanceRequest& request) const noexcept {
  const Implementation& pair = *implementation_;
  DistanceAnswer answer;
  const auto* a = std::get_if<tree::WideTree>(&pair.a->data().tree);
  const auto* b = std::get_if<tree::WideTree>(&pair.b->data().tree);
  if (a == nullptr || b == nullptr || pair.polygon_free || !usable(pose_b_in_a, request)) return answer;
  Spending spending(request.budget);
  const PosedMeshes meshes(pair.a->mesh(), pair.b->mesh(), a->origin(), b->origin(), pose_b_in_a);
  // The square of what is beyond 1e154 metres would be infinite, and so the lower bound.
  const double apart = meshes.pose().translation.stableNorm();
  const double reach = a->reach() + b->reach();
  answer.lower = std::max(0.0, apart - reach * most_stretch);
  const double farthest = (apart + reach) * most_stretch;
  if (answer.lower > request.within) {
    answer.lower = request.within;
    answer.proved = true;
  } else if (apart <= 1000.0 * reach && std::isfinite(farthest)) {
    const wide::Encounter encounter(*a, *b, meshes, EstimatorKind::kinematic);
    search_nearest(pair, encounter, farthest, request, spending, answer);
  }
  answer.cost = spending.close();
  return answer;
}

}  // namespace odds::query
