// Growth within the bound on memory, and welding by exact position.
#include "mesh/mesh_builder.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "mesh/refusal.hpp"

namespace odds::mesh {
namespace {

// The bound that read() promises, and what of it is set aside for windows, zlib, headers and messages.
constexpr std::uint64_t bound_factor = 10;
constexpr std::uint64_t bound_constant = std::uint64_t{64} << 20;
constexpr std::uint64_t set_aside = std::uint64_t{2} << 20;

std::uint64_t memory_bound(std::uint64_t stored_bytes) {
  constexpr std::uint64_t largest = std::numeric_limits<std::uint64_t>::max() / bound_factor - bound_constant;
  return bound_factor * std::min(stored_bytes, largest) + bound_constant - set_aside;
}

std::uint64_t mixed(std::uint64_t bits) {  // the finalizer of SplitMix64 (Steele, Lea, Flood 2014)
  bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9u;
  bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebu;
  return bits ^ (bits >> 31);
}

std::uint64_t hash(const Vec3& position) {
  std::uint64_t value = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double coordinate = position[axis] + 0.0;  // -0 becomes 0
    value = mixed(value + 0x9e3779b97f4a7c15u + std::bit_cast<std::uint64_t>(coordinate));
  }
  return value;
}

}  // namespace

MeshBuilder::MeshBuilder(Input& input, const ReadOptions& options, std::uint64_t stored_bytes)
    : input_(input),
      scale_(options.scale),
      max_vertices_(std::min<std::uint64_t>(options.max_vertices, TriangleMesh::largest_count)),
      max_triangles_(std::min<std::uint64_t>(options.max_triangles, TriangleMesh::largest_count)),
      max_bytes_(memory_bound(stored_bytes)) {}

std::uint64_t MeshBuilder::held_bytes() const noexcept {
  return vertices_.capacity() * sizeof(Vec3) + triangles_.capacity() * sizeof(Triangle) +
         table_.capacity() * sizeof(std::uint32_t) + late_polygons_.capacity() * sizeof(LatePolygon) +
         ring_.capacity() * sizeof(RingCorner);
}

template <class T>
void MeshBuilder::grow(std::vector<T>& vector, std::uint64_t size, std::uint64_t largest_size) {
  if (size <= vector.capacity()) return;
  const auto fits = [&](std::uint64_t capacity) {  // while growing, the old and the new block are both held
    return held_bytes() <= max_bytes_ && capacity <= (max_bytes_ - held_bytes()) / sizeof(T);
  };
  const std::uint64_t held = vector.capacity();
  std::uint64_t capacity = std::min(std::max<std::uint64_t>({size, 2 * held, 16}), largest_size);
  if (!fits(capacity)) capacity = std::min(std::max(size, held + held / 8), largest_size);
  if (!fits(capacity)) {
    input_.refuse("the mesh needs more memory than 10 times the size of its file + 64 MiB",
                  "unpack the file if it is packed; otherwise it is not a sensible mesh");
  }
  vector.reserve(static_cast<std::size_t>(capacity));
}

void MeshBuilder::reserve(std::uint64_t vertices, std::uint64_t triangles) {
  check_limits(vertices, triangles);
  grow(vertices_, vertices, vertices);
  grow(triangles_, triangles, triangles);
}

void MeshBuilder::check_limits(std::uint64_t vertices, std::uint64_t triangles) const {
  if (vertices > max_vertices_) refuse_vertex_limit();
  if (triangles > max_triangles_) refuse_triangle_limit();
}

void MeshBuilder::grow_vertices() {
  if (vertices_.size() >= max_vertices_) refuse_vertex_limit();
  grow(vertices_, vertices_.size() + 1, max_vertices_);
}

void MeshBuilder::grow_triangles() {
  if (triangles_.size() >= max_triangles_) refuse_triangle_limit();
  grow(triangles_, triangles_.size() + 1, max_triangles_);
}

Vec3 MeshBuilder::checked(double x, double y, double z) const {
  const Vec3 position = scale_ * Vec3(x, y, z);
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(position[axis]) <= TriangleMesh::largest_coordinate) continue;
    const std::string which = std::string("coordinate ") + "xyz"[axis];
    if (!std::isfinite(position[axis])) {
      input_.refuse(which + " is not finite", "remove or correct the vertex where the file was made");
    }
    input_.refuse(which + " exceeds 1e15 m", "check the file's unit of length and the scale");
  }
  return position;
}

void MeshBuilder::add_vertex(double x, double y, double z) {
  const Vec3 position = checked(x, y, z);
  if (vertices_.size() == vertices_.capacity()) grow_vertices();
  vertices_.push_back(position);
}

std::uint32_t MeshBuilder::weld_vertex(double x, double y, double z) {
  const Vec3 position = checked(x, y, z);
  if (2 * (vertices_.size() + 1) > table_.size()) grow_table();
  const std::size_t mask = table_.size() - 1;
  std::size_t slot = static_cast<std::size_t>(hash(position)) & mask;
  while (table_[slot] != 0) {
    if (vertices_[table_[slot] - 1] == position) return table_[slot] - 1;
    slot = (slot + 1) & mask;
  }
  if (vertices_.size() == vertices_.capacity()) grow_vertices();
  vertices_.push_back(position);
  table_[slot] = static_cast<std::uint32_t>(vertices_.size());
  return table_[slot] - 1;
}

void MeshBuilder::grow_table() {
  const std::size_t size = std::max<std::size_t>(64, 2 * table_.size());
  std::vector<std::uint32_t> larger;
  grow(larger, size, size);
  larger.assign(size, 0);
  const std::size_t mask = size - 1;
  for (std::size_t vertex = 0; vertex < vertices_.size(); ++vertex) {
    std::size_t slot = static_cast<std::size_t>(hash(vertices_[vertex])) & mask;
    while (larger[slot] != 0) slot = (slot + 1) & mask;
    larger[slot] = static_cast<std::uint32_t>(vertex + 1);
  }
  table_ = std::move(larger);
}

void MeshBuilder::end_polygon() {
  if (corners_ < 3) {
    input_.refuse(
        "a face has " + std::to_string(corners_) + (corners_ == 1 ? " corner" : " corners") + ", not at least 3",
        "remove the face or give it its missing corners");
  }
  if (corners_ == 3) return;
  const std::uint32_t triangles = corners_ - 2;
  const std::uint64_t first = triangles_.size() - triangles;
  if (greatest_ < vertices_.size()) {
    unfold(first, triangles);
  } else {
    grow(late_polygons_, late_polygons_.size() + 1, max_triangles_);
    late_polygons_.push_back({static_cast<std::uint32_t>(first), triangles});
  }
}

void MeshBuilder::unfold(std::uint64_t first_triangle, std::uint64_t triangles) {
  const std::span<Triangle> fan =
      std::span(triangles_).subspan(static_cast<std::size_t>(first_triangle), static_cast<std::size_t>(triangles));
  if (!fan_folds(vertices_, fan)) return;
  grow(ring_, triangles + 2, max_triangles_ + 2);
  cut_ears(vertices_, fan, ring_, looks_left_);
}

TriangleMesh MeshBuilder::finish(const std::string& hint) && {
  if (triangles_.empty()) {
    input_.refuse("the file has no face" + (hint.empty() ? "" : " (" + hint + ")"),
                  "give a file with at least one triangle or polygon");
  }
  table_ = {};
  for (const LatePolygon& polygon : late_polygons_) unfold(polygon.first_triangle, polygon.triangles);
  late_polygons_ = {};
  ring_ = {};
  // What growth left unused would be held for the life of the mesh; giving it back briefly needs both blocks.
  if (held_bytes() + vertices_.size() * sizeof(Vec3) <= max_bytes_) vertices_.shrink_to_fit();
  if (held_bytes() + triangles_.size() * sizeof(Triangle) <= max_bytes_) triangles_.shrink_to_fit();
  Result<TriangleMesh> mesh = TriangleMesh::make(std::move(vertices_), std::move(triangles_), input_.name());
  if (!mesh.ok()) throw Refusal{mesh.error()};
  return std::move(mesh).value();
}

void MeshBuilder::refuse_vertex_limit() const {
  input_.refuse("more than " + std::to_string(max_vertices_) + " vertices",
                "raise max_vertices or give a smaller mesh");
}

void MeshBuilder::refuse_triangle_limit() const {
  input_.refuse("more than " + std::to_string(max_triangles_) + " triangles",
                "raise max_triangles or give a smaller mesh");
}

}  // namespace odds::mesh
