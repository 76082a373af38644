// Counts crossings of a ray along x.
#include "mesh/surrounds.hpp"

#include "odds/math/orient2d.hpp"

namespace odds::mesh {
namespace {

/// Whether the edge p q, seen along x, crosses the height z of the point at a greater y. The same whichever end comes
/// first; an end at just that height counts as below it, so that of edges that meet there each is judged alike.
bool passes(const Vec3& p, const Vec3& q, const Vec3& point) {
  if ((p.z() > point.z()) == (q.z() > point.z())) return false;
  const Vec3& low = p.z() < q.z() ? p : q;
  const Vec3& high = p.z() < q.z() ? q : p;
  return math::orient2d(low.y(), low.z(), high.y(), high.z(), point.y(), point.z()) > 0;
}

}  // namespace

bool surrounds(std::span<const Vec3> vertices, std::span<const Triangle> triangles,
               std::span<const std::uint32_t> chosen, const Vec3& point) {
  bool odd = false;
  for (const std::uint32_t index : chosen) {
    const Triangle& t = triangles[index];
    const Vec3& a = vertices[t[0]];
    const Vec3& b = vertices[t[1]];
    const Vec3& c = vertices[t[2]];
    if ((passes(a, b, point) != passes(b, c, point)) == passes(c, a, point)) continue;  // the line goes beside it
    const bool faces_along = math::orient2d(a.y(), a.z(), b.y(), b.z(), c.y(), c.z()) > 0;
    const bool before = (b - a).cross(c - a).dot(a - point) > 0.0;
    if (before == faces_along) odd = !odd;
  }
  return odd;
}

}  // namespace odds::mesh
