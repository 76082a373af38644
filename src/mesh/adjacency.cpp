#include "mesh/adjacency.hpp"

#include <algorithm>
#include <bit>
#include <numeric>
#include <tuple>

#include "odds/math/random.hpp"

namespace odds::mesh {

namespace {

std::uint64_t hash_of(const Vec3& position) {
  std::uint64_t hash = 0;
  for (const double x : position) {
    const double unsigned_zero = x + 0.0;  // -0 equals 0
    hash = math::scramble(hash ^ std::bit_cast<std::uint64_t>(unsigned_zero));
  }
  return hash;
}

}  // namespace

std::vector<std::uint32_t> first_at_position(std::span<const Vec3> vertices) {
  // An open-addressed table of the indices seen first, at most half full.
  constexpr std::uint32_t none = ~std::uint32_t{0};
  std::vector<std::uint32_t> table(std::bit_ceil(2 * vertices.size() + 1), none);
  const std::size_t mask = table.size() - 1;
  std::vector<std::uint32_t> first(vertices.size());
  for (std::uint32_t i = 0; i < vertices.size(); ++i) {
    std::size_t slot = hash_of(vertices[i]) & mask;
    while (table[slot] != none && vertices[table[slot]] != vertices[i]) slot = (slot + 1) & mask;
    if (table[slot] == none) table[slot] = i;
    first[i] = table[slot];
  }
  return first;
}

std::vector<EdgeUse> sorted_edge_uses(std::span<const Triangle> triangles) {
  const auto for_each_use = [&](const auto& visit) {
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
      const Triangle& t = triangles[i];
      if (repeats_vertex(t)) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t from = t[k];
        const std::uint32_t to = t[(k + 1) % 3];
        visit(EdgeUse{{std::min(from, to), std::max(from, to)}, i, from < to});
      }
    }
  };
  // By the smaller vertex first, by counting; a vertex has few edges, so that the rest is quick.
  std::vector<std::uint32_t> end;
  for (const Triangle& t : triangles) {
    const std::size_t needed = *std::max_element(t.begin(), t.end()) + std::size_t{2};
    if (end.size() < needed) end.resize(needed, 0);
  }
  for_each_use([&](const EdgeUse& use) { ++end[use.edge[0] + 1]; });
  for (std::size_t i = 1; i < end.size(); ++i) end[i] += end[i - 1];
  std::vector<EdgeUse> uses(end.empty() ? 0 : end.back());
  for_each_use([&](const EdgeUse& use) { uses[end[use.edge[0]]++] = use; });
  std::uint32_t begin = 0;
  for (const std::uint32_t last : end) {
    std::sort(uses.begin() + begin, uses.begin() + last, [](const EdgeUse& a, const EdgeUse& b) {
      return std::tie(a.edge[1], a.triangle) < std::tie(b.edge[1], b.triangle);
    });
    begin = last;
  }
  return uses;
}

void for_each_edge(std::span<const EdgeUse> uses, const std::function<void(std::span<const EdgeUse>)>& visit) {
  for (std::size_t begin = 0; begin < uses.size();) {
    std::size_t end = begin + 1;
    while (end < uses.size() && uses[end].edge == uses[begin].edge) ++end;
    visit(uses.subspan(begin, end - begin));
    begin = end;
  }
}

std::vector<std::uint32_t> later_duplicates(std::span<const Triangle> triangles) {
  struct Keyed {
    Triangle sorted;
    std::uint32_t index;
  };
  std::vector<Keyed> keyed(triangles.size());
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    keyed[i] = {triangles[i], i};
    std::sort(keyed[i].sorted.begin(), keyed[i].sorted.end());
  }
  std::sort(keyed.begin(), keyed.end(),
            [](const Keyed& a, const Keyed& b) { return std::tie(a.sorted, a.index) < std::tie(b.sorted, b.index); });
  std::vector<std::uint32_t> later;
  for (std::size_t i = 1; i < keyed.size(); ++i) {
    if (keyed[i].sorted == keyed[i - 1].sorted) later.push_back(keyed[i].index);
  }
  std::sort(later.begin(), later.end());
  return later;
}

ParitySets::ParitySets(std::size_t count) : parent_(count), odd_(count, false) {
  std::iota(parent_.begin(), parent_.end(), 0U);
}

ParitySets::Place ParitySets::find(std::uint32_t item) {
  std::uint32_t root = item;
  bool odd = false;
  while (parent_[root] != root) {
    odd = odd != odd_[root];
    root = parent_[root];
  }
  const Place place{root, odd};
  while (parent_[item] != root && item != root) {  // path compression
    const std::uint32_t next = parent_[item];
    const bool next_odd = odd != odd_[item];
    parent_[item] = root;
    odd_[item] = odd;
    item = next;
    odd = next_odd;
  }
  return place;
}

bool ParitySets::join(std::uint32_t a, std::uint32_t b, bool odd) {
  const Place at_a = find(a);
  const Place at_b = find(b);
  const bool between_roots = (at_a.odd != at_b.odd) != odd;
  if (at_a.root == at_b.root) return !between_roots;
  // The smaller index stays root, so that results do not depend on the order of edges.
  const std::uint32_t root = std::min(at_a.root, at_b.root);
  const std::uint32_t child = std::max(at_a.root, at_b.root);
  parent_[child] = root;
  odd_[child] = between_roots;
  return true;
}

}  // namespace odds::mesh
