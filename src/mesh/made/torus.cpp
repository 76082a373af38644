#include "odds/mesh/made/torus.hpp"

#include <array>

#include "mesh/made/parameters.hpp"
#include "mesh/made/tube.hpp"

namespace odds::mesh::made {

std::span<const Field<Torus>> Torus::fields() {
  static constexpr std::array<Field<Torus>, 4> list = {
      {{"ring", &Torus::ring, 1e-6, 1e4, "radius of the centre line, metres"},
       {"tube", &Torus::tube, 1e-7, 1e4, "radius of the tube, metres, less than ring"},
       {"around", &Torus::around, 3, 4096, "sections of the ring"},
       {"across", &Torus::across, 3, 4096, "points of a section"}}};
  return list;
}

Result<TriangleMesh> make(const Torus& shape) {
  if (auto error = out_of_range(shape)) return *std::move(error);
  if (shape.tube >= shape.ring) {
    return refuse(shape, "the tube's radius is not less than the ring's, so the torus would meet itself",
                  "give tube < ring");
  }
  const auto section = [&](double turn) {
    const double angle = 2.0 * std::numbers::pi * turn;
    const Vec3 outward(std::cos(angle), std::sin(angle), 0.0);
    return Section{shape.ring * outward, Vec3::UnitZ(), outward};  // z x outward is the tangent
  };
  return closed_tube(section, shape.tube, shape.around, shape.across).finish(title(shape));
}

}  // namespace odds::mesh::made
