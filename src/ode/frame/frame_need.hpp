// What a pair needs in a frame for an answer that is of use, learned from what its collisions cost.
#pragma once

#include "ode/frame/frame_share.hpp"

namespace odds::ode {

/// In the frame's own measure: microseconds, or work units.
class FrameNeed {
 public:
  /// The least share that is worth giving. `unknown`: of a pair that nobody has met; `most`: what a frame gives to one
  /// pair at most.
  [[nodiscard]] double least_share(double unknown, double most) const noexcept;

  /// Whether a larger share would buy more: its last answer was cut short.
  [[nodiscard]] bool is_hungry() const noexcept { return hungry_; }

  /// A collision with that share cost so much and went like that. True: it was a turn, of use or the last of a row that
  /// `most` could not satisfy, after which the pair begins again small; so one that needs more than there is takes no
  /// more than some turns from the others. False: the share was too small; the next has to be twice as large.
  bool learn(double share, double cost, Outcome outcome, double most) noexcept;

 private:
  void fall(double cost) noexcept;

  static constexpr double nobody_knows = -1.0;
  double need_ = nobody_knows;
  double starved_at_ = 0.0;  // the most that lately was too little
  bool hungry_ = true;
};

}  // namespace odds::ode
