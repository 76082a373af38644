#include "mesh/caps.hpp"

#include <algorithm>
#include <optional>
#include <tuple>

#include "mesh/adjacency.hpp"
#include "odds/mesh/faults.hpp"

namespace odds::mesh {
namespace {

class Flips {
 public:
  Flips(std::span<const Vec3> vertices, std::span<Triangle> triangles)
      : vertices_(vertices), triangles_(triangles), first_(first_at_position(vertices)) {
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
      if (is_cap(triangles[i])) caps_.push_back(i);
    }
  }

  /// Caps may lie beyond caps: each round flips those that the last one has made neighbours of a triangle.
  std::size_t run() {
    constexpr int most_rounds = 64;
    std::size_t flipped = 0;
    for (int round = 0; round < most_rounds && !caps_.empty(); ++round) {
      const std::size_t before = caps_.size();
      flip_once();
      flipped += before - caps_.size();
      if (caps_.size() == before) break;
    }
    return flipped;
  }

 private:
  [[nodiscard]] Triangle by_position(const Triangle& t) const { return {first_[t[0]], first_[t[1]], first_[t[2]]}; }
  [[nodiscard]] bool is_flat(const Triangle& t) const {
    return has_zero_area(vertices_[t[0]], vertices_[t[1]], vertices_[t[2]]);
  }
  [[nodiscard]] bool is_cap(const Triangle& t) const { return !repeats_vertex(by_position(t)) && is_flat(t); }

  /// Which of its corners lies between the others.
  [[nodiscard]] std::size_t middle_of(const Triangle& cap) const {
    std::array<std::size_t, 3> order = {0, 1, 2};
    const auto before = [&](std::size_t i, std::size_t j) {
      const Vec3& p = vertices_[cap[i]];
      const Vec3& q = vertices_[cap[j]];
      return std::tie(p.x(), p.y(), p.z()) < std::tie(q.x(), q.y(), q.z());  // along a line as good as any axis
    };
    std::sort(order.begin(), order.end(), before);
    return order[1];
  }

  void flip_once() {
    std::vector<Triangle> welded;
    welded.reserve(triangles_.size());
    for (const Triangle& t : triangles_) welded.push_back(by_position(t));
    const std::vector<EdgeUse> uses = sorted_edge_uses(welded);
    std::vector<bool> changed(triangles_.size(), false);
    std::erase_if(caps_, [&](std::uint32_t cap) {
      if (changed[cap]) return false;
      const std::size_t middle = middle_of(triangles_[cap]);
      const std::uint32_t m = welded[cap][middle];
      const std::uint32_t a = welded[cap][(middle + 1) % 3];
      const std::uint32_t b = welded[cap][(middle + 2) % 3];
      const std::optional<std::uint32_t> beyond = only_other(uses, a, b, cap);
      if (!beyond || changed[*beyond] || is_flat(triangles_[*beyond])) return false;
      Triangle& neighbour = triangles_[*beyond];
      const std::size_t apex = corner_beside(welded[*beyond], a, b);
      if (!of_edge(uses, m, welded[*beyond][apex]).empty()) return false;  // a third triangle would meet there
      Triangle other = neighbour;
      neighbour[(apex + 2) % 3] = triangles_[cap][middle];
      other[(apex + 1) % 3] = triangles_[cap][middle];
      triangles_[cap] = other;
      changed[cap] = true;
      changed[*beyond] = true;
      return true;
    });
  }

  static std::span<const EdgeUse> of_edge(std::span<const EdgeUse> uses, std::uint32_t p, std::uint32_t q) {
    const Edge edge = {std::min(p, q), std::max(p, q)};
    const auto [begin, end] =
        std::equal_range(uses.begin(), uses.end(), EdgeUse{edge, 0, false},
                         [](const EdgeUse& one, const EdgeUse& other) { return one.edge < other.edge; });
    return {begin, end};
  }
  /// The triangle that shares the side with `cap`, if it is one.
  static std::optional<std::uint32_t> only_other(std::span<const EdgeUse> uses, std::uint32_t a, std::uint32_t b,
                                                 std::uint32_t cap) {
    const std::span<const EdgeUse> both = of_edge(uses, a, b);
    if (both.size() != 2) return std::nullopt;
    return both[0].triangle == cap ? both[1].triangle : both[0].triangle;
  }
  static std::size_t corner_beside(const Triangle& t, std::uint32_t a, std::uint32_t b) {
    return t[0] != a && t[0] != b ? 0U : t[1] != a && t[1] != b ? 1U : 2U;
  }

  std::span<const Vec3> vertices_;
  std::span<Triangle> triangles_;
  std::vector<std::uint32_t> first_;
  std::vector<std::uint32_t> caps_;  // not flipped yet
};

}  // namespace

std::size_t flip_caps(std::span<const Vec3> vertices, std::span<Triangle> triangles) {
  return Flips(vertices, triangles).run();
}

}  // namespace odds::mesh
