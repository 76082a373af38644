#include "odds/tree/wide_tree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "odds/math/rounding.hpp"
#include "odds/mesh/side_by_side.hpp"
#include "odds/volume/box_overlap.hpp"

namespace odds::tree {
namespace {

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
    [[nodiscard]] std::span<const std::uint32_t> used() const { return std::span(lanes).first(count); }
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
    for (const std::uint32_t index : lanes.used()) {
      plan.wanted[index] = 1;
      if (topology.nodes[index].is_leaf()) continue;
      plan.node_of[index] = static_cast<std::uint32_t>(plan.nodes.size());
      open.push_back(static_cast<std::uint32_t>(plan.nodes.size()));
      plan.nodes.push_back(gather_lanes(topology, bounds, index));
      plan.nodes.back().level = lanes.level + 1;
    }
  }
  return plan;
}

/// Where what hangs below the plan's lanes is stored.
struct Layout {
  std::vector<std::uint32_t> statistics_at;  ///< wide node -> its first lane's statistics
  std::vector<std::uint32_t> leaf_of;        ///< topology node -> wide leaf
  std::vector<std::uint32_t> heights;        ///< wide node -> levels of nodes from it down
  std::uint32_t lanes = 0;
  std::uint32_t leaves = 0;
};

Layout lay_out(const Topology& topology, const Plan& plan) {
  Layout layout;
  layout.statistics_at.resize(plan.nodes.size());
  layout.leaf_of.assign(topology.nodes.size(), 0);
  layout.heights.assign(plan.nodes.size(), 1);
  for (std::size_t w = 0; w < plan.nodes.size(); ++w) {
    layout.statistics_at[w] = layout.lanes;
    layout.lanes += plan.nodes[w].count;
    for (const std::uint32_t index : plan.nodes[w].used()) {
      if (topology.nodes[index].is_leaf()) layout.leaf_of[index] = layout.leaves++;
    }
  }
  for (std::size_t w = plan.nodes.size(); w-- > 0;) {  // children come after their parents
    for (const std::uint32_t index : plan.nodes[w].used()) {
      const std::uint32_t below = plan.node_of[index];
      if (below != 0) layout.heights[w] = std::max(layout.heights[w], layout.heights[below] + 1);
    }
  }
  return layout;
}

/// Float numbers about which |x - center| <= half holds for every x in [lower, upper].
ODDS_KEEPS_ROUNDING void enclose(double lower, double upper, float& center, float& half) {
  center = static_cast<float>(0.5 * lower + 0.5 * upper);
  const auto middle = static_cast<double>(center);
  half = volume::rounded_up(std::max({upper - middle, middle - lower, 0.0}));
}

void clear(WideNode& node) {
  std::memset(static_cast<void*>(&node), 0, sizeof(node));
  for (auto& axis : node.half) std::fill(std::begin(axis), std::end(axis), empty_extent);
  std::fill(std::begin(node.thickness), std::end(node.thickness), empty_extent);
}

ODDS_KEEPS_ROUNDING void set_volume(WideNode& node, std::uint32_t lane, const Bounds& bounds,
                                    const NodeStatistics& statistics) {
  const auto middle = static_cast<double>(statistics.slab_center);
  double offset = middle;
  double summed = std::abs(middle);
  for (int i = 0; i < 3; ++i) {
    enclose(bounds.lower[i], bounds.upper[i], node.center[i][lane], node.half[i][lane]);
    node.normal[i][lane] = statistics.slab_normal[i];
    const double along = static_cast<double>(node.normal[i][lane]) * static_cast<double>(node.center[i][lane]);
    offset -= along;
    summed += std::abs(along);
  }
  node.offset[lane] = static_cast<float>(offset);
  // The products are exact; three sums in double precision, and the number's own rounding, move the slab's middle.
  const double moved = std::abs(static_cast<double>(node.offset[lane]) - offset) + 4e-16 * summed;
  node.thickness[lane] = volume::rounded_up(static_cast<double>(statistics.slab_half) + moved);
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

/// What the surface measured once is to the lane's own box.
void relate_to_box(NodeStatistics& statistics, const WideNode& node, std::uint32_t lane,
                   std::span<const TriangleCorners> triangles, double tau, CellCounter& counter) {
  const Vec3f center(node.center[0][lane], node.center[1][lane], node.center[2][lane]);
  const Vec3f half(node.half[0][lane], node.half[1][lane], node.half[2][lane]);
  relate_area(statistics, volume::box_volume(half));
  counter.begin(center.cast<double>(), Mat3::Identity(), half.cast<double>());
  for (const TriangleCorners& triangle : triangles) counter.add(triangle[0], triangle[1], triangle[2]);
  statistics.well_filled_cells = counter.count(tau);
}

}  // namespace

WideTree WideTree::build(const mesh::TriangleMesh& mesh, const BuildOptions& options, const Progress& progress) {
  Parts parts;
  parts.origin = 0.5 * mesh.lower() + 0.5 * mesh.upper();
  parts.triangles = mesh.triangles().size();
  std::vector<TriangleCorners> unordered = corners_about(mesh, parts.origin);
  const Progress first_half = progress ? [&](double share) { progress(0.5 * share); } : Progress{};
  const Topology topology = build_topology(unordered, std::min(options.leaf_triangles, wide_lanes), first_half);
  std::vector<TriangleCorners> corners(unordered.size());
  for (std::size_t i = 0; i < corners.size(); ++i) corners[i] = unordered[topology.order[i]];
  unordered = {};
  for (const TriangleCorners& triangle : corners) {
    for (const Vec3& corner : triangle) parts.reach = std::max(parts.reach, corner.norm());
  }
  const std::vector<Bounds> bounds = bounds_of_nodes(topology, corners);
  const Plan plan = plan_nodes(topology, bounds);
  if (plan.nodes.size() > most_nodes) return {};
  parts.levels = plan.levels;
  NodeSurface surface = measure_surface(topology, corners, plan.wanted);
  if (progress) progress(0.7);

  Layout layout = lay_out(topology, plan);
  std::vector<WideNode> nodes(plan.nodes.size());
  std::vector<WideLeaf> leaves(layout.leaves);
  std::vector<NodeStatistics> all_statistics(layout.lanes);
  const auto fill_lane = [&](std::size_t w, std::uint32_t lane, CellCounter& counter) {
    WideNode& node = nodes[w];
    const std::uint32_t index = plan.nodes[w].lanes[lane];
    const TopologyNode& source = topology.nodes[index];
    const auto triangles = std::span(corners).subspan(source.begin, source.end - source.begin);
    NodeStatistics& statistics = all_statistics[layout.statistics_at[w] + lane];
    statistics = surface.statistics[index];
    set_volume(node, lane, bounds[index], statistics);
    relate_to_box(statistics, node, lane, triangles, options.tau, counter);
    if (source.is_leaf()) {
      const std::uint32_t leaf = layout.leaf_of[index];
      node.child[lane] = ChildRef::leaf(leaf, source.count);
      fill_leaf(leaves[leaf], node, lane, triangles, std::span(topology.order).subspan(source.begin, source.count));
    } else {
      node.child[lane] = ChildRef::node(plan.node_of[index], layout.heights[plan.node_of[index]]);
    }
    statistics.depth = static_cast<std::uint8_t>(plan.nodes[w].level - 1);
    statistics.height = static_cast<std::uint8_t>(node.child[lane].height());
  };
  for_parts(plan.nodes.size(), 256, [&](std::size_t begin, std::size_t end) {
    CellCounter counter;
    for (std::size_t w = begin; w < end; ++w) {
      clear(nodes[w]);
      for (std::uint32_t lane = 0; lane < plan.nodes[w].count; ++lane) fill_lane(w, lane, counter);
    }
  });
  parts.nodes = std::move(nodes);
  parts.leaves = std::move(leaves);
  parts.statistics = std::move(all_statistics);
  parts.statistics_at = std::move(layout.statistics_at);
  mesh::put_side_by_side(parts.nodes, parts.leaves, parts.statistics_at, parts.statistics);
  if (progress) progress(1.0);
  return WideTree(std::move(parts));
}

}  // namespace odds::tree
