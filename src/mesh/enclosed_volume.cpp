#include "odds/mesh/enclosed_volume.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "mesh/adjacency.hpp"
#include "mesh/signed_volume.hpp"
#include "odds/math/exact.hpp"

namespace odds::mesh {
namespace {

/// Calls visit(smaller, greater, forward) for each side of each triangle without a repeated vertex.
template <class Visit>
void for_each_side(const TriangleMesh& mesh, const std::vector<std::uint32_t>& first, const Visit& visit) {
  for (const Triangle& by_index : mesh.triangles()) {
    const Triangle t = {first[by_index[0]], first[by_index[1]], first[by_index[2]]};
    if (repeats_vertex(t)) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = t[k];
      const std::uint32_t to = t[(k + 1) % 3];
      visit(std::min(from, to), std::max(from, to), from < to);
    }
  }
}

/// Whether each edge has two sides in opposite directions, or more than two.
bool is_closed_and_consistent(const TriangleMesh& mesh, const std::vector<std::uint32_t>& first) {
  // The sides of each vertex stand together: 2 * the greater vertex + direction.
  std::vector<std::uint32_t> end(first.size() + 1, 0);
  for_each_side(mesh, first, [&](std::uint32_t smaller, std::uint32_t, bool) { ++end[smaller + 1]; });
  for (std::size_t i = 1; i < end.size(); ++i) end[i] += end[i - 1];
  std::vector<std::uint32_t> sides(end.back());
  for_each_side(mesh, first, [&](std::uint32_t smaller, std::uint32_t greater, bool forward) {
    sides[end[smaller]++] = 2 * greater + (forward ? 1 : 0);
  });
  std::uint32_t begin = 0;
  for (std::size_t vertex = 0; vertex + 1 < end.size(); ++vertex) {
    const auto last = sides.begin() + end[vertex];
    auto side = sides.begin() + begin;
    begin = end[vertex];
    std::sort(side, last);
    while (side != last) {
      const auto next = std::find_if(side, last, [&](std::uint32_t other) { return other / 2 != *side / 2; });
      const auto count = next - side;
      if (count == 1 || (count == 2 && side[0] == side[1])) return false;
      side = next;
    }
  }
  return true;
}

}  // namespace

double signed_volume(const TriangleMesh& mesh) {
  // By the divergence theorem, from the middle of the box so that far-off meshes lose no digits.
  const Vec3 middle = 0.5 * mesh.lower() + 0.5 * mesh.upper();
  math::TwoDoubles six_volumes{0.0, 0.0};
  double uncertain = 0.0;
  for (const Triangle& t : mesh.triangles()) {
    const Vec3& corner = mesh.vertices()[t[0]];
    const Vec3 a = corner - middle;
    const Vec3 u = mesh.vertices()[t[1]] - corner;
    const Vec3 v = mesh.vertices()[t[2]] - corner;
    const math::TwoDoubles sum = math::two_sum(six_volumes.high, a.dot(u.cross(v)));
    six_volumes = {sum.high, six_volumes.low + sum.low};
    uncertain += std::sqrt(a.squaredNorm() * u.squaredNorm() * v.squaredNorm());
  }
  // Differences err by 3 roundings of that product, the cross product by 4, the other by 3; the sum by next to nothing.
  const double sum = six_volumes.high + six_volumes.low;
  return std::abs(sum) > 16.0 * 0x1p-53 * uncertain ? sum / 6.0 : 0.0;
}

std::optional<double> enclosed_volume(const TriangleMesh& mesh) {
  if (!is_closed_and_consistent(mesh, first_at_position(mesh.vertices()))) return std::nullopt;
  return signed_volume(mesh);
}

}  // namespace odds::mesh
