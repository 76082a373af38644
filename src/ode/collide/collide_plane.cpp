// Our class against ODE's plane: exact, by the vertices below it.
#include <array>

#include "ode/collide/contact_writer.hpp"
#include "ode/collide/limit.hpp"
#include "ode/collide/manifold.hpp"
#include "ode/geom/colliders.hpp"
#include "ode/statistics.hpp"

namespace odds::ode {
namespace {

constexpr double nothing = -std::numeric_limits<double>::infinity();
// Relative to the mesh's size: vertices this close count as equally deep, and points this close as one. Far above
// rounding, far below what a contact can feel; without it the deepest corner of a flat face would jump about with the
// last bit.
constexpr double same_depth = 1e-6;
constexpr double same_place = 1e-6;

// The vertices below a plane {x: normal x = offset}, all in the mesh's frame, as a source for select_manifold.
class VerticesBelow {
 public:
  VerticesBelow(const PreparedMesh& mesh, const Vec3& normal, double offset, std::uint64_t& units) noexcept
      : mesh_(mesh), normal_(normal), offset_(offset), units_(units) {}

  [[nodiscard]] const Vec3& position(std::uint32_t v) const noexcept { return mesh_.vertices[v].position; }
  [[nodiscard]] double depth(std::uint32_t v) const noexcept { return offset_ - normal_.dot(position(v)); }

  // Of the deepest vertices the outermost: stable where a whole face lies on the plane.
  [[nodiscard]] std::uint32_t first() const noexcept {
    const std::uint32_t deepest = search(
        0.0, [this](const Vec3& x) { return -normal_.dot(x); },
        [this](const Vec3& center, const Vec3& half) { return -normal_.dot(center) + normal_.cwiseAbs().dot(half); });
    if (deepest == no_item) return no_item;
    const Vec3 middle = 0.5 * (mesh_.mesh().lower() + mesh_.mesh().upper());
    const double least_depth = std::max(0.0, depth(deepest) - same_depth * mesh_.mesh().size());
    const std::uint32_t outermost = farthest_below(middle, least_depth);
    return outermost != no_item ? outermost : deepest;
  }
  [[nodiscard]] std::uint32_t farthest(const Vec3& from) const noexcept { return farthest_below(from, 0.0); }
  [[nodiscard]] std::uint32_t extreme(const Vec3& direction) const noexcept {
    const Vec3 downwards = direction - deeper_at_one_place * direction.norm() * normal_;
    return search(
        0.0, [&](const Vec3& x) { return downwards.dot(x); },
        [&](const Vec3& center, const Vec3& half) { return downwards.dot(center) + downwards.cwiseAbs().dot(half); });
  }

 private:
  [[nodiscard]] std::uint32_t farthest_below(const Vec3& from, double least_depth) const noexcept {
    const double for_depth = deeper_at_one_place * mesh_.mesh().size();
    const auto square_across = [&](const Vec3& x) {
      const Vec3 d = x - from;
      return (d - d.dot(normal_) * normal_).squaredNorm();
    };
    return search(
        least_depth, [&](const Vec3& x) { return square_across(x) - for_depth * normal_.dot(x - from); },
        [&](const Vec3& center, const Vec3& half) {
          const double reach = std::sqrt(square_across(center)) + half.norm();
          return reach * reach + for_depth * (normal_.cwiseAbs().dot(half) - normal_.dot(center - from));
        });
  }
  template <class Value, class Bound>
  [[nodiscard]] std::uint32_t search(double least_depth, const Value& value, const Bound& bound) const noexcept {
    const double highest = offset_ - least_depth;
    return mesh_.vertex_tree.greatest(
        [&](std::uint32_t v) { return normal_.dot(position(v)) <= highest ? value(position(v)) : nothing; },
        [&](const Vec3& center, const Vec3& half) {
          return normal_.dot(center) - normal_.cwiseAbs().dot(half) <= highest ? bound(center, half) : nothing;
        },
        units_);
  }

  const PreparedMesh& mesh_;
  Vec3 normal_;
  double offset_;
  std::uint64_t& units_;
};

}  // namespace

int collide_plane(dGeomID o1, dGeomID o2, int flags, dContactGeom* contacts, int skip) noexcept {
  count(statistics().primitive_queries);
  const GeomData& data = own_data(o1);
  const std::optional<math::Pose> pose = world_pose(o1);
  dVector4 plane;
  dGeomPlaneGetParams(o2, plane);
  const Vec3 normal(plane[0], plane[1], plane[2]);
  if (!pose || !normal.allFinite()) {
    count(statistics().bad_poses);
    return 0;
  }
  Limit limit(data.settings);
  const Vec3 local_normal = pose->rotation.transpose() * normal;
  const VerticesBelow below(*data.mesh, local_normal, plane[3] - normal.dot(pose->translation), limit.units);
  std::array<std::uint32_t, most_contacts> chosen;
  const int room = room_for(flags, data.settings.max_contacts);
  const std::size_t found = select_manifold(below, local_normal, same_place * data.mesh->mesh().size(),
                                            std::span(chosen).first(static_cast<std::size_t>(room)));
  ContactWriter writer(o1, o2, room, contacts, skip);
  for (std::size_t i = 0; i < found; ++i) {
    const PreparedMesh::Vertex& vertex = data.mesh->vertices[chosen[i]];
    writer.add(*pose * vertex.position, normal, below.depth(chosen[i]), vertex.triangle, query::no_feature);
  }
  return limit.finish(limit.units > 0, writer.count());
}

}  // namespace odds::ode
