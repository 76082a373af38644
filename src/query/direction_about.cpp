#include "query/direction_about.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <variant>

#include "query/node_odds.hpp"
#include "query/shape_data.hpp"

namespace odds::query {
namespace {

constexpr std::size_t sizes = 3;  ///< of nodes about a place: a leaf, about 8 and about 64 times as much

/// The smallest first. A tree that has fewer levels repeats its largest.
using NodesAbout = std::array<const tree::NodeStatistics*, sizes>;

/// The last nodes of a way down.
template <std::size_t levels_between>
class WayDown {
 public:
  void add(const tree::NodeStatistics& statistics) noexcept { last_[count_++ % last_.size()] = &statistics; }
  /// Precondition: at least one was added.
  [[nodiscard]] NodesAbout nodes() const noexcept {
    NodesAbout about;
    for (std::size_t i = 0; i < sizes; ++i) {
      about[i] = last_[(count_ - 1 - std::min(i * levels_between, count_ - 1)) % last_.size()];
    }
    return about;
  }

 private:
  std::array<const tree::NodeStatistics*, (sizes - 1) * levels_between + 1> last_;
  std::size_t count_ = 0;
};

float beyond(float length, float limit) noexcept { return std::max(std::abs(length) - limit, 0.0F); }

/// How far a place is from a node's middle, over the node's size, the more if it lies outside; all squared.
float strangeness(float away, float outside, float size) noexcept {
  constexpr float weight = 16.0F;
  return (away + weight * outside) / std::max(size, 1e-37F);
}

float strangeness(const tree::NodeStatistics& statistics, float radius, const Vec3f& place) noexcept {
  const float above = beyond(statistics.slab_normal.dot(place) - statistics.slab_center, statistics.slab_half);
  return strangeness((place - statistics.centroid).squaredNorm(), above * above, radius * radius);
}

/// The lane to which a place belongs. Of sizes of 1e19 m any.
std::uint32_t lane_about(const tree::WideNode& node, const Vec3f& place) noexcept {
  std::array<float, tree::wide_lanes> strange;
  for (std::uint32_t lane = 0; lane < tree::wide_lanes; ++lane) {
    float away = 0.0F;
    float outside = 0.0F;
    float size = 0.0F;
    float along = -node.offset[lane];
    for (int i = 0; i < 3; ++i) {
      const float d = place[i] - node.center[i][lane];
      const float half = node.half[i][lane];
      const float out = beyond(d, half);
      along += node.normal[i][lane] * d;
      away += d * d;
      size += half * half;
      outside += out * out;
    }
    const float above = beyond(along, node.thickness[lane]);
    strange[lane] = strangeness(away, outside + above * above, size);
  }
  std::uint32_t best = 0;
  for (std::uint32_t lane = 1; lane < tree::wide_lanes && !node.child[lane].is_nothing(); ++lane) {
    if (strange[lane] < strange[best]) best = lane;
  }
  return best;
}

NodesAbout nodes_about(const tree::WideTree& tree, const Vec3f& place) noexcept {
  WayDown<1> way;
  tree::Slot slot = tree::WideTree::root;
  while (true) {
    way.add(tree.statistics(slot));
    const tree::ChildRef child = tree.nodes()[slot / tree::wide_lanes].child[slot % tree::wide_lanes];
    if (child.is_leaf()) return way.nodes();
    slot = child.node_index() * tree::wide_lanes + lane_about(tree.nodes()[child.node_index()], place);
  }
}

template <volume::BoundingVolume V>
NodesAbout nodes_about(const tree::Hierarchy<V>& tree, const Vec3f& place) noexcept {
  WayDown<3> way;  // three levels of two are one of eight
  std::uint32_t index = 0;
  while (true) {
    way.add(tree.statistics()[index]);
    const auto& node = tree.nodes()[index];
    if (node.is_leaf()) return way.nodes();
    const auto strange = [&](std::uint32_t child) noexcept {
      return strangeness(tree.statistics()[child], tree.nodes()[child].radius, place);
    };
    index = node.first + (strange(node.first + 1) < strange(node.first) ? 1U : 0U);
  }
}

NodesAbout nodes_about(const Shape& shape, const Vec3f& place) noexcept {
  return std::visit([&](const auto& tree) noexcept { return nodes_about(tree, place); }, shape.data().tree);
}

/// What one pair of nodes says: the direction, and how much it is worth.
struct Facing {
  Vec3 direction;
  double opposition;  ///< 0 .. 1
};

Facing facing_of(const tree::NodeStatistics& a, const tree::NodeStatistics& b, const math::Pose& b_in_a) noexcept {
  const Vec3 normal_a = a.mean_normal.cast<double>();
  const Vec3 normal_b = b_in_a.rotation * b.mean_normal.cast<double>();
  return {facing_where_they_touch(normal_a, static_cast<double>(a.area), normal_b, static_cast<double>(b.area),
                                  a.centroid.cast<double>() - b_in_a * b.centroid.cast<double>()),
          std::clamp(-normal_a.dot(normal_b), 0.0, 1.0)};
}

/// Whether a leaf is met from behind, as a sheet may be: then its normals say nothing of where it pushes.
bool is_met_from_behind(const NodesAbout& a, const NodesAbout& b, const math::Pose& b_in_a,
                        const Vec3& into_a) noexcept {
  return a[0]->mean_normal.cast<double>().dot(into_a) > 0.0 ||
         (b_in_a.rotation * b[0]->mean_normal.cast<double>()).dot(into_a) < 0.0;
}

double longest_side(const tree::TriangleCorners& t) noexcept {
  return std::sqrt(std::max({(t[1] - t[0]).squaredNorm(), (t[2] - t[1]).squaredNorm(), (t[0] - t[2]).squaredNorm()}));
}

/// How much the triangles' word is worth beside that of nodes that face each other, which say up to 2 each.
double worth_of_triangles(const PosedMeshes& meshes, const Contact& contact, double flat) noexcept {
  constexpr double least = 0.15;
  constexpr double at_a_touch = 10.0;
  constexpr double touching = 0.006;  // of a triangle: deeper, and more than these two meet
  const double side =
      std::min(longest_side(meshes.corners_a(contact.triangle_a)), longest_side(meshes.corners_b(contact.triangle_b)));
  const double depth = side > 0.0 ? contact.depth / (touching * side) : 0.0;
  return least + 1.0 - std::clamp(flat, 0.0, 1.0) + at_a_touch / (1.0 + depth * depth);
}

}  // namespace

Vec3 direction_about(const Shape& a, const Shape& b, const PosedMeshes& meshes, const Contact& contact) noexcept {
  const math::Pose& b_in_a = meshes.pose();
  const Vec3 place = contact.position - meshes.origin_a();
  const NodesAbout about_a = nodes_about(a, place.cast<float>());
  const NodesAbout about_b = nodes_about(b, (b_in_a.inverse() * place).cast<float>());
  const bool both_solid = a.is_solid() && b.is_solid();
  if (!both_solid && is_met_from_behind(about_a, about_b, b_in_a, contact.normal)) return contact.normal;
  const auto flat = static_cast<double>(about_a[0]->mean_normal.norm() * about_b[0]->mean_normal.norm());
  Vec3 sum = worth_of_triangles(meshes, contact, flat) * contact.normal;
  for (std::size_t i = 0; i < sizes; ++i) {
    const Facing facing = facing_of(*about_a[i], *about_b[i], b_in_a);
    sum += facing.opposition * facing.direction;
  }
  const double length = sum.norm();
  return length > 1e-3 && std::isfinite(length) ? Vec3(sum / length) : contact.normal;
}

}  // namespace odds::query
