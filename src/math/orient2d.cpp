// Exact arithmetic behind orient2d, for what its filter leaves open.
#include "odds/math/orient2d.hpp"

#include "math/wide_integer.hpp"
#include "odds/math/exact.hpp"

namespace odds::math::detail {

int orient2d_exact(double ax, double ay, double bx, double by, double cx, double cy) noexcept {
  if ((ax == bx && ax == cx) || (ay == by && ay == cy)) return 0;
  const double coordinates[6] = {ax, ay, bx, by, cx, cy};
  if (std::all_of(coordinates, coordinates + 6, fits_expansions)) {
    const auto difference = [](double p, double q) noexcept { return Expansion<2>(two_difference(p, q)); };
    return (difference(bx, ax) * difference(cy, ay) - difference(by, ay) * difference(cx, ax)).sign();
  }
  int unit = last_bit_exponent(ax);
  for (const double coordinate : coordinates) unit = std::min(unit, last_bit_exponent(coordinate));
  const auto difference = [unit](double p, double q) noexcept { return WideDouble(p, unit) - WideDouble(q, unit); };
  return (difference(bx, ax) * difference(cy, ay) - difference(by, ay) * difference(cx, ax)).sign();
}

}  // namespace odds::math::detail
