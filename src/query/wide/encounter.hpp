// Two wide trees in one relative pose: what the wide searches ask besides their kernels.
#pragma once

#include <algorithm>

#include "odds/query/answer.hpp"
#include "odds/query/request.hpp"
#include "odds/tree/wide_tree.hpp"
#include "odds/volume/aabb.hpp"
#include "query/node_odds/met_place.hpp"
#include "query/node_odds/node_odds.hpp"
#include "query/posed_meshes.hpp"
#include "query/search/bucket_queue.hpp"
#include "query/wide/triangle_kernel.hpp"

namespace odds::query::wide {

struct NearestTask;

/// Made once per query. Both trees and the posed meshes must outlive it.
class Encounter {
 public:
  Encounter(const tree::WideTree& a, const tree::WideTree& b, const PosedMeshes& meshes,
            EstimatorKind estimator) noexcept;

  /// See query::Encounter::far_apart.
  [[nodiscard]] bool far_apart() const noexcept { return are_far_apart(a_, b_, meshes_.pose()); }
  [[nodiscard]] static bool are_far_apart(const tree::WideTree& a, const tree::WideTree& b,
                                          const math::Pose& b_in_a) noexcept {
    return !(b_in_a.translation.norm() <= (a.reach() + b.reach()) * most_stretch);
  }
  /// Whether the boxes of both roots are apart along one of their fifteen separating axes (Gottschalk et al. 1996).
  /// What a broad phase calls near, with boxes along the world's axes, mostly is: this takes a tenth of opening the
  /// roots.
  [[nodiscard]] static bool are_roots_apart(const tree::WideTree& a, const tree::WideTree& b,
                                            const math::Pose& b_in_a) noexcept;

  [[nodiscard]] const tree::WideTree& a() const noexcept { return a_; }
  [[nodiscard]] const tree::WideTree& b() const noexcept { return b_; }
  [[nodiscard]] const PosedMeshes& meshes() const noexcept { return meshes_; }
  /// Sides are 0 (A) and 1 (B).
  [[nodiscard]] const WideNode* nodes(std::uint32_t side) const noexcept { return nodes_[side]; }
  [[nodiscard]] ODDS_LANES_INLINE LaneNumbers numbers(std::uint32_t side, Slot slot) const noexcept {
    return {nodes_[side][slot / wide_lanes], slot % wide_lanes};
  }
  [[nodiscard]] tree::ChildRef child(std::uint32_t side, Slot slot) const noexcept {
    return nodes_[side][slot / wide_lanes].child[slot % wide_lanes];
  }
  [[nodiscard]] bool are_leaves(Slot slot_a, Slot slot_b) const noexcept {
    return child(0, slot_a).is_leaf() && child(1, slot_b).is_leaf();
  }
  /// `slot` must lead to a leaf.
  [[nodiscard]] PlacedLeaf leaf(std::uint32_t side, Slot slot) const noexcept {
    return {nodes_[side][slot / wide_lanes], slot % wide_lanes, leaves_[side][child(side, slot).index()]};
  }
  /// How the other tree's frame stands in this side's.
  [[nodiscard]] const Turn& turn_into(std::uint32_t side) const noexcept { return turns_[side]; }
  /// Covers the rounding of all tests of bounding volumes, metres.
  [[nodiscard]] float margin() const noexcept { return margin_; }

  /// Where the centre of B's slot stands from that of A's, in A's frame: in doubles, so that near pairs lose nothing.
  ODDS_LANES_INLINE void shift(Slot slot_a, Slot slot_b, float shift[3]) const noexcept {
    const LaneNumbers a = numbers(0, slot_a);
    const LaneNumbers b = numbers(1, slot_b);
    const double* const r = meshes_.pose().rotation.data();  // by columns
    const double* const t = meshes_.pose().translation.data();
    const double center[3] = {b.center(0), b.center(1), b.center(2)};
    for (int k = 0; k < 3; ++k) {
      const double placed = ((r[k] * center[0] + r[k + 3] * center[1]) + r[k + 6] * center[2]) + t[k];
      shift[k] = static_cast<float>(placed - static_cast<double>(a.center(k)));
    }
  }

  /// The exact test of two triangles, given by their indices in the meshes.
  [[nodiscard]] bool triangles_meet(std::uint32_t triangle_a, std::uint32_t triangle_b) const noexcept;

  /// Keeps the nearest points of two triangles in the task if they are nearer than its bound.
  void bring_nearer(std::uint32_t triangle_a, std::uint32_t triangle_b, NearestTask& task) const noexcept;

  /// From the point of A's triangle that is nearest to B's to that of B's, in A's frame.
  [[nodiscard]] Vec3 shortest_way(std::uint32_t triangle_a, std::uint32_t triangle_b) const noexcept;

  /// See query::Encounter.
  [[nodiscard]] float rank(Slot slot_a, Slot slot_b) const noexcept;
  [[nodiscard]] float probability(Slot slot_a, Slot slot_b) const noexcept;
  /// Asks the caches for the statistics of both slots.
  void prefetch(const NodePair& pair) const noexcept {
    for (const auto* at : {&a_.statistics(pair.a), &b_.statistics(pair.b)}) {
      __builtin_prefetch(at);
      __builtin_prefetch(reinterpret_cast<const char*>(at + 1) - 1);
    }
  }
  [[nodiscard]] float facing(Slot slot_a, Slot slot_b) const noexcept;
  [[nodiscard]] double thickness(Slot slot_a, Slot slot_b) const noexcept {
    return thickness_of(a_.statistics(slot_a), b_.statistics(slot_b));
  }
  [[nodiscard]] double smaller_radius(Slot slot_a, Slot slot_b) const noexcept;
  [[nodiscard]] PatchPair patches(const NodePair& pair) const noexcept;
  /// Of B's tree frame in A's.
  [[nodiscard]] const math::Pose& pose() const noexcept { return meshes_.pose(); }

 private:
  [[nodiscard]] static volume::Aabb box(const tree::WideTree& tree, Slot slot) noexcept;
  [[nodiscard]] NodesMet met(Slot slot_a, Slot slot_b) const noexcept;

  const tree::WideTree& a_;
  const tree::WideTree& b_;
  const PosedMeshes& meshes_;
  volume::RelativePose relative_;
  const WideNode* nodes_[2];
  const WideLeaf* leaves_[2];
  Turn turns_[2];
  float margin_ = 0.0F;
  EstimatorKind estimator_;
};

}  // namespace odds::query::wide
