// A car-body-like open shell of exactly the triangle count asked for.
#pragma once

#include <span>

#include "odds/mesh/made/field.hpp"
#include "odds/mesh/triangle_mesh.hpp"

namespace odds::mesh::made {

/// Open; about thirty curved panels with gaps as on real bodies (fenders, doors with inner skins, bonnet, roof, boot
/// lid, pillars, bumpers, floor with a tunnel, wheel arches and their liners, firewall), openings for windows and
/// grille. x forwards, y left, z up, the ground at z = 0. Meets itself nowhere by intent, but is not guarded against it
/// where panels of very few triangles cut corners. Has exactly `triangles` triangles.
struct CarBody {
  static constexpr std::string_view name = "car_body";
  static constexpr std::string_view meaning = "a car-body-like open shell of exactly the triangle count asked for";

  double length = 4.5;              ///< metres, 1e-3 .. 1e3; the rest in proportion (1.8 m wide, 1.4 m high at 4.5 m)
  double dent = 0.002;              ///< greatest seeded unevenness, metres at a length of 4.5 m, 0 .. 0.01
  std::uint32_t triangles = 60000;  ///< 500 .. 5000000
  std::uint64_t seed = 1;           ///< of the unevenness

  [[nodiscard]] static std::span<const Field<CarBody>> fields();
};

/// The mesh, or an error that names the parameter and its range. Thread-safe; same parameters, same bits.
Result<TriangleMesh> make(const CarBody& shape);

}  // namespace odds::mesh::made
