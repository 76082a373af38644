// Our class against ODE's box.
#include <array>

#include "ode/collide/convex_contacts.hpp"
#include "ode/geom/colliders.hpp"

namespace odds::ode {
namespace {

// More edges of the surface than these add nothing but time in a patch of many triangles.
constexpr std::size_t most_surface_edges = 8;

class BoxBody final : public ConvexBody {
 public:
  explicit BoxBody(const Vec3& half) noexcept : half_(half) {
    for (int axis = 0; axis < 3; ++axis) {
      faces_[static_cast<std::size_t>(2 * axis)] = {Vec3::Unit(axis), half[axis]};
      faces_[static_cast<std::size_t>(2 * axis + 1)] = {-Vec3::Unit(axis), half[axis]};
    }
    sides_ = faces_;
    box_half_extents_ = half;
  }
  BoxBody(const BoxBody&) = delete;
  BoxBody& operator=(const BoxBody&) = delete;

  [[nodiscard]] Vec3 farthest(const Vec3& direction) const noexcept override {
    return (direction.array() < 0.0).select(-half_, half_);
  }

  // Its faces, and the crossings of its edges with the surface's edges.
  void add_exits(std::span<const Piece* const> patch, bool, ExitList& exits) const noexcept override {
    for (int axis = 0; axis < 3; ++axis) {
      exits.add(Vec3::Unit(axis));
      exits.add(-Vec3::Unit(axis));
    }
    std::size_t edges = 0;
    for (const Piece* piece : patch) {
      for (std::size_t i = 0; i < piece->count && edges < most_surface_edges; ++i) {
        if (piece->side[i] != Piece::own_edge) continue;
        ++edges;
        const Vec3 edge = piece->corners[(i + 1) % piece->count] - piece->corners[i];
        for (int axis = 0; axis < 3; ++axis) {
          const Vec3 across = edge.cross(Vec3::Unit(axis));
          if (across.norm() > 1e-6 * edge.norm()) exits.add_facing(across);
        }
      }
    }
  }

  void add_features(const Vec3&, double, Features& features) const noexcept override {
    for (int c = 0; c < 8; ++c) {
      features.add_corner(half_.cwiseProduct(Vec3(c & 1 ? 1 : -1, c & 2 ? 1 : -1, c & 4 ? 1 : -1)));
    }
    for (int axis = 0; axis < 3; ++axis) {
      for (int e = 0; e < 4; ++e) {
        Vec3 end = half_;
        end[(axis + 1) % 3] *= (e & 1) != 0 ? 1.0 : -1.0;
        end[(axis + 2) % 3] *= (e & 2) != 0 ? 1.0 : -1.0;
        Vec3 begin = end;
        begin[axis] = -half_[axis];
        features.add_edge(begin, end);
      }
    }
  }

 private:
  Vec3 half_;
  std::array<HalfSpace, 6> faces_;
};

}  // namespace

int collide_box(dGeomID o1, dGeomID o2, int flags, dContactGeom* contacts, int skip) noexcept {
  dVector3 lengths;
  dGeomBoxGetLengths(o2, lengths);
  const BoxBody body(0.5 * Vec3(lengths[0], lengths[1], lengths[2]));
  return collide_convex_body(o1, o2, body, flags, contacts, skip);
}

}  // namespace odds::ode
