// Preparing a shape for geoms: a wide tree, whether the surface closes, and corners where many triangles meet.
#include "ode/mesh/prepared_mesh.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <span>
#include <stdexcept>
#include <utility>
#include <variant>
#include <vector>

#include "odds/math/tolerances.hpp"
#include "odds/mesh/enclosed_volume.hpp"
#include "ode/mesh/triangle_corners.hpp"
#include "query/shape_data.hpp"

namespace odds::ode {
namespace {

// Files without shared vertices (STL) repeat them: equal positions count as one vertex.
std::vector<std::uint32_t> weld_equal_positions(const mesh::TriangleMesh& mesh) {
  const auto vertices = mesh.vertices();
  std::vector<std::uint32_t> order(vertices.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto less = [vertices](std::uint32_t a, std::uint32_t b) {
    const Vec3& u = vertices[a];
    const Vec3& v = vertices[b];
    return std::lexicographical_compare(u.data(), u.data() + 3, v.data(), v.data() + 3);
  };
  std::sort(order.begin(), order.end(), less);
  std::vector<std::uint32_t> representative(vertices.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && vertices[order[i]] == vertices[order[i - 1]];
    representative[order[i]] = same ? representative[order[i - 1]] : order[i];
  }
  return representative;
}

// Closed: as many edges u->v as v->u, for every u, v. Degenerate triangles have no area and do not count.
bool closes(const mesh::TriangleMesh& mesh, std::span<const std::uint32_t> representative) {
  std::vector<std::pair<std::array<std::uint32_t, 2>, int>> edges;
  edges.reserve(3 * mesh.triangles().size());
  for (const mesh::Triangle& triangle : mesh.triangles()) {
    const std::array<std::uint32_t, 3> v = {representative[triangle[0]], representative[triangle[1]],
                                            representative[triangle[2]]};
    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t from = v[i];
      const std::uint32_t to = v[(i + 1) % 3];
      edges.push_back({{std::min(from, to), std::max(from, to)}, from < to ? 1 : -1});
    }
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 0; i < edges.size();) {
    int balance = 0;
    const auto key = edges[i].first;
    for (; i < edges.size() && edges[i].first == key; ++i) balance += edges[i].second;
    if (balance != 0) return false;
  }
  return !edges.empty();
}

std::vector<PreparedMesh::Fan> find_fans(const PreparedMesh& prepared, std::span<const std::uint32_t> representative) {
  const mesh::TriangleMesh& mesh = prepared.mesh();
  std::vector<std::uint32_t> users(mesh.vertices().size(), 0);
  for (const mesh::Triangle& triangle : mesh.triangles()) {
    for (const std::uint32_t v : triangle) ++users[representative[v]];
  }
  std::vector<PreparedMesh::Fan> fans;
  std::vector<std::uint32_t> fan_of(users.size(), query::no_feature);
  for (std::size_t v = 0; v < users.size(); ++v) {
    if (users[v] <= PreparedMesh::most_touching) continue;
    fan_of[v] = static_cast<std::uint32_t>(fans.size());
    fans.push_back({mesh.vertices()[v], Vec3::Zero()});
  }
  if (fans.empty()) return fans;
  for (std::uint32_t t = 0; t < mesh.triangles().size(); ++t) {
    for (const std::uint32_t v : mesh.triangles()[t]) {
      const std::uint32_t number = fan_of[representative[v]];
      if (number == query::no_feature) continue;
      const Corners corners = prepared.corners(t);
      fans[number].normal += angle_at(corners, fans[number].tip, 0.0) * unit_normal(corners);
    }
  }
  std::erase_if(fans, [](const PreparedMesh::Fan& fan) { return !(fan.normal.norm() > 0.0); });
  for (PreparedMesh::Fan& fan : fans) fan.normal.normalize();
  std::sort(fans.begin(), fans.end(), [](const auto& a, const auto& b) { return a.tip.x() < b.tip.x(); });
  return fans;
}

// How low triangles are that may be nothing but rounding, if there are some.
double find_thin(const PreparedMesh& prepared) {
  const double thin = tolerances::flat_face * prepared.mesh().size();
  for (std::uint32_t t = 0; t < prepared.mesh().triangles().size(); ++t) {
    if (is_thin(prepared.corners(t), thin)) return thin;
  }
  return 0.0;
}

}  // namespace

std::shared_ptr<const PreparedMesh> PreparedMesh::make(std::shared_ptr<const query::Shape> shape) {
  auto prepared = std::make_shared<PreparedMesh>();
  prepared->shape = std::move(shape);
  prepared->shape->find_flat_faces();  // or the first collision that prepares a pair would
  const mesh::TriangleMesh& mesh = prepared->mesh();
  prepared->wide_tree = std::get_if<tree::WideTree>(&prepared->shape->data().tree);
  if (prepared->wide_tree == nullptr) {
    prepared->own_tree = tree::WideTree::build(mesh, {.leaf_triangles = tree::wide_lanes});
    if (prepared->own_tree->node_count() == 0)
      throw std::length_error("mesh data: more triangles than a tree can hold");
    prepared->wide_tree = &*prepared->own_tree;
  }
  const std::vector<std::uint32_t> representative = weld_equal_positions(mesh);
  // A sheet whose triangles are there twice, once for each side, closes, too, but has no inside to be pushed out of.
  // (As part of a mesh that encloses something it is not told apart.)
  prepared->closed = closes(mesh, representative) && mesh::enclosed_volume(mesh) != 0.0;
  prepared->fans = find_fans(*prepared, representative);
  prepared->thin = find_thin(*prepared);
  return prepared;
}

}  // namespace odds::ode
