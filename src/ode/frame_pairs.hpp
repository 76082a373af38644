// Pairs of geoms that a frame remembers: a table of fixed size, searched by both geoms.
#pragma once

#include <ode/ode.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace odds::ode {

struct FramePair {
  dGeomID a = nullptr;  ///< the lesser address; null: free
  dGeomID b = nullptr;
  std::uint64_t seen = 0;     ///< number of the last frame that met it
  std::uint64_t served = 0;   ///< ... that called for it
  std::uint64_t touched = 0;  ///< ... in which it gave contacts; 0: never
  double probability = 0.5;   ///< of a hit, at the last service
  bool proved = false;
  double cost = 0.0;  ///< of the last service: microseconds, or work units
};

/// Finds and makes entries without allocating. An entry that its last frame did not see may be given away.
class FramePairs {
 public:
  explicit FramePairs(std::size_t most_pairs);

  /// The entry of this pair, new if there is none; null where none is free.
  [[nodiscard]] FramePair* at(dGeomID a, dGeomID b, std::uint64_t frame) noexcept;

 private:
  std::vector<FramePair> slots_;  // a power of two; pairs of this frame and of the last fill half of it at most
};

}  // namespace odds::ode
