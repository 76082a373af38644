#include "odds/mesh/repair.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "mesh/adjacency.hpp"
#include "mesh/caps.hpp"
#include "mesh/surrounds.hpp"

namespace odds::mesh {
namespace {

class Bench {
 public:
  explicit Bench(const TriangleMesh& mesh)
      : vertices_(mesh.vertices().begin(), mesh.vertices().end()),
        triangles_(mesh.triangles().begin(), mesh.triangles().end()) {}

  void weld() {
    const std::vector<std::uint32_t> first = first_at_position(vertices_);
    std::vector<bool> counted(vertices_.size(), false);
    for (Triangle& t : triangles_) {
      for (std::uint32_t& vertex : t) {
        if (first[vertex] != vertex && !counted[vertex]) {
          counted[vertex] = true;
          ++log_.welded_vertices;
        }
        vertex = first[vertex];
      }
    }
  }

  void drop_degenerate() {
    log_.flipped_degenerate = flip_caps(vertices_, triangles_);
    log_.dropped_degenerate = std::erase_if(triangles_, [&](const Triangle& t) {
      return has_zero_area(vertices_[t[0]], vertices_[t[1]], vertices_[t[2]]);
    });
  }

  void drop_duplicates() {
    const std::vector<std::uint32_t> later = later_duplicates(triangles_);
    std::size_t kept = 0;
    std::size_t next = 0;
    for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
      if (next < later.size() && later[next] == i) {
        ++next;
      } else {
        triangles_[kept++] = triangles_[i];
      }
    }
    triangles_.resize(kept);
    log_.dropped_duplicates = later.size();
  }

  void orient() {
    find_components();
    std::vector<bool> turn(triangles_.size(), false);
    for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
      const Component& own = components_[component_of_[i]];
      if (!own.orientable) continue;
      const bool majority_odd = 2 * own.odd > own.triangles;
      turn[i] = odd_[i] != majority_odd;
    }
    judge_volumes(turn);
    for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
      if (turn[i] == components_[component_of_[i]].turned) continue;
      std::swap(triangles_[i][1], triangles_[i][2]);
      ++log_.turned_triangles;
    }
  }

  void drop_unused() {
    constexpr std::uint32_t unused = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> place(vertices_.size(), unused);
    for (const Triangle& t : triangles_) {
      for (const std::uint32_t vertex : t) place[vertex] = 0;
    }
    std::uint32_t kept = 0;
    for (std::size_t i = 0; i < vertices_.size(); ++i) {
      if (place[i] == unused) continue;
      vertices_[kept] = vertices_[i];
      place[i] = kept++;
    }
    log_.dropped_vertices = vertices_.size() - kept;
    vertices_.resize(kept);
    for (Triangle& t : triangles_) {
      for (std::uint32_t& vertex : t) vertex = place[vertex];
    }
  }

  Result<Repaired> finish(const std::string& name) {
    if (triangles_.empty()) {
      return Error{name, "", "no triangle is left: all have zero area", "check the file's coordinates and units"};
    }
    Result<TriangleMesh> mesh = TriangleMesh::make(std::move(vertices_), std::move(triangles_), name);
    if (!mesh.ok()) return mesh.error();
    return Repaired{std::move(mesh).value(), log_};
  }

 private:
  struct Component {
    std::size_t triangles = 0;
    std::size_t odd = 0;
    bool orientable = true;
    bool closed = true;
    bool inside_out = false;  ///< and in no other
    bool turned = false;      ///< because of that, or with another
    double six_volumes = 0.0;
    std::size_t first_member = 0;
    Vec3 lower = Vec3::Constant(std::numeric_limits<double>::infinity());
    Vec3 upper = Vec3::Constant(-std::numeric_limits<double>::infinity());

    [[nodiscard]] double length() const { return upper.x() - lower.x(); }  ///< along x
  };

  /// Positions, not indices, decide who is whose neighbour, whether or not the mesh was welded.
  void find_components() {
    const std::vector<std::uint32_t> first = first_at_position(vertices_);
    std::vector<Triangle> by_position;
    by_position.reserve(triangles_.size());
    for (const Triangle& t : triangles_) by_position.push_back({first[t[0]], first[t[1]], first[t[2]]});
    const std::vector<EdgeUse> uses = sorted_edge_uses(by_position);
    ParitySets sets(triangles_.size());
    std::vector<std::uint32_t> open;
    std::vector<std::uint32_t> twisted;
    for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
      if (edge.size() != 2) {
        for (const EdgeUse& use : edge) open.push_back(use.triangle);
      } else if (!sets.join(edge[0].triangle, edge[1].triangle, edge[0].forward == edge[1].forward)) {
        twisted.push_back(edge[0].triangle);
      }
    });
    std::vector<std::uint32_t> number(triangles_.size(), 0);
    component_of_.resize(triangles_.size());
    odd_.resize(triangles_.size());
    for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
      const ParitySets::Place place = sets.find(i);
      if (place.root == i) {  // a root is the least index of its set
        number[i] = static_cast<std::uint32_t>(components_.size());
        components_.emplace_back();
      }
      component_of_[i] = number[place.root];
      odd_[i] = place.odd;
      ++components_[component_of_[i]].triangles;
      components_[component_of_[i]].odd += place.odd ? 1 : 0;
    }
    for (const std::uint32_t i : open) components_[component_of_[i]].closed = false;
    for (const std::uint32_t i : twisted) components_[component_of_[i]].orientable = false;
    for (const Component& component : components_) log_.unorientable_components += component.orientable ? 0 : 1;
  }

  /// Says which closed components are turned: those that face inwards, except cavities, and what lies in them.
  void judge_volumes(const std::vector<bool>& turn) {
    for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
      Component& own = components_[component_of_[i]];
      for (const std::uint32_t vertex : triangles_[i]) {
        own.lower = own.lower.cwiseMin(vertices_[vertex]);
        own.upper = own.upper.cwiseMax(vertices_[vertex]);
      }
    }
    for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
      Component& own = components_[component_of_[i]];
      const Vec3 middle = 0.5 * (own.lower + own.upper);
      const Triangle& t = triangles_[i];
      const Vec3 a = vertices_[t[0]] - middle;
      const double sixfold = a.dot((vertices_[t[1]] - middle).cross(vertices_[t[2]] - middle));
      own.six_volumes += turn[i] ? -sixfold : sixfold;
    }
    const auto faces_inwards = [](const Component& c) { return c.closed && c.orientable && c.six_volumes < 0.0; };
    list_members();
    const std::vector<std::uint32_t> closed = longest_first([](const Component& c) { return c.closed; });
    for (Component& component : components_) {
      component.inside_out = faces_inwards(component) && !lies_in_one_of(closed, component);
      component.turned = component.inside_out;
      log_.turned_components += component.inside_out ? 1 : 0;
    }
    const std::vector<std::uint32_t> inside_out = longest_first([](const Component& c) { return c.inside_out; });
    for (Component& inner : components_) {
      if (!inner.closed || !inner.orientable || inner.inside_out) continue;
      inner.turned = lies_in_one_of(inside_out, inner);
      log_.turned_inner_components += inner.turned ? 1 : 0;
      log_.cavities_kept += !inner.turned && faces_inwards(inner) ? 1 : 0;
    }
  }

  /// The triangles of each component, one component after the other.
  void list_members() {
    std::size_t end = 0;
    for (Component& component : components_) {
      component.first_member = end;
      end += component.triangles;
    }
    members_.resize(end);
    std::vector<std::size_t> next;
    next.reserve(components_.size());
    for (const Component& component : components_) next.push_back(component.first_member);
    for (std::uint32_t i = 0; i < triangles_.size(); ++i) members_[next[component_of_[i]]++] = i;
  }
  [[nodiscard]] std::span<const std::uint32_t> members(const Component& component) const {
    return std::span(members_).subspan(component.first_member, component.triangles);
  }

  template <class IsOfKind>
  [[nodiscard]] std::vector<std::uint32_t> longest_first(IsOfKind is_of_kind) const {
    std::vector<std::uint32_t> numbers;
    for (std::uint32_t i = 0; i < components_.size(); ++i) {
      if (is_of_kind(components_[i])) numbers.push_back(i);
    }
    std::sort(numbers.begin(), numbers.end(),
              [&](std::uint32_t a, std::uint32_t b) { return components_[a].length() > components_[b].length(); });
    return numbers;
  }

  /// Whether one of the closed components `outers`, longest first, surrounds this one: a box about its box does not say
  /// so, as that of a ring. It may be the wall of its cavity.
  [[nodiscard]] bool lies_in_one_of(std::span<const std::uint32_t> outers, const Component& inner) const {
    const Triangle& first = triangles_[members(inner).front()];
    const Vec3 point = (vertices_[first[0]] + vertices_[first[1]] + vertices_[first[2]]) / 3.0;
    const double least = inner.length() * (1.0 + 1e-12);  // equal parts need not be compared with each other
    for (const std::uint32_t number : outers) {
      const Component& outer = components_[number];
      if (!(outer.length() > least)) return false;
      if ((outer.lower.array() < inner.lower.array()).all() && (outer.upper.array() > inner.upper.array()).all() &&
          surrounds(vertices_, triangles_, members(outer), point)) {
        return true;
      }
    }
    return false;
  }

  std::vector<Vec3> vertices_;
  std::vector<Triangle> triangles_;
  std::vector<Component> components_;
  std::vector<std::uint32_t> component_of_;
  std::vector<std::uint32_t> members_;
  std::vector<bool> odd_;
  RepairLog log_;
};

}  // namespace

std::vector<std::string> RepairLog::lines() const {
  std::vector<std::string> text;
  const auto add = [&](std::size_t count, const char* what) {
    if (count > 0) text.push_back(std::to_string(count) + " " + what);
  };
  add(welded_vertices, "vertices welded to an earlier one at exactly the same position");
  add(flipped_degenerate, "degenerate triangles became part of the one beyond their long side, lest a gap open");
  add(dropped_degenerate, "degenerate triangles dropped");
  add(dropped_duplicates, "duplicate triangles dropped");
  add(turned_triangles, "triangles turned over to agree with their neighbours or to face outwards");
  add(turned_components, "closed components were inside out and now face outwards");
  add(turned_inner_components, "closed components within one of those were turned over with it");
  add(cavities_kept, "closed components face inwards inside another one and were left so, as cavities");
  add(unorientable_components, "components cannot be oriented and were left as they are");
  add(dropped_vertices, "unused vertices dropped");
  if (text.empty()) text.emplace_back("nothing to repair");
  return text;
}

Result<Repaired> repair(const TriangleMesh& mesh, const RepairOptions& options) {
  Bench bench(mesh);
  if (options.weld) bench.weld();
  if (options.drop_degenerate) bench.drop_degenerate();
  if (options.drop_duplicates) bench.drop_duplicates();
  if (options.orient) bench.orient();
  if (options.drop_unused) bench.drop_unused();
  return bench.finish(mesh.name());
}

}  // namespace odds::mesh
