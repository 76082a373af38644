#include "odds/mesh/faults.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "mesh/adjacency.hpp"
#include "mesh/signed_volume.hpp"

namespace odds::mesh {
namespace {

class Search {
 public:
  Search(const TriangleMesh& mesh, const FaultOptions& options)
      : mesh_(mesh), options_(options), first_(first_at_position(mesh.vertices())) {
    triangles_.reserve(mesh.triangles().size());
    for (const Triangle& t : mesh.triangles()) triangles_.push_back({first_[t[0]], first_[t[1]], first_[t[2]]});
    uses_ = sorted_edge_uses(triangles_);
  }

  Faults run() {
    judge_triangles();
    judge_edges();
    judge_vertices();
    faults_.closed = faults_.boundary.count == 0;
    faults_.manifold = faults_.non_manifold.count == 0 && faults_.non_manifold_vertex.count == 0;
    if (faults_.closed && faults_.consistent()) faults_.volume = signed_volume(mesh_);
    return std::move(faults_);
  }

 private:
  template <class Item>
  void note(Finding<Item>& finding, const Item& item) {
    ++finding.count;
    if (finding.examples.size() < options_.examples) finding.examples.push_back(item);
  }

  void judge_triangles() {
    for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
      const Triangle& t = triangles_[i];
      const Vec3& a = mesh_.vertices()[t[0]];
      const Vec3& b = mesh_.vertices()[t[1]];
      const Vec3& c = mesh_.vertices()[t[2]];
      if (repeats_vertex(t) || has_zero_area(a, b, c)) {
        note(faults_.degenerate, i);
        continue;
      }
      const double twice_area = (b - a).cross(c - a).norm();
      faults_.area += 0.5 * twice_area;
      const double longest_squared = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
      if (twice_area < options_.sliver_height * longest_squared) note(faults_.sliver, i);
    }
    for (const std::uint32_t index : later_duplicates(triangles_)) note(faults_.duplicate, index);
  }

  void judge_edges() {
    ParitySets parts(triangles_.size());
    ParitySets sides(triangles_.size());
    faults_.orientable = true;
    for_each_edge(uses_, [&](std::span<const EdgeUse> edge) {
      if (edge.size() == 1) note(faults_.boundary, edge[0].edge);
      if (edge.size() > 2) note(faults_.non_manifold, edge[0].edge);
      if (edge.size() == 2) {
        const bool same_direction = edge[0].forward == edge[1].forward;
        if (same_direction) note(faults_.inconsistent, edge[0].edge);
        if (!sides.join(edge[0].triangle, edge[1].triangle, same_direction)) faults_.orientable = false;
      }
      for (const EdgeUse& use : edge.subspan(1)) parts.join(edge[0].triangle, use.triangle, false);
    });
    for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
      if (parts.find(i).root == i && !repeats_vertex(triangles_[i])) ++faults_.components;
    }
  }

  /// A corner is a triangle at one of its vertices. Two corners of a vertex belong to one fan if their triangles share
  /// an edge at that vertex.
  void judge_vertices() {
    const auto corner = [&](std::uint32_t triangle, std::uint32_t vertex) {
      const Triangle& t = triangles_[triangle];
      return 3 * triangle + (t[0] == vertex ? 0U : t[1] == vertex ? 1U : 2U);
    };
    ParitySets fans(3 * triangles_.size());
    for_each_edge(uses_, [&](std::span<const EdgeUse> edge) {
      for (const EdgeUse& use : edge.subspan(1)) {
        for (const std::uint32_t vertex : use.edge) {
          fans.join(corner(edge[0].triangle, vertex), corner(use.triangle, vertex), false);
        }
      }
    });
    std::vector<std::uint32_t> fans_at(mesh_.vertices().size(), 0);
    for (const EdgeUse& use : uses_) {
      // Each corner has two sides; it is counted at the one that leaves its vertex.
      const std::uint32_t vertex = use.edge[use.forward ? 0 : 1];
      const std::uint32_t own = corner(use.triangle, vertex);
      if (fans.find(own).root == own) ++fans_at[vertex];
    }
    std::vector<bool> used(mesh_.vertices().size(), false);
    for (const Triangle& t : mesh_.triangles()) {
      for (const std::uint32_t vertex : t) used[vertex] = true;
    }
    std::vector<bool> seen(mesh_.vertices().size(), false);
    for (std::uint32_t i = 0; i < mesh_.vertices().size(); ++i) {
      if (fans_at[i] > 1) note(faults_.non_manifold_vertex, i);
      if (!used[i]) {
        note(faults_.unused_vertex, i);
        continue;
      }
      if (seen[first_[i]]) note(faults_.duplicate_vertex, i);
      seen[first_[i]] = true;
    }
  }

  const TriangleMesh& mesh_;
  const FaultOptions& options_;
  std::vector<std::uint32_t> first_;
  std::vector<Triangle> triangles_;  ///< by the least index at a position
  std::vector<EdgeUse> uses_;
  Faults faults_;
};

std::string short_text(double value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, 3);
  return {text.data(), end.ptr};
}

}  // namespace

Faults find_faults(const TriangleMesh& mesh, const FaultOptions& options) { return Search(mesh, options).run(); }

std::string units_hint(const TriangleMesh& mesh) {
  // A part that a hand or a robot holds is 1 mm to 10 m; numbers beyond are more often millimetres than buildings.
  const double size = mesh.size();
  const double away = (0.5 * (mesh.lower() + mesh.upper())).norm();
  if (size > 0.0 && away > 1e4 * size) {  // a point has no size to compare with
    return "lies " + short_text(away / size) + " times its size from the origin; moving it there keeps more digits";
  }
  if (size > 10.0) {
    return "is " + short_text(size) +
           " m across as it stands; a part or a robot link of that number is in millimetres "
           "(then " +
           short_text(size * 1e-3) + " m): check, and scale by 0.001 if so";
  }
  if (size < 1e-3) {
    return "is " + short_text(size) + " m across as it stands; check whether the file is in metres";
  }
  return {};
}

}  // namespace odds::mesh
