// Which pairs of a patch are asked for the corners of their overlap.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "query/patch/components.hpp"
#include "query/patch/rim.hpp"
#include "query/patch/select.hpp"
#include "query/patch/watch.hpp"

namespace odds::query::patch {

/// A patch of many pairs is judged by some of them: by those at its extremes, which are its corners, and by a share of
/// the others. A pair is in the share by its own two triangles alone, not by its place in a list: from tick to tick the
/// same ones speak, and contacts do not flicker.
class Telling {
 public:
  static constexpr std::size_t few = 96;                    ///< patches of up to so many pieces are heard whole
  static constexpr std::size_t sampled = 64;                ///< about so many of the others beside the extremes
  static constexpr std::size_t most = 4 * (few + sampled);  ///< chosen, and then some

  explicit Telling(std::size_t most_pieces) : chosen_(most_pieces) {}

  /// Pieces of the patch whose pairs are to be asked, in the order of `indices`; valid until the next call; fewer if
  /// it is late. `centre`: of the patch.
  [[nodiscard]] std::span<const std::uint32_t> of(const Kernels& kernels, const Rim& rim,
                                                  std::span<const std::uint32_t> indices, const Frame& frame,
                                                  const Fan& fan, const Vec3& centre, Watch& watch) noexcept;

  /// Only those at the extremes, at least one. Precondition: `indices` is not empty.
  [[nodiscard]] std::span<const std::uint32_t> ends_of(const Kernels& kernels, const Rim& rim,
                                                       std::span<const std::uint32_t> indices, const Frame& frame,
                                                       const Fan& fan, const Vec3& centre, Watch& watch) noexcept;

 private:
  std::vector<std::uint32_t> chosen_;
};

}  // namespace odds::query::patch
