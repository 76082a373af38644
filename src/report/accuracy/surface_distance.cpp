// Whether two surfaces come within a distance of each other: a descent of both trees that leaves out what is farther.
#include <algorithm>
#include <variant>
#include <vector>

#include "odds/primitive/triangle_distance.hpp"
#include "odds/report/accuracy/poses.hpp"
#include "odds/tree/wide_tree.hpp"
#include "query/posed_meshes.hpp"
#include "query/shape_data.hpp"

namespace odds::report {
namespace {

using tree::ChildRef;
using tree::Slot;
using tree::wide_lanes;
using tree::WideNode;
using tree::WideTree;

struct Box {
  Vec3 center;
  Vec3 half;
};

struct SlotPair {
  Slot a = WideTree::root;
  Slot b = WideTree::root;
  double gap = 0.0;  ///< their boxes are at least so far apart
};

const ChildRef& child_of(const WideTree& tree, Slot slot) {
  return tree.nodes()[slot / wide_lanes].child[slot % wide_lanes];
}

Box box_of(const WideTree& tree, Slot slot) {
  const WideNode& node = tree.nodes()[slot / wide_lanes];
  const std::uint32_t lane = slot % wide_lanes;
  Box box;
  for (int k = 0; k < 3; ++k) {
    box.center[k] = static_cast<double>(node.center[k][lane]);
    box.half[k] = static_cast<double>(node.half[k][lane]);
  }
  return box;
}

/// Of an axis-aligned box around the origin and the axis-aligned bounds of another.
double gap_of(const Vec3& center, const Vec3& halves) { return (center.cwiseAbs() - halves).cwiseMax(0.0).norm(); }

class Descent {
 public:
  Descent(const query::Shape& a, const query::Shape& b, const math::Pose& pose_b_in_a, double distance)
      : a_(std::get<WideTree>(a.data().tree)),
        b_(std::get<WideTree>(b.data().tree)),
        meshes_(a.mesh(), b.mesh(), a_.origin(), b_.origin(), pose_b_in_a),
        absolute_(meshes_.pose().rotation.cwiseAbs()),
        distance_(distance) {}

  bool run() {
    push({WideTree::root, WideTree::root, 0.0});
    while (!stack_.empty()) {
      const SlotPair pair = stack_.back();
      stack_.pop_back();
      const bool leaf_a = child_of(a_, pair.a).is_leaf();
      const bool leaf_b = child_of(b_, pair.b).is_leaf();
      if (leaf_a && leaf_b) {
        if (triangles_within(child_of(a_, pair.a), child_of(b_, pair.b))) return true;
        continue;
      }
      const bool open_a = leaf_b || (!leaf_a && box_of(a_, pair.a).half.norm() >= box_of(b_, pair.b).half.norm());
      expand(pair, open_a);
    }
    return false;
  }

 private:
  void push(SlotPair pair) {
    const Box a = box_of(a_, pair.a);
    const Box b = box_of(b_, pair.b);
    const Vec3 between = meshes_.pose() * b.center - a.center;
    const Vec3 turned = meshes_.pose().rotation.transpose() * between;
    pair.gap =
        std::max(gap_of(between, a.half + absolute_ * b.half), gap_of(turned, b.half + absolute_.transpose() * a.half));
    if (pair.gap <= distance_) stack_.push_back(pair);
  }

  /// Nearest last, so that it comes first.
  void expand(const SlotPair& pair, bool open_a) {
    const std::size_t before = stack_.size();
    const ChildRef child = open_a ? child_of(a_, pair.a) : child_of(b_, pair.b);
    const WideTree& opened = open_a ? a_ : b_;
    for (std::uint32_t lane = 0; lane < wide_lanes; ++lane) {
      const Slot slot = child.index() * wide_lanes + lane;
      if (child_of(opened, slot).is_nothing()) continue;
      push(open_a ? SlotPair{slot, pair.b, 0.0} : SlotPair{pair.a, slot, 0.0});
    }
    std::sort(stack_.begin() + static_cast<std::ptrdiff_t>(before), stack_.end(),
              [](const SlotPair& x, const SlotPair& y) { return x.gap > y.gap; });
  }

  [[nodiscard]] bool triangles_within(ChildRef a, ChildRef b) const {
    for (std::uint32_t i = 0; i < a.count(); ++i) {
      const tree::TriangleCorners x = meshes_.corners_a(a_.leaves()[a.index()].triangle[i]);
      for (std::uint32_t j = 0; j < b.count(); ++j) {
        const tree::TriangleCorners y = meshes_.corners_b(b_.leaves()[b.index()].triangle[j]);
        if (bounds_apart(x, y)) continue;
        if (primitive::closest_points(x.data(), y.data()).squared_distance <= distance_ * distance_) return true;
      }
    }
    return false;
  }

  [[nodiscard]] bool bounds_apart(const tree::TriangleCorners& x, const tree::TriangleCorners& y) const {
    for (int k = 0; k < 3; ++k) {
      const auto [least_x, greatest_x] = std::minmax({x[0][k], x[1][k], x[2][k]});
      const auto [least_y, greatest_y] = std::minmax({y[0][k], y[1][k], y[2][k]});
      if (least_y - greatest_x > distance_ || least_x - greatest_y > distance_) return true;
    }
    return false;
  }

  const WideTree& a_;
  const WideTree& b_;
  query::PosedMeshes meshes_;
  Mat3 absolute_;
  double distance_;
  std::vector<SlotPair> stack_;
};

}  // namespace

bool surfaces_within(const query::Shape& a, const query::Shape& b, const math::Pose& pose_b_in_a, double distance) {
  return Descent(a, b, pose_b_in_a, distance).run();
}

}  // namespace odds::report
