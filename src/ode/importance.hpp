// How much a pair of bodies matters in a frame.
#pragma once

#include <cstdint>

namespace odds::ode {

/// What is known about a pair before its collision.
struct PairSigns {
  double hit_probability = 0.5;     ///< of its last answer; where nobody asked yet, a half
  bool proved = false;              ///< whether that was a proof
  std::uint64_t since_contact = 0;  ///< frames since it gave contacts; 0: in the last one
  bool ever_contact = false;
  double relative_speed = 0.0;  ///< share of the fastest pair's of this frame, [0, 1]
  double way_share = 0.0;       ///< its way in a frame as a share of how far its boxes overlap, >= 0
  double attention = 1.0;       ///< 1 near to it, less far away, > 0
  std::uint64_t waited = 0;     ///< frames since it was served; 0: in the last one
};

/// In powers of two: a pair of 1 more matters twice as much. Finite. A pair that touched in the last frame is at least
/// ten times as important as one that was proved apart, stands still and is as near. Each frame of waiting adds 1,
/// without end, so that any pair becomes the most important one in time.
[[nodiscard]] double importance(const PairSigns& signs) noexcept;

/// Parts of pairs in what is left, told from the least important pair to the most important one.
class PartsOfRest {
 public:
  /// The part, in (0, 1], of a pair's importance in the sum of its own and of all that were told before. Precondition:
  /// `importance` is not less than theirs.
  [[nodiscard]] double next(double importance) noexcept;

 private:
  double sum_ = 0.0;  // in units of the last one
  double last_ = 0.0;
};

/// What the next pair in order of importance may spend. `left` is all that the frame has for this pair and those after
/// it, `demand` what the pair will probably need, `part` its part of the importance from this pair on, and `after` the
/// number of pairs that come later, each of which keeps `floor`.
struct Share {
  double left = 0.0;
  double demand = 0.0;
  double part = 1.0;
  double after = 0.0;
  double floor = 0.0;
};

/// At least 0, at most `left`.
[[nodiscard]] double share_of(const Share& share) noexcept;

}  // namespace odds::ode
