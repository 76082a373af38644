// Where an overlap is deepest along a direction, found from a few places where it was measured.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "query/patch/components.hpp"
#include "query/patch/overlap.hpp"

namespace odds::query::patch {

/// What is known of a surface that is convex towards one side: the planes of triangles that were met. No place of it is
/// higher than the lowest of them.
class Roof {
 public:
  /// Across the normal, metres from an origin.
  struct Place {
    double u;
    double v;
  };
  struct Plane {
    double height;  ///< metres over the origin
    Place slope;
    std::uint32_t triangle;
    [[nodiscard]] double at(const Place& place) const noexcept {
      return height + slope.u * place.u + slope.v * place.v;
    }
  };
  static constexpr std::size_t most = 24;

  /// Of a triangle that is known already nothing new; one too many is left out.
  void add(const Plane& plane) noexcept;
  /// Leaves out the planes that are below a place of the surface by more than rounding: it is not convex there.
  void leave_out_below(const Place& place, double height, double rounding) noexcept;
  /// Infinite where nothing is known.
  [[nodiscard]] double at(const Place& place) const noexcept;
  /// Of the lowest plane there, squared.
  [[nodiscard]] double steepness(const Place& place) const noexcept;
  [[nodiscard]] const Plane* begin() const noexcept { return planes_.data(); }
  [[nodiscard]] const Plane* end() const noexcept { return planes_.data() + count_; }

 private:
  std::array<Plane, most> planes_;
  std::size_t count_ = 0;
};

/// Of two convex surfaces the depth of the overlap is a concave function of the place: each ray bounds it by the planes
/// of the two triangles that it met. The next ray goes to where these allow the greatest depth (Kelley, The
/// cutting-plane method for solving convex programs, SIAM 1960), until that is no deeper than what was measured.
class Summit {
 public:
  /// `centre`: near the patch. `sums`: of its rim. `exits`: of what counts. All must outlive this.
  Summit(const PatchInput& input, const Frame& frame, const Vec3& centre, const RimSums& sums,
         ExitRanges exits) noexcept
      : input_(input), frame_(frame), centre_(centre), sums_(sums), exits_(exits) {}

  /// Whether an overlap of that depth within the rim may be at a place: no farther from the rim's box than it is deep,
  /// and where it is flat only along the normal. Under a wall's foot begins the floor.
  [[nodiscard]] bool may_be_at(const Vec3& place, double depth) const noexcept;

  /// Something that was measured; also of bodies that are apart there.
  void add(const Witness& measured) noexcept;

  /// The deepest place that is found from `start`, which was added, by a few rays of length `reach`, in steps of up to
  /// `radius`; at least `start`. Where no way leads on from there, goes on from another witness, `beside` it.
  [[nodiscard]] Witness climb(const Witness& start, const Witness& beside, double radius, double reach,
                              Watch& watch) noexcept;

 private:
  [[nodiscard]] Roof::Place place_of(const Vec3& point) const noexcept;
  [[nodiscard]] double height_of(const Vec3& point) const noexcept { return frame_.normal.dot(point - centre_); }
  [[nodiscard]] bool is_flat(double depth) const noexcept;
  /// Casts the rays that should meet both surfaces there.
  bool measure(const Roof::Place& place, const Witness& best, bool may_lean, double reach, Watch& watch,
               Witness& found) noexcept;
  /// No overlap is deeper there, as far as is known.
  [[nodiscard]] double allowed_at(const Roof::Place& place) const noexcept { return of_a_.at(place) + of_b_.at(place); }
  [[nodiscard]] double rounding_of(double radius) const noexcept;
  /// Where what is known allows the greatest depth, up to `radius` away along each axis.
  [[nodiscard]] Roof::Place highest(const Roof::Place& from, double radius, Watch& watch) const noexcept;

  const PatchInput& input_;
  const Frame& frame_;
  const Vec3& centre_;
  const RimSums& sums_;
  ExitRanges exits_;
  Roof of_b_;  ///< heights of B's upper side
  Roof of_a_;  ///< of A's lower side, upside down: the depth is the sum of both
};

}  // namespace odds::query::patch
