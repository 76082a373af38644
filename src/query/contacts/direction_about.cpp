#include "query/contacts/direction_about.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <variant>

#include "odds/math/float_sums.hpp"
#include "query/node_odds/facing.hpp"
#include "query/shape_data.hpp"

namespace odds::query {
namespace {

constexpr std::size_t sizes = 3;  ///< of nodes about a place: a leaf, about 8 and about 64 times as much
static_assert(sizes <= Four::count);

/// The smallest first. A tree that has fewer levels repeats its largest.
using NodesAbout = std::array<const tree::NodeStatistics*, sizes>;

/// Asks the caches for what is needed next.
void prefetch(const NodesAbout& nodes) noexcept {
  for (const tree::NodeStatistics* const at : nodes) {
    __builtin_prefetch(at);
    __builtin_prefetch(reinterpret_cast<const char*>(at + 1) - 1);
  }
}

using OfBoth = std::array<NodesAbout, 2>;

OfBoth nodes_about(const tree::WideTree& a, const Vec3f& place_a, const tree::WideTree& b, const Vec3f& place_b,
                   const wide::Searches& searches) noexcept {
  const auto slots = searches.slots_about({a, place_a}, {b, place_b});
  OfBoth about;
  for (std::size_t i = 0; i < sizes; ++i) {
    about[0][i] = &a.statistics(slots[0][i]);
    about[1][i] = &b.statistics(slots[1][i]);
  }
  return about;
}

/// How far a place is from a node's middle, over the node's size, the more if it lies outside; squared.
float strangeness(const tree::NodeStatistics& statistics, float radius, const Vec3f& place) noexcept {
  constexpr float outside_counts = 16.0F;
  const float along = math::dot(statistics.slab_normal, place) - statistics.slab_center;
  const float above = std::max(std::abs(along) - statistics.slab_half, 0.0F);
  return (math::squared_length(place - statistics.centroid) + outside_counts * above * above) /
         std::max(radius * radius, 1e-37F);
}

template <volume::BoundingVolume V>
NodesAbout nodes_about(const tree::Hierarchy<V>& tree, const Vec3f& place) noexcept {
  constexpr std::size_t levels_between = 3;  // three levels of two are one of eight
  std::array<std::uint32_t, (sizes - 1) * levels_between + 1> last{};
  std::size_t count = 0;
  std::uint32_t index = 0;
  while (true) {
    last[count++ % last.size()] = index;
    const auto& node = tree.nodes()[index];
    if (node.is_leaf()) break;
    const auto strange = [&](std::uint32_t child) noexcept {
      return strangeness(tree.statistics()[child], tree.nodes()[child].radius, place);
    };
    index = node.first + (strange(node.first + 1) < strange(node.first) ? 1U : 0U);
  }
  NodesAbout about;
  for (std::size_t i = 0; i < sizes; ++i) {
    about[i] = &tree.statistics()[last[(count - 1 - std::min(i * levels_between, count - 1)) % last.size()]];
  }
  return about;
}

template <volume::BoundingVolume V>
OfBoth nodes_about(const tree::Hierarchy<V>& a, const Vec3f& place_a, const tree::Hierarchy<V>& b, const Vec3f& place_b,
                   const wide::Searches&) noexcept {
  return {nodes_about(a, place_a), nodes_about(b, place_b)};
}

/// Of two bodies with trees of one kind.
OfBoth nodes_about(const Shape& a, const Vec3f& place_a, const Shape& b, const Vec3f& place_b,
                   const wide::Searches& searches) noexcept {
  const OfBoth about = std::visit(
      [&]<class Tree>(const Tree& tree_a) noexcept {
        return nodes_about(tree_a, place_a, *std::get_if<Tree>(&b.data().tree), place_b, searches);
      },
      a.data().tree);
  for (const NodesAbout& nodes : about) prefetch(nodes);
  return about;
}

/// Whether a leaf whose normals have that mean, outwards, is met from behind.
bool is_met_from_behind(const Vec3& outwards, const Vec3& mean_normal) noexcept {
  return mean_normal.dot(outwards) < 0.0;
}

double longest_side(const tree::TriangleCorners& t) noexcept {
  return std::sqrt(std::max({(t[1] - t[0]).squaredNorm(), (t[2] - t[1]).squaredNorm(), (t[0] - t[2]).squaredNorm()}));
}

/// How much the triangles' word is worth beside that of nodes that face each other, which say up to 2 each.
double worth_of_triangles(const PosedMeshes& meshes, const Contact& contact, double flat) noexcept {
  constexpr double least = 0.15;
  constexpr double touching = 0.014;  // of a triangle: deeper, and more than these two meet
  constexpr double most = 1e6;        // all there is to say, squared
  const double side =
      std::min(longest_side(meshes.corners_a(contact.triangle_a)), longest_side(meshes.corners_b(contact.triangle_b)));
  const double at_a_touch = std::min(touching * side / std::max(contact.depth, 1e-300), most);
  return least + 1.0 - flat + at_a_touch * at_a_touch;
}

}  // namespace

Vec3 direction_about(const Shape& a, const Shape& b, const wide::Searches& searches, const PosedMeshes& meshes,
                     const Contact& contact) noexcept {
  const math::Pose& b_in_a = meshes.pose();
  const Vec3 place = contact.position - meshes.origin_a();
  const auto [about_a, about_b] =
      nodes_about(a, place.cast<float>(), b, (b_in_a.inverse() * place).cast<float>(), searches);
  float sign_a = 1.0F;
  float sign_b = 1.0F;
  if (!a.is_solid() || !b.is_solid()) {
    const bool behind_a = is_met_from_behind(-contact.normal, about_a[0]->mean_normal.cast<double>());
    const bool behind_b = is_met_from_behind(contact.normal, b_in_a.rotation * about_b[0]->mean_normal.cast<double>());
    // A sheet has two sides; the normals of a solid, from behind, say nothing of where it pushes.
    if ((behind_a && a.is_solid()) || (behind_b && b.is_solid())) return contact.normal;
    if (behind_a) sign_a = -1.0F;
    if (behind_b) sign_b = -1.0F;
  }
  Vec3 sum = worth_of_triangles(meshes, contact, flatness_of(*about_a[0], *about_b[0])) * contact.normal;
  const auto of = [](const NodesAbout& nodes) {
    return FourPatches::from([&](std::size_t i) { return nodes[std::min(i, sizes - 1)]; });
  };
  const FourFacings facings =
      facings_of(of(about_a).seen_from(sign_a), of(about_b).placed(math::PoseOfFour(b_in_a)).seen_from(sign_b));
  for (std::size_t i = 0; i < sizes; ++i) sum += static_cast<double>(facings.opposition[i]) * facings.direction[i];
  const double length = sum.norm();
  return length > 1e-3 && std::isfinite(length) ? Vec3(sum / length) : contact.normal;
}

}  // namespace odds::query
