// Four numbers in single precision side by side, where one after the other each would wait for its own roots and
// quotients. In one register that every processor has (the eight of query/wide/lanes.hpp are for kernels that are there
// once for each instruction set). For probabilities and guesses, never for geometry.
#pragma once

#include <cmath>
#include <cstddef>

#include "odds/math/pose.hpp"
#if defined(__SSE2__)
#include <xmmintrin.h>
#elif defined(__aarch64__)
#include <arm_neon.h>
#endif

namespace odds::math {

/// What is true of each of four.
struct FourTruths {
  using Register = int __attribute__((vector_size(16)));
  Register v;

  friend FourTruths operator&(const FourTruths& a, const FourTruths& b) noexcept { return {a.v & b.v}; }
};

/// Four floats.
struct Four {
  using Register = float __attribute__((vector_size(16)));
  static constexpr std::size_t count = 4;
  Register v;

  [[nodiscard]] static Four all(float x) noexcept { return {Register{x, x, x, x}}; }
  /// What `of(i)` gives for each of the four.
  template <class Of>
  [[nodiscard]] static Four from(const Of& of) noexcept {
    return {Register{of(0), of(1), of(2), of(3)}};
  }
  [[nodiscard]] float operator[](std::size_t i) const noexcept { return v[i]; }

  friend Four operator+(const Four& a, const Four& b) noexcept { return {a.v + b.v}; }
  friend Four operator-(const Four& a, const Four& b) noexcept { return {a.v - b.v}; }
  friend Four operator*(const Four& a, const Four& b) noexcept { return {a.v * b.v}; }
  friend Four operator/(const Four& a, const Four& b) noexcept { return {a.v / b.v}; }
  friend FourTruths operator<(const Four& a, const Four& b) noexcept { return {a.v < b.v}; }
  friend Four operator*(float a, const Four& b) noexcept { return all(a) * b; }
  friend Four operator-(float a, const Four& b) noexcept { return all(a) - b; }
  friend Four operator/(float a, const Four& b) noexcept { return all(a) / b; }
  friend FourTruths operator<(float a, const Four& b) noexcept { return all(a) < b; }
  friend FourTruths operator<(const Four& a, float b) noexcept { return a < all(b); }
};

/// Of each lane `a` where it is true, else `b`.
inline Four choose(const FourTruths& which, const Four& a, const Four& b) noexcept { return {which.v ? a.v : b.v}; }
inline Four root(const Four& a) noexcept {
#if defined(__SSE2__)
  return {_mm_sqrt_ps(a.v)};
#elif defined(__aarch64__)
  return {vsqrtq_f32(a.v)};
#else
  return Four::from([&](std::size_t i) { return std::sqrt(a[i]); });
#endif
}
/// The first of two where neither is less.
inline Four lesser(const Four& a, const Four& b) noexcept { return choose(b < a, b, a); }
inline Four greater(const Four& a, const Four& b) noexcept { return choose(a < b, b, a); }
/// Neither infinite nor no number.
inline FourTruths are_finite(const Four& a) noexcept { return a - a < 1.0F; }

/// Four vectors.
struct FourVectors {
  Four x, y, z;

  [[nodiscard]] static FourVectors all(const Vec3f& v) noexcept {
    return {Four::all(v.x()), Four::all(v.y()), Four::all(v.z())};
  }
  /// What `of(i)` gives for each of the four.
  template <class Of>
  [[nodiscard]] static FourVectors from(const Of& of) noexcept {
    const auto axis = [&](Eigen::Index k) { return Four::from([&](std::size_t i) { return of(i)[k]; }); };
    return {axis(0), axis(1), axis(2)};
  }
  [[nodiscard]] Vec3 operator[](std::size_t i) const noexcept { return Vec3f(x[i], y[i], z[i]).cast<double>(); }

  friend FourVectors operator+(const FourVectors& a, const FourVectors& b) noexcept {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  friend FourVectors operator-(const FourVectors& a, const FourVectors& b) noexcept {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  friend FourVectors operator*(const Four& s, const FourVectors& a) noexcept { return {s * a.x, s * a.y, s * a.z}; }
  friend FourVectors operator*(float s, const FourVectors& a) noexcept { return Four::all(s) * a; }
};

inline Four dot(const FourVectors& a, const FourVectors& b) noexcept { return (a.x * b.x + a.y * b.y) + a.z * b.z; }
inline Four length(const FourVectors& a) noexcept { return root(dot(a, a)); }
inline FourVectors choose(const FourTruths& which, const FourVectors& a, const FourVectors& b) noexcept {
  return {choose(which, a.x, b.x), choose(which, a.y, b.y), choose(which, a.z, b.z)};
}

/// A pose that takes four at a time.
class PoseOfFour {
 public:
  explicit PoseOfFour(const Pose& pose) noexcept
      : rotation_(pose.rotation.cast<float>()), translation_(pose.translation.cast<float>()) {}
  [[nodiscard]] FourVectors turn(const FourVectors& a) const noexcept {
    const auto row = [&](Eigen::Index k) {
      return (rotation_(k, 0) * a.x + rotation_(k, 1) * a.y) + rotation_(k, 2) * a.z;
    };
    return {row(0), row(1), row(2)};
  }
  [[nodiscard]] FourVectors place(const FourVectors& a) const noexcept {
    return turn(a) + FourVectors::all(translation_);
  }

 private:
  Mat3f rotation_;
  Vec3f translation_;
};

}  // namespace odds::math
