#include "odds/query/shape.hpp"

#include <array>
#include <bit>
#include <chrono>
#include <future>
#include <string>

#include "odds/mesh/enclosed_volume.hpp"
#include "query/search/search.hpp"
#include "query/shape/box_mesh.hpp"
#include "query/shape/count_bytes.hpp"
#include "query/shape_data.hpp"
#include "query/wide/lookup.hpp"

namespace odds::query {
namespace {

template <std::size_t... I>
AnyTree build_tree(volume::Kind kind, const mesh::TriangleMesh& mesh, const tree::BuildOptions& options,
                   const Progress& progress, std::index_sequence<I...>) {
  AnyTree tree;
  static_cast<void>(
      ((static_cast<std::size_t>(kind) == I
            ? (tree.emplace<I>(std::variant_alternative_t<I, AnyTree>::build(mesh, options, progress)), true)
            : false) ||
       ...));
  return tree;
}

/// Leaves, and well-filled cells of the other nodes.
struct NodeCounts {
  std::size_t leaves = 0;
  std::size_t inner = 0;
  double cells = 0.0;

  void add(bool is_leaf, const tree::NodeStatistics& statistics) {
    if (is_leaf) {
      ++leaves;
    } else {
      ++inner;
      cells += statistics.well_filled_cells;
    }
  }
};

template <volume::BoundingVolume V>
NodeCounts count_nodes(const tree::Hierarchy<V>& hierarchy) {
  NodeCounts counts;
  for (std::size_t i = 0; i < hierarchy.nodes().size(); ++i) {
    counts.add(hierarchy.nodes()[i].is_leaf(), hierarchy.statistics()[i]);
  }
  return counts;
}

NodeCounts count_nodes(const tree::WideTree& tree) {
  NodeCounts counts;
  for (std::size_t node = 0; node < tree.node_count(); ++node) {
    for (std::uint32_t lane = 0; lane < tree::wide_lanes; ++lane) {
      const tree::ChildRef child = tree.nodes()[node].child[lane];
      if (child.is_nothing()) continue;
      counts.add(child.is_leaf(), tree.statistics(static_cast<tree::Slot>(node * tree::wide_lanes + lane)));
    }
  }
  return counts;
}

ShapeSummary summarise(const AnyTree& any_tree, const mesh::TriangleMesh& mesh) {
  ShapeSummary summary;
  const NodeCounts counts = std::visit([](const auto& tree) { return count_nodes(tree); }, any_tree);
  count_bytes(any_tree, mesh, summary);
  summary.triangles = mesh.triangles().size();
  summary.leaves = counts.leaves;
  summary.mean_leaf_triangles = static_cast<double>(summary.triangles) / static_cast<double>(summary.leaves);
  summary.mean_well_filled_cells = counts.inner == 0 ? 0.0 : counts.cells / static_cast<double>(counts.inner);
  return summary;
}

template <volume::BoundingVolume V>
tree::Hierarchy<V> polygon_free(const tree::Hierarchy<V>& hierarchy) {
  auto parts = hierarchy.parts();
  parts.corners = {};
  parts.order = {};
  return tree::Hierarchy<V>(std::move(parts));
}

tree::WideTree polygon_free(const tree::WideTree& tree) {
  tree::WideTree::Parts parts = tree.parts();
  parts.leaves = {};
  return tree::WideTree(std::move(parts));
}

bool closed_and_outward(const mesh::TriangleMesh& mesh) { return mesh::enclosed_volume(mesh).value_or(0.0) > 0.0; }

/// The query box in the hierarchy's frame.
struct Box {
  Vec3 center;
  Mat3 axes;
  Vec3 half_extents;

  [[nodiscard]] std::array<Vec3, 8> corners() const {
    std::array<Vec3, 8> corners;
    for (unsigned i = 0; i < 8; ++i) {
      const Vec3 signs((i & 1U) != 0 ? 1 : -1, (i & 2U) != 0 ? 1 : -1, (i & 4U) != 0 ? 1 : -1);
      corners[i] = center + axes * half_extents.cwiseProduct(signs);
    }
    return corners;
  }

  /// The triangle's extents along the box's axes meet the box.
  [[nodiscard]] bool meets(const tree::TriangleCorners& triangle) const noexcept {
    const Vec3 p = axes.transpose() * (triangle[0] - center);
    const Vec3 q = axes.transpose() * (triangle[1] - center);
    const Vec3 r = axes.transpose() * (triangle[2] - center);
    const Vec3 lower = p.cwiseMin(q).cwiseMin(r);
    const Vec3 upper = p.cwiseMax(q).cwiseMax(r);
    return (lower.array() <= half_extents.array()).all() && (upper.array() >= -half_extents.array()).all();
  }
};

template <volume::BoundingVolume V>
std::size_t collect(const mesh::TriangleMesh&, const tree::Hierarchy<V>& hierarchy, const Box& box,
                    std::span<std::uint32_t> found, std::uint64_t budget_nodes, bool& complete,
                    std::uint64_t& visited) noexcept {
  const std::array<Vec3, 8> corners = box.corners();
  const V enclosing = V::fit(corners, box.axes);
  const double reach = hierarchy.reach() + box.center.norm() + box.half_extents.norm();
  const auto same_frame = V::PreparedPose::make({}, 2.0 * reach);
  // A volume about a larger box overflows where it is squared, and meets nothing.
  const bool has_volume = reach < 1e15 * mesh::TriangleMesh::largest_coordinate;
  std::array<std::uint32_t, stack_capacity> stack;
  std::size_t size = 0;
  stack[size++] = 0;
  std::size_t count = 0;
  complete = false;
  while (size != 0) {
    if (visited >= budget_nodes) return count;
    ++visited;
    const auto& node = hierarchy.nodes()[stack[--size]];
    if (has_volume && !overlap(node.volume, enclosing, same_frame)) continue;
    if (!node.is_leaf()) {
      stack[size++] = node.first + 1;
      stack[size++] = node.first;
      continue;
    }
    for (std::uint32_t t = node.first; t < node.first + node.count; ++t) {
      if (!box.meets(hierarchy.corners()[t])) continue;
      if (count == found.size()) return count;
      found[count++] = hierarchy.order()[t];
    }
  }
  complete = true;
  return count;
}

std::size_t collect(const mesh::TriangleMesh& mesh, const tree::WideTree& tree, const Box& box,
                    std::span<std::uint32_t> found, std::uint64_t budget_nodes, bool& complete,
                    std::uint64_t& visited) noexcept {
  const Vec3f center = box.center.cast<float>();
  const Mat3f axes = box.axes.cast<float>();
  const double largest = box.half_extents.maxCoeff();
  const Vec3f half = (box.half_extents * (1.0 + 1e-6)).cast<float>();
  const auto margin = static_cast<float>((tree.reach() + box.center.norm() + largest) * 32.0 * 0x1p-24);
  std::array<tree::ChildRef, (tree::wide_lanes - 1) * (tree::deepest_level + 2)> stack;
  std::size_t size = 0;
  stack[size++] = tree.nodes()[0].child[0];
  std::size_t count = 0;
  complete = false;
  while (size != 0) {
    if (visited >= budget_nodes) return count;
    ++visited;
    const tree::ChildRef child = stack[--size];
    if (!child.is_leaf()) {
      const tree::WideNode& node = tree.nodes()[child.index()];
      for (unsigned lanes = wide::lanes_in_box(node, center, axes, half, margin); lanes != 0; lanes &= lanes - 1U) {
        stack[size++] = node.child[std::countr_zero(lanes)];
      }
      continue;
    }
    const tree::WideLeaf& leaf = tree.leaves()[child.index()];
    for (std::uint32_t t = 0; t < child.count(); ++t) {
      const mesh::Triangle& triangle = mesh.triangles()[leaf.triangle[t]];
      if (!box.meets({mesh.vertices()[triangle[0]] - tree.origin(), mesh.vertices()[triangle[1]] - tree.origin(),
                      mesh.vertices()[triangle[2]] - tree.origin()})) {
        continue;
      }
      if (count == found.size()) return count;
      found[count++] = leaf.triangle[t];
    }
  }
  complete = true;
  return count;
}

}  // namespace

Result<std::shared_ptr<const Shape>> Shape::build(std::shared_ptr<const mesh::TriangleMesh> mesh,
                                                  const ShapeOptions& options, const Progress& progress) {
  if (!mesh) return Error{"", "", "no mesh was given", "pass a mesh that was made or read without an error"};
  const bool wide = options.volume == volume::Kind::wide;
  const std::uint32_t most = wide ? tree::wide_lanes : 16;
  if (options.leaf_triangles > most) {
    return Error{mesh->name(), "", "leaf_triangles is " + std::to_string(options.leaf_triangles),
                 "choose 1 to " + std::to_string(most) + ", or 0 for what suits the volume"};
  }
  if (!(options.tau > 0.0 && options.tau <= 1.0)) {
    return Error{mesh->name(), "", "tau is " + std::to_string(options.tau), "choose a value in (0, 1]"};
  }
  const auto start = std::chrono::steady_clock::now();
  auto data = std::make_unique<Data>();
  // Beside the hierarchy, whose first steps leave processors idle; not worth a thread for a small mesh.
  const bool is_big = mesh->triangles().size() > 20000;
  auto solid = std::async(is_big ? std::launch::async | std::launch::deferred : std::launch::deferred,
                          [&mesh] { return closed_and_outward(*mesh); });
  data->options = options;
  if (options.leaf_triangles == 0) data->options.leaf_triangles = wide ? tree::wide_lanes : 4;
  const tree::BuildOptions build_options{data->options.leaf_triangles, options.tau};
  data->tree = build_tree(options.volume, *mesh, build_options, progress,
                          std::make_index_sequence<std::variant_size_v<AnyTree>>());
  data->solid = solid.get();
  if (const auto* tree = std::get_if<tree::WideTree>(&data->tree); tree != nullptr && tree->node_count() == 0) {
    return Error{mesh->name(), "",
                 "its hierarchy would have more than " + std::to_string(tree::WideTree::most_nodes) + " nodes",
                 "put more triangles into a leaf, or divide the mesh"};
  }
  data->summary = summarise(data->tree, *mesh);
  data->summary.build_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  data->mesh = std::move(mesh);
  return of(std::move(data));
}

std::shared_ptr<const Shape> Shape::of(std::unique_ptr<Data> data) {
  return std::shared_ptr<const Shape>(new Shape(std::move(data)));
}

std::shared_ptr<const Shape> Shape::without_polygons() const {
  auto data = std::make_unique<Data>();
  data->options = data_->options;
  data->solid = data_->solid;
  data->polygons = false;
  data->tree = std::visit([](const auto& tree) { return AnyTree(polygon_free(tree)); }, data_->tree);
  Result<mesh::TriangleMesh> box = box_mesh(mesh().lower(), mesh().upper(), mesh().name());
  data->mesh = std::make_shared<const mesh::TriangleMesh>(std::move(box).value());  // a valid mesh has a valid box
  data->summary = data_->summary;
  count_bytes(data->tree, *data->mesh, data->summary);
  return of(std::move(data));
}

Shape::Shape(std::unique_ptr<Data> data) : data_(std::move(data)) {}
Shape::~Shape() = default;

bool Shape::has_polygons() const noexcept { return data_->polygons; }
const mesh::TriangleMesh& Shape::mesh() const noexcept { return *data_->mesh; }
volume::Kind Shape::volume() const noexcept { return data_->options.volume; }
const ShapeOptions& Shape::options() const noexcept { return data_->options; }
const ShapeSummary& Shape::summary() const noexcept { return data_->summary; }
bool Shape::is_solid() const noexcept { return data_->solid; }
void Shape::find_flat_faces() const { static_cast<void>(data_->flat_faces()); }

std::size_t triangles_in_box(const Shape& shape, const Vec3& center, const Mat3& axes, const Vec3& half_extents,
                             std::span<std::uint32_t> found, std::uint64_t budget_nodes, bool* complete,
                             std::uint64_t* visited) noexcept {
  bool all = false;
  std::uint64_t nodes = 0;
  std::size_t count = 0;
  const bool usable = center.allFinite() && axes.allFinite() && half_extents.allFinite() && !found.empty();
  if (usable && shape.has_polygons()) {
    count = std::visit(
        [&](const auto& tree) {
          return collect(shape.mesh(), tree, Box{center - tree.origin(), axes, half_extents.cwiseMax(0.0)}, found,
                         budget_nodes, all, nodes);
        },
        shape.data().tree);
  }
  if (complete != nullptr) *complete = all;
  if (visited != nullptr) *visited = nodes;
  return count;
}

}  // namespace odds::query
