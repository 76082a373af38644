// Eight doubles at a time, beside lanes.hpp: one AVX-512 register, two of AVX, four of SSE2 or NEON, or plain loops.
// All give the same bits: no fused multiply-add.
#pragma once

#include <cmath>
#include <cstdint>

#include "query/wide/lanes.hpp"

namespace odds::query::lanes {

#if defined(__AVX2__)
struct FourDoubles {
  using Register = __m256d;
  using Truth = __m256d;  ///< all bits of a lane, or none
  static constexpr int lanes = 4;
  ODDS_LANES_INLINE static Register load(const double* p) noexcept { return _mm256_load_pd(p); }
  ODDS_LANES_INLINE static Register from(const double* const* p, int offset) noexcept {
    return _mm256_set_pd(p[3][offset], p[2][offset], p[1][offset], p[0][offset]);
  }
  ODDS_LANES_INLINE static void store(double* p, Register a) noexcept { _mm256_store_pd(p, a); }
  ODDS_LANES_INLINE static Register all(double x) noexcept { return _mm256_set1_pd(x); }
  ODDS_LANES_INLINE static Register add(Register a, Register b) noexcept { return _mm256_add_pd(a, b); }
  ODDS_LANES_INLINE static Register subtract(Register a, Register b) noexcept { return _mm256_sub_pd(a, b); }
  ODDS_LANES_INLINE static Register multiply(Register a, Register b) noexcept { return _mm256_mul_pd(a, b); }
  ODDS_LANES_INLINE static Register divide(Register a, Register b) noexcept { return _mm256_div_pd(a, b); }
  ODDS_LANES_INLINE static Register root(Register a) noexcept { return _mm256_sqrt_pd(a); }
  ODDS_LANES_INLINE static Register abs(Register a) noexcept { return _mm256_andnot_pd(_mm256_set1_pd(-0.0), a); }
  ODDS_LANES_INLINE static Register min(Register a, Register b) noexcept { return _mm256_min_pd(a, b); }
  ODDS_LANES_INLINE static Register max(Register a, Register b) noexcept { return _mm256_max_pd(a, b); }
  ODDS_LANES_INLINE static Truth less(Register a, Register b) noexcept { return _mm256_cmp_pd(a, b, _CMP_LT_OQ); }
  ODDS_LANES_INLINE static Truth less_equal(Register a, Register b) noexcept { return _mm256_cmp_pd(a, b, _CMP_LE_OQ); }
  ODDS_LANES_INLINE static Truth both(Truth a, Truth b) noexcept { return _mm256_and_pd(a, b); }
  ODDS_LANES_INLINE static Truth either(Truth a, Truth b) noexcept { return _mm256_or_pd(a, b); }
  ODDS_LANES_INLINE static unsigned bits(Truth a) noexcept { return static_cast<unsigned>(_mm256_movemask_pd(a)); }
  ODDS_LANES_INLINE static Register choose(Truth t, Register a, Register b) noexcept {
    return _mm256_blendv_pd(b, a, t);
  }
};
#endif

#if defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512VL__)
struct AllDoubles {
  using Register = __m512d;
  using Truth = __mmask8;
  static constexpr int lanes = 8;
  ODDS_LANES_INLINE static Register load(const double* p) noexcept { return _mm512_load_pd(p); }
  ODDS_LANES_INLINE static Register from(const double* const* p, int offset) noexcept {
    // Not a gather: processors whose microcode guards it take long.
    return _mm512_insertf64x4(_mm512_castpd256_pd512(FourDoubles::from(p, offset)), FourDoubles::from(p + 4, offset),
                              1);
  }
  ODDS_LANES_INLINE static void store(double* p, Register a) noexcept { _mm512_store_pd(p, a); }
  ODDS_LANES_INLINE static Register all(double x) noexcept { return _mm512_set1_pd(x); }
  ODDS_LANES_INLINE static Register add(Register a, Register b) noexcept { return _mm512_add_pd(a, b); }
  ODDS_LANES_INLINE static Register subtract(Register a, Register b) noexcept { return _mm512_sub_pd(a, b); }
  ODDS_LANES_INLINE static Register multiply(Register a, Register b) noexcept { return _mm512_mul_pd(a, b); }
  ODDS_LANES_INLINE static Register divide(Register a, Register b) noexcept { return _mm512_div_pd(a, b); }
  ODDS_LANES_INLINE static Register root(Register a) noexcept { return _mm512_sqrt_pd(a); }
  ODDS_LANES_INLINE static Register abs(Register a) noexcept { return _mm512_andnot_pd(_mm512_set1_pd(-0.0), a); }
  ODDS_LANES_INLINE static Register min(Register a, Register b) noexcept { return _mm512_min_pd(a, b); }
  ODDS_LANES_INLINE static Register max(Register a, Register b) noexcept { return _mm512_max_pd(a, b); }
  ODDS_LANES_INLINE static Truth less(Register a, Register b) noexcept { return _mm512_cmp_pd_mask(a, b, _CMP_LT_OQ); }
  ODDS_LANES_INLINE static Truth less_equal(Register a, Register b) noexcept {
    return _mm512_cmp_pd_mask(a, b, _CMP_LE_OQ);
  }
  ODDS_LANES_INLINE static Truth both(Truth a, Truth b) noexcept { return static_cast<Truth>(a & b); }
  ODDS_LANES_INLINE static Truth either(Truth a, Truth b) noexcept { return static_cast<Truth>(a | b); }
  ODDS_LANES_INLINE static unsigned bits(Truth a) noexcept { return a; }
  ODDS_LANES_INLINE static Register choose(Truth t, Register a, Register b) noexcept {
    return _mm512_mask_blend_pd(t, b, a);
  }
};
#endif

#if defined(__SSE2__)
struct TwoDoubles {
  using Register = __m128d;
  using Truth = __m128d;
  static constexpr int lanes = 2;
  ODDS_LANES_INLINE static Register load(const double* p) noexcept { return _mm_load_pd(p); }
  ODDS_LANES_INLINE static Register from(const double* const* p, int offset) noexcept {
    return _mm_set_pd(p[1][offset], p[0][offset]);
  }
  ODDS_LANES_INLINE static void store(double* p, Register a) noexcept { _mm_store_pd(p, a); }
  ODDS_LANES_INLINE static Register all(double x) noexcept { return _mm_set1_pd(x); }
  ODDS_LANES_INLINE static Register add(Register a, Register b) noexcept { return _mm_add_pd(a, b); }
  ODDS_LANES_INLINE static Register subtract(Register a, Register b) noexcept { return _mm_sub_pd(a, b); }
  ODDS_LANES_INLINE static Register multiply(Register a, Register b) noexcept { return _mm_mul_pd(a, b); }
  ODDS_LANES_INLINE static Register divide(Register a, Register b) noexcept { return _mm_div_pd(a, b); }
  ODDS_LANES_INLINE static Register root(Register a) noexcept { return _mm_sqrt_pd(a); }
  ODDS_LANES_INLINE static Register abs(Register a) noexcept { return _mm_andnot_pd(_mm_set1_pd(-0.0), a); }
  ODDS_LANES_INLINE static Register min(Register a, Register b) noexcept { return _mm_min_pd(a, b); }
  ODDS_LANES_INLINE static Register max(Register a, Register b) noexcept { return _mm_max_pd(a, b); }
  ODDS_LANES_INLINE static Truth less(Register a, Register b) noexcept { return _mm_cmplt_pd(a, b); }
  ODDS_LANES_INLINE static Truth less_equal(Register a, Register b) noexcept { return _mm_cmple_pd(a, b); }
  ODDS_LANES_INLINE static Truth both(Truth a, Truth b) noexcept { return _mm_and_pd(a, b); }
  ODDS_LANES_INLINE static Truth either(Truth a, Truth b) noexcept { return _mm_or_pd(a, b); }
  ODDS_LANES_INLINE static unsigned bits(Truth a) noexcept { return static_cast<unsigned>(_mm_movemask_pd(a)); }
  ODDS_LANES_INLINE static Register choose(Truth t, Register a, Register b) noexcept {
    return _mm_or_pd(_mm_and_pd(t, a), _mm_andnot_pd(t, b));
  }
};
#endif

#if defined(__aarch64__)
struct NeonDoubles {
  using Register = float64x2_t;
  using Truth = uint64x2_t;
  static constexpr int lanes = 2;
  ODDS_LANES_INLINE static Register load(const double* p) noexcept { return vld1q_f64(p); }
  ODDS_LANES_INLINE static Register from(const double* const* p, int offset) noexcept {
    return Register{p[0][offset], p[1][offset]};
  }
  ODDS_LANES_INLINE static void store(double* p, Register a) noexcept { vst1q_f64(p, a); }
  ODDS_LANES_INLINE static Register all(double x) noexcept { return vdupq_n_f64(x); }
  ODDS_LANES_INLINE static Register add(Register a, Register b) noexcept { return vaddq_f64(a, b); }
  ODDS_LANES_INLINE static Register subtract(Register a, Register b) noexcept { return vsubq_f64(a, b); }
  ODDS_LANES_INLINE static Register multiply(Register a, Register b) noexcept { return vmulq_f64(a, b); }
  ODDS_LANES_INLINE static Register divide(Register a, Register b) noexcept { return vdivq_f64(a, b); }
  ODDS_LANES_INLINE static Register root(Register a) noexcept { return vsqrtq_f64(a); }
  ODDS_LANES_INLINE static Register abs(Register a) noexcept { return vabsq_f64(a); }
  ODDS_LANES_INLINE static Register min(Register a, Register b) noexcept { return choose(less(a, b), a, b); }
  ODDS_LANES_INLINE static Register max(Register a, Register b) noexcept { return choose(less(b, a), a, b); }
  ODDS_LANES_INLINE static Truth less(Register a, Register b) noexcept { return vcltq_f64(a, b); }
  ODDS_LANES_INLINE static Truth less_equal(Register a, Register b) noexcept { return vcleq_f64(a, b); }
  ODDS_LANES_INLINE static Truth both(Truth a, Truth b) noexcept { return vandq_u64(a, b); }
  ODDS_LANES_INLINE static Truth either(Truth a, Truth b) noexcept { return vorrq_u64(a, b); }
  ODDS_LANES_INLINE static unsigned bits(Truth a) noexcept {
    return static_cast<unsigned>(vaddvq_u64(vandq_u64(a, Truth{1, 2})));
  }
  ODDS_LANES_INLINE static Register choose(Truth t, Register a, Register b) noexcept { return vbslq_f64(t, a, b); }
};
#endif

struct OneDouble {
  using Register = double;
  using Truth = bool;
  static constexpr int lanes = 1;
  ODDS_LANES_INLINE static Register load(const double* p) noexcept { return *p; }
  ODDS_LANES_INLINE static Register from(const double* const* p, int offset) noexcept { return p[0][offset]; }
  ODDS_LANES_INLINE static void store(double* p, Register a) noexcept { *p = a; }
  ODDS_LANES_INLINE static Register all(double x) noexcept { return x; }
  ODDS_LANES_INLINE static Register add(Register a, Register b) noexcept { return a + b; }
  ODDS_LANES_INLINE static Register subtract(Register a, Register b) noexcept { return a - b; }
  ODDS_LANES_INLINE static Register multiply(Register a, Register b) noexcept { return a * b; }
  ODDS_LANES_INLINE static Register divide(Register a, Register b) noexcept { return a / b; }
  ODDS_LANES_INLINE static Register root(Register a) noexcept { return __builtin_sqrt(a); }
  ODDS_LANES_INLINE static Register abs(Register a) noexcept { return __builtin_fabs(a); }
  ODDS_LANES_INLINE static Register min(Register a, Register b) noexcept { return a < b ? a : b; }
  ODDS_LANES_INLINE static Register max(Register a, Register b) noexcept { return a > b ? a : b; }
  ODDS_LANES_INLINE static Truth less(Register a, Register b) noexcept { return a < b; }
  ODDS_LANES_INLINE static Truth less_equal(Register a, Register b) noexcept { return a <= b; }
  ODDS_LANES_INLINE static Truth both(Truth a, Truth b) noexcept { return a && b; }
  ODDS_LANES_INLINE static Truth either(Truth a, Truth b) noexcept { return a || b; }
  ODDS_LANES_INLINE static unsigned bits(Truth a) noexcept { return a ? 1U : 0U; }
  ODDS_LANES_INLINE static Register choose(Truth t, Register a, Register b) noexcept { return t ? a : b; }
};

/// Eight of them in as many registers as it takes. `R`: one of the above.
template <class R>
struct Doubles {
  static constexpr int registers = 8 / R::lanes;
  typename R::Register v[registers];

  ODDS_LANES_INLINE static Doubles all(double x) noexcept {
    Doubles result;
    for (auto& part : result.v) part = R::all(x);
    return result;
  }
  /// From an address that is a multiple of 64.
  ODDS_LANES_INLINE static Doubles load(const double* p) noexcept {
    Doubles result;
    for (int i = 0; i < registers; ++i) result.v[i] = R::load(p + i * R::lanes);
    return result;
  }
  /// p[0][offset], p[1][offset], ... p[7][offset].
  ODDS_LANES_INLINE static Doubles from(const double* const (&p)[8], int offset) noexcept {
    Doubles result;
    for (int i = 0; i < registers; ++i) result.v[i] = R::from(p + i * R::lanes, offset);
    return result;
  }
  ODDS_LANES_INLINE void store(double* p) const noexcept {
    for (int i = 0; i < registers; ++i) R::store(p + i * R::lanes, v[i]);
  }
};

/// What is true of each of eight.
template <class R>
struct Truths {
  typename R::Truth v[Doubles<R>::registers];

  [[nodiscard]] ODDS_LANES_INLINE unsigned bits() const noexcept {
    unsigned result = 0;
    for (int i = 0; i < Doubles<R>::registers; ++i) result |= R::bits(v[i]) << static_cast<unsigned>(i * R::lanes);
    return result;
  }
};

template <class R>
ODDS_LANES_INLINE Doubles<R> operator+(const Doubles<R>& a, const Doubles<R>& b) noexcept {
  Doubles<R> result;
  for (int i = 0; i < Doubles<R>::registers; ++i) result.v[i] = R::add(a.v[i], b.v[i]);
  return result;
}
template <class R>
ODDS_LANES_INLINE Doubles<R> operator-(const Doubles<R>& a, const Doubles<R>& b) noexcept {
  Doubles<R> result;
  for (int i = 0; i < Doubles<R>::registers; ++i) result.v[i] = R::subtract(a.v[i], b.v[i]);
  return result;
}
template <class R>
ODDS_LANES_INLINE Doubles<R> operator*(const Doubles<R>& a, const Doubles<R>& b) noexcept {
  Doubles<R> result;
  for (int i = 0; i < Doubles<R>::registers; ++i) result.v[i] = R::multiply(a.v[i], b.v[i]);
  return result;
}
template <class R>
ODDS_LANES_INLINE Doubles<R> operator/(const Doubles<R>& a, const Doubles<R>& b) noexcept {
  Doubles<R> result;
  for (int i = 0; i < Doubles<R>::registers; ++i) result.v[i] = R::divide(a.v[i], b.v[i]);
  return result;
}
template <class R>
ODDS_LANES_INLINE Doubles<R> root(const Doubles<R>& a) noexcept {
  Doubles<R> result;
  for (int i = 0; i < Doubles<R>::registers; ++i) result.v[i] = R::root(a.v[i]);
  return result;
}
template <class R>
ODDS_LANES_INLINE Doubles<R> abs(const Doubles<R>& a) noexcept {
  Doubles<R> result;
  for (int i = 0; i < Doubles<R>::registers; ++i) result.v[i] = R::abs(a.v[i]);
  return result;
}
template <class R>
ODDS_LANES_INLINE Doubles<R> min(const Doubles<R>& a, const Doubles<R>& b) noexcept {
  Doubles<R> result;
  for (int i = 0; i < Doubles<R>::registers; ++i) result.v[i] = R::min(a.v[i], b.v[i]);
  return result;
}
template <class R>
ODDS_LANES_INLINE Doubles<R> max(const Doubles<R>& a, const Doubles<R>& b) noexcept {
  Doubles<R> result;
  for (int i = 0; i < Doubles<R>::registers; ++i) result.v[i] = R::max(a.v[i], b.v[i]);
  return result;
}
template <class R>
ODDS_LANES_INLINE Truths<R> operator<(const Doubles<R>& a, const Doubles<R>& b) noexcept {
  Truths<R> result;
  for (int i = 0; i < Doubles<R>::registers; ++i) result.v[i] = R::less(a.v[i], b.v[i]);
  return result;
}
template <class R>
ODDS_LANES_INLINE Truths<R> operator<=(const Doubles<R>& a, const Doubles<R>& b) noexcept {
  Truths<R> result;
  for (int i = 0; i < Doubles<R>::registers; ++i) result.v[i] = R::less_equal(a.v[i], b.v[i]);
  return result;
}
template <class R>
ODDS_LANES_INLINE Truths<R> operator&(const Truths<R>& a, const Truths<R>& b) noexcept {
  Truths<R> result;
  for (int i = 0; i < Doubles<R>::registers; ++i) result.v[i] = R::both(a.v[i], b.v[i]);
  return result;
}
template <class R>
ODDS_LANES_INLINE Truths<R> operator|(const Truths<R>& a, const Truths<R>& b) noexcept {
  Truths<R> result;
  for (int i = 0; i < Doubles<R>::registers; ++i) result.v[i] = R::either(a.v[i], b.v[i]);
  return result;
}
/// `a` where it is true, else `b`.
template <class R>
ODDS_LANES_INLINE Doubles<R> choose(const Truths<R>& t, const Doubles<R>& a, const Doubles<R>& b) noexcept {
  Doubles<R> result;
  for (int i = 0; i < Doubles<R>::registers; ++i) result.v[i] = R::choose(t.v[i], a.v[i], b.v[i]);
  return result;
}

/// The register of doubles that goes with the floats of an instruction set.
template <class L>
struct DoublesOf;
template <>
struct DoublesOf<Portable> {
  using Register = OneDouble;
};
#if defined(__SSE2__)
template <>
struct DoublesOf<Sse2> {
  using Register = TwoDoubles;
};
#endif
#if defined(__aarch64__)
template <>
struct DoublesOf<Neon> {
  using Register = NeonDoubles;
};
#endif
#if defined(__AVX2__)
template <>
struct DoublesOf<Avx2> {
  using Register = FourDoubles;
};
#endif
#if defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512VL__)
template <>
struct DoublesOf<Avx512> {
  using Register = AllDoubles;
};
#endif

/// Eight points or vectors.
template <class R>
struct Points {
  Doubles<R> x, y, z;

  /// p[0][3 * corner ...], ..., p[7][3 * corner ...]: x, y, z.
  ODDS_LANES_INLINE static Points from(const double* const (&p)[8], int corner = 0) noexcept {
    return {Doubles<R>::from(p, 3 * corner), Doubles<R>::from(p, 3 * corner + 1), Doubles<R>::from(p, 3 * corner + 2)};
  }
  ODDS_LANES_INLINE static Points all(const double* p) noexcept {
    return {Doubles<R>::all(p[0]), Doubles<R>::all(p[1]), Doubles<R>::all(p[2])};
  }
  ODDS_LANES_INLINE void store(double (*to)[8]) const noexcept {
    x.store(to[0]);
    y.store(to[1]);
    z.store(to[2]);
  }
  [[nodiscard]] ODDS_LANES_INLINE Doubles<R> largest() const noexcept { return max(max(abs(x), abs(y)), abs(z)); }
};

template <class R>
ODDS_LANES_INLINE Points<R> operator+(const Points<R>& a, const Points<R>& b) noexcept {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class R>
ODDS_LANES_INLINE Points<R> operator-(const Points<R>& a, const Points<R>& b) noexcept {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class R>
ODDS_LANES_INLINE Points<R> operator*(const Doubles<R>& s, const Points<R>& a) noexcept {
  return {s * a.x, s * a.y, s * a.z};
}
template <class R>
ODDS_LANES_INLINE Doubles<R> dot(const Points<R>& a, const Points<R>& b) noexcept {
  return (a.x * b.x + a.y * b.y) + a.z * b.z;
}
template <class R>
ODDS_LANES_INLINE Points<R> cross(const Points<R>& a, const Points<R>& b) noexcept {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class R>
ODDS_LANES_INLINE Points<R> choose(const Truths<R>& t, const Points<R>& a, const Points<R>& b) noexcept {
  return {choose(t, a.x, b.x), choose(t, a.y, b.y), choose(t, a.z, b.z)};
}

}  // namespace odds::query::lanes
