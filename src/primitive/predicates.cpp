// Exact arithmetic behind orient3d, for what its filter leaves open.
#include "odds/primitive/predicates.hpp"

#include "math/wide_integer.hpp"
#include "odds/math/exact.hpp"

namespace odds::primitive::detail {
namespace {

// Sign of the determinant of the rows b - a, c - a, d - a; `difference` makes exact numbers of two doubles.
template <class Difference>
int determinant_sign(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d,
                     const Difference& difference) noexcept {
  const auto bx = difference(b.x(), a.x());
  const auto by = difference(b.y(), a.y());
  const auto bz = difference(b.z(), a.z());
  const auto cx = difference(c.x(), a.x());
  const auto cy = difference(c.y(), a.y());
  const auto cz = difference(c.z(), a.z());
  const auto along_x = (by * cz - bz * cy) * difference(d.x(), a.x());
  const auto along_y = (bz * cx - bx * cz) * difference(d.y(), a.y());
  const auto along_z = (bx * cy - by * cx) * difference(d.z(), a.z());
  return (along_x + along_y + along_z).sign();
}

}  // namespace

int orient3d_exact(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) noexcept {
  if (d == a || d == b || d == c || a == b || a == c || b == c) return 0;  // a shared corner is the usual reason
  bool fits = true;
  int unit = math::last_bit_exponent(a[0]);
  for (int axis = 0; axis < 3; ++axis) {
    if (a[axis] == b[axis] && a[axis] == c[axis] && a[axis] == d[axis]) return 0;
    for (const double coordinate : {a[axis], b[axis], c[axis], d[axis]}) {
      fits = fits && math::fits_expansions(coordinate);
      unit = std::min(unit, math::last_bit_exponent(coordinate));
    }
  }
  if (fits) {
    return determinant_sign(a, b, c, d,
                            [](double p, double q) noexcept { return math::Expansion<2>(math::two_difference(p, q)); });
  }
  return determinant_sign(a, b, c, d, [unit](double p, double q) noexcept {
    return math::WideDouble(p, unit) - math::WideDouble(q, unit);
  });
}

}  // namespace odds::primitive::detail
