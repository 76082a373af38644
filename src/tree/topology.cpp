#include "odds/tree/topology.hpp"

#include <algorithm>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <thread>

#include "odds/tree/for_parts.hpp"
#include "tree/split.hpp"

namespace odds::tree {
namespace {

// From here on only median splits are made: 64 levels minus the 30 that halving 2^30 triangles needs.
constexpr std::uint32_t last_heuristic_level = deepest_level - 32;
// A subtree of no more triangles than this is built in one go by one thread.
constexpr std::uint32_t subtree_triangles = 4096;

std::vector<SplitReference> make_references(std::span<const TriangleCorners> triangles) {
  std::vector<SplitReference> references(triangles.size());
  for_parts(triangles.size(), 4 * subtree_triangles, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      SplitBounds bounds;
      for (const Vec3& corner : triangles[i]) {
        const Vec3f rounded = corner.cast<float>();
        bounds.add({rounded[0], rounded[1], rounded[2], 0.0F});
      }
      references[i] = {bounds, static_cast<std::uint32_t>(i)};
    }
  });
  return references;
}

/// A part of the tree while it is built: split in two branches, or a finished subtree whose node 0 is the branch.
struct Branch {
  TopologyNode node;
  Branch* left = nullptr;
  Branch* right = nullptr;
  std::vector<TopologyNode> subtree;
};

class Builder {
 public:
  Builder(std::span<const TriangleCorners> triangles, std::uint32_t leaf_triangles, const Progress& progress)
      : leaf_triangles_(leaf_triangles),
        progress_(progress),
        references_(make_references(triangles)),
        scratch_(references_.size()) {
    branches_.push_back({{0, 0, 0, static_cast<std::uint32_t>(triangles.size()), 0, 0}, nullptr, nullptr, {}});
    open_.push_back(&branches_.front());
  }

  Topology build(std::size_t threads) {
    const std::size_t subtrees = references_.size() / subtree_triangles + 1;
    const auto caller = std::this_thread::get_id();
    on_threads(threads != 0 ? threads : threads_for(subtrees),
               [&] { work(std::this_thread::get_id() == caller ? progress_ : Progress{}); });
    scratch_ = {};
    Topology topology;
    topology.nodes.reserve(node_count_);
    topology.nodes.push_back(branches_.front().node);
    collect(branches_.front(), 0, topology.nodes);
    measure_heights(topology);
    topology.order.resize(references_.size());
    for (std::size_t i = 0; i < references_.size(); ++i) topology.order[i] = references_[i].triangle();
    return topology;
  }

 private:
  /// Takes branches until none is left; whatever a thread takes first, the same nodes come of it.
  void work(const Progress& progress) {
    try {
      while (Branch* branch = take()) {
        if (branch->node.end - branch->node.begin <= subtree_triangles) {
          build_subtree(*branch);
          finish(*branch, progress);
        } else {
          divide(*branch);
        }
      }
    } catch (...) {
      const std::lock_guard lock(mutex_);
      failed_ = true;
      changed_.notify_all();
      throw;
    }
  }

  Branch* take() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return failed_ || !open_.empty() || unfinished_ == 0; });
    if (failed_ || open_.empty()) return nullptr;
    Branch* branch = open_.back();
    open_.pop_back();
    return branch;
  }

  void divide(Branch& branch) {
    TopologyNode left;
    TopologyNode right;
    divide(branch.node, left, right);
    const std::lock_guard lock(mutex_);
    branch.left = &branches_.emplace_back(Branch{left, nullptr, nullptr, {}});
    branch.right = &branches_.emplace_back(Branch{right, nullptr, nullptr, {}});
    open_.push_back(branch.right);
    open_.push_back(branch.left);
    ++unfinished_;  // one is divided, two are open
    ++node_count_;
    changed_.notify_all();
  }

  void divide(const TopologyNode& node, TopologyNode& left, TopologyNode& right) noexcept {
    const std::uint32_t size = node.end - node.begin;
    const auto references = std::span(references_).subspan(node.begin, size);
    const auto middle =
        node.begin + static_cast<std::uint32_t>(split(references, std::span(scratch_).subspan(node.begin, size),
                                                      centroid_bounds(references), node.depth >= last_heuristic_level));
    const auto depth = static_cast<std::uint8_t>(node.depth + 1);
    left = {0, 0, node.begin, middle, depth, 0};
    right = {0, 0, middle, node.end, depth, 0};
  }

  void build_subtree(Branch& branch) {
    std::vector<TopologyNode>& nodes = branch.subtree;
    nodes.reserve((branch.node.end - branch.node.begin) / std::max(1U, leaf_triangles_ / 2) * 2 + 1);
    nodes.push_back(branch.node);
    std::vector<std::uint32_t> open = {0};
    while (!open.empty()) {
      const std::uint32_t index = open.back();
      open.pop_back();
      const std::uint32_t size = nodes[index].end - nodes[index].begin;
      if (size <= leaf_triangles_) {
        nodes[index].first = nodes[index].begin;
        nodes[index].count = size;
        continue;
      }
      nodes[index].first = static_cast<std::uint32_t>(nodes.size());
      TopologyNode left;
      TopologyNode right;
      divide(nodes[index], left, right);
      open.push_back(nodes[index].first + 1);
      open.push_back(nodes[index].first);
      nodes.push_back(left);
      nodes.push_back(right);
    }
  }

  void finish(const Branch& branch, const Progress& progress) {
    double share = 0.0;
    {
      const std::lock_guard lock(mutex_);
      finished_ += branch.node.end - branch.node.begin;
      node_count_ += branch.subtree.size();
      share = static_cast<double>(finished_) / static_cast<double>(references_.size());
      if (--unfinished_ == 0) changed_.notify_all();
    }
    if (progress) progress(share);
  }

  /// Nodes in the order in which one thread that goes down on the left first would have made them.
  static void collect(const Branch& branch, std::uint32_t index, std::vector<TopologyNode>& nodes) {
    const auto next = static_cast<std::uint32_t>(nodes.size());
    if (branch.left != nullptr) {
      nodes[index].first = next;
      nodes.push_back(branch.left->node);
      nodes.push_back(branch.right->node);
      collect(*branch.left, next, nodes);
      collect(*branch.right, next + 1, nodes);
      return;
    }
    // Node i > 0 of the subtree becomes next + i - 1.
    for (std::size_t i = 0; i < branch.subtree.size(); ++i) {
      TopologyNode node = branch.subtree[i];
      if (!node.is_leaf()) node.first += next - 1;
      if (i == 0) {
        nodes[index] = node;
      } else {
        nodes.push_back(node);
      }
    }
  }

  static void measure_heights(Topology& topology) {
    for (std::size_t i = topology.nodes.size(); i-- > 0;) {  // children come after their parents
      TopologyNode& node = topology.nodes[i];
      topology.levels = std::max(topology.levels, node.depth + 1U);
      if (node.is_leaf()) continue;
      node.height = static_cast<std::uint8_t>(
          1 + std::max(topology.nodes[node.first].height, topology.nodes[node.first + 1].height));
    }
  }

  const std::uint32_t leaf_triangles_;
  const Progress& progress_;
  std::vector<SplitReference> references_;
  std::vector<SplitReference> scratch_;
  std::mutex mutex_;  // guards what follows
  std::condition_variable changed_;
  std::deque<Branch> branches_;
  std::vector<Branch*> open_;
  std::size_t unfinished_ = 1;  ///< branches that are neither divided nor finished subtrees
  std::size_t finished_ = 0;    ///< triangles in finished subtrees
  std::size_t node_count_ = 0;
  bool failed_ = false;
};

}  // namespace

Topology build_topology(std::span<const TriangleCorners> triangles, std::uint32_t leaf_triangles,
                        const Progress& progress, std::size_t threads) {
  return Builder(triangles, leaf_triangles, progress).build(threads);
}

}  // namespace odds::tree
