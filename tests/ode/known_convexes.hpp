// Bodies of planar faces as ODE's convexes, known to the library.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "odds/math/types.hpp"
#include "odds/ode/odds_ode.h"

namespace odds::test {

/// Owns its geom.
class KnownConvex {
 public:
  ~KnownConvex() {
    oddsForgetGeom(geom);
    dGeomDestroy(geom);
  }
  KnownConvex(const KnownConvex&) = delete;
  KnownConvex& operator=(const KnownConvex&) = delete;

  /// Of its corners, turned; metres from its centre.
  [[nodiscard]] double lowest(const Quat& turn) const {
    double z = 0.0;
    for (const Vec3& corner : corners_) z = std::min(z, (turn * corner).z());
    return z;
  }

  dGeomID geom = nullptr;

 protected:
  KnownConvex() = default;
  void add(const Vec3& corner) {
    corners_.push_back(corner);
    points_.insert(points_.end(), corner.data(), corner.data() + 3);
  }
  void face(const std::vector<unsigned>& of) {
    const Vec3 normal = (corners_[of[1]] - corners_[of[0]]).cross(corners_[of[2]] - corners_[of[0]]).normalized();
    planes_.insert(planes_.end(), {normal.x(), normal.y(), normal.z(), normal.dot(corners_[of[0]])});
    polygons_.push_back(static_cast<unsigned>(of.size()));
    polygons_.insert(polygons_.end(), of.begin(), of.end());
    ++faces_;
  }
  /// After the last face.
  void make(dSpaceID space) {
    const auto count = static_cast<unsigned>(corners_.size());
    geom = dCreateConvex(space, planes_.data(), faces_, points_.data(), count, polygons_.data());
    const int is_known = oddsRegisterConvex(geom, points_.data(), count, polygons_.data(), faces_);
    if (is_known != 1) throw std::runtime_error(oddsGetLastError());
  }

 private:
  std::vector<Vec3> corners_;
  std::vector<dReal> points_;
  std::vector<dReal> planes_;
  std::vector<unsigned> polygons_;
  unsigned faces_ = 0;
};

class ConvexBall : public KnownConvex {
 public:
  ConvexBall(dSpaceID space, double radius, unsigned around_axis, unsigned down_axis) {
    const auto at = [around_axis](unsigned i, unsigned k) { return 2 + (i - 1) * around_axis + k % around_axis; };
    add(Vec3(0, 0, radius));
    add(Vec3(0, 0, -radius));
    for (unsigned i = 1; i < down_axis; ++i) {
      for (unsigned k = 0; k < around_axis; ++k) {
        const double a = std::numbers::pi * i / down_axis;
        const double b = 2.0 * std::numbers::pi * k / around_axis;
        add(radius * Vec3(std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a)));
      }
    }
    for (unsigned k = 0; k < around_axis; ++k) {
      face({0, at(1, k), at(1, k + 1)});
      for (unsigned i = 1; i + 1 < down_axis; ++i) face({at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k + 1)});
      face({1, at(down_axis - 1, k + 1), at(down_axis - 1, k)});
    }
    make(space);
  }
};

/// A prism with its axis along z.
class ConvexCoin : public KnownConvex {
 public:
  ConvexCoin(dSpaceID space, double radius, double height, unsigned sides) {
    std::vector<unsigned> top;
    std::vector<unsigned> bottom;
    for (unsigned k = 0; k < sides; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / sides;
      for (const double z : {-0.5 * height, 0.5 * height}) {
        add(Vec3(radius * std::cos(angle), radius * std::sin(angle), z));
      }
      top.push_back(2 * k + 1);
      bottom.insert(bottom.begin(), 2 * k);
    }
    face(top);
    face(bottom);
    for (unsigned k = 0; k < sides; ++k) {
      const unsigned next = (k + 1) % sides;
      face({2 * k, 2 * next, 2 * next + 1, 2 * k + 1});
    }
    make(space);
  }
};

}  // namespace odds::test
