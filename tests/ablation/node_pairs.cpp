#include "ablation/node_pairs.hpp"

#include <algorithm>
#include <type_traits>
#include <variant>

#include "query/posed_meshes.hpp"
#include "query/search/search.hpp"
#include "query/shape_data.hpp"
#include "support/node_sample.hpp"

namespace odds::ablation {
namespace {

constexpr std::size_t kept_of_a_pose = 48;

/// Of the box about A's volume in its axes, and the box in the same axes about B's.
template <class V>
double overlap_of_boxes(const V& a, const V& b, const math::Pose& b_in_a) {
  const volume::OrientedBox box_a = a.cell_box();
  const volume::OrientedBox box_b = b.cell_box();
  const Mat3 turned = box_a.axes.transpose() * b_in_a.rotation * box_b.axes;
  const Vec3 half_b = turned.cwiseAbs() * box_b.half_extents;
  const Vec3 shift = box_a.axes.transpose() * (b_in_a * box_b.center - box_a.center);
  double volume = 1.0;
  for (int i = 0; i < 3; ++i) {
    const double low = std::max(-box_a.half_extents[i], shift[i] - half_b[i]);
    const double high = std::min(box_a.half_extents[i], shift[i] + half_b[i]);
    volume *= std::max(high - low, 0.0);
  }
  return volume;
}

template <volume::BoundingVolume V>
class Judge {
 public:
  Judge(const tree::Hierarchy<V>& a, const tree::Hierarchy<V>& b, const math::Pose& pose)
      : a_(a), b_(b), pose_(pose), met_(a, b, pose, request_) {
    relative_ = V::PreparedPose::make(pose, 2.0 * (a.reach() + b.reach()));
  }

  void judge(std::uint64_t line, std::vector<JudgedNodes>& judged) {
    for (const query::NodePair& pair : testing::sample_nodes(met_, kept_of_a_pose, line)) {
      JudgedNodes one;
      for (std::size_t kind = 0; kind < estimate_kinds.size(); ++kind) {
        one.probability[kind] = static_cast<double>(probability(pair, estimate_kinds[kind]));
      }
      one.meet = testing::meet_below(met_, pair, hits_);
      one.line = line;
      judged.push_back(one);
    }
  }

 private:
  float probability(const query::NodePair& pair, const EstimateKind& kind) const {
    if (kind.learnt) return met_.probability(pair.a, pair.b);
    const V& volume_a = a_.nodes()[pair.a].volume;
    const V& volume_b = b_.nodes()[pair.b].volume;
    const double common = kind.enclosing_box ? overlap_of_boxes(volume_a, volume_b, pose_)
                                             : overlap_volume(volume_a, volume_b, relative_);
    const query::NodesMet met{a_.statistics()[pair.a], b_.statistics()[pair.b], relative_.rotation,
                              volume_a.volume(),       volume_b.volume(),       common};
    return query::met_probability(met, kind.kinematic ? query::EstimatorKind::kinematic : query::EstimatorKind::cells,
                                  {a_.levels(), b_.levels()});
  }

  const tree::Hierarchy<V>& a_;
  const tree::Hierarchy<V>& b_;
  math::Pose pose_;
  query::Request request_;
  query::Encounter<V> met_;
  typename V::PreparedPose relative_;
  query::HitList hits_{8};
};

}  // namespace

void judge_nodes(const query::Shape& a, const query::Shape& b, const math::Pose& b_in_a, std::uint64_t line,
                 std::vector<JudgedNodes>& judged) {
  std::visit(
      [&](const auto& tree_a) {
        using Tree = std::remove_cvref_t<decltype(tree_a)>;
        if constexpr (!std::is_same_v<Tree, tree::WideTree>) {
          const Tree& tree_b = *std::get_if<Tree>(&b.data().tree);
          const query::PosedMeshes meshes(a.mesh(), b.mesh(), tree_a.origin(), tree_b.origin(), b_in_a);
          Judge(tree_a, tree_b, meshes.pose()).judge(line, judged);
        }
      },
      a.data().tree);
}

double separation(const std::vector<JudgedNodes>& judged, std::size_t kind) {
  std::vector<const JudgedNodes*> sorted;
  for (const JudgedNodes& one : judged) sorted.push_back(&one);
  const auto of = [kind](const JudgedNodes* one) { return one->probability[kind]; };
  std::sort(sorted.begin(), sorted.end(), [&](auto* x, auto* y) { return of(x) < of(y); });
  double misses = 0.0;
  double meetings = 0.0;
  double won = 0.0;
  for (std::size_t i = 0; i < sorted.size();) {
    double equal_misses = 0.0;
    double equal_meetings = 0.0;
    const double p = of(sorted[i]);
    for (; i < sorted.size() && of(sorted[i]) == p; ++i) (sorted[i]->meet ? equal_meetings : equal_misses) += 1.0;
    won += equal_meetings * (misses + 0.5 * equal_misses);
    misses += equal_misses;
    meetings += equal_meetings;
  }
  return misses > 0.0 && meetings > 0.0 ? won / (misses * meetings) : 0.5;
}

}  // namespace odds::ablation
