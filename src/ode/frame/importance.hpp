// How much a pair of bodies matters in a frame, and what it gets.
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
};

/// In powers of two: a pair of 1 more matters twice as much. Finite. A pair that touched in the last frame is at least
/// ten times as important as one that was proved apart, stands still and is as near.
[[nodiscard]] double importance(const PairSigns& signs) noexcept;

/// So much less than the most important pair of a frame, and no less, a pair counts where turns are taken: a sixteenth.
constexpr double least_in_turns = -4.0;

/// Whose turn it is: the pair of the greatest value. `importance` and the greatest one, `most_important`, of this
/// frame; `waited`: frames without service, 0: served in the last one. It grows with importance times the square of the
/// wait, which makes turns as frequent as the root of the importance: where what an old answer costs grows with its age
/// and its importance, that is the best use of too little time (as the index policies of Kadota et al., Scheduling
/// Policies for Minimizing Age of Information in Broadcast Wireless Networks, 2018). As no pair counts for less than a
/// sixteenth, none has its turns more than four times as rarely as another.
[[nodiscard]] double turn(double importance, double most_important, std::uint64_t waited) noexcept;

/// What the next pair in order may spend. `left` is all that the frame has for this pair and those that come after it,
/// `need` its least useful share, `kept` the sum of the needs of those after it, and `part` its part in what is left
/// over then.
struct Share {
  double left = 0.0;
  double need = 0.0;
  double kept = 0.0;
  double part = 1.0;
};

/// At least `need`, if there is so much beside `kept`; never more than is left beside it.
[[nodiscard]] double share_of(const Share& share) noexcept;

}  // namespace odds::ode
