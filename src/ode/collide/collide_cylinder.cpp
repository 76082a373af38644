// Our class against ODE's cylinder: exact extents; the surface is cut by a sixteen-sided prism around it.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "ode/collide/convex_contacts.hpp"
#include "ode/geom/colliders.hpp"

namespace odds::ode {
namespace {

constexpr std::size_t prism_sides = 16;
// More directions than these add nothing but time in a patch of many triangles.
constexpr std::size_t most_surface_edges = 8;
constexpr std::size_t most_radii = 12;
// Sine of the tilt below which a cylinder stands: the lowest point of its rim would wander with the last bit.
constexpr double standing = 1e-3;
// Cosine of the tilt from which on it lies.
constexpr double lying = 0.1;

// About the z axis, centred at the origin.
class CylinderBody final : public ConvexBody {
 public:
  CylinderBody(double radius, double length) noexcept : radius_(radius), half_length_(0.5 * length) {
    for (std::size_t i = 0; i < prism_sides; ++i) {
      const double angle = 2.0 * std::numbers::pi * static_cast<double>(i) / prism_sides;
      planes_[i] = {Vec3(std::cos(angle), std::sin(angle), 0.0), radius};
    }
    planes_[prism_sides] = {Vec3::UnitZ(), half_length_};
    planes_[prism_sides + 1] = {-Vec3::UnitZ(), half_length_};
    sides_ = planes_;
    box_half_extents_ = Vec3(radius, radius, half_length_);
  }
  CylinderBody(const CylinderBody&) = delete;
  CylinderBody& operator=(const CylinderBody&) = delete;

  [[nodiscard]] Vec3 farthest(const Vec3& direction) const noexcept override {
    const double across = direction.head<2>().norm();
    Vec3 point = Vec3::Zero();
    if (across > 0.0) point.head<2>() = radius_ / across * direction.head<2>();
    point.z() = direction.z() < 0.0 ? -half_length_ : half_length_;
    return point;
  }

  [[nodiscard]] double way_through(const Vec3& point, const Vec3& direction) const noexcept override {
    double way = HUGE_VAL;
    if (std::abs(direction.z()) > 1e-12) {
      way = std::max(0.0, (std::copysign(half_length_, direction.z()) - point.z()) / direction.z());
    }
    // |p + t d|^2 = r^2 across the axis; the greater root.
    const double a = direction.head<2>().squaredNorm();
    if (!(a > 1e-24)) return way;
    const double b = point.head<2>().dot(direction.head<2>());
    const double c = point.head<2>().squaredNorm() - radius_ * radius_;
    const double under_root = b * b - a * c;
    if (!(under_root > 0.0)) return 0.0;
    return std::min(way, std::max(0.0, (-b + std::sqrt(under_root)) / a));
  }

  [[nodiscard]] Vec3 pull_in(const Vec3& point) const noexcept override {
    const double across = point.head<2>().norm();
    if (!(across > radius_)) return point;
    Vec3 inside = point;
    inside.head<2>() *= radius_ / across;
    return inside;
  }

  [[nodiscard]] double crowding() const noexcept override { return 0.25 * std::min(radius_, half_length_); }

  // The prism's caps are exact; seen along the axis the piece must come within the radius.
  [[nodiscard]] bool meets(const Piece& piece) const noexcept override {
    bool left = false;
    bool right = false;
    for (std::size_t i = 0; i < piece.count; ++i) {
      const Eigen::Vector2d a = piece.corners[i].head<2>();
      const Eigen::Vector2d edge = piece.corners[(i + 1) % piece.count].head<2>() - a;
      const double square = edge.squaredNorm();
      const double along = square > 0.0 ? std::clamp(-a.dot(edge) / square, 0.0, 1.0) : 0.0;
      if ((a + along * edge).squaredNorm() < radius_ * radius_) return true;
      const double turn = edge.x() * a.y() - edge.y() * a.x();
      left = left || turn < 0.0;
      right = right || turn > 0.0;
    }
    return left != right;  // the axis is on the same side of all edges: it goes through the piece
  }

  // Along the axis; away from corners of the surface, straight through the wall; across the wall and an edge.
  void add_exits(std::span<const Piece* const> patch, bool refined, ExitList& exits) const noexcept override {
    exits.add(Vec3::UnitZ());
    exits.add(-Vec3::UnitZ());
    if (refined) add_refined_exit(*this, patch, exits);
    std::size_t edges = 0;
    std::size_t radii = 0;
    for (const Piece* piece : patch) {
      for (std::size_t i = 0; i < piece->count; ++i) {
        const Vec3& corner = piece->corners[i];
        if (piece->side[i] == Piece::own_edge && edges < most_surface_edges) {
          ++edges;
          const Vec3 edge = piece->corners[(i + 1) % piece->count] - corner;
          const Vec3 across = edge.cross(Vec3::UnitZ());
          if (across.norm() > 1e-6 * edge.norm()) exits.add_facing(across);
        }
        if (piece->side[i] == Piece::own_edge && radii < most_radii && corner.head<2>().norm() > 1e-6 * radius_) {
          ++radii;
          exits.add_facing(Vec3(corner.x(), corner.y(), 0.0));
        }
      }
    }
  }

  // The lowest line of the wall and the lowest point of each rim; around the rims of one that stands.
  void add_features(const Vec3& up, double, Features& features) const noexcept override {
    const bool stands = up.head<2>().norm() < standing;
    const Eigen::Vector2d low = stands ? Eigen::Vector2d(1.0, 0.0) : Eigen::Vector2d(-up.head<2>().normalized());
    const int points = stands ? 8 : 4;
    for (int i = 0; i < points; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / points;
      const double c = std::cos(angle);
      const double s = std::sin(angle);
      const Vec3 rim(radius_ * (c * low.x() - s * low.y()), radius_ * (s * low.x() + c * low.y()), half_length_);
      const Vec3 other(rim.x(), rim.y(), -half_length_);
      features.add_corner(rim);
      features.add_corner(other);
      features.add_edge(rim, other);
    }
  }

  // The lower rim, unless it is seen edge-on: then the lowest line of the wall is at its ends.
  std::size_t over_curved_edge(const Vec3& begin, const Vec3& along, const Vec3& up,
                               std::array<OverEdge, 2>& over) const noexcept override {
    if (!(std::abs(up.z()) > lying)) return 0;
    const double cap = -std::copysign(half_length_, up.z());
    const Eigen::Vector2d lean = up.head<2>() / up.z();
    const Eigen::Vector2d from = begin.head<2>() - (begin.z() - cap) * lean;
    const Eigen::Vector2d way = along.head<2>() - along.z() * lean;
    const double a = way.squaredNorm();
    const double b = from.dot(way);
    const double under_root = b * b - a * (from.squaredNorm() - radius_ * radius_);
    if (!(a > 0.0) || !(under_root > 0.0)) return 0;
    for (std::size_t i = 0; i < 2; ++i) {
      const double at = (-b + (i == 0 ? -1.0 : 1.0) * std::sqrt(under_root)) / a;
      over[i] = {at, (begin.z() + at * along.z() - cap) / up.z()};
    }
    return 2;
  }

 private:
  double radius_;
  double half_length_;
  std::array<HalfSpace, prism_sides + 2> planes_;
};

}  // namespace

int collide_cylinder(dGeomID o1, dGeomID o2, int flags, dContactGeom* contacts, int skip) noexcept {
  dReal radius = 0;
  dReal length = 0;
  dGeomCylinderGetParams(o2, &radius, &length);
  const CylinderBody body(radius, length);
  return collide_convex_body(o1, o2, body, flags, contacts, skip);
}

}  // namespace odds::ode
