// Over how much of two bodies the places where they were found to meet are spread.
#pragma once

#include <algorithm>
#include <cmath>

#include "math/rotation_between.hpp"
#include "odds/math/types.hpp"

namespace odds::query {

/// Gears meet in one place, a bolt and its nut all around. RMS distance of the places of some dozens of runs from their
/// middle, which goes along with the line from A's centre to B's as that turns about an axis across it: so it is one
/// place, too, where both gears turn and only that line stands still. In A's hierarchy frame, metres.
class PlaceSpread {
 public:
  void forget() noexcept {
    sum_.setZero();
    line_.setZero();
    squares_ = weight_ = 0.0;
  }
  /// A run begins in which places are seen, with B's centre at `centre_b`; nearer than `little` it has no direction.
  void begin(const Vec3& centre_b, double little) noexcept {
    const double far = centre_b.norm();
    const Vec3 line = far > little ? Vec3(centre_b / far) : Vec3(Vec3::Zero());
    if (!line.isZero() && !line_.isZero() && line.dot(line_) > -0.9)
      sum_ = math::rotation_between(line_, line) * sum_;
    line_ = line;
    sum_ *= kept;
    squares_ *= kept;
    weight_ *= kept;
  }
  void see(const Vec3& place) noexcept {
    if (!place.allFinite()) return;
    sum_ += place;
    squares_ += place.squaredNorm();
    weight_ += 1.0;
  }
  /// 0 while fewer than some were seen.
  [[nodiscard]] double metres() const noexcept {
    if (weight_ < fewest) return 0.0;
    return std::sqrt(std::max(0.0, squares_ / weight_ - (sum_ / weight_).squaredNorm()));
  }

 private:
  static constexpr double kept = 0.98;
  static constexpr double fewest = 3.0;

  Vec3 sum_ = Vec3::Zero();
  Vec3 line_ = Vec3::Zero();  ///< unit; zero: none
  double squares_ = 0.0;
  double weight_ = 0.0;
};

}  // namespace odds::query
