// Exact arithmetic on doubles: error-free transforms and floating-point expansions of bounded size.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace odds::math {

/// The exact value high + low, where `high` is the rounded result of an operation and `low` what rounding left out.
struct TwoDoubles {
  double high;
  double low;
};

/// Exactly a + b (Knuth). Any order of magnitudes; no overflow allowed.
[[nodiscard]] inline TwoDoubles two_sum(double a, double b) noexcept {
  const double sum = a + b;
  const double b_seen = sum - a;
  const double a_seen = sum - b_seen;
  return {sum, (a - a_seen) + (b - b_seen)};
}

/// Exactly a + b. Precondition: |a| >= |b| or a == 0 (Dekker).
[[nodiscard]] inline TwoDoubles fast_two_sum(double a, double b) noexcept {
  const double sum = a + b;
  return {sum, b - (sum - a)};
}

/// Exactly a - b, subnormal results included; no overflow allowed.
[[nodiscard]] inline TwoDoubles two_difference(double a, double b) noexcept { return two_sum(a, -b); }

/// Exactly a * b, provided that |a|, |b| < 2^995 and that the product's last bit, i.e. the product of the last bits of
/// a and b, is not below 2^-1074 (Dekker 1971; the same value with and without a fused multiply-add).
[[nodiscard]] inline TwoDoubles two_product(double a, double b) noexcept {
  const double product = a * b;
#ifdef __FMA__
  return {product, __builtin_fma(a, b, -product)};
#else
  constexpr double kSplitter = 134217729.0;  // 2^27 + 1 cuts a double into two halves of 26 bits
  const double a_scaled = kSplitter * a;
  const double a_high = a_scaled - (a_scaled - a);
  const double a_low = a - a_high;
  const double b_scaled = kSplitter * b;
  const double b_high = b_scaled - (b_scaled - b);
  const double b_low = b - b_high;
  return {product, ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low};
#endif
}

/// An exact real number as a sum of at most `Capacity` doubles that do not overlap, by increasing magnitude, zeros left
/// out. No allocation; every operation is exact within the ranges that two_sum and two_product state and has the room
/// it needs by its type. Source: J. R. Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast Robust
/// Geometric Predicates", 1997 (round to nearest even is assumed). Value type.
template <std::size_t Capacity>
class Expansion {
 public:
  Expansion() noexcept {}  // NOLINT: the terms beyond size_ stay uninitialised on purpose, they are never read
  explicit Expansion(TwoDoubles value) noexcept {
    append(value.low);
    append(value.high);
  }

  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] double operator[](std::size_t i) const noexcept { return terms_[i]; }

  /// -1, 0 or 1: exact, for the largest term outweighs all others.
  [[nodiscard]] int sign() const noexcept {
    if (size_ == 0) return 0;
    return terms_[size_ - 1] > 0.0 ? 1 : -1;
  }

  /// The value rounded to a double, within one unit in the last place.
  [[nodiscard]] double approximate() const noexcept {
    double sum = 0.0;
    for (std::size_t i = 0; i < size_; ++i) sum += terms_[i];
    return sum;
  }

  [[nodiscard]] Expansion operator-() const noexcept {
    Expansion negated;
    for (std::size_t i = 0; i < size_; ++i) negated.terms_[i] = -terms_[i];
    negated.size_ = size_;
    return negated;
  }

  /// Adds a term that is not smaller than, and does not overlap, those present; zero is left out.
  void append(double term) noexcept {
    if (term != 0.0) terms_[size_++] = term;
  }

 private:
  std::array<double, Capacity> terms_;
  std::size_t size_ = 0;
};

/// Exact sum (Shewchuk, FAST-EXPANSION-SUM with zeros left out).
template <std::size_t N, std::size_t M>
[[nodiscard]] Expansion<N + M> operator+(const Expansion<N>& a, const Expansion<M>& b) noexcept {
  Expansion<N + M> sum;
  std::size_t i = 0;
  std::size_t j = 0;
  const auto next = [&]() noexcept {
    if (j == b.size() || (i < a.size() && std::fabs(a[i]) < std::fabs(b[j]))) return a[i++];
    return b[j++];
  };
  const std::size_t count = a.size() + b.size();
  if (count == 0) return sum;
  double carry = next();
  for (std::size_t k = 1; k < count; ++k) {
    const TwoDoubles partial = two_sum(carry, next());
    sum.append(partial.low);
    carry = partial.high;
  }
  sum.append(carry);
  return sum;
}

/// Exact difference.
template <std::size_t N, std::size_t M>
[[nodiscard]] Expansion<N + M> operator-(const Expansion<N>& a, const Expansion<M>& b) noexcept {
  return a + (-b);
}

/// Exact multiple (Shewchuk, SCALE-EXPANSION with zeros left out).
template <std::size_t N>
[[nodiscard]] Expansion<2 * N> operator*(const Expansion<N>& a, double factor) noexcept {
  Expansion<2 * N> scaled;
  if (a.size() == 0 || factor == 0.0) return scaled;
  TwoDoubles product = two_product(a[0], factor);
  scaled.append(product.low);
  double carry = product.high;
  for (std::size_t i = 1; i < a.size(); ++i) {
    product = two_product(a[i], factor);
    const TwoDoubles low = two_sum(carry, product.low);
    scaled.append(low.low);
    const TwoDoubles high = fast_two_sum(product.high, low.high);
    scaled.append(high.low);
    carry = high.high;
  }
  scaled.append(carry);
  return scaled;
}

/// Exact product of any expansion and one of two terms, such as a difference of doubles.
template <std::size_t N>
[[nodiscard]] Expansion<4 * N> operator*(const Expansion<N>& a, const Expansion<2>& b) noexcept {
  Expansion<4 * N> product;
  if (b.size() == 0) return product;
  if (b.size() == 1) {
    const auto only = a * b[0];
    for (std::size_t i = 0; i < only.size(); ++i) product.append(only[i]);
    return product;
  }
  return a * b[0] + a * b[1];
}

}  // namespace odds::math
