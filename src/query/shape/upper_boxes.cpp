#include "odds/query/upper_boxes.hpp"

#include <queue>
#include <utility>
#include <variant>

#include "query/shape_data.hpp"

namespace odds::query {
namespace {

/// What the list is made from: a node's box, and the nodes below.
struct Opened {
  UpperBox box;
  std::vector<std::uint32_t> below;
};

template <volume::BoundingVolume V>
Opened look_at(const tree::Hierarchy<V>& tree, std::uint32_t node) {
  const auto& here = tree.nodes()[node];
  const volume::OrientedBox box = here.volume.cell_box();
  Opened opened;
  opened.box.center = box.center + tree.origin();
  opened.box.half = box.axes.cwiseAbs() * box.half_extents;
  if (!here.is_leaf()) opened.below = {here.first, here.first + 1};
  return opened;
}

/// A node is a slot here.
Opened look_at(const tree::WideTree& tree, std::uint32_t slot) {
  const tree::WideNode& node = tree.nodes()[slot / tree::wide_lanes];
  const std::uint32_t lane = slot % tree::wide_lanes;
  Opened opened;
  for (int i = 0; i < 3; ++i) {
    opened.box.center[i] = static_cast<double>(node.center[i][lane]) + tree.origin()[i];
    opened.box.half[i] = static_cast<double>(node.half[i][lane]);
  }
  const tree::ChildRef child = node.child[lane];
  if (child.is_leaf() || child.is_nothing()) return opened;
  for (std::uint32_t i = 0; i < tree::wide_lanes; ++i) {
    if (!tree.nodes()[child.index()].child[i].is_nothing()) {
      opened.below.push_back(child.index() * tree::wide_lanes + i);
    }
  }
  return opened;
}

template <class Tree>
std::vector<UpperBox> boxes_of(const Tree& tree, std::size_t most) {
  std::vector<UpperBox> boxes;
  std::vector<std::vector<std::uint32_t>> below;
  std::priority_queue<std::pair<double, std::size_t>> largest;
  const auto add = [&](std::uint32_t node) {
    Opened opened = look_at(tree, node);
    largest.emplace(opened.box.half.norm(), boxes.size());
    boxes.push_back(opened.box);
    below.push_back(std::move(opened.below));
  };
  if (most == 0) return boxes;
  add(0);
  while (!largest.empty()) {
    const std::size_t at = largest.top().second;
    largest.pop();
    const std::vector<std::uint32_t> children = below[at];
    if (children.empty() || boxes.size() + children.size() > most) continue;
    boxes[at].first = static_cast<std::uint32_t>(boxes.size());
    boxes[at].children = static_cast<std::uint32_t>(children.size());
    for (const std::uint32_t child : children) add(child);
  }
  return boxes;
}

}  // namespace

std::vector<UpperBox> upper_boxes(const Shape& shape, std::size_t most) {
  return std::visit([&](const auto& tree) { return boxes_of(tree, most); }, shape.data().tree);
}

}  // namespace odds::query
