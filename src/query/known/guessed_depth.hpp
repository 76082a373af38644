// How deep a contact that is guessed may say it is.
#pragma once

#include <algorithm>
#include <cmath>

#include "odds/math/tolerances.hpp"

namespace odds::query {

/// Where two triangles cross they say how deep they are in each other there, if little of how deep the bodies are; of
/// that a guess gives what nobody need have measured at once. While bodies go on sinking in that is not enough, and a
/// little more is given each run: as slowly as of late contacts, for the guess may be wrong. Once they come out it is
/// taken back as slowly, for what pushes a body off what it rests on makes it hop. Parts of the smaller body's size.
class GuessedDepth {
 public:
  void forget() noexcept {
    most_ = tolerances::unmeasured_depth;
    usual_ = 0.0;
  }
  /// Of one contact.
  [[nodiscard]] double most() const noexcept { return most_; }
  /// A run has guessed; `overlap`: by how much what crosses overlaps, in the mean.
  void note(double overlap) noexcept {
    if (!std::isfinite(overlap)) return;
    const bool sinks = overlap > most_ && overlap >= usual_;
    const double next = most_ + (sinks ? tolerances::hasty_rise : -tolerances::hasty_rise);
    most_ = std::clamp(next, tolerances::unmeasured_depth, tolerances::hasty_deepest);
    usual_ = kept * usual_ + (1.0 - kept) * overlap;
  }

 private:
  static constexpr double kept = 0.95;

  double most_ = tolerances::unmeasured_depth;
  double usual_ = 0.0;  ///< overlap in the last dozens of runs
};

}  // namespace odds::query
