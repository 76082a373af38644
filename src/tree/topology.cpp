#include "odds/tree/topology.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

namespace odds::tree {
namespace {

struct Bounds {
  Vec3f lower = Vec3f::Constant(std::numeric_limits<float>::max());
  Vec3f upper = Vec3f::Constant(std::numeric_limits<float>::lowest());
  void add(const Vec3f& point) {
    lower = lower.cwiseMin(point);
    upper = upper.cwiseMax(point);
  }
  void add(const Bounds& other) {
    lower = lower.cwiseMin(other.lower);
    upper = upper.cwiseMax(other.upper);
  }
  [[nodiscard]] double half_area() const {
    const Eigen::Vector3d d = (upper - lower).cast<double>();
    return d[0] * d[1] + d[1] * d[2] + d[2] * d[0];
  }
};

// Splits only decide speed, never verdicts, so single precision is enough here.
struct Reference {
  Bounds bounds;
  Vec3f centroid;
  std::uint32_t triangle;
};

constexpr int bin_count = 16;
// From here on only median splits are made: 64 levels minus the 30 that halving 2^30 triangles needs.
constexpr std::uint32_t last_heuristic_level = deepest_level - 32;

struct Split {
  int axis = -1;
  float position = 0.0F;
};

int bin_of(float centroid, float lower, float scale) {
  return std::clamp(static_cast<int>((centroid - lower) * scale), 0, bin_count - 1);
}

// The cheapest of 15 planes on each of three axes; axis -1 where all centroids coincide.
Split best_split(std::span<const Reference> references, const Bounds& centroids) {
  Split best;
  double best_cost = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const float extent = centroids.upper[axis] - centroids.lower[axis];
    if (!(extent > 0.0F)) continue;
    const float scale = static_cast<float>(bin_count) / extent;
    if (!(scale < std::numeric_limits<float>::max())) continue;
    std::array<Bounds, bin_count> bounds;
    std::array<std::uint32_t, bin_count> counts{};
    for (const Reference& reference : references) {
      const auto bin = static_cast<std::size_t>(bin_of(reference.centroid[axis], centroids.lower[axis], scale));
      bounds[bin].add(reference.bounds);
      ++counts[bin];
    }
    std::array<double, bin_count> right_cost{};
    Bounds right;
    std::uint32_t right_count = 0;
    for (std::size_t bin = bin_count - 1; bin > 0; --bin) {
      if (counts[bin] != 0) right.add(bounds[bin]);
      right_count += counts[bin];
      right_cost[bin] = right_count == 0 ? 0.0 : right.half_area() * right_count;
    }
    Bounds left;
    std::uint32_t left_count = 0;
    for (std::size_t bin = 0; bin + 1 < bin_count; ++bin) {
      if (counts[bin] != 0) left.add(bounds[bin]);
      left_count += counts[bin];
      if (left_count == 0 || left_count == references.size()) continue;
      const double cost = left.half_area() * left_count + right_cost[bin + 1];
      if (cost < best_cost) {
        best_cost = cost;
        best = {axis, centroids.lower[axis] + extent * (static_cast<float>(bin + 1) / bin_count)};
      }
    }
  }
  return best;
}

Bounds centroid_bounds(std::span<const Reference> references) {
  Bounds bounds;
  for (const Reference& reference : references) bounds.add(reference.centroid);
  return bounds;
}

// Reorders `references`; returns the size of the left part, never 0 nor all of them.
std::size_t partition(std::span<Reference> references, std::uint32_t depth) {
  const Bounds centroids = centroid_bounds(references);
  if (depth < last_heuristic_level) {
    if (const Split split = best_split(references, centroids); split.axis >= 0) {
      const auto middle = std::stable_partition(references.begin(), references.end(), [&](const Reference& reference) {
        return reference.centroid[split.axis] < split.position;
      });
      const auto left = static_cast<std::size_t>(middle - references.begin());
      if (left != 0 && left != references.size()) return left;
    }
  }
  int axis = 0;
  (centroids.upper - centroids.lower).maxCoeff(&axis);
  const std::size_t half = references.size() / 2;
  std::nth_element(references.begin(), references.begin() + static_cast<std::ptrdiff_t>(half), references.end(),
                   [axis](const Reference& p, const Reference& q) {
                     return p.centroid[axis] != q.centroid[axis] ? p.centroid[axis] < q.centroid[axis]
                                                                 : p.triangle < q.triangle;
                   });
  return half;
}

std::vector<Reference> make_references(std::span<const TriangleCorners> triangles) {
  std::vector<Reference> references(triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    Reference& reference = references[i];
    for (const Vec3& corner : triangles[i]) reference.bounds.add(corner.cast<float>());
    reference.centroid = 0.5F * (reference.bounds.lower + reference.bounds.upper);
    reference.triangle = static_cast<std::uint32_t>(i);
  }
  return references;
}

}  // namespace

Topology build_topology(std::span<const TriangleCorners> triangles, std::uint32_t leaf_triangles,
                        const Progress& progress) {
  std::vector<Reference> references = make_references(triangles);
  Topology topology;
  topology.nodes.reserve(triangles.size() / std::max(1U, leaf_triangles / 2) * 2 + 1);
  topology.nodes.push_back({0, 0, 0, static_cast<std::uint32_t>(triangles.size()), 0, 0});
  std::vector<std::uint32_t> open = {0};
  std::size_t finished = 0;
  std::size_t reported = 0;
  while (!open.empty()) {
    const std::uint32_t index = open.back();
    open.pop_back();
    TopologyNode& node = topology.nodes[index];
    topology.levels = std::max(topology.levels, node.depth + 1U);
    const std::uint32_t size = node.end - node.begin;
    if (size <= leaf_triangles) {
      node.first = node.begin;
      node.count = size;
      finished += size;
      if (progress && finished - reported > triangles.size() / 50) {
        reported = finished;
        progress(static_cast<double>(finished) / static_cast<double>(triangles.size()));
      }
      continue;
    }
    const auto left =
        static_cast<std::uint32_t>(partition(std::span(references).subspan(node.begin, size), node.depth));
    const auto child_depth = static_cast<std::uint8_t>(node.depth + 1);
    const std::uint32_t begin = node.begin;
    const std::uint32_t end = node.end;
    node.first = static_cast<std::uint32_t>(topology.nodes.size());
    open.push_back(node.first + 1);
    open.push_back(node.first);
    topology.nodes.push_back({0, 0, begin, begin + left, child_depth, 0});  // invalidates `node`
    topology.nodes.push_back({0, 0, begin + left, end, child_depth, 0});
  }
  for (std::size_t i = topology.nodes.size(); i-- > 0;) {  // children come after their parents
    TopologyNode& node = topology.nodes[i];
    if (node.is_leaf()) continue;
    node.height = static_cast<std::uint8_t>(
        1 + std::max(topology.nodes[node.first].height, topology.nodes[node.first + 1].height));
  }
  topology.order.resize(references.size());
  for (std::size_t i = 0; i < references.size(); ++i) topology.order[i] = references[i].triangle;
  return topology;
}

}  // namespace odds::tree
