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
  const Vec3f& ha = box_a.half_;
  const Vec3f& hb = box_b.half_;
  const Vec3f t = (b_in_a * Vec3(box_b.center_.cast<double>()) - box_a.center_.cast<double>()).cast<float>();
  // No axis parts boxes whose middles are nearer to each other than both are thick.
  const float thick = ha.minCoeff() + hb.minCoeff();
  if (math::squared_length(t) < thick * thick) return false;
  const Mat3f r = b_in_a.rotation.cast<float>();
  const auto three = [](const auto& v) noexcept { return Vector{v[0], v[1], v[2], 0.0F}; };
  const auto magnitude = [](const Vector& v) noexcept -> Vector { return v < 0.0F ? -v : v; };
  const Vector row[3] = {three(r.row(0)), three(r.row(1)), three(r.row(2))};
  const Vector abs_row[3] = {magnitude(row[0]), magnitude(row[1]), magnitude(row[2])};
  const Vector extents_b = three(hb);
  // The axes of A, by its axes; those of B, by its.
  const Vector enclosed =
      (magnitude(three(r.col(0))) * hb[0] + magnitude(three(r.col(1))) * hb[1]) + magnitude(three(r.col(2))) * hb[2];
  const Vector along_a = magnitude(three(t)) - (three(ha) + enclosed);
  const Vector along_b = magnitude((t[0] * row[0] + t[1] * row[1]) + t[2] * row[2]) -
                         (extents_b + ((ha[0] * abs_row[0] + ha[1] * abs_row[1]) + ha[2] * abs_row[2]));
  Vector gap = along_a > along_b ? along_a : along_b;
  // An axis of each, crossed: by those of B.
  const auto next = [](const Vector& v) noexcept { return Vector{v[1], v[2], v[0], 0.0F}; };
  const Vector next_b = next(extents_b);
  const Vector last_b = next(next_b);
  for (int i = 0; i < 3; ++i) {
    const int i1 = (i + 1) % 3;
    const int i2 = (i + 2) % 3;
    const Vector next_row = next(abs_row[i]);
    const Vector reach = (ha[i1] * abs_row[i2] + ha[i2] * abs_row[i1]) + (next_b * next(next_row) + last_b * next_row);
    const Vector crossed = magnitude(t[i2] * row[i1] - t[i1] * row[i2]) - reach;
    gap = crossed > gap ? crossed : gap;
  }
  // Covers rotations that are only just ones, and the rounding of a dozen floats.
  constexpr double share = 8.0 * tolerances::pose_orthonormality + 32.0 * 0x1p-24;
  const float margin =
      static_cast<float>(share * (a.reach() + b.reach() + b_in_a.translation.norm())) + volume::least_margin;
  return gap[0] > margin || gap[1] > margin || gap[2] > margin;
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

MetPlace Encounter::place(Slot slot_a, Slot slot_b) const noexcept {
  return met_place(a_.statistics(slot_a), b_.statistics(slot_b), static_cast<double>(box(a_, slot_a).radius()),
                   static_cast<double>(box(b_, slot_b).radius()), meshes_.pose());
}

}  // namespace odds::query::wide
