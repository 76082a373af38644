// Elementary functions by plain arithmetic: a few nanoseconds, and the same bits on every compiler and C library. For
// probabilities and orders of search, never for geometry.
#pragma once

#include <bit>
#include <cstdint>

namespace odds::math {

/// Cube root of a positive finite normal float; relative error < 2e-6. 0 and less give 0.
[[nodiscard]] inline float cube_root(float x) noexcept {
  if (!(x > 0.0F)) return 0.0F;
  // A third of the exponent by integer division of the bits (Kahan), then two steps of Halley's iteration (cubic).
  float y = std::bit_cast<float>(std::bit_cast<std::uint32_t>(x) / 3U + 709921077U);
  for (int i = 0; i < 2; ++i) {
    const float cube = y * y * y;
    y *= (cube + x + x) / (cube + cube + x);
  }
  return y;
}

/// log2 of a positive normal number; absolute error < 0.01. Anything else gives about -1023 or less.
[[nodiscard]] inline float rough_log2(double x) noexcept {
  if (!(x > 0.0)) return -1e4F;
  const auto bits = std::bit_cast<std::uint64_t>(x);
  const auto exponent = static_cast<int>((bits >> 52U) & 0x7FFU) - 1023;
  // log2(1 + f) by the parabola through its ends and its middle.
  const auto f =
      static_cast<float>(std::bit_cast<double>((bits & 0x000FFFFFFFFFFFFFULL) | 0x3FF0000000000000ULL) - 1.0);
  return static_cast<float>(exponent) + f * (1.33985F - 0.33985F * f);
}

/// 2^x for x in [-126, 127); relative error < 0.4 %. NaN and what is beyond counts as the nearest of them.
[[nodiscard]] inline float rough_exp2(float x) noexcept {
  const float within = x >= -126.0F ? (x < 127.0F ? x : 126.99999F) : -126.0F;
  const auto whole = static_cast<int>(within + 128.0F) - 128;  // rounded down
  const float f = within - static_cast<float>(whole);
  const float power = std::bit_cast<float>(static_cast<std::uint32_t>(127 + whole) << 23U);
  return power * (1.0F + f * (0.656F + 0.344F * f));
}

/// 1 - exp(-x) for x >= 0, in [0, 1]; error < 3e-7. NaN and negative numbers give 0.
[[nodiscard]] inline float probability_of_rate(float x) noexcept {
  if (!(x > 0.0F)) return 0.0F;
  if (x > 17.0F) return 1.0F;
  if (x < 1e-3F) return x - 0.5F * x * x;
  // exp(-x) = 2^-n * exp(-r), r = x - n ln 2 in [-0.35, 0.35]; Taylor to the sixth power.
  const float n = static_cast<float>(static_cast<int>(x * 1.44269504F + 0.5F));
  const float r = (x - n * 0.693359375F) + n * 2.12194440e-4F;
  const float series =
      1.0F - r * (1.0F - r * (0.5F - r * (1.0F / 6.0F - r * (1.0F / 24.0F - r * (1.0F / 120.0F - r / 720.0F)))));
  const float power = std::bit_cast<float>(static_cast<std::uint32_t>(127 - static_cast<int>(n)) << 23U);
  return 1.0F - power * series;
}

}  // namespace odds::math
