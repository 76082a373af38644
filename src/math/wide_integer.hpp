// Signed integers of bounded size that hold any product of three differences of doubles: the last resort of predicates.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace odds::math {

/// Exponent of the last bit of a double as an integer multiple of 2^-1074 (0 for subnormals and zero).
[[nodiscard]] inline int last_bit_exponent(double value) noexcept {
  const auto biased = static_cast<int>((std::bit_cast<std::uint64_t>(value) >> 52) & 0x7ffU);
  return std::max(biased, 1) - 1;
}

/// Sign and magnitude in `Limbs` words of 32 bits. No allocation; results must fit, which the callers' types guarantee.
template <std::size_t Limbs>
class WideInteger {
 public:
  WideInteger() noexcept {}  // NOLINT: limbs from used_ on stay uninitialised on purpose, they are never read

  /// value / 2^(unit - 1074); precondition: unit <= last_bit_exponent(value).
  WideInteger(double value, int unit) noexcept {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    const bool normal = ((bits >> 52) & 0x7ffU) != 0;
    const std::uint64_t mantissa = (bits & 0xfffffffffffffU) | (normal ? 1ULL << 52 : 0);
    if (mantissa == 0) return;
    const auto shift = static_cast<std::size_t>(last_bit_exponent(value) - unit);
    const std::size_t whole = shift / 32;
    const std::size_t part = shift % 32;
    std::fill_n(limbs_.begin(), whole, 0U);
    limbs_[whole] = static_cast<std::uint32_t>(mantissa << part);
    limbs_[whole + 1] = static_cast<std::uint32_t>((mantissa << part) >> 32);
    limbs_[whole + 2] = part == 0 ? 0U : static_cast<std::uint32_t>((mantissa >> (64 - part)));
    used_ = whole + 3;
    trim();
    sign_ = (bits >> 63) != 0 ? -1 : 1;
  }

  [[nodiscard]] int sign() const noexcept { return used_ == 0 ? 0 : sign_; }

  [[nodiscard]] WideInteger operator-() const noexcept {
    WideInteger negated = *this;
    negated.sign_ = -sign_;
    return negated;
  }
  [[nodiscard]] WideInteger operator-(const WideInteger& other) const noexcept { return *this + (-other); }
  [[nodiscard]] WideInteger operator+(const WideInteger& other) const noexcept {
    if (other.used_ == 0) return *this;
    if (used_ == 0) return other;
    if (sign_ == other.sign_) return longer(*this, other).plus(shorter(*this, other));
    const int order = compare(*this, other);
    if (order == 0) return WideInteger();
    return order > 0 ? minus(other) : other.minus(*this);
  }

  template <std::size_t N, std::size_t M>
  friend WideInteger<N + M> operator*(const WideInteger<N>& a, const WideInteger<M>& b) noexcept;

 private:
  template <std::size_t>
  friend class WideInteger;

  static const WideInteger& longer(const WideInteger& a, const WideInteger& b) noexcept {
    return a.used_ >= b.used_ ? a : b;
  }
  static const WideInteger& shorter(const WideInteger& a, const WideInteger& b) noexcept {
    return a.used_ >= b.used_ ? b : a;
  }
  // Order of the magnitudes.
  static int compare(const WideInteger& a, const WideInteger& b) noexcept {
    if (a.used_ != b.used_) return a.used_ > b.used_ ? 1 : -1;
    for (std::size_t i = a.used_; i-- > 0;) {
      if (a.limbs_[i] != b.limbs_[i]) return a.limbs_[i] > b.limbs_[i] ? 1 : -1;
    }
    return 0;
  }
  // |this| + |small|, sign of this; small has no more limbs.
  WideInteger plus(const WideInteger& small) const noexcept {
    WideInteger sum;
    sum.sign_ = sign_;
    std::uint64_t carry = 0;
    for (std::size_t i = 0; i < used_; ++i) {
      carry += std::uint64_t{limbs_[i]} + (i < small.used_ ? small.limbs_[i] : 0U);
      sum.limbs_[i] = static_cast<std::uint32_t>(carry);
      carry >>= 32;
    }
    sum.used_ = used_;
    if (carry != 0) sum.limbs_[sum.used_++] = static_cast<std::uint32_t>(carry);
    return sum;
  }
  // |this| - |small|, sign of this; |small| < |this|.
  WideInteger minus(const WideInteger& small) const noexcept {
    WideInteger difference;
    difference.sign_ = sign_;
    std::uint64_t borrow = 0;
    for (std::size_t i = 0; i < used_; ++i) {
      const std::uint64_t taken = (i < small.used_ ? small.limbs_[i] : 0U) + borrow;
      borrow = limbs_[i] < taken ? 1 : 0;
      difference.limbs_[i] = static_cast<std::uint32_t>(limbs_[i] - taken);
    }
    difference.used_ = used_;
    difference.trim();
    return difference;
  }
  void trim() noexcept {
    while (used_ > 0 && limbs_[used_ - 1] == 0) --used_;
  }

  std::array<std::uint32_t, Limbs> limbs_;
  std::size_t used_ = 0;
  int sign_ = 1;
};

template <std::size_t N, std::size_t M>
[[nodiscard]] WideInteger<N + M> operator*(const WideInteger<N>& a, const WideInteger<M>& b) noexcept {
  WideInteger<N + M> product;
  if (a.used_ == 0 || b.used_ == 0) return product;
  product.sign_ = a.sign_ * b.sign_;
  product.used_ = a.used_ + b.used_;
  std::fill_n(product.limbs_.begin(), product.used_, 0U);
  for (std::size_t i = 0; i < a.used_; ++i) {
    std::uint64_t carry = 0;
    for (std::size_t j = 0; j < b.used_; ++j) {
      carry += std::uint64_t{a.limbs_[i]} * b.limbs_[j] + product.limbs_[i + j];
      product.limbs_[i + j] = static_cast<std::uint32_t>(carry);
      carry >>= 32;
    }
    product.limbs_[i + b.used_] = static_cast<std::uint32_t>(carry);
  }
  product.trim();
  return product;
}

/// Holds any double and any difference of two, in units of 2^-1074: 2,099 bits, with room for the last partial word.
using WideDouble = WideInteger<68>;

/// True if expansions of differences of such coordinates, multiplied up to three at a time, neither overflow nor lose
/// bits below 2^-1074: zero, or between 2^-305 and 2^330 in size.
[[nodiscard]] inline bool fits_expansions(double coordinate) noexcept {
  const double size = coordinate < 0.0 ? -coordinate : coordinate;
  return size == 0.0 || (size >= 0x1p-305 && size <= 0x1p330);
}

}  // namespace odds::math
