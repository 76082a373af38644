#include "odds/tree/wide_tree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "odds/math/rounding.hpp"
#include "odds/volume/box_overlap.hpp"

namespace odds::tree {
namespace {

constexpr float empty_extent = -1e30F;

struct Bounds {
  Vec3 lower = Vec3::Constant(INFINITY);
  Vec3 upper = Vec3::Constant(-INFINITY);
  void add(const Vec3& point) {
    lower = lower.cwiseMin(point);
    upper = upper.cwiseMax(point);
  }
  void add(const Bounds& other) {
    lower = lower.cwiseMin(other.lower);
    upper = upper.cwiseMax(other.upper);
  }
  [[nodiscard]] double half_area() const {
    const Vec3 d = upper - lower;
    return d[0] * d[1] + d[1] * d[2] + d[2] * d[0];
  }
};

std::vector<Bounds> bounds_of_nodes(const Topology& topology, std::span<const TriangleCorners> corners) {
  std::vector<Bounds> bounds(topology.nodes.size());
  for (std::size_t i = topology.nodes.size(); i-- > 0;) {  // children come after their parents
    const TopologyNode& node = topology.nodes[i];
    if (node.is_leaf()) {
      for (std::uint32_t t = node.begin; t < node.end; ++t) {
        for (const Vec3& corner : corners[t]) bounds[i].add(corner);
      }
    } else {
      bounds[i] = bounds[node.first];
      bounds[i].add(bounds[node.first + 1]);
    }
  }
  return bounds;
}

/// Which binary nodes become lanes, and of which node.
struct Plan {
  struct Node {
    std::array<std::uint32_t, wide_lanes> lanes;  ///< nodes of the topology
    std::uint32_t count = 0;
    std::uint32_t level = 1;
  };
  std::vector<Node> nodes;             ///< node 0 holds the root
  std::vector<std::uint32_t> node_of;  ///< topology node -> the wide node of its children; 0: a leaf
  std::vector<std::uint8_t> wanted;    ///< topology nodes that are lanes
  std::uint32_t levels = 1;
};

/// Opens the child with the greatest surface until there are eight: it is the one that a search enters most often.
Plan::Node gather_lanes(const Topology& topology, std::span<const Bounds> bounds, std::uint32_t index) {
  Plan::Node gathered;
  const auto add = [&](std::uint32_t lane) { gathered.lanes[gathered.count++] = lane; };
  add(topology.nodes[index].first);
  add(topology.nodes[index].first + 1);
  while (gathered.count < wide_lanes) {
    std::uint32_t widest = wide_lanes;
    double greatest = -1.0;
    for (std::uint32_t k = 0; k < gathered.count; ++k) {
      if (topology.nodes[gathered.lanes[k]].is_leaf()) continue;
      const double area = bounds[gathered.lanes[k]].half_area();
      if (area > greatest) {
        greatest = area;
        widest = k;
      }
    }
    if (widest == wide_lanes) break;
    const std::uint32_t opened = gathered.lanes[widest];
    gathered.lanes[widest] = topology.nodes[opened].first;
    add(topology.nodes[opened].first + 1);
  }
  return gathered;
}

Plan plan_nodes(const Topology& topology, std::span<const Bounds> bounds) {
  Plan plan;
  plan.node_of.assign(topology.nodes.size(), 0);
  plan.wanted.assign(topology.nodes.size(), 0);
  plan.nodes.emplace_back();
  plan.nodes[0].lanes[0] = 0;
  plan.nodes[0].count = 1;
  std::vector<std::uint32_t> open = {0};
  // Depth first, so that what a search visits in turn stands together.
  while (!open.empty()) {
    const Plan::Node lanes = plan.nodes[open.back()];
    open.pop_back();
    plan.levels = std::max(plan.levels, lanes.level);
    for (std::uint32_t k = 0; k < lanes.count; ++k) {
      plan.wanted[lanes.lanes[k]] = 1;
      if (topology.nodes[lanes.lanes[k]].is_leaf()) continue;
      plan.node_of[lanes.lanes[k]] = static_cast<std::uint32_t>(plan.nodes.size());
      open.push_back(static_cast<std::uint32_t>(plan.nodes.size()));
      plan.nodes.push_back(gather_lanes(topology, bounds, lanes.lanes[k]));
      plan.nodes.back().level = lanes.level + 1;
    }
  }
  return plan;
}

/// Float numbers about which |x - center| <= half holds for every x in [lower, upper].
ODDS_KEEPS_ROUNDING void enclose(double lower, double upper, float& center, float& half) {
  center = static_cast<float>(0.5 * lower + 0.5 * upper);
  const auto middle = static_cast<double>(center);
  half = volume::rounded_up(std::max({upper - middle, middle - lower, 0.0}));
}

/// The slab along the thinnest principal axis, not longer than 1 so that its gaps are distances.
ODDS_KEEPS_ROUNDING void fit_slab(WideNode& node, std::uint32_t lane, const Vec3& axis,
                                  std::span<const TriangleCorners> triangles) {
  Vec3f normal = (axis * (1.0 - 0x1p-22)).cast<float>();
  const Vec3 exact = normal.cast<double>();
  double lower = INFINITY;
  double upper = -INFINITY;
  for (const TriangleCorners& triangle : triangles) {
    for (const Vec3& corner : triangle) {
      const double along = exact.dot(corner);
      lower = std::min(lower, along);
      upper = std::max(upper, along);
    }
  }
  for (int i = 0; i < 3; ++i) node.normal[i][lane] = normal[i];
  enclose(lower, upper, node.offset[lane], node.thickness[lane]);
}

/// E[(normal . n)^2] from the moments of the statistics.
float flatness_along(const NodeStatistics& node, const Vec3& axis) {
  const float* m = node.normal_moment;
  const Vec3f a = axis.cast<float>();
  const float value = m[0] * a[0] * a[0] + m[1] * a[1] * a[1] + m[2] * a[2] * a[2] +
                      2.0F * (m[3] * a[0] * a[1] + m[4] * a[0] * a[2] + m[5] * a[1] * a[2]);
  return std::clamp(value, 0.0F, 1.0F);
}

void clear(WideNode& node) {
  std::memset(static_cast<void*>(&node), 0, sizeof(node));
  for (auto& axis : node.half) std::fill(std::begin(axis), std::end(axis), empty_extent);
  std::fill(std::begin(node.thickness), std::end(node.thickness), empty_extent);
  std::fill(std::begin(node.log_density), std::end(node.log_density), -1e4F);
}

void fill_leaf(WideLeaf& leaf, const WideNode& node, std::uint32_t lane, std::span<const TriangleCorners> triangles,
               std::span<const std::uint32_t> order) {
  for (std::uint32_t t = 0; t < wide_lanes; ++t) {
    const std::size_t source = t < triangles.size() ? t : 0;
    leaf.triangle[t] = order[source];
    for (std::size_t corner = 0; corner < 3; ++corner) {
      for (int axis = 0; axis < 3; ++axis) {
        leaf.corner[corner][static_cast<std::size_t>(axis)][t] =
            static_cast<float>(triangles[source][corner][axis] - static_cast<double>(node.center[axis][lane]));
      }
    }
  }
}

}  // namespace

WideTree WideTree::build(const mesh::TriangleMesh& mesh, const BuildOptions& options, const Progress& progress) {
  WideTree tree;
  tree.origin_ = 0.5 * mesh.lower() + 0.5 * mesh.upper();
  tree.triangle_count_ = mesh.triangles().size();
  std::vector<TriangleCorners> unordered = corners_about(mesh, tree.origin_);
  const Progress first_half = progress ? [&](double share) { progress(0.5 * share); } : Progress{};
  const Topology topology = build_topology(unordered, std::min(options.leaf_triangles, wide_lanes), first_half);
  std::vector<TriangleCorners> corners(unordered.size());
  for (std::size_t i = 0; i < corners.size(); ++i) corners[i] = unordered[topology.order[i]];
  unordered = {};
  for (const TriangleCorners& triangle : corners) {
    for (const Vec3& corner : triangle) tree.reach_ = std::max(tree.reach_, corner.norm());
  }
  const std::vector<Bounds> bounds = bounds_of_nodes(topology, corners);
  const Plan plan = plan_nodes(topology, bounds);
  tree.levels_ = plan.levels;
  NodeSurface surface = measure_surface(topology, corners, plan.wanted);
  if (progress) progress(0.7);

  tree.nodes_.resize(plan.nodes.size());
  tree.statistics_at_.resize(plan.nodes.size());
  std::uint32_t lanes = 0;
  std::vector<std::uint32_t> leaf_of(topology.nodes.size(), 0);
  std::uint32_t leaves = 0;
  std::vector<std::uint32_t> heights(plan.nodes.size(), 1);
  for (std::size_t w = 0; w < plan.nodes.size(); ++w) {
    tree.statistics_at_[w] = lanes;
    lanes += plan.nodes[w].count;
    for (std::uint32_t k = 0; k < plan.nodes[w].count; ++k) {
      const std::uint32_t index = plan.nodes[w].lanes[k];
      if (topology.nodes[index].is_leaf()) leaf_of[index] = leaves++;
    }
  }
  for (std::size_t w = plan.nodes.size(); w-- > 0;) {
    for (std::uint32_t k = 0; k < plan.nodes[w].count; ++k) {
      const std::uint32_t below = plan.node_of[plan.nodes[w].lanes[k]];
      if (below != 0) heights[w] = std::max(heights[w], heights[below] + 1);
    }
  }
  tree.statistics_.resize(lanes);
  tree.leaves_.resize(leaves);
  for_parts(plan.nodes.size(), 256, [&](std::size_t begin, std::size_t end) {
    CellCounter counter;
    for (std::size_t w = begin; w < end; ++w) {
      WideNode& node = tree.nodes_[w];
      clear(node);
      for (std::uint32_t k = 0; k < plan.nodes[w].count; ++k) {
        const std::uint32_t index = plan.nodes[w].lanes[k];
        const TopologyNode& source = topology.nodes[index];
        const auto triangles = std::span(corners).subspan(source.begin, source.end - source.begin);
        Vec3f half;
        Vec3f center;
        for (int i = 0; i < 3; ++i) {
          enclose(bounds[index].lower[i], bounds[index].upper[i], center[i], half[i]);
          node.center[i][k] = center[i];
          node.half[i][k] = half[i];
        }
        fit_slab(node, k, surface.axes[index].col(0), triangles);
        NodeStatistics& statistics = surface.statistics[index];
        relate_area(statistics, volume::box_volume(half));
        counter.begin(center.cast<double>(), Mat3::Identity(), half.cast<double>());
        for (const TriangleCorners& triangle : triangles) counter.add(triangle[0], triangle[1], triangle[2]);
        statistics.well_filled_cells = counter.count(options.tau);
        node.log_density[k] = statistics.log_relative_area - statistics.log_volume / 3.0F;
        node.flatness[k] = flatness_along(statistics, surface.axes[index].col(0));
        if (source.is_leaf()) {
          node.child[k] = ChildRef::leaf(leaf_of[index], source.count);
          fill_leaf(tree.leaves_[leaf_of[index]], node, k, triangles,
                    std::span(topology.order).subspan(source.begin, source.count));
        } else {
          node.child[k] = ChildRef::node(plan.node_of[index], heights[plan.node_of[index]]);
        }
        statistics.depth = static_cast<std::uint8_t>(plan.nodes[w].level - 1);
        statistics.height = static_cast<std::uint8_t>(node.child[k].height());
        tree.statistics_[tree.statistics_at_[w] + k] = statistics;
      }
    }
  });
  if (progress) progress(1.0);
  return tree;
}

}  // namespace odds::tree
