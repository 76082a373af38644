#include "query/wide/encounter.hpp"

#include <algorithm>
#include <cmath>

#include "odds/math/float_sums.hpp"
#include "query/wide/searches.hpp"

namespace odds::query::wide {
namespace {

Turn make_turn(const volume::RelativePose& pose) noexcept {
  const auto vector = [](const auto& v) { return Vector{v[0], v[1], v[2], 0.0F}; };
  Turn turn;
  for (int j = 0; j < 3; ++j) {
    turn.column[j] = vector(pose.rotation.col(j));
    turn.abs_column[j] = vector(pose.abs_rotation.col(j));
  }
  turn.t = vector(pose.translation);
  return turn;
}

}  // namespace

Encounter::Encounter(const tree::WideTree& a, const tree::WideTree& b, const PosedMeshes& meshes,
                     EstimatorKind estimator) noexcept
    : a_(a),
      b_(b),
      meshes_(meshes),
      nodes_{a.nodes(), b.nodes()},
      leaves_{a.leaves(), b.leaves()},
      estimator_(estimator) {
  const math::Pose& pose = meshes.pose();
  // Bodies that are farther apart than their own sizes are only asked for their distance.
  const double reach = std::max(a.reach() + b.reach(), pose.translation.norm());
  // Sums of up to 50 roundings of `reach` stand for a gap along a slab: twice the margin that single boxes need.
  relative_ = volume::RelativePose::make(pose, 4.0 * reach);
  turns_[0] = make_turn(relative_);
  turns_[1] = make_turn(volume::RelativePose::make(pose.inverse(), 4.0 * reach));
  margin_ = relative_.margin;
}

bool Encounter::are_roots_apart(const tree::WideTree& a, const tree::WideTree& b, const math::Pose& b_in_a) noexcept {
  const volume::Aabb box_a = box(a, tree::WideTree::root);
  const volume::Aabb box_b = box(b, tree::WideTree::root);
  const double reach = std::max(a.reach() + b.reach(), b_in_a.translation.norm());
  const volume::RelativePose relative = volume::RelativePose::make(b_in_a, reach);
  const volume::BoxPairView view = view_of(box_a, box_b, relative);
  // Rotations that are only just ones stretch boxes.
  const float margin = relative.margin + static_cast<float>(8.0 * tolerances::pose_orthonormality * reach);
  return !faces_overlap(box_a.half_, box_b.half_, view, margin) ||
         !edges_overlap(box_a.half_, box_b.half_, view, margin);
}

bool Encounter::triangles_meet(std::uint32_t triangle_a, std::uint32_t triangle_b) const noexcept {
  return meshes_.meet({triangle_a, triangle_b});
}

void Encounter::bring_nearer(std::uint32_t triangle_a, std::uint32_t triangle_b, NearestTask& task) const noexcept {
  const tree::TriangleCorners a = meshes_.corners_a(triangle_a);
  const tree::TriangleCorners b = meshes_.corners_b(triangle_b);
  const primitive::ClosestPoints points = primitive::closest_points(a.data(), b.data());
  const double distance = std::sqrt(points.squared_distance);
  if (!(distance < task.bound) && (task.found || !(distance <= task.bound))) return;
  task.bound = distance;
  task.found = true;
  task.points = points;
  task.triangles = {triangle_a, triangle_b};
}

Vec3 Encounter::shortest_way(std::uint32_t triangle_a, std::uint32_t triangle_b) const noexcept {
  const tree::TriangleCorners a = meshes_.corners_a(triangle_a);
  const tree::TriangleCorners b = meshes_.corners_b(triangle_b);
  const primitive::ClosestPoints points = primitive::closest_points(a.data(), b.data());
  return points.on_b - points.on_a;
}

volume::Aabb Encounter::box(const tree::WideTree& tree, Slot slot) noexcept {
  const tree::WideNode& node = tree.nodes()[slot / wide_lanes];
  const std::uint32_t lane = slot % wide_lanes;
  volume::Aabb box;
  box.center_ = Vec3f(node.center[0][lane], node.center[1][lane], node.center[2][lane]);
  box.half_ = Vec3f(node.half[0][lane], node.half[1][lane], node.half[2][lane]);
  return box;
}

NodesMet Encounter::met(Slot slot_a, Slot slot_b) const noexcept {
  const volume::Aabb a = box(a_, slot_a);
  const volume::Aabb b = box(b_, slot_b);
  return {a_.statistics(slot_a),          b_.statistics(slot_b), relative_.rotation, a.volume(), b.volume(),
          overlap_volume(a, b, relative_)};
}

float Encounter::rank(Slot slot_a, Slot slot_b) const noexcept {
  return met_rank(met(slot_a, slot_b), estimator_, {a_.levels(), b_.levels()});
}

float Encounter::probability(Slot slot_a, Slot slot_b) const noexcept {
  return met_probability(met(slot_a, slot_b), estimator_, {a_.levels(), b_.levels()});
}

float Encounter::facing(Slot slot_a, Slot slot_b) const noexcept {
  return math::dot(a_.statistics(slot_a).mean_normal,
                   math::times(relative_.rotation, b_.statistics(slot_b).mean_normal));
}

double Encounter::smaller_radius(Slot slot_a, Slot slot_b) const noexcept {
  return static_cast<double>(std::min(box(a_, slot_a).radius(), box(b_, slot_b).radius()));
}

PatchPair Encounter::patches(const NodePair& pair) const noexcept {
  return {&a_.statistics(pair.a), &b_.statistics(pair.b), box(a_, pair.a).radius(), box(b_, pair.b).radius()};
}

}  // namespace odds::query::wide
