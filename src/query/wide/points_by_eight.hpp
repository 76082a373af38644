// Points as kernels look at them: eight at a time.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "odds/math/types.hpp"
#include "query/wide/outermost.hpp"

namespace odds::query::wide {

/// At most so many, numbered in the order in which they came. Not set at first, for most collisions have few.
template <std::size_t most>
class PointsByEight {
 public:
  [[nodiscard]] std::size_t count() const noexcept { return count_; }
  [[nodiscard]] std::span<const EightPoints> all() const noexcept {
    return std::span(eights_).first((count_ + EightPoints::count - 1) / EightPoints::count);
  }
  [[nodiscard]] Vec3 point(std::size_t i) const noexcept {
    return eights_[i / EightPoints::count].point(i % EightPoints::count);
  }

  /// Precondition: there are not that many yet. `depth`: as of EightPoints.
  void add(const Vec3& point, double depth) noexcept {
    EightPoints& eight = eights_[count_ / EightPoints::count];
    const std::size_t lane = count_++ % EightPoints::count;
    for (std::size_t other = 1; lane == 0 && other < EightPoints::count; ++other) eight.leave_out(other);
    eight.set(lane, point, depth);
  }

 private:
  std::array<EightPoints, (most + EightPoints::count - 1) / EightPoints::count> eights_;
  std::size_t count_ = 0;
};

}  // namespace odds::query::wide
