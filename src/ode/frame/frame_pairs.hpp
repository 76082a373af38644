// Pairs of geoms that a frame remembers: tables of fixed size, searched by both geoms.
#pragma once

#include <ode/ode.h>

#include <cstdint>
#include <vector>

#include "ode/frame/frame_need.hpp"

namespace odds::ode {

struct FramePair {
  dGeomID a = nullptr;  ///< the lesser address
  dGeomID b = nullptr;
  std::uint64_t seen = 0;     ///< number of the frame that met it
  std::uint64_t served = 0;   ///< ... of the last in which it had its turn; of one before its first, if it had none
  std::uint64_t touched = 0;  ///< ... of the last in which it gave contacts; 0: never
  double probability = 0.5;   ///< of a hit, at the last service
  bool proved = false;
  bool touches = false;  ///< the last call gave contacts
  FrameNeed need;
};

/// Finds and makes entries without allocating. A pair that a frame does not meet is forgotten with that frame. What is
/// remembered does not depend on where the geoms lie in memory.
class FramePairs {
 public:
  explicit FramePairs(std::size_t most_pairs);

  /// From here on `at` makes the entries of the next frame, out of those of the last.
  void begin_frame() noexcept;
  [[nodiscard]] std::uint64_t frame() const noexcept { return frame_; }

  /// The entry of this pair in this frame: its own, until the next one begins. At most `most_pairs` different ones.
  [[nodiscard]] FramePair& at(dGeomID a, dGeomID b) noexcept;

  /// No need is known any more.
  void forget_needs() noexcept;

 private:
  // Each of a power of two, half full at most. An entry that another frame has seen is free.
  std::vector<FramePair> now_;
  std::vector<FramePair> before_;
  std::uint64_t frame_ = 1;
};

}  // namespace odds::ode
