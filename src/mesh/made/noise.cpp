#include "mesh/made/noise.hpp"

#include <cmath>

#include "odds/math/random.hpp"

namespace odds::mesh::made {

double smooth_noise(std::uint64_t seed, const Vec3& position) {
  const Vec3 base = position.array().floor();
  const Vec3 t = position - base;
  const Vec3 blend = t.array() * t.array() * t.array() * (t.array() * (t.array() * 6.0 - 15.0) + 10.0);
  const math::Random lattice(seed);
  double sum = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    double weight = 1.0;
    std::uint64_t key = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const bool upper = ((corner >> axis) & 1) != 0;
      weight *= upper ? blend[axis] : 1.0 - blend[axis];
      const auto at = static_cast<std::int64_t>(base[axis]) + (upper ? 1 : 0);
      key = math::scramble(key + 0x9e3779b97f4a7c15ULL + static_cast<std::uint64_t>(at));
    }
    sum += weight * (2.0 * lattice.uniform_at(key) - 1.0);
  }
  return sum;
}

}  // namespace odds::mesh::made
