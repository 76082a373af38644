// How deep a contact that is guessed may say it is.
#pragma once

#include <algorithm>
#include <cmath>

#include "odds/math/tolerances.hpp"

namespace odds::query {

/// Where two triangles cross they say how deep they are in each other there, if little of how deep the bodies are. A
/// guess gives no more of that than what nobody need have measured; but bodies that go on sinking in are not held by so
/// little. So with each guess that finds them deeper than those before it did, a little more may be given, and with
/// each that finds them less deep a little less: as slowly as late contacts get deeper, for a guess may be wrong, and
/// what pushes a body off what it rests on makes it hop. Parts of the smaller body's size.
class GuessedDepth {
 public:
  void forget() noexcept {
    most_ = tolerances::unmeasured_depth;
    usual_ = -1.0;
  }
  /// Of one contact.
  [[nodiscard]] double most() const noexcept { return most_; }
  /// A run has guessed; `overlap`: by how much what crosses overlaps, in the mean. Not what is no number.
  void note(double overlap) noexcept {
    if (!std::isfinite(overlap)) return;
    if (usual_ < 0.0) usual_ = overlap;
    if (overlap <= most_ || overlap < usual_) {
      most_ = std::max(most_ - tolerances::hasty_rise, tolerances::unmeasured_depth);
    } else if (overlap > usual_) {
      most_ = std::min(most_ + tolerances::hasty_rise, tolerances::hasty_deepest);
    }
    usual_ = kept * usual_ + (1.0 - kept) * overlap;
  }

 private:
  static constexpr double kept = 0.95;

  double most_ = tolerances::unmeasured_depth;
  double usual_ = -1.0;  ///< overlap of the last dozens of guesses; negative: of none
};

}  // namespace odds::query
