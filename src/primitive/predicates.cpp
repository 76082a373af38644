// Exact arithmetic behind orient3d, for what its filter leaves open.
#include "odds/primitive/predicates.hpp"

#include "math/double_double.hpp"
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

// Rows b - a, c - a, d - a, exact.
struct Differences {
  math::TwoDoubles b[3];
  math::TwoDoubles c[3];
  math::TwoDoubles d[3];

  Differences(const Vec3& at, const Vec3& p, const Vec3& q, const Vec3& r) noexcept {
    for (int axis = 0; axis < 3; ++axis) {
      b[axis] = math::two_difference(p[axis], at[axis]);
      c[axis] = math::two_difference(q[axis], at[axis]);
      d[axis] = math::two_difference(r[axis], at[axis]);
    }
  }
  [[nodiscard]] double largest(int axis) const noexcept {
    return std::max({std::fabs(b[axis].high), std::fabs(c[axis].high), std::fabs(d[axis].high)});
  }
};

// Second filter: decides unless the points are in one plane to 28 digits. 0 means undecided.
int sign_by_double_doubles(const Differences& rows) noexcept {
  const auto term = [&rows](int u, int v, int w) noexcept {
    const math::TwoDoubles minor =
        math::difference(math::product(rows.b[u], rows.c[v]), math::product(rows.b[v], rows.c[u]));
    return math::product(minor, rows.d[w]);
  };
  const math::TwoDoubles determinant = math::sum(math::sum(term(1, 2, 0), term(2, 0, 1)), term(0, 1, 2));
  // With e = 2^-100: a minor is at most 2 and errs by 4 e, a term by 7 e, the sums by 10 e: 31 e. The factor below, 48
  // u from the first filter's bound times 2^-46, is 48 * 2^-99, which also covers the rounding of the bound.
  const double bound = 0x1p-46 * orient3d_error_bound(rows.largest(0), rows.largest(1), rows.largest(2));
  if (determinant.high > bound) return 1;
  return determinant.high < -bound ? -1 : 0;
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
    const int sign = sign_by_double_doubles(Differences(a, b, c, d));
    if (sign != 0) return sign;
    return determinant_sign(a, b, c, d,
                            [](double p, double q) noexcept { return math::Expansion<2>(math::two_difference(p, q)); });
  }
  return determinant_sign(a, b, c, d, [unit](double p, double q) noexcept {
    return math::WideDouble(p, unit) - math::WideDouble(q, unit);
  });
}

}  // namespace odds::primitive::detail
