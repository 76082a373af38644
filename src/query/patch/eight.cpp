#include "query/patch/eight.hpp"

#include <algorithm>
#include <bit>

namespace odds::query::patch {

namespace {

double sum_of(const double (&lanes)[eight]) noexcept {
  return ((lanes[0] + lanes[1]) + (lanes[2] + lanes[3])) + ((lanes[4] + lanes[5]) + (lanes[6] + lanes[7]));
}

}  // namespace

Vec3 FaceSums::normals() const noexcept { return {sum_of(normal[0]), sum_of(normal[1]), sum_of(normal[2])}; }
double FaceSums::lengths() const noexcept { return sum_of(length); }

std::array<std::uint16_t, eight> CornersOfEight::kinds_of_lanes() const noexcept {
  std::array<std::uint16_t, eight> kinds_of{};
  for (std::size_t kind = 0; kind < kinds; ++kind) {
    for (unsigned left = found[kind]; left != 0; left &= left - 1U) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(left));
      kinds_of[lane] = static_cast<std::uint16_t>(kinds_of[lane] | 1U << kind);
    }
  }
  return kinds_of;
}

Witness CornersOfEight::witness(const PlacedPair& placed, const Vec3& direction, std::size_t kind,
                                std::size_t lane) const noexcept {
  const double deep = depth[kind][lane];
  const Vec3 way = deep * direction;
  if (kind >= of_b && kind < crossing) {
    const Vec3& corner = placed.b[kind - of_b];
    return {corner - way, corner, deep, placed.index.a, placed.index.b};
  }
  Vec3 on_a;
  if (kind < of_b) {
    on_a = placed.a[kind];
  } else {
    const std::size_t side = (kind - crossing) / 3;
    const Vec3& from = placed.a[side];
    on_a = from + share[kind][lane] * (placed.a[side == 2 ? 0 : side + 1] - from);
  }
  return {on_a, on_a + way, deep, placed.index.a, placed.index.b};
}

}  // namespace odds::query::patch
