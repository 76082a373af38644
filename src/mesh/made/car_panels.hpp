// The panels of the car-like body as smooth patches. Private to mesh/made.
#pragma once

#include <functional>
#include <vector>

#include "odds/math/types.hpp"

namespace odds::mesh::made {

/// A patch over the unit square; counter-clockwise in (s, t) is seen from outside the car, or the other way if
/// `mirrored`.
struct Panel {
  std::function<Vec3(double s, double t)> position;  ///< metres, for a car 4.5 m long
  double along_s;                                    ///< rough length along s, metres; sets the density of cells
  double along_t;                                    ///< rough length along t
  bool mirrored = false;
};

/// All panels, the same in every call.
std::vector<Panel> car_panels();

}  // namespace odds::mesh::made
