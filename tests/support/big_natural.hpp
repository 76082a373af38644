// Natural numbers of any size, slow and simple: the exact side of comparisons with rounded formulas.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace odds::test {

class BigNatural {
 public:
  explicit BigNatural(std::uint32_t value = 0) : limbs_{value} {}

  BigNatural& operator+=(const BigNatural& other) {
    if (limbs_.size() < other.limbs_.size()) limbs_.resize(other.limbs_.size(), 0);
    std::uint64_t carry = 0;
    for (std::size_t i = 0; i < limbs_.size(); ++i) {
      carry += std::uint64_t{limbs_[i]} + (i < other.limbs_.size() ? other.limbs_[i] : 0U);
      limbs_[i] = static_cast<std::uint32_t>(carry);
      carry >>= 32;
    }
    if (carry != 0) limbs_.push_back(static_cast<std::uint32_t>(carry));
    return *this;
  }

  friend BigNatural operator*(const BigNatural& a, const BigNatural& b) {
    BigNatural product;
    product.limbs_.assign(a.limbs_.size() + b.limbs_.size(), 0);
    for (std::size_t i = 0; i < a.limbs_.size(); ++i) {
      std::uint64_t carry = 0;
      for (std::size_t j = 0; j < b.limbs_.size(); ++j) {
        carry += std::uint64_t{a.limbs_[i]} * b.limbs_[j] + product.limbs_[i + j];
        product.limbs_[i + j] = static_cast<std::uint32_t>(carry);
        carry >>= 32;
      }
      product.limbs_[i + b.limbs_.size()] = static_cast<std::uint32_t>(carry);
    }
    while (product.limbs_.size() > 1 && product.limbs_.back() == 0) product.limbs_.pop_back();
    return product;
  }

  friend bool operator==(const BigNatural& a, const BigNatural& b) = default;

  /// numerator / denominator to a few units in the last place.
  friend double ratio(const BigNatural& numerator, const BigNatural& denominator) {
    return std::ldexp(numerator.leading() / denominator.leading(),
                      32 * (static_cast<int>(numerator.limbs_.size()) - static_cast<int>(denominator.limbs_.size())));
  }

 private:
  // The number times 2^-32 per limb.
  [[nodiscard]] double leading() const {
    double sum = 0.0;
    for (const std::uint32_t limb : limbs_) sum = (sum + limb) * 0x1p-32;
    return sum;
  }

  std::vector<std::uint32_t> limbs_;  // least first
};

}  // namespace odds::test
