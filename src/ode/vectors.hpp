// ODE's vectors and matrices as ours.
#pragma once

#include <ode/ode.h>

#include "odds/math/types.hpp"

namespace odds::ode {

inline Vec3 vector_of(const dReal* v) { return {v[0], v[1], v[2]}; }

inline Mat3 matrix_of(const dReal* r) {
  Mat3 m;
  m << r[0], r[1], r[2], r[4], r[5], r[6], r[8], r[9], r[10];
  return m;
}

inline void to_ode(const Mat3& m, dMatrix3 r) {
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) r[4 * i + j] = m(i, j);
    r[4 * i + 3] = 0.0;
  }
}

}  // namespace odds::ode
