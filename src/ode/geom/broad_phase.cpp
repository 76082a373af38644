#include "ode/geom/broad_phase.hpp"

namespace odds::ode {

void note_places(dSpaceID space, std::uint64_t number) noexcept {
  const int count = dSpaceGetNumGeoms(space);
  for (int i = 0; i < count; ++i) {  // in this order each is found at once
    const dGeomID geom = dSpaceGetGeom(space, i);
    const std::optional<math::Pose> pose = world_pose(geom);
    if (!pose) continue;
    GeomData& data = own_data(geom);
    data.seen_at = *pose;
    data.seen_in = number;
  }
}

void forget_place(dGeomID geom) noexcept { own_data(geom).seen_in = 0; }

std::optional<math::Pose> before_this_broad_phase(const GeomData& a, const GeomData& b) noexcept {
  const std::uint64_t before = current_broad_phase - 1;
  if (current_broad_phase <= 1 || a.seen_in != before || b.seen_in != before) return std::nullopt;
  return a.seen_at.inverse() * b.seen_at;
}

}  // namespace odds::ode
