// How a set of triangles is divided in two: the surface area heuristic over bins (Wald 2007).
#pragma once

#include <Eigen/Core>
#include <bit>
#include <cstdint>
#include <limits>
#include <span>

#include "odds/math/types.hpp"

namespace odds::tree {

/// A box in single precision; the fourth lane is idle, it makes room for vector instructions. Splits only decide speed,
/// never verdicts, so single precision is enough here.
struct SplitBounds {
  Eigen::Array4f lower = Eigen::Array4f::Constant(std::numeric_limits<float>::max());
  Eigen::Array4f upper = Eigen::Array4f::Constant(std::numeric_limits<float>::lowest());
  void add(const Eigen::Array4f& point) noexcept {
    lower = lower.min(point);
    upper = upper.max(point);
  }
  void add(const SplitBounds& other) noexcept {
    lower = lower.min(other.lower);
    upper = upper.max(other.upper);
  }
  [[nodiscard]] double half_area() const noexcept {
    const Eigen::Array4f d = upper - lower;
    const auto x = static_cast<double>(d[0]);
    const auto y = static_cast<double>(d[1]);
    const auto z = static_cast<double>(d[2]);
    return x * y + y * z + z * x;
  }
};

/// A triangle's box and, in the idle lane, its index.
struct SplitReference {
  SplitBounds bounds;

  SplitReference() = default;
  SplitReference(const SplitBounds& box, std::uint32_t triangle) noexcept : bounds(box) {
    // The set bit makes it a number of ordinary size: sums with tiny ones are slow on some processors.
    bounds.lower[3] = std::bit_cast<float>(triangle | index_mark);
    bounds.upper[3] = 1.0F;
  }
  [[nodiscard]] std::uint32_t triangle() const noexcept {
    return std::bit_cast<std::uint32_t>(bounds.lower[3]) & ~index_mark;
  }
  [[nodiscard]] Eigen::Array4f centroid() const noexcept { return 0.5F * (bounds.lower + bounds.upper); }

 private:
  static constexpr std::uint32_t index_mark = 1U << 30U;  // meshes have at most 2^30 triangles
};

/// The box of the references' centroids.
[[nodiscard]] SplitBounds centroid_bounds(std::span<const SplitReference> references) noexcept;

/// Reorders `references`, at least two whose centroids lie in `centroids`; returns the size of the left part, never 0
/// nor all of them. With `at_median` the plane is that through the middle triangle along the longest axis; otherwise
/// the cheapest of 15 planes on each axis, and that one only where all centroids coincide. `scratch` is of the same
/// size; its contents do not matter.
std::size_t split(std::span<SplitReference> references, std::span<SplitReference> scratch, const SplitBounds& centroids,
                  bool at_median) noexcept;

}  // namespace odds::tree
