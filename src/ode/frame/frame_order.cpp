// Which pairs of a frame come first: from how they move, where they are, and what the frames before found.
#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "ode/frame/frame_budget.hpp"
#include "ode/vectors.hpp"

namespace odds::ode {
namespace {

struct Box {
  Vec3 lower;
  Vec3 upper;
};

Box box_of(dGeomID geom) noexcept {
  dReal aabb[6];
  dGeomGetAABB(geom, aabb);
  // A plane's box is infinite.
  static constexpr double far = 1e9;
  const auto bound = [](dReal x) { return std::clamp(static_cast<double>(x), -far, far); };
  return {{bound(aabb[0]), bound(aabb[2]), bound(aabb[4])}, {bound(aabb[1]), bound(aabb[3]), bound(aabb[5])}};
}

Vec3 velocity_at(dGeomID geom, const Vec3& point) noexcept {
  const dBodyID body = dGeomGetBody(geom);
  if (body == nullptr) return Vec3::Zero();
  dVector3 velocity;
  dBodyGetPointVel(body, point.x(), point.y(), point.z(), velocity);
  return vector_of(velocity);
}

void look(FrameCandidate& candidate, const FrameSettings& settings, std::uint64_t frame) noexcept {
  const Box a = box_of(candidate.a);
  const Box b = box_of(candidate.b);
  const Vec3 lower = a.lower.cwiseMax(b.lower);
  const Vec3 upper = a.upper.cwiseMin(b.upper);
  const Vec3 middle = 0.5 * (lower + upper);
  candidate.speed = (velocity_at(candidate.a, middle) - velocity_at(candidate.b, middle)).norm();
  if (!std::isfinite(candidate.speed)) candidate.speed = 0.0;
  const FramePair& known = *candidate.memory;
  PairSigns& signs = candidate.signs;
  signs.hit_probability = known.probability;
  signs.proved = known.proved;
  signs.ever_contact = known.touched > 0;
  signs.since_contact = frame - 1 - known.touched;
  constexpr double frame_s = 0.01;  // nobody says how long a frame is; only the order matters
  signs.way_share = candidate.speed * frame_s / std::max((upper - lower).norm(), 1e-9);
  if (settings.attends) {
    const double far = (middle - settings.attention).norm() / settings.attention_radius;
    signs.attention = std::max(0.1, 1.0 / (1.0 + far * far));
  }
}

}  // namespace

void put_in_order(std::vector<FrameCandidate>& candidates, const FrameSettings& settings,
                  std::uint64_t frame) noexcept {
  double fastest = 0.0;
  for (FrameCandidate& candidate : candidates) {
    look(candidate, settings, frame);
    fastest = std::max(fastest, candidate.speed);
  }
  double most_important = -std::numeric_limits<double>::infinity();
  for (FrameCandidate& candidate : candidates) {
    candidate.signs.relative_speed = fastest > 0.0 ? candidate.speed / fastest : 0.0;
    candidate.importance = importance(candidate.signs);
    most_important = std::max(most_important, candidate.importance);
  }
  for (FrameCandidate& candidate : candidates) {
    candidate.turn = turn(candidate.importance, most_important, frame - 1 - candidate.memory->served);
  }
  std::sort(candidates.begin(), candidates.end(), [](const FrameCandidate& x, const FrameCandidate& y) {
    return std::tie(y.turn, y.importance, x.order) < std::tie(x.turn, x.importance, y.order);
  });
}

}  // namespace odds::ode
