// The search for what touches elsewhere than where flat faces lie on each other.
#pragma once

#include <array>
#include <bit>

#include "query/wide/known_faces.hpp"
#include "query/wide/opening.hpp"

namespace odds::query::wide {

/// From the roots, depth-first, the deepest overlap first, and past all that meets between known faces: of a crate
/// that stands on a floor a handful of pairs are left. Ends as `finished` if nothing else touches.
template <class L>
class BesideFaces {
 public:
  static void run(Task& task, const KnownFaces& faces) noexcept { BesideFaces(task, faces).run(); }

 private:
  BesideFaces(Task& task, const KnownFaces& faces) noexcept
      : task_(task), met_(task.encounter), faces_(faces), hits_(task.hits.size()) {}

  void run() noexcept {
    open_.of[0][0] = open_.of[1][0] = tree::WideTree::root;
    open_.size = 1;
    while (open_.size != 0) {
      if (!task_.spending.start_may_go_on_after(units_between_polls) || !task_.spending.allows(wide_lanes)) {
        task_.result.ended = Progressed::spent;
        return;
      }
      const SlotPair pair = open_.take();
      if (!met_.are_leaves(pair.of[0], pair.of[1])) {
        open(pair);
      } else if (!visit(pair)) {
        return;
      } else {
        go_elsewhere();
      }
    }
  }

  void open(const SlotPair& pair) noexcept {
    const Expanded<L> found = expand<L>(met_, pair);
    task_.spending.spend_node_pairs(wide_lanes);
    unsigned lanes = found.lanes;
    const typename OnePair<L>::Nodes nodes{met_.nodes(found.side)[found.first / wide_lanes]};
    const typename OnePair<L>::Boxes box{met_.numbers(1 - found.side, found.other)};
    for (const KnownFaces::Layer& layer : faces_.layers()) {
      lanes &= ~lanes_within<OnePair<L>>(layer, found.side, nodes, box);
    }
    const unsigned deepest = lanes & (1U << L::least(found.gaps));
    open_.add(found, lanes & ~deepest);
    open_.add(found, deepest);
  }

  /// A leaf has triangles of a face and of what stands up from it.
  bool visit(const SlotPair& pair) noexcept {
    return visit_triangles(task_, pair.of[0], pair.of[1], compare_leaves<L>(task_, pair.of[0], pair.of[1]),
                           [this](std::uint32_t a, std::uint32_t b) noexcept {
                             const PosedMeshes& meshes = met_.meshes();
                             return faces_.include(meshes.corners_a(a), meshes.corners_b(b));
                           });
  }

  /// After a hit, to an open pair that follows no order: what is found until an early end comes from all over.
  void go_elsewhere() noexcept {
    if (task_.hits.size() == hits_ || open_.size < 2 || open_.size > wide_stack_capacity) return;
    hits_ = task_.hits.size();
    open_.bring_up(elsewhere(hits_, open_.size - 1));
  }

  Task& task_;
  const Encounter& met_;
  const KnownFaces& faces_;
  std::size_t hits_;
  Slot slots_[2][2 * wide_stack_capacity];
  SlotPairs open_{{slots_[0], slots_[1]}};
};

}  // namespace odds::query::wide
