#include "odds/mesh/made/torus_knot.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <vector>

#include "mesh/made/parameters.hpp"
#include "mesh/made/tube.hpp"

namespace odds::mesh::made {
namespace {

constexpr double two_pi = 2.0 * std::numbers::pi;

Vec3 curve(const TorusKnot& shape, double turn) {
  const double about_axis = two_pi * shape.p * turn;
  const double about_ring = two_pi * shape.q * turn;
  const double r = shape.ring + shape.winding * std::cos(about_ring);
  return {r * std::cos(about_axis), r * std::sin(about_axis), shape.winding * std::sin(about_ring)};
}

/// The frame of the torus on which the knot winds: its normal never turns against the curve, so the tube closes.
Section section(const TorusKnot& shape, double turn) {
  const double about_axis = two_pi * shape.p * turn;
  const double about_ring = two_pi * shape.q * turn;
  const Vec3 outward(std::cos(about_axis), std::sin(about_axis), 0.0);
  const Vec3 sideways(-outward.y(), outward.x(), 0.0);
  const Vec3 normal = std::cos(about_ring) * outward + std::sin(about_ring) * Vec3::UnitZ();
  const Vec3 around_tube = -std::sin(about_ring) * outward + std::cos(about_ring) * Vec3::UnitZ();
  const double r = shape.ring + shape.winding * std::cos(about_ring);
  const Vec3 tangent = (shape.p * r * sideways + shape.q * shape.winding * around_tube).normalized();
  return {curve(shape, turn), normal, tangent.cross(normal)};
}

/// The thickest tube that does not meet itself, to the accuracy of the sampling: the least radius of curvature, or half
/// the least distance between points of the curve farther apart along it than a half circle of that distance.
double thickest_tube(const TorusKnot& shape) {
  const std::size_t count = 256 * std::max(shape.p, shape.q) / 2;
  std::vector<Vec3> points(count);
  for (std::size_t i = 0; i < count; ++i) points[i] = curve(shape, static_cast<double>(i) / static_cast<double>(count));
  std::vector<double> arc(count + 1, 0.0);
  for (std::size_t i = 0; i < count; ++i) arc[i + 1] = arc[i] + (points[(i + 1) % count] - points[i]).norm();
  double thickest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 before = points[i] - points[(i + count - 1) % count];
    const Vec3 after = points[(i + 1) % count] - points[i];
    const double turning = (after.normalized() - before.normalized()).norm();
    if (turning > 0.0) thickest = std::min(thickest, 0.5 * (before.norm() + after.norm()) / turning);
    for (std::size_t j = i + 1; j < count; ++j) {
      const double between = std::min(arc[j] - arc[i], arc[count] - (arc[j] - arc[i]));
      const double distance = (points[j] - points[i]).norm();
      if (between > 0.5 * std::numbers::pi * distance) thickest = std::min(thickest, 0.5 * distance);
    }
  }
  return thickest;
}

}  // namespace

std::span<const Field<TorusKnot>> TorusKnot::fields() {
  static constexpr std::array<Field<TorusKnot>, 7> list = {
      {{"ring", &TorusKnot::ring, 1e-6, 1e4, "radius of the torus's centre line, metres"},
       {"winding", &TorusKnot::winding, 1e-7, 1e4, "radius of the torus under the knot, metres, less than ring"},
       {"tube", &TorusKnot::tube, 1e-7, 1e4, "radius of the knot's tube, metres"},
       {"p", &TorusKnot::p, 1, 16, "turns about the axis"},
       {"q", &TorusKnot::q, 1, 16, "turns about the centre line"},
       {"along", &TorusKnot::along, 16, 65536, "sections"},
       {"across", &TorusKnot::across, 3, 512, "points of a section"}}};
  return list;
}

Result<TriangleMesh> make(const TorusKnot& shape) {
  if (auto error = out_of_range(shape)) return *std::move(error);
  if (shape.winding >= shape.ring) {
    return refuse(shape, "winding is not less than ring, so the knot would cross the axis", "give winding < ring");
  }
  if (std::gcd(shape.p, shape.q) != 1) {
    return refuse(shape, "p and q have a common divisor, so this is several loops",
                  "give p and q without one, as 2 and 3");
  }
  if (shape.along < 16 * std::max(shape.p, shape.q)) {
    return refuse(shape, "too few sections for so many turns", "give along >= 16 times the greater of p and q");
  }
  const double limit = thickest_tube(shape);
  if (shape.tube > 0.95 * limit) {
    return refuse(shape, "the tube is so thick that it would meet itself", "give tube <= " + number_text(0.95 * limit));
  }
  return closed_tube([&](double turn) { return section(shape, turn); }, shape.tube, shape.along, shape.across)
      .finish(title(shape));
}

}  // namespace odds::mesh::made
