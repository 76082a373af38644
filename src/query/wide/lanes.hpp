// Eight floats at a time: AVX-512 (sixteen), AVX2, two SSE or NEON registers, or plain loops. All give the same bits:
// no fused multiply-add.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>

#if defined(__SSE2__)
#include <immintrin.h>
#elif defined(__aarch64__)
#include <arm_neon.h>
#endif

// Everything here must vanish into its caller: a function of its own, compiled with wider instructions than the
// processor may have, could be the one that the linker keeps for all callers.
#define ODDS_LANES_INLINE [[gnu::always_inline]] inline

namespace odds::query::lanes {

/// For each mask the lanes that it names, in order; the rest is filled with zeros.
struct LaneOrder {
  std::uint8_t of[256][8];
};
inline constexpr LaneOrder lane_order = [] {
  LaneOrder order{};
  for (unsigned mask = 0; mask < 256; ++mask) {
    unsigned count = 0;
    for (unsigned lane = 0; lane < 8; ++lane) {
      if ((mask >> lane & 1U) != 0) order.of[mask][count++] = static_cast<std::uint8_t>(lane);
    }
  }
  return order;
}();

/// Writing for processors that cannot permute lanes by a register.
template <class L>
struct WritesInOrder {
  ODDS_LANES_INLINE static void write_lanes(std::uint32_t* to, std::uint32_t first, unsigned mask) noexcept {
    for (int i = 0; i < 8; ++i) to[i] = first + lane_order.of[mask][i];
  }
  ODDS_LANES_INLINE static void write_either(std::uint32_t* to, std::uint32_t first, std::uint32_t other, unsigned mask,
                                             unsigned counted) noexcept {
    for (; mask != 0; mask &= mask - 1U) {
      const auto lane = static_cast<unsigned>(std::countr_zero(mask));
      *to++ = (counted >> lane & 1U) != 0 ? first + lane : other;
    }
  }
  ODDS_LANES_INLINE static void write_all(std::uint32_t* to, std::uint32_t value) noexcept {
    for (int i = 0; i < 8; ++i) to[i] = value;
  }
  template <class Float>
  ODDS_LANES_INLINE static void write_some(float* to, const Float& a, unsigned mask) noexcept {
    alignas(64) float of[8];
    L::store(of, a);
    for (int i = 0; i < 8; ++i) to[i] = of[lane_order.of[mask][i]];
  }
};

#if defined(__AVX2__)
struct Avx2 {
  struct Float {
    __m256 v;
  };
  static constexpr const char* name = "avx2";
  ODDS_LANES_INLINE static Float load(const float* p) noexcept { return {_mm256_load_ps(p)}; }
  /// From any address.
  ODDS_LANES_INLINE static Float load_from(const float* p) noexcept { return {_mm256_loadu_ps(p)}; }
  ODDS_LANES_INLINE static void store(float* p, Float a) noexcept { _mm256_store_ps(p, a.v); }
  ODDS_LANES_INLINE static Float all(float x) noexcept { return {_mm256_set1_ps(x)}; }
  ODDS_LANES_INLINE static Float abs(Float a) noexcept { return {_mm256_andnot_ps(_mm256_set1_ps(-0.0F), a.v)}; }
  ODDS_LANES_INLINE static Float divide(Float a, Float b) noexcept { return {_mm256_div_ps(a.v, b.v)}; }
  ODDS_LANES_INLINE static Float root(Float a) noexcept { return {_mm256_sqrt_ps(a.v)}; }
  /// Exponent of positive normal numbers, and mantissa - 1 in [0, 1).
  ODDS_LANES_INLINE static void split(Float a, Float& exponent, Float& fraction) noexcept {
    const __m256i bits = _mm256_castps_si256(a.v);
    exponent.v = _mm256_cvtepi32_ps(_mm256_sub_epi32(_mm256_srli_epi32(bits, 23), _mm256_set1_epi32(127)));
    const __m256i one = _mm256_set1_epi32(0x3F800000);
    const __m256i mantissa = _mm256_and_si256(bits, _mm256_set1_epi32(0x007FFFFF));
    fraction.v = _mm256_sub_ps(_mm256_castsi256_ps(_mm256_or_si256(mantissa, one)), _mm256_set1_ps(1.0F));
  }
  ODDS_LANES_INLINE static Float min(Float a, Float b) noexcept { return {_mm256_min_ps(a.v, b.v)}; }
  ODDS_LANES_INLINE static Float max(Float a, Float b) noexcept { return {_mm256_max_ps(a.v, b.v)}; }
  ODDS_LANES_INLINE static unsigned less_equal(Float a, Float b) noexcept {
    return static_cast<unsigned>(_mm256_movemask_ps(_mm256_cmp_ps(a.v, b.v, _CMP_LE_OQ)));
  }
  /// `a` in the lanes of the mask, `b` in the others.
  ODDS_LANES_INLINE static Float choose(unsigned mask, Float a, Float b) noexcept {
    const __m256i bits = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
    const __m256i chosen = _mm256_cmpeq_epi32(_mm256_and_si256(_mm256_set1_epi32(static_cast<int>(mask)), bits), bits);
    return {_mm256_blendv_ps(b.v, a.v, _mm256_castsi256_ps(chosen))};
  }
  /// `a` in the lanes where x <= bound, `b` in the others.
  ODDS_LANES_INLINE static Float choose_at_most(Float x, Float bound, Float a, Float b) noexcept {
    return {_mm256_blendv_ps(b.v, a.v, _mm256_cmp_ps(x.v, bound.v, _CMP_LE_OQ))};
  }
  /// Writes the lanes of the mask, in order, to `to`, and anything to the rest of to[0 .. 8).
  ODDS_LANES_INLINE static void write_some(float* to, Float a, unsigned mask) noexcept {
    const __m128i packed = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(lane_order.of[mask]));
    _mm256_storeu_ps(to, _mm256_permutevar8x32_ps(a.v, _mm256_cvtepu8_epi32(packed)));
  }
  /// Writes `first` + lane for every lane of the mask, in order, to `to`, and anything to the rest of to[0 .. 8).
  ODDS_LANES_INLINE static void write_lanes(std::uint32_t* to, std::uint32_t first, unsigned mask) noexcept {
    const __m128i packed = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(lane_order.of[mask]));
    const __m256i lanes = _mm256_add_epi32(_mm256_cvtepu8_epi32(packed), _mm256_set1_epi32(static_cast<int>(first)));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), lanes);
  }
  /// Writes `first` + lane for every lane of the mask that is `counted`, else `other`, in order, to `to`, and anything
  /// to the rest of to[0 .. 8).
  ODDS_LANES_INLINE static void write_either(std::uint32_t* to, std::uint32_t first, std::uint32_t other, unsigned mask,
                                             unsigned counted) noexcept {
    const __m256i bits = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
    const __m256i lane = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
    const __m256i is_counted =
        _mm256_cmpeq_epi32(_mm256_and_si256(_mm256_set1_epi32(static_cast<int>(counted)), bits), bits);
    const __m256i counts = _mm256_add_epi32(_mm256_set1_epi32(static_cast<int>(first)), lane);
    const __m256i all = _mm256_blendv_epi8(_mm256_set1_epi32(static_cast<int>(other)), counts, is_counted);
    const __m128i packed = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(lane_order.of[mask]));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), _mm256_permutevar8x32_epi32(all, _mm256_cvtepu8_epi32(packed)));
  }
  ODDS_LANES_INLINE static void write_all(std::uint32_t* to, std::uint32_t value) noexcept {
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), _mm256_set1_epi32(static_cast<int>(value)));
  }
  /// Bits of the lanes whose highest bit is set.
  ODDS_LANES_INLINE static unsigned highest_bits(const void* eight) noexcept {
    return static_cast<unsigned>(_mm256_movemask_ps(_mm256_load_ps(static_cast<const float*>(eight))));
  }
  /// The least value, and the first lane that has it.
  ODDS_LANES_INLINE static float least_value(Float a) noexcept { return _mm256_cvtss_f32(least_in_all(a)); }
  ODDS_LANES_INLINE static unsigned least(Float a) noexcept {
    return static_cast<unsigned>(__builtin_ctz(less_equal(a, {least_in_all(a)}) | 0x100U));
  }
  ODDS_LANES_INLINE static __m256 least_in_all(Float a) noexcept {
    __m256 m = _mm256_min_ps(a.v, _mm256_permute2f128_ps(a.v, a.v, 1));
    m = _mm256_min_ps(m, _mm256_shuffle_ps(m, m, 0x4E));
    return _mm256_min_ps(m, _mm256_shuffle_ps(m, m, 0xB1));
  }
};
ODDS_LANES_INLINE Avx2::Float operator+(Avx2::Float a, Avx2::Float b) noexcept { return {_mm256_add_ps(a.v, b.v)}; }
ODDS_LANES_INLINE Avx2::Float operator-(Avx2::Float a, Avx2::Float b) noexcept { return {_mm256_sub_ps(a.v, b.v)}; }
ODDS_LANES_INLINE Avx2::Float operator*(Avx2::Float a, Avx2::Float b) noexcept { return {_mm256_mul_ps(a.v, b.v)}; }
#endif

#if defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512VL__)
/// Eight lanes as before, and sixteen for two pairs at once.
struct Avx512 : Avx2 {
  static constexpr const char* name = "avx512";
};

/// Sixteen lanes: the lower eight of one pair, the upper eight of another.
struct Sixteen {
  struct Float {
    __m512 v;
  };
  ODDS_LANES_INLINE static Float load(const float* p) noexcept { return {_mm512_load_ps(p)}; }
  ODDS_LANES_INLINE static Float load(const float* lower, const float* upper) noexcept {
    return {_mm512_insertf32x8(_mm512_castps256_ps512(_mm256_load_ps(lower)), _mm256_load_ps(upper), 1)};
  }
  ODDS_LANES_INLINE static Float all(float x) noexcept { return {_mm512_set1_ps(x)}; }
  ODDS_LANES_INLINE static Float all(float lower, float upper) noexcept {
    return {_mm512_mask_broadcastss_ps(_mm512_set1_ps(lower), 0xFF00, _mm_set_ss(upper))};
  }
  ODDS_LANES_INLINE static Float abs(Float a) noexcept { return {_mm512_abs_ps(a.v)}; }
  ODDS_LANES_INLINE static Float root(Float a) noexcept { return {_mm512_sqrt_ps(a.v)}; }
  ODDS_LANES_INLINE static Float max(Float a, Float b) noexcept { return {_mm512_max_ps(a.v, b.v)}; }
};
ODDS_LANES_INLINE Sixteen::Float operator+(Sixteen::Float a, Sixteen::Float b) noexcept {
  return {_mm512_add_ps(a.v, b.v)};
}
ODDS_LANES_INLINE Sixteen::Float operator-(Sixteen::Float a, Sixteen::Float b) noexcept {
  return {_mm512_sub_ps(a.v, b.v)};
}
ODDS_LANES_INLINE Sixteen::Float operator*(Sixteen::Float a, Sixteen::Float b) noexcept {
  return {_mm512_mul_ps(a.v, b.v)};
}
#endif

#if defined(__SSE2__)
struct Sse2 : WritesInOrder<Sse2> {
  struct Float {
    __m128 lo, hi;
  };
  static constexpr const char* name = "sse2";
  ODDS_LANES_INLINE static Float load(const float* p) noexcept { return {_mm_load_ps(p), _mm_load_ps(p + 4)}; }
  ODDS_LANES_INLINE static Float load_from(const float* p) noexcept { return {_mm_loadu_ps(p), _mm_loadu_ps(p + 4)}; }
  ODDS_LANES_INLINE static void store(float* p, Float a) noexcept {
    _mm_store_ps(p, a.lo);
    _mm_store_ps(p + 4, a.hi);
  }
  ODDS_LANES_INLINE static Float all(float x) noexcept { return {_mm_set1_ps(x), _mm_set1_ps(x)}; }
  ODDS_LANES_INLINE static Float abs(Float a) noexcept {
    const __m128 sign = _mm_set1_ps(-0.0F);
    return {_mm_andnot_ps(sign, a.lo), _mm_andnot_ps(sign, a.hi)};
  }
  ODDS_LANES_INLINE static Float divide(Float a, Float b) noexcept {
    return {_mm_div_ps(a.lo, b.lo), _mm_div_ps(a.hi, b.hi)};
  }
  ODDS_LANES_INLINE static Float root(Float a) noexcept { return {_mm_sqrt_ps(a.lo), _mm_sqrt_ps(a.hi)}; }
  ODDS_LANES_INLINE static void split(Float a, Float& exponent, Float& fraction) noexcept {
    split_four(a.lo, exponent.lo, fraction.lo);
    split_four(a.hi, exponent.hi, fraction.hi);
  }
  ODDS_LANES_INLINE static void split_four(__m128 a, __m128& exponent, __m128& fraction) noexcept {
    const __m128i bits = _mm_castps_si128(a);
    exponent = _mm_cvtepi32_ps(_mm_sub_epi32(_mm_srli_epi32(bits, 23), _mm_set1_epi32(127)));
    const __m128i mantissa = _mm_and_si128(bits, _mm_set1_epi32(0x007FFFFF));
    fraction = _mm_sub_ps(_mm_castsi128_ps(_mm_or_si128(mantissa, _mm_set1_epi32(0x3F800000))), _mm_set1_ps(1.0F));
  }
  ODDS_LANES_INLINE static Float min(Float a, Float b) noexcept {
    return {_mm_min_ps(a.lo, b.lo), _mm_min_ps(a.hi, b.hi)};
  }
  ODDS_LANES_INLINE static Float max(Float a, Float b) noexcept {
    return {_mm_max_ps(a.lo, b.lo), _mm_max_ps(a.hi, b.hi)};
  }
  ODDS_LANES_INLINE static unsigned less_equal(Float a, Float b) noexcept {
    return static_cast<unsigned>(_mm_movemask_ps(_mm_cmple_ps(a.lo, b.lo))) |
           (static_cast<unsigned>(_mm_movemask_ps(_mm_cmple_ps(a.hi, b.hi))) << 4U);
  }
  ODDS_LANES_INLINE static unsigned highest_bits(const void* eight) noexcept {
    const auto* lanes = static_cast<const float*>(eight);
    return static_cast<unsigned>(_mm_movemask_ps(_mm_load_ps(lanes))) |
           (static_cast<unsigned>(_mm_movemask_ps(_mm_load_ps(lanes + 4))) << 4U);
  }
  ODDS_LANES_INLINE static Float choose(unsigned mask, Float a, Float b) noexcept {
    return {choose_four(mask, a.lo, b.lo), choose_four(mask >> 4U, a.hi, b.hi)};
  }
  ODDS_LANES_INLINE static __m128 choose_four(unsigned mask, __m128 a, __m128 b) noexcept {
    const __m128i bits = _mm_setr_epi32(1, 2, 4, 8);
    const __m128 chosen =
        _mm_castsi128_ps(_mm_cmpeq_epi32(_mm_and_si128(_mm_set1_epi32(static_cast<int>(mask)), bits), bits));
    return _mm_or_ps(_mm_and_ps(chosen, a), _mm_andnot_ps(chosen, b));
  }
  ODDS_LANES_INLINE static Float choose_at_most(Float x, Float bound, Float a, Float b) noexcept {
    const __m128 lo = _mm_cmple_ps(x.lo, bound.lo);
    const __m128 hi = _mm_cmple_ps(x.hi, bound.hi);
    return {_mm_or_ps(_mm_and_ps(lo, a.lo), _mm_andnot_ps(lo, b.lo)),
            _mm_or_ps(_mm_and_ps(hi, a.hi), _mm_andnot_ps(hi, b.hi))};
  }
  ODDS_LANES_INLINE static float least_value(Float a) noexcept { return _mm_cvtss_f32(least_in_all(a)); }
  ODDS_LANES_INLINE static unsigned least(Float a) noexcept {
    const __m128 m = least_in_all(a);
    return static_cast<unsigned>(__builtin_ctz(less_equal(a, {m, m}) | 0x100U));
  }
  ODDS_LANES_INLINE static __m128 least_in_all(Float a) noexcept {
    __m128 m = _mm_min_ps(a.lo, a.hi);
    m = _mm_min_ps(m, _mm_shuffle_ps(m, m, 0x4E));
    return _mm_min_ps(m, _mm_shuffle_ps(m, m, 0xB1));
  }
};
ODDS_LANES_INLINE Sse2::Float operator+(Sse2::Float a, Sse2::Float b) noexcept {
  return {_mm_add_ps(a.lo, b.lo), _mm_add_ps(a.hi, b.hi)};
}
ODDS_LANES_INLINE Sse2::Float operator-(Sse2::Float a, Sse2::Float b) noexcept {
  return {_mm_sub_ps(a.lo, b.lo), _mm_sub_ps(a.hi, b.hi)};
}
ODDS_LANES_INLINE Sse2::Float operator*(Sse2::Float a, Sse2::Float b) noexcept {
  return {_mm_mul_ps(a.lo, b.lo), _mm_mul_ps(a.hi, b.hi)};
}
#endif

#if defined(__aarch64__)
/// Every 64-bit ARM; those of 32 bits have no doubles in their registers, and lose what is very small.
struct Neon {
  struct Float {
    float32x4_t lo, hi;
  };
  static constexpr const char* name = "neon";
  ODDS_LANES_INLINE static Float load(const float* p) noexcept { return {vld1q_f32(p), vld1q_f32(p + 4)}; }
  ODDS_LANES_INLINE static Float load_from(const float* p) noexcept { return load(p); }
  ODDS_LANES_INLINE static void store(float* p, Float a) noexcept {
    vst1q_f32(p, a.lo);
    vst1q_f32(p + 4, a.hi);
  }
  ODDS_LANES_INLINE static Float all(float x) noexcept { return {vdupq_n_f32(x), vdupq_n_f32(x)}; }
  ODDS_LANES_INLINE static Float abs(Float a) noexcept { return {vabsq_f32(a.lo), vabsq_f32(a.hi)}; }
  ODDS_LANES_INLINE static Float divide(Float a, Float b) noexcept {
    return {vdivq_f32(a.lo, b.lo), vdivq_f32(a.hi, b.hi)};
  }
  ODDS_LANES_INLINE static Float root(Float a) noexcept { return {vsqrtq_f32(a.lo), vsqrtq_f32(a.hi)}; }
  ODDS_LANES_INLINE static void split(Float a, Float& exponent, Float& fraction) noexcept {
    split_four(a.lo, exponent.lo, fraction.lo);
    split_four(a.hi, exponent.hi, fraction.hi);
  }
  ODDS_LANES_INLINE static void split_four(float32x4_t a, float32x4_t& exponent, float32x4_t& fraction) noexcept {
    const uint32x4_t bits = vreinterpretq_u32_f32(a);
    exponent = vcvtq_f32_s32(vsubq_s32(vreinterpretq_s32_u32(vshrq_n_u32(bits, 23)), vdupq_n_s32(127)));
    const uint32x4_t mantissa = vandq_u32(bits, vdupq_n_u32(0x007FFFFF));
    fraction = vsubq_f32(vreinterpretq_f32_u32(vorrq_u32(mantissa, vdupq_n_u32(0x3F800000))), vdupq_n_f32(1.0F));
  }
  // Not vminq_f32 and vmaxq_f32: of what is not a number they make another one than SSE does.
  ODDS_LANES_INLINE static Float min(Float a, Float b) noexcept {
    return {vbslq_f32(vcltq_f32(a.lo, b.lo), a.lo, b.lo), vbslq_f32(vcltq_f32(a.hi, b.hi), a.hi, b.hi)};
  }
  ODDS_LANES_INLINE static Float max(Float a, Float b) noexcept {
    return {vbslq_f32(vcgtq_f32(a.lo, b.lo), a.lo, b.lo), vbslq_f32(vcgtq_f32(a.hi, b.hi), a.hi, b.hi)};
  }
  ODDS_LANES_INLINE static unsigned less_equal(Float a, Float b) noexcept {
    return vaddvq_u32(
        vorrq_u32(vandq_u32(vcleq_f32(a.lo, b.lo), lower_bits()), vandq_u32(vcleq_f32(a.hi, b.hi), upper_bits())));
  }
  ODDS_LANES_INLINE static unsigned highest_bits(const void* eight) noexcept {
    const auto* const lanes = static_cast<const float*>(eight);
    const auto is_set = [](const float* four) {
      return vreinterpretq_u32_s32(vshrq_n_s32(vreinterpretq_s32_f32(vld1q_f32(four)), 31));
    };
    return vaddvq_u32(vorrq_u32(vandq_u32(is_set(lanes), lower_bits()), vandq_u32(is_set(lanes + 4), upper_bits())));
  }
  ODDS_LANES_INLINE static Float choose(unsigned mask, Float a, Float b) noexcept {
    return {vbslq_f32(vtstq_u32(vdupq_n_u32(mask), lower_bits()), a.lo, b.lo),
            vbslq_f32(vtstq_u32(vdupq_n_u32(mask), upper_bits()), a.hi, b.hi)};
  }
  ODDS_LANES_INLINE static Float choose_at_most(Float x, Float bound, Float a, Float b) noexcept {
    return {vbslq_f32(vcleq_f32(x.lo, bound.lo), a.lo, b.lo), vbslq_f32(vcleq_f32(x.hi, bound.hi), a.hi, b.hi)};
  }
  ODDS_LANES_INLINE static void write_some(float* to, Float a, unsigned mask) noexcept {
    write_permuted(reinterpret_cast<std::uint8_t*>(to), vreinterpretq_u8_f32(a.lo), vreinterpretq_u8_f32(a.hi), mask);
  }
  ODDS_LANES_INLINE static void write_lanes(std::uint32_t* to, std::uint32_t first, unsigned mask) noexcept {
    const uint16x8_t lanes = vmovl_u8(vld1_u8(lane_order.of[mask]));
    vst1q_u32(to, vaddw_u16(vdupq_n_u32(first), vget_low_u16(lanes)));
    vst1q_u32(to + 4, vaddw_u16(vdupq_n_u32(first), vget_high_u16(lanes)));
  }
  ODDS_LANES_INLINE static void write_either(std::uint32_t* to, std::uint32_t first, std::uint32_t other, unsigned mask,
                                             unsigned counted) noexcept {
    const uint32x4_t lane = {0, 1, 2, 3};
    const uint32x4_t lower = vaddq_u32(vdupq_n_u32(first), lane);
    const uint32x4_t upper = vaddq_u32(vdupq_n_u32(first + 4), lane);
    const uint32x4_t uncounted = vdupq_n_u32(other);
    const uint32x4_t counts = vdupq_n_u32(counted);
    write_permuted(reinterpret_cast<std::uint8_t*>(to),
                   vreinterpretq_u8_u32(vbslq_u32(vtstq_u32(counts, lower_bits()), lower, uncounted)),
                   vreinterpretq_u8_u32(vbslq_u32(vtstq_u32(counts, upper_bits()), upper, uncounted)), mask);
  }
  ODDS_LANES_INLINE static void write_all(std::uint32_t* to, std::uint32_t value) noexcept {
    vst1q_u32(to, vdupq_n_u32(value));
    vst1q_u32(to + 4, vdupq_n_u32(value));
  }
  ODDS_LANES_INLINE static float least_value(Float a) noexcept { return vgetq_lane_f32(least_in_all(a), 0); }
  ODDS_LANES_INLINE static unsigned least(Float a) noexcept {
    const float32x4_t m = least_in_all(a);
    return static_cast<unsigned>(__builtin_ctz(less_equal(a, {m, m}) | 0x100U));
  }

 private:
  ODDS_LANES_INLINE static uint32x4_t lower_bits() noexcept { return uint32x4_t{1, 2, 4, 8}; }
  ODDS_LANES_INLINE static uint32x4_t upper_bits() noexcept { return uint32x4_t{16, 32, 64, 128}; }
  ODDS_LANES_INLINE static float32x4_t least_in_all(Float a) noexcept {
    const Float m = min(a, {vextq_f32(a.lo, a.lo, 2), vextq_f32(a.hi, a.hi, 2)});
    const float32x4_t four = min({m.lo, m.lo}, {m.hi, m.hi}).lo;
    return min({four, four}, {vrev64q_f32(four), four}).lo;
  }
  /// Lanes of the mask, in order: each is four bytes of a table of 32.
  ODDS_LANES_INLINE static void write_permuted(std::uint8_t* to, uint8x16_t lower, uint8x16_t upper,
                                               unsigned mask) noexcept {
    const uint16x8_t lanes = vmovl_u8(vld1_u8(lane_order.of[mask]));
    const auto bytes_of = [](uint16x4_t four) {
      return vreinterpretq_u8_u32(vmlaq_n_u32(vdupq_n_u32(0x03020100), vmovl_u16(four), 0x04040404));
    };
    const uint8x16x2_t table = {{lower, upper}};
    vst1q_u8(to, vqtbl2q_u8(table, bytes_of(vget_low_u16(lanes))));
    vst1q_u8(to + 16, vqtbl2q_u8(table, bytes_of(vget_high_u16(lanes))));
  }
};
ODDS_LANES_INLINE Neon::Float operator+(Neon::Float a, Neon::Float b) noexcept {
  return {vaddq_f32(a.lo, b.lo), vaddq_f32(a.hi, b.hi)};
}
ODDS_LANES_INLINE Neon::Float operator-(Neon::Float a, Neon::Float b) noexcept {
  return {vsubq_f32(a.lo, b.lo), vsubq_f32(a.hi, b.hi)};
}
ODDS_LANES_INLINE Neon::Float operator*(Neon::Float a, Neon::Float b) noexcept {
  return {vmulq_f32(a.lo, b.lo), vmulq_f32(a.hi, b.hi)};
}
#endif

/// For every other processor; compilers make vector code of these loops where it has any.
struct Portable : WritesInOrder<Portable> {
  struct Float {
    float v[8];
  };
  static constexpr const char* name = "portable";
  ODDS_LANES_INLINE static Float load(const float* p) noexcept {
    Float result;
    for (int i = 0; i < 8; ++i) result.v[i] = p[i];
    return result;
  }
  ODDS_LANES_INLINE static Float load_from(const float* p) noexcept { return load(p); }
  ODDS_LANES_INLINE static void store(float* p, const Float& a) noexcept {
    for (int i = 0; i < 8; ++i) p[i] = a.v[i];
  }
  ODDS_LANES_INLINE static Float all(float x) noexcept {
    Float result;
    for (float& lane : result.v) lane = x;
    return result;
  }
  ODDS_LANES_INLINE static Float abs(const Float& a) noexcept {
    Float result;
    for (int i = 0; i < 8; ++i) result.v[i] = a.v[i] < 0.0F ? -a.v[i] : a.v[i];
    return result;
  }
  ODDS_LANES_INLINE static Float divide(const Float& a, const Float& b) noexcept {
    Float result;
    for (int i = 0; i < 8; ++i) result.v[i] = a.v[i] / b.v[i];
    return result;
  }
  ODDS_LANES_INLINE static Float root(const Float& a) noexcept {
    Float result;
    for (int i = 0; i < 8; ++i) result.v[i] = __builtin_sqrtf(a.v[i]);
    return result;
  }
  ODDS_LANES_INLINE static void split(const Float& a, Float& exponent, Float& fraction) noexcept {
    for (int i = 0; i < 8; ++i) {
      const auto bits = std::bit_cast<std::uint32_t>(a.v[i]);
      exponent.v[i] = static_cast<float>(static_cast<std::int32_t>(bits >> 23U) - 127);
      fraction.v[i] = std::bit_cast<float>((bits & 0x007FFFFFU) | 0x3F800000U) - 1.0F;
    }
  }
  ODDS_LANES_INLINE static Float min(const Float& a, const Float& b) noexcept {
    Float result;
    for (int i = 0; i < 8; ++i) result.v[i] = a.v[i] < b.v[i] ? a.v[i] : b.v[i];
    return result;
  }
  ODDS_LANES_INLINE static Float max(const Float& a, const Float& b) noexcept {
    Float result;
    for (int i = 0; i < 8; ++i) result.v[i] = a.v[i] > b.v[i] ? a.v[i] : b.v[i];
    return result;
  }
  ODDS_LANES_INLINE static unsigned less_equal(const Float& a, const Float& b) noexcept {
    unsigned mask = 0;
    for (int i = 0; i < 8; ++i) mask |= (a.v[i] <= b.v[i] ? 1U : 0U) << static_cast<unsigned>(i);
    return mask;
  }
  ODDS_LANES_INLINE static unsigned highest_bits(const void* eight) noexcept {
    std::uint32_t lanes[8];
    std::memcpy(lanes, eight, sizeof lanes);
    unsigned mask = 0;
    for (unsigned i = 0; i < 8; ++i) mask |= (lanes[i] >> 31U) << i;
    return mask;
  }
  ODDS_LANES_INLINE static Float choose(unsigned mask, const Float& a, const Float& b) noexcept {
    Float result;
    for (unsigned i = 0; i < 8; ++i) result.v[i] = (mask >> i & 1U) != 0 ? a.v[i] : b.v[i];
    return result;
  }
  ODDS_LANES_INLINE static Float choose_at_most(const Float& x, const Float& bound, const Float& a,
                                                const Float& b) noexcept {
    Float result;
    for (unsigned i = 0; i < 8; ++i) result.v[i] = x.v[i] <= bound.v[i] ? a.v[i] : b.v[i];
    return result;
  }
  ODDS_LANES_INLINE static float least_value(const Float& a) noexcept { return a.v[least(a)]; }
  ODDS_LANES_INLINE static unsigned least(const Float& a) noexcept {
    unsigned lane = 0;
    for (unsigned i = 1; i < 8; ++i) lane = a.v[i] < a.v[lane] ? i : lane;
    return lane;
  }
};
ODDS_LANES_INLINE Portable::Float operator+(const Portable::Float& a, const Portable::Float& b) noexcept {
  Portable::Float result;
  for (int i = 0; i < 8; ++i) result.v[i] = a.v[i] + b.v[i];
  return result;
}
ODDS_LANES_INLINE Portable::Float operator-(const Portable::Float& a, const Portable::Float& b) noexcept {
  Portable::Float result;
  for (int i = 0; i < 8; ++i) result.v[i] = a.v[i] - b.v[i];
  return result;
}
ODDS_LANES_INLINE Portable::Float operator*(const Portable::Float& a, const Portable::Float& b) noexcept {
  Portable::Float result;
  for (int i = 0; i < 8; ++i) result.v[i] = a.v[i] * b.v[i];
  return result;
}

/// log2 of positive normal numbers; absolute error < 0.01. See math::rough_log2.
template <class L>
ODDS_LANES_INLINE typename L::Float rough_log2(typename L::Float x) noexcept {
  typename L::Float exponent;
  typename L::Float fraction;
  L::split(x, exponent, fraction);
  return exponent + fraction * (L::all(1.33985F) - L::all(0.33985F) * fraction);
}

}  // namespace odds::query::lanes
