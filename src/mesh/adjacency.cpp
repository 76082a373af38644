#include "mesh/adjacency.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace odds::mesh {

std::vector<std::uint32_t> first_at_position(std::span<const Vec3> vertices) {
  std::vector<std::uint32_t> order(vertices.size());
  std::iota(order.begin(), order.end(), 0U);
  const auto key = [&](std::uint32_t i) {
    const Vec3& v = vertices[i];
    return std::make_tuple(v.x(), v.y(), v.z());
  };
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::tuple_cat(key(a), std::make_tuple(a)) < std::tuple_cat(key(b), std::make_tuple(b));
  });
  std::vector<std::uint32_t> first(vertices.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && vertices[order[i]] == vertices[order[i - 1]];
    first[order[i]] = same ? first[order[i - 1]] : order[i];
  }
  return first;
}

std::vector<EdgeUse> sorted_edge_uses(std::span<const Triangle> triangles) {
  std::vector<EdgeUse> uses;
  uses.reserve(3 * triangles.size());
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    const Triangle& t = triangles[i];
    if (repeats_vertex(t)) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = t[k];
      const std::uint32_t to = t[(k + 1) % 3];
      uses.push_back({{std::min(from, to), std::max(from, to)}, i, from < to});
    }
  }
  std::sort(uses.begin(), uses.end(), [](const EdgeUse& a, const EdgeUse& b) {
    return std::tie(a.edge, a.triangle) < std::tie(b.edge, b.triangle);
  });
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
