#include "tree/tree_defect.hpp"

#include <algorithm>
#include <cmath>

#include "tree/first_bad.hpp"

namespace odds::tree {
namespace {

using Found = std::optional<Defect>;

constexpr std::uint32_t most_leaf_triangles = 16;
constexpr std::size_t scan_part = 16384;  // records that a processor looks at before it asks for more

/// What estimates rely on, so that none of them is a NaN.
bool is_sound(const NodeStatistics& statistics) noexcept {
  constexpr float unit = 1.001F;  // components of averages of unit normals, rounded
  const float slab_reach = std::abs(statistics.slab_center);
  return statistics.area >= 0.0F && statistics.relative_area >= 0.0F &&
         statistics.centroid.cwiseAbs().maxCoeff() <= farthest && statistics.mean_normal.norm() <= unit &&
         statistics.slab_normal.norm() <= unit && slab_reach <= farthest && statistics.slab_half >= 0.0F &&
         statistics.slab_half <= farthest && statistics.well_filled_cells <= kCellsPerNode &&
         std::ranges::all_of(statistics.normal_moment, [](float x) { return std::abs(x) <= unit; });
}

/// The same of the statistics of a node `level` below the root and `height` above the leaves.
bool is_sound(const NodeStatistics& statistics, std::uint32_t level, std::uint32_t height) noexcept {
  return statistics.depth == level && statistics.height == height && is_sound(statistics);
}

/// Whether a lane's volume is one that searches meet as they should: within the range of coordinates if it is in use,
/// and otherwise so empty that nothing within that range overlaps it.
bool is_sound(const WideNode& node, std::uint32_t lane) noexcept {
  const bool in_use = !node.child[lane].is_nothing();
  const auto is_place = [&](float x) { return in_use ? std::abs(x) <= farthest : x == 0.0F; };
  const auto is_extent = [&](float x) { return in_use ? x >= 0.0F && x <= farthest : x == empty_extent; };
  bool sound = is_place(node.offset[lane]) && is_extent(node.thickness[lane]);
  for (int i = 0; i < 3; ++i) {
    sound = sound && is_place(node.center[i][lane]) && is_extent(node.half[i][lane]);
    sound = sound && std::abs(node.normal[i][lane]) <= (in_use ? 1.0F : 0.0F);
  }
  return sound;
}

Found find_bad_index(Section section, std::span<const std::uint32_t> indices, std::size_t triangles) {
  const std::size_t bad = first_bad(indices.size(), scan_part, [&](std::size_t i) { return indices[i] >= triangles; });
  if (bad == indices.size()) return std::nullopt;
  return Defect{section, bad, "the index of a triangle is out of range"};
}

/// From the root down, then back up.
class BinaryWalk {
 public:
  explicit BinaryWalk(const BinaryTree& tree)
      : tree_(tree), level_(tree.nodes.size(), unseen), height_(tree.nodes.size(), 0) {}

  Found walk() {
    if (tree_.nodes.empty()) return Defect{Section::nodes, 0, "there is no node"};
    if (tree_.statistics.size() != tree_.nodes.size()) {
      return Defect{Section::statistics, 0, "nodes and their statistics differ in number"};
    }
    level_[0] = 0;
    for (std::size_t i = 0; i < tree_.nodes.size(); ++i) {
      if (auto defect = enter(i)) return defect;
    }
    if (triangles_ != tree_.triangles) return Defect{Section::nodes, 0, "the leaves do not hold all triangles"};
    if (deepest_ + 1U != tree_.levels) return Defect{Section::facts, 0, "the number of levels is not the tree's"};
    return climb();
  }

 private:
  static constexpr std::uint8_t unseen = 255;
  static_assert(deepest_level < unseen);

  Found enter(std::size_t i) {
    const BinaryNode& node = tree_.nodes[i];
    if (level_[i] == unseen) return defect(i, "no node before it leads to this one");
    deepest_ = std::max(deepest_, level_[i]);
    if (node.count != 0) {
      triangles_ += node.count;
      const bool fits = node.count <= most_leaf_triangles && node.first <= tree_.triangles &&
                        node.count <= tree_.triangles - node.first;
      return fits ? std::nullopt : Found(defect(i, "the triangles of a leaf are out of range"));
    }
    const std::size_t child = node.first;
    if (child <= i || child + 1 >= tree_.nodes.size()) return defect(i, "the children of a node are out of range");
    if (level_[child] != unseen || level_[child + 1] != unseen) return defect(i, "a node has two parents");
    if (level_[i] + 1U >= deepest_level) return defect(i, "the tree is deeper than searches go");
    level_[child] = level_[child + 1] = static_cast<std::uint8_t>(level_[i] + 1U);
    return std::nullopt;
  }

  Found climb() {
    for (std::size_t i = tree_.nodes.size(); i-- > 0;) {
      const BinaryNode& node = tree_.nodes[i];
      if (node.count == 0) {
        height_[i] = static_cast<std::uint8_t>(std::max(height_[node.first], height_[node.first + 1]) + 1);
      }
      if (is_sound(tree_.statistics[i], level_[i], height_[i])) continue;
      return Defect{Section::statistics, i, "the statistics of a node do not suit its place"};
    }
    return std::nullopt;
  }

  static Defect defect(std::size_t node, const char* what) { return {Section::nodes, node, what}; }

  const BinaryTree& tree_;
  std::vector<std::uint8_t> level_;
  std::vector<std::uint8_t> height_;
  std::size_t triangles_ = 0;
  std::uint8_t deepest_ = 0;
};

/// The same for wide trees, whose lanes are the nodes of the above.
class WideWalk {
 public:
  explicit WideWalk(const WideTree::Parts& parts)
      : parts_(parts), level_(parts.nodes.size(), unseen), height_(parts.nodes.size(), 1) {}

  Found walk() {
    if (parts_.nodes.empty() || parts_.nodes.size() > WideTree::most_nodes) {
      return Defect{Section::wide_nodes, 0, "the number of nodes is out of range"};
    }
    if (parts_.statistics_at.size() != parts_.nodes.size()) {
      return Defect{Section::statistics_at, 0, "nodes and the places of their statistics differ in number"};
    }
    if (parts_.nodes[0].child[0].is_nothing() || !parts_.nodes[0].child[1].is_nothing()) {
      return defect(0, "the first node does not hold the root alone");
    }
    level_[0] = 1;
    for (std::size_t i = 0; i < parts_.nodes.size(); ++i) {
      if (auto found = enter(i)) return found;
    }
    if (auto found = check_totals()) return found;
    return climb();
  }

 private:
  static constexpr std::uint8_t unseen = 255;

  /// Follows the lanes of a node: those in use come first.
  Found enter(std::size_t i) {
    if (level_[i] == unseen) return defect(i, "no node before it leads to this one");
    if (parts_.statistics_at[i] != lanes_)
      return Defect{Section::statistics_at, i, "statistics are not where lanes are"};
    deepest_ = std::max(deepest_, level_[i]);
    const WideNode& node = parts_.nodes[i];
    bool ended = false;
    for (std::uint32_t lane = 0; lane < wide_lanes; ++lane) {
      const ChildRef child = node.child[lane];
      if (!is_sound(node, lane)) return defect(i, "the bounding volume of a lane is not one");
      if (child.is_nothing()) {
        ended = true;
      } else if (ended) {
        return defect(i, "a lane in use comes after one that is not");
      } else if (auto found = follow(i, child)) {
        return found;
      } else {
        ++lanes_;
      }
    }
    return std::nullopt;
  }

  Found follow(std::size_t i, ChildRef child) {
    if (child.is_leaf()) {
      triangles_ += child.count();
      return child.index() == leaves_++ ? std::nullopt : Found(defect(i, "leaves are not in the order of the lanes"));
    }
    if (child.index() <= i || child.index() >= parts_.nodes.size()) return defect(i, "a child is out of range");
    if (level_[child.index()] != unseen) return defect(i, "a node has two parents");
    if (level_[i] >= deepest_level) return defect(i, "the tree is deeper than searches go");
    level_[child.index()] = static_cast<std::uint8_t>(level_[i] + 1U);
    return std::nullopt;
  }

  [[nodiscard]] Found check_totals() const {
    if (parts_.statistics.size() != lanes_) return Defect{Section::statistics, 0, "not one for each lane in use"};
    if (!parts_.leaves.empty() && parts_.leaves.size() != leaves_) {
      return Defect{Section::wide_leaves, 0, "the number of leaves is not the tree's"};
    }
    if (triangles_ != parts_.triangles) return defect(0, "the leaves do not hold all triangles");
    if (deepest_ != parts_.levels) return Defect{Section::facts, 0, "the number of levels is not the tree's"};
    return std::nullopt;
  }

  Found climb() {
    for (std::size_t i = parts_.nodes.size(); i-- > 0;) {
      const WideNode& node = parts_.nodes[i];
      for (std::uint32_t lane = 0; lane < wide_lanes && !node.child[lane].is_nothing(); ++lane) {
        const ChildRef child = node.child[lane];
        if (!child.is_leaf()) {
          const std::uint8_t below = height_[child.index()];
          if (child.height() != std::min<std::uint32_t>(below, ChildRef::highest)) {
            return defect(i, "the height of a child is not the tree's");
          }
          height_[i] = std::max(height_[i], static_cast<std::uint8_t>(below + 1U));
        }
        const std::size_t at = parts_.statistics_at[i] + lane;
        if (is_sound(parts_.statistics[at], level_[i] - 1U, child.height())) continue;
        return Defect{Section::statistics, at, "the statistics of a lane do not suit its place"};
      }
    }
    return std::nullopt;
  }

  static Defect defect(std::size_t node, const char* what) { return {Section::wide_nodes, node, what}; }

  const WideTree::Parts& parts_;
  std::vector<std::uint8_t> level_;
  std::vector<std::uint8_t> height_;
  std::size_t lanes_ = 0;
  std::size_t leaves_ = 0;
  std::size_t triangles_ = 0;
  std::uint8_t deepest_ = 0;
};

}  // namespace

Found find_defect(const BinaryTree& tree) {
  if (auto defect = BinaryWalk(tree).walk()) return defect;
  const bool polygon_free = tree.corners.empty() && tree.order.empty();
  if (polygon_free) return std::nullopt;
  if (tree.corners.size() != tree.triangles || tree.order.size() != tree.triangles) {
    return Defect{Section::corners, 0, "corners and triangles differ in number"};
  }
  const std::size_t far = first_bad(tree.corners.size(), scan_part, [&](std::size_t i) {
    const auto out_of_range = [](const Vec3& p) {
      return p.cwiseAbs().maxCoeff() > 2.0 * mesh::TriangleMesh::largest_coordinate;
    };
    return std::any_of(tree.corners[i].begin(), tree.corners[i].end(), out_of_range);
  });
  if (far != tree.corners.size()) return Defect{Section::corners, far, "a corner is out of range"};
  return find_bad_index(Section::order, tree.order, tree.triangles);
}

Found find_defect(const WideTree::Parts& parts) {
  if (auto defect = WideWalk(parts).walk()) return defect;
  const std::size_t bad = first_bad(parts.leaves.size(), scan_part, [&](std::size_t i) {
    const auto& triangle = parts.leaves[i].triangle;
    return *std::max_element(std::begin(triangle), std::end(triangle)) >= parts.triangles;
  });
  if (bad == parts.leaves.size()) return std::nullopt;
  return Defect{Section::wide_leaves, bad, "the index of a triangle is out of range"};
}

}  // namespace odds::tree
