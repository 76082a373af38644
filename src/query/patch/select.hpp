// From many witnesses to a few: the deepest, then those that span the largest area.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <span>

#include "odds/math/tolerances.hpp"
#include "query/patch/overlap.hpp"
#include "query/patch/watch.hpp"

namespace odds::query::patch {

/// Unit directions in a plane, at angles that no rectangle's sides have, so that a side is never extreme as a whole.
struct Fan {
  static constexpr std::size_t size = 16;
  alignas(64) std::array<double, size> u{};
  alignas(64) std::array<double, size> v{};
  Fan() noexcept;
};

/// The farthest points in these directions, by their numbers. Of equally far ones the first.
struct FanEnds {
  alignas(64) std::array<double, Fan::size> far;
  alignas(64) std::array<double, Fan::size> at{};
  FanEnds() noexcept { far.fill(-std::numeric_limits<double>::infinity()); }
  [[nodiscard]] std::size_t end(std::size_t direction) const noexcept {
    return static_cast<std::size_t>(at[direction]);
  }
};

/// Keeps, out of any number of witnesses, the extreme ones in sixteen fixed directions across the normal and the
/// deepest. The corners of a flat patch are extreme in several directions each, whatever the triangles between them; so
/// what stays does not depend on how a face is cut. Places count from `centre`, half if the overlap has no depth there:
/// the end of a cylinder's lowest line is kept rather than the rim beside it, and yet the far corners of a tilted face.
/// Fixed size.
class Extremes {
 public:
  static constexpr std::size_t at_once = 16;

  Extremes(const Kernels& kernels, const Frame& frame, const Fan& fan, const Vec3& centre,
           const Witness& deepest) noexcept;
  /// Best `at_once` at a time.
  void add(std::span<const Witness> witnesses) noexcept;
  /// Nothing if none were added.
  [[nodiscard]] std::span<const Witness> all() noexcept;

 private:
  const Kernels& kernels_;
  const Frame& frame_;
  const Fan& fan_;
  Vec3 centre_;
  double per_depth_;
  double least_weight_;
  FanEnds ends_;
  std::size_t seen_ = 0;
  std::array<Witness, Fan::size + 1> best_;
  std::array<Witness, Fan::size + 1> found_;
};

/// Witnesses in the order in which they are to be used.
struct Chosen {
  std::array<Witness, most_contacts> witnesses;
  std::size_t count = 0;
};

/// Of contacts nearer to each other one is enough: by the depth of the overlap, and by how far from it the nearer
/// body's weight is, or how wide it is; metres.
[[nodiscard]] inline double spacing(double depth, double lever) noexcept {
  return std::max(tolerances::spacing_by_depth * depth, tolerances::spacing_by_lever * lever);
}

/// How far the nearer body's weight is from a patch, metres: that of large ground may be anywhere.
[[nodiscard]] inline double lever_of(const PatchInput& input, const Vec3& centre) noexcept {
  return std::min((input.reference_a - centre).norm(), (input.reference_b - centre).norm());
}

/// Orders at most `most` of the witnesses: the deepest (of those equally deep to 2 %, one far out), the farthest from
/// it, the one that adds the largest triangle, and so on while the area grows. Leaves out shallow ones and ones nearer
/// to a chosen one than `spacing`. Asks the watch, if any, between two, so that work over several queries can pause
/// there; the answer does not depend on it.
[[nodiscard]] Chosen choose(std::span<const Witness> witnesses, const Frame& frame, std::size_t most, double spacing,
                            Watch* watch = nullptr) noexcept;

/// The deepest; of those equally deep to 2 %, one far from `centre` (up to about `radius`). Precondition: not empty.
[[nodiscard]] Witness deepest_of(std::span<const Witness> witnesses, const Frame& frame, const Vec3& centre,
                                 double radius) noexcept;

/// A witness shallower than a fifth of the deepest moves towards it until it is not, its depth changing linearly: so
/// the border of what counts does not depend on where a mesh has its vertices, and nothing appears or vanishes at a
/// threshold. On flat overlaps that is exact; inside convex ones the true depth is greater.
[[nodiscard]] Witness pulled_in(const Witness& witness, const Witness& deepest) noexcept;

/// All chosen ones as one with the greatest depth: over `centre`, which moves smoothly whichever were chosen, at their
/// mean height.
[[nodiscard]] Witness merged(const Chosen& chosen, const Vec3& normal, const Vec3& centre) noexcept;

}  // namespace odds::query::patch
