// Counter-based random numbers: the same seed and stream give the same numbers on every machine and compiler.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "odds/math/types.hpp"

namespace odds::math {

/// A bijective scrambling of 64 bits (SplitMix64's finaliser; Steele, Lea, Flood, OOPSLA 2014).
[[nodiscard]] constexpr std::uint64_t scramble(std::uint64_t x) noexcept {
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31U);
}

/// Random numbers keyed by (seed, stream): number i is a function of seed, stream and i alone, so that objects, pairs
/// and queries draw independently of each other's order. Not for cryptography. A plain value; not shared among threads.
/// The standard library's distributions are not used because they differ between implementations.
class Random {
 public:
  constexpr explicit Random(std::uint64_t seed, std::uint64_t stream = 0) noexcept
      : key_(scramble(seed + golden) ^ scramble(scramble(stream + 2 * golden))) {}

  /// The 64 bits that belong to a counter; does not change the state.
  [[nodiscard]] constexpr std::uint64_t bits_at(std::uint64_t counter) const noexcept {
    return scramble(key_ + golden * (counter + 1));
  }
  /// In [0, 1), multiples of 2^-53; does not change the state.
  [[nodiscard]] constexpr double uniform_at(std::uint64_t counter) const noexcept {
    return static_cast<double>(bits_at(counter) >> 11U) * 0x1p-53;
  }

  constexpr std::uint64_t bits() noexcept { return bits_at(counter_++); }
  constexpr double uniform() noexcept { return uniform_at(counter_++); }
  constexpr double uniform(double least, double greatest) noexcept { return least + (greatest - least) * uniform(); }
  /// In [0, count), count >= 1; biased by less than count * 2^-53.
  constexpr std::uint64_t below(std::uint64_t count) noexcept {
    const auto drawn = static_cast<std::uint64_t>(uniform() * static_cast<double>(count));
    return drawn < count ? drawn : count - 1;
  }

  /// Uniform on the unit sphere (Archimedes: the height is uniform).
  Vec3 direction() noexcept {
    const double z = uniform(-1.0, 1.0);
    const double angle = 2.0 * std::numbers::pi * uniform();
    const double r = std::sqrt(std::fmax(0.0, 1.0 - z * z));
    return {r * std::cos(angle), r * std::sin(angle), z};
  }
  /// Uniform over all rotations (Shoemake, Graphics Gems III, 1992).
  Quat rotation() noexcept {
    const double u = uniform();
    const double a = 2.0 * std::numbers::pi * uniform();
    const double b = 2.0 * std::numbers::pi * uniform();
    const double p = std::sqrt(1.0 - u);
    const double q = std::sqrt(u);
    return Quat(q * std::cos(b), p * std::sin(a), p * std::cos(a), q * std::sin(b));
  }

 private:
  static constexpr std::uint64_t golden = 0x9e3779b97f4a7c15ULL;
  std::uint64_t key_;
  std::uint64_t counter_ = 0;
};

}  // namespace odds::math
