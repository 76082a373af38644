// How much of a contact's depth is given to a solver.
#pragma once

#include <algorithm>

namespace odds::query {

/// What bodies have come deeper where a contact held them is given at once: they did so against its push. What came
/// deep while nobody knew is given slowly: a solver would take back in a step or two what took ten, and throw the body.
/// Where they part faster than that, less is given: what a solver makes of a depth, a speed, is energy that nobody put
/// in. Metres.
class GivenDepth {
 public:
  /// A contact that is new, and `depth` deep now.
  void begin(double depth, double given) noexcept {
    depth_ = std::max(depth, 0.0);
    given_ = given;
    holds_ = false;
  }
  /// A run begins, in which it is `depth` deep; negative: a gap. `least` is given at least, and by `rise` more a run.
  void age(double depth, double least, double rise) noexcept {
    const double now = std::max(depth, 0.0);
    const double deeper = holds_ ? std::max(now - depth_, 0.0) : 0.0;
    const bool parts = holds_ && depth_ - now > rise;
    given_ = std::min(now, std::max(given_ + deeper + (parts ? -rise : rise), least));
    depth_ = now;
    holds_ = false;
  }
  /// It was measured after `runs`, and is `depth` deep, `deeper` than was thought: that came while nobody knew, and a
  /// run's share of it is given.
  void correct(double depth, double deeper, int runs) noexcept {
    depth_ = std::max(depth, 0.0);
    given_ += std::max(deeper, 0.0) / std::max(runs, 1);
  }
  /// It is among the contacts of this run.
  void hold() noexcept { holds_ = true; }
  [[nodiscard]] bool holds() const noexcept { return holds_; }
  /// Of a depth, so much.
  [[nodiscard]] double of(double depth) const noexcept { return std::min(depth, given_); }
  [[nodiscard]] double given() const noexcept { return given_; }

 private:
  double depth_ = 0.0;  ///< at the last run, not negative
  double given_ = 0.0;
  bool holds_ = false;
};

}  // namespace odds::query
