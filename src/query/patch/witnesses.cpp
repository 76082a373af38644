#include "query/patch/witnesses.hpp"

#include <algorithm>
#include <limits>

#include "odds/math/random.hpp"
#include "query/patch/eight.hpp"

namespace odds::query::patch {
namespace {

/// Where a patch ends in the directions of the fan: positions in `indices`. At least sixteen pieces are looked at,
/// however late it is.
using Ends = std::array<std::size_t, Fan::size>;

Ends find_ends(const Kernels& kernels, const Rim& rim, std::span<const std::uint32_t> indices, const Frame& frame,
               const Fan& fan, const Vec3& centre, Watch& watch) noexcept {
  constexpr std::size_t at_once = 16;
  std::array<double, at_once> u;
  std::array<double, at_once> v;
  FanEnds farthest;
  for (std::size_t first = 0; first < indices.size() && !(first != 0 && watch.late()); first += at_once) {
    const std::size_t count = std::min(at_once, indices.size() - first);
    for (std::size_t i = 0; i < count; ++i) {
      // The middle: both ends of a piece belong to its neighbours too.
      const Vec3 out = rim.pieces[indices[first + i]].middle() - centre;
      u[i] = frame.u.dot(out);
      v[i] = frame.v.dot(out);
    }
    kernels.farthest(u.data(), v.data(), count, first, fan, farthest);
  }
  Ends ends;
  for (std::size_t d = 0; d < Fan::size; ++d) ends[d] = farthest.end(d);
  std::sort(ends.begin(), ends.end());
  return ends;
}

}  // namespace

std::span<const std::uint32_t> Telling::of(const Kernels& kernels, const Rim& rim,
                                           std::span<const std::uint32_t> indices, const Frame& frame, const Fan& fan,
                                           const Vec3& centre, Watch& watch) noexcept {
  if (indices.size() <= few) return indices;
  const Ends ends = find_ends(kernels, rim, indices, frame, fan, centre, watch);
  const std::uint64_t share = std::numeric_limits<std::uint64_t>::max() / indices.size() * sampled;
  std::size_t count = 0;
  std::size_t next_end = 0;
  for (std::size_t i = 0; i < indices.size() && !(watch.late_in_small_steps(i) && count > 0); ++i) {
    bool tells = false;
    for (; next_end < ends.size() && ends[next_end] == i; ++next_end) tells = true;
    if (!tells) {
      const TrianglePair& index = rim.pairs[rim.pieces[indices[i]].pair].index;
      tells = math::scramble((std::uint64_t{index.a} << 32U) | index.b) < share;
    }
    if (tells) chosen_[count++] = indices[i];
  }
  return {chosen_.data(), count};
}

std::span<const std::uint32_t> Telling::ends_of(const Kernels& kernels, const Rim& rim,
                                                std::span<const std::uint32_t> indices, const Frame& frame,
                                                const Fan& fan, const Vec3& centre, Watch& watch) noexcept {
  const Ends ends = find_ends(kernels, rim, indices, frame, fan, centre, watch);
  std::size_t count = 0;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    if (i == 0 || ends[i] != ends[i - 1]) chosen_[count++] = indices[ends[i]];
  }
  return {chosen_.data(), count};
}

}  // namespace odds::query::patch
