#include "query/wide/encounter.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "odds/math/float_sums.hpp"
#include "query/wide/searches.hpp"

namespace odds::query::wide {
namespace {

using Bits = std::int32_t __attribute__((vector_size(16)));

Vector magnitude(Vector v) noexcept { return std::bit_cast<Vector>(std::bit_cast<Bits>(v) & 0x7FFFFFFF); }
Vector yzx(Vector v) noexcept { return Vector{v[1], v[2], v[0], v[3]}; }
Vector zxy(Vector v) noexcept { return Vector{v[2], v[0], v[1], v[3]}; }
bool any(Bits set) noexcept { return ((set[0] | set[1]) | set[2]) != 0; }

Vector narrowed(double x, double y, double z) noexcept {
  using Doubles = double __attribute__((vector_size(32)));
  return __builtin_convertvector((Doubles{x, y, z, 0.0}), Vector);
}
Vector sum(const Vector (&of)[3], Vector weights) noexcept {
  return (of[0] * weights[0] + of[1] * weights[1]) + of[2] * weights[2];
}
Turn turn_of(const math::Pose& pose) noexcept {
  const Mat3& r = pose.rotation;
  Turn turn;
  for (int j = 0; j < 3; ++j) {
    turn.column[j] = narrowed(r(0, j), r(1, j), r(2, j));
    turn.abs_column[j] = magnitude(turn.column[j]) + volume::RelativePose::more_than_rounding;
  }
  turn.t = narrowed(pose.translation[0], pose.translation[1], pose.translation[2]);
  return turn;
}
/// The i-th numbers.
Vector across(const Vector (&of)[3], int i) noexcept { return Vector{of[0][i], of[1][i], of[2][i], 0.0F}; }

/// The box of a tree's root.
struct RootBox {
  Vector center;
  Vector half;
  explicit RootBox(const tree::WideTree& tree) noexcept {
    const LaneNumbers numbers(*tree.nodes(), tree::WideTree::root);
    center = Vector{numbers.center(0), numbers.center(1), numbers.center(2), 0.0F};
    half = Vector{numbers.half(0), numbers.half(1), numbers.half(2), 0.0F};
  }
};

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
  turns_[0] = turn_of(pose);
  turns_[1] = turn_of(pose.inverse());
  margin_ = relative_.margin;
}

// As volume::faces_overlap and edges_overlap, but an axis in each lane: every query of bodies that may be near asks it.
bool Encounter::are_roots_apart(const tree::WideTree& a, const tree::WideTree& b, const math::Pose& b_in_a) noexcept {
  const double reach = std::max(a.reach() + b.reach(), b_in_a.translation.norm());
  // Rotations that are only just ones stretch boxes.
  const float margin =
      volume::RelativePose::margin_of(reach) + static_cast<float>(8.0 * tolerances::pose_orthonormality * reach);
  const RootBox of_a(a);
  const RootBox of_b(b);
  const auto [turn, steep, translation] = turn_of(b_in_a);
  const Vector shift = (sum(turn, of_b.center) + translation) - of_a.center;
  const Vector gaps_a = magnitude(shift) - (of_a.half + sum(steep, of_b.half));
  if (any(gaps_a > margin)) return true;
  const Vector back[3] = {across(turn, 0), across(turn, 1), across(turn, 2)};
  const Vector steep_back[3] = {across(steep, 0), across(steep, 1), across(steep, 2)};
  const Vector gaps_b = magnitude(sum(back, shift)) - (of_b.half + sum(steep_back, of_a.half));
  if (any(gaps_b > margin)) return true;
  Bits apart{};
  for (int j = 0; j < 3; ++j) {
    const int j1 = (j + 1) % 3;
    const int j2 = (j + 2) % 3;
    const Vector distance = magnitude(zxy(shift) * yzx(turn[j]) - yzx(shift) * zxy(turn[j]));
    const Vector reach_a = yzx(of_a.half) * zxy(steep[j]) + zxy(of_a.half) * yzx(steep[j]);
    const Vector reach_b = of_b.half[j1] * steep[j2] + of_b.half[j2] * steep[j1];
    apart |= distance - (reach_a + reach_b) > 2.0F * margin;
  }
  return any(apart);
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
