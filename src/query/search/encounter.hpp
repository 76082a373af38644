// Two hierarchies in one relative pose: what the searches ask about pairs of nodes and of leaves.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "odds/math/float_sums.hpp"
#include "odds/primitive/triangle_triangle.hpp"
#include "odds/query/answer.hpp"
#include "odds/query/contact_patch.hpp"
#include "odds/query/request.hpp"
#include "odds/tree/hierarchy.hpp"
#include "query/node_odds/met_place.hpp"
#include "query/node_odds/node_odds.hpp"
#include "query/node_odds/node_odds_table.hpp"
#include "query/posed_meshes.hpp"
#include "query/search/bucket_queue.hpp"
#include "query/shape_data.hpp"
#include "query/spending.hpp"

namespace odds::query {

/// Intersecting triangle pairs found so far, by their indices in the meshes. Fixed capacity.
class HitList {
 public:
  explicit HitList(std::uint32_t capacity) : pairs_(capacity) {}
  void clear() noexcept { size_ = 0; }
  [[nodiscard]] bool full(std::uint32_t wanted) const noexcept {
    return size_ >= std::min<std::size_t>(wanted, pairs_.size());
  }
  [[nodiscard]] bool empty() const noexcept { return size_ == 0; }
  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] std::size_t capacity() const noexcept { return pairs_.size(); }
  void add(TrianglePair pair) noexcept {
    if (size_ < pairs_.size()) pairs_[size_++] = pair;
  }
  [[nodiscard]] std::span<TrianglePair> pairs() noexcept { return std::span(pairs_).first(size_); }

 private:
  std::vector<TrianglePair> pairs_;
  std::size_t size_ = 0;
};

/// How a leaf pair or a search ended.
enum class Progressed : std::uint8_t {
  finished,  ///< everything asked was done
  enough,    ///< as many hits as wanted
  spent,     ///< the budget ended it
};

template <volume::BoundingVolume V>
class Encounter {
 public:
  /// `b_in_a`: of B's hierarchy frame in A's.
  Encounter(const tree::Hierarchy<V>& a, const tree::Hierarchy<V>& b, const math::Pose& b_in_a,
            const Request& request) noexcept
      : a_(a), b_(b), b_in_a_(b_in_a), estimator_(request.estimator), leaf_test_(request.leaf_test) {
    reach_ = a.reach() + b.reach();
    relative_ = V::PreparedPose::make(b_in_a_, 2.0 * reach_);
    place_ = b_in_a_.translation.template cast<float>();
  }

  /// True if the enclosing balls about both origins are apart; then nothing below may be asked (the margins assume
  /// less).
  [[nodiscard]] bool far_apart() const noexcept { return !(b_in_a_.translation.norm() <= reach_ * most_stretch); }

  /// True too for two leaves whose volumes are not to be tested.
  [[nodiscard]] bool volumes_overlap(std::uint32_t i, std::uint32_t j) const noexcept {
    if (!leaf_test_ && is_leaf_pair(i, j)) return true;
    return overlap(a_.nodes()[i].volume, b_.nodes()[j].volume, relative_);
  }

  [[nodiscard]] bool is_leaf_pair(std::uint32_t i, std::uint32_t j) const noexcept {
    return a_.nodes()[i].is_leaf() && b_.nodes()[j].is_leaf();
  }

  /// The two pairs that replace (i, j): the larger node is split, or the one that is no leaf.
  struct Children {
    NodePair first;
    NodePair second;
  };
  [[nodiscard]] Children children(std::uint32_t i, std::uint32_t j) const noexcept {
    const auto& node_a = a_.nodes()[i];
    const auto& node_b = b_.nodes()[j];
    const bool split_a = node_b.is_leaf() || (!node_a.is_leaf() && node_a.radius >= node_b.radius);
    if (split_a) return {{node_a.first, j, 0.0F}, {node_a.first + 1, j, 0.0F}};
    return {{i, node_b.first, 0.0F}, {i, node_b.first + 1, 0.0F}};
  }

  /// Asks the caches for what `volumes_overlap` and `probability` will read of the pair: on random poses a search waits
  /// for memory most of its time.
  void prefetch(const NodePair& pair) const noexcept {
    prefetch_line(&a_.nodes()[pair.a]);
    prefetch_line(&b_.nodes()[pair.b]);
    prefetch_line(&a_.statistics()[pair.a]);
    prefetch_line(&b_.statistics()[pair.b]);
  }

  /// What orders the search; see met_rank.
  [[nodiscard]] float rank(std::uint32_t i, std::uint32_t j) const noexcept {
    if (estimator_ == EstimatorKind::kinematic) return log_rate_of_log_odds(order_odds(i, j));
    return met_rank(met(i, j), estimator_, {a_.levels(), b_.levels()});
  }

  /// Estimated probability that surfaces below i and j meet, given that their volumes overlap.
  [[nodiscard]] float probability(std::uint32_t i, std::uint32_t j) const noexcept {
    if (estimator_ == EstimatorKind::kinematic) return probability_of_log_odds(odds(i, j));
    return met_probability(met(i, j), estimator_, {a_.levels(), b_.levels()});
  }

  /// What the odds of a pair are made from.
  [[nodiscard]] NodeNumbers numbers(std::uint32_t i, std::uint32_t j,
                                    std::size_t used = numbers_used(kind_of<V>)) const noexcept {
    return numbers_of(met(i, j), {place_, a_.nodes()[i].radius, b_.nodes()[j].radius}, used);
  }

  [[nodiscard]] bool tests_leaf_volumes() const noexcept { return leaf_test_; }

  /// Levels that still lie below the pair: 0 for two leaves.
  [[nodiscard]] int levels_left(std::uint32_t i, std::uint32_t j) const noexcept {
    return a_.statistics()[i].height + b_.statistics()[j].height;
  }

  /// Tests all triangles of two leaves, a row of B's triangles at a time, until `wanted` hits are in the list.
  [[nodiscard]] Progressed test_leaves(std::uint32_t i, std::uint32_t j, std::uint32_t wanted, HitList& hits,
                                       Spending& spending) const noexcept {
    const auto& leaf_a = a_.nodes()[i];
    const auto& leaf_b = b_.nodes()[j];
    for (std::uint32_t tb = leaf_b.first; tb < leaf_b.first + leaf_b.count; ++tb) {
      const tree::TriangleCorners moved = in_a(tb);
      for (std::uint32_t ta = leaf_a.first; ta < leaf_a.first + leaf_a.count; ++ta) {
        if (!spending.allows(1)) return Progressed::spent;
        spending.spend_triangle_pairs(1);
        if (primitive::triangles_intersect(a_.corners()[ta].data(), moved.data())) {
          if (hits.empty() && wanted > 1) spending.keep_time_for_contacts();
          hits.add({a_.order()[ta], b_.order()[tb]});
          if (hits.full(wanted)) return Progressed::enough;
        }
        const bool last = ta + 1 == leaf_a.first + leaf_a.count;
        if ((last || (ta - leaf_a.first) % pairs_between_polls == pairs_between_polls - 1) && !spending.may_go_on()) {
          if (!last || tb + 1 < leaf_b.first + leaf_b.count) return Progressed::spent;
        }
      }
    }
    return Progressed::finished;
  }

  [[nodiscard]] tree::TriangleCorners in_a(std::uint32_t leaf_triangle_b) const noexcept {
    const tree::TriangleCorners& corners = b_.corners()[leaf_triangle_b];
    return {b_in_a_ * corners[0], b_in_a_ * corners[1], b_in_a_ * corners[2]};
  }

  /// Of the thinner of both surfaces, metres.
  [[nodiscard]] double thickness(std::uint32_t i, std::uint32_t j) const noexcept {
    return thickness_of(a_.statistics()[i], b_.statistics()[j]);
  }
  /// Of the smaller of both bounding volumes, metres.
  [[nodiscard]] double smaller_radius(std::uint32_t i, std::uint32_t j) const noexcept {
    return static_cast<double>(std::min(a_.nodes()[i].radius, b_.nodes()[j].radius));
  }
  /// What tells where the surfaces of a pair most probably meet.
  [[nodiscard]] PatchPair patches(const NodePair& pair) const noexcept {
    return {&a_.statistics()[pair.a], &b_.statistics()[pair.b], a_.nodes()[pair.a].radius, b_.nodes()[pair.b].radius};
  }
  /// Of B's tree frame in A's.
  [[nodiscard]] const math::Pose& pose() const noexcept { return b_in_a_; }

  /// Cosine between the mean normals of both nodes, times how flat they are: -1 face to face, 1 one behind the other.
  [[nodiscard]] float facing(std::uint32_t i, std::uint32_t j) const noexcept {
    return math::dot(a_.statistics()[i].mean_normal, math::times(relative_.rotation, b_.statistics()[j].mean_normal));
  }

  [[nodiscard]] const tree::Hierarchy<V>& a() const noexcept { return a_; }
  [[nodiscard]] const tree::Hierarchy<V>& b() const noexcept { return b_; }

 private:
  [[nodiscard]] float odds(std::uint32_t i, std::uint32_t j) const noexcept {
    return log_odds(numbers(i, j), node_weights[static_cast<std::size_t>(kind_of<V>)], numbers_used(kind_of<V>));
  }

  [[nodiscard]] float order_odds(std::uint32_t i, std::uint32_t j) const noexcept {
    constexpr std::size_t used = NodeNumbers::usual;
    return log_odds(numbers(i, j, used), order_weights(kind_of<V>), used);
  }

  /// A pair takes 20 to 60 ns, but 1.5 us where both triangles lie exactly in one plane.
  static constexpr std::uint32_t pairs_between_polls = 2;

  static void prefetch_line(const void* address) noexcept { __builtin_prefetch(address); }

  [[nodiscard]] NodesMet met(std::uint32_t i, std::uint32_t j) const noexcept {
    const V& volume_a = a_.nodes()[i].volume;
    const V& volume_b = b_.nodes()[j].volume;
    return {a_.statistics()[i], b_.statistics()[j], relative_.rotation,
            volume_a.volume(),  volume_b.volume(),  overlap_volume(volume_a, volume_b, relative_)};
  }

  const tree::Hierarchy<V>& a_;
  const tree::Hierarchy<V>& b_;
  math::Pose b_in_a_;
  typename V::PreparedPose relative_;
  Vec3f place_;  ///< of B's origin in A's frame
  double reach_ = 0.0;
  EstimatorKind estimator_;
  bool leaf_test_;
};

}  // namespace odds::query
