// Faces of one body that form a concave corner, as a floor and its walls do, and what of a patch lies on each.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "query/patch/components.hpp"
#include "query/patch/overlap.hpp"
#include "query/patch/watch.hpp"

namespace odds::query::patch {

/// What is asked of a piece of rim for every face.
struct CornerPiece {
  Vec3 normal;  ///< out of the body; of a sheet, to the side on which the other body is
  Vec3 place;   ///< of its middle, from the rim's origin
  double length;
  double cosine;  ///< to the normal that its face was begun with
  std::uint32_t face;
  bool counts;
  bool tells;  ///< where a face is: it is no copy, nor a point
};

/// A face, flat or bent, that some of a rim is on.
struct CornerFace {
  ExitRange exit;              ///< between which heights it lies along the mean of its normals, out of the body
  Vec3 moment = Vec3::Zero();  ///< of the pieces that tell, as in RimSums
  double length = 0.0;
  RimSums sums;            ///< of the same, once there are two sides
  double spread = 0.0;     ///< radians; the largest angle between a normal and the mean
  std::size_t pieces = 0;  ///< how many
};

/// One side of the corner: a face, or several about an edge, as of a pillar on a floor.
struct CornerSide {
  RimSums sums;
  std::size_t pieces = 0;
  std::size_t faces = 0;
  Vec3 outwards = Vec3::Zero();  ///< unit; of its first face
};

/// The sides of a concave corner that a patch lies in.
///
/// What reaches into such a corner overlaps each of its sides by as much as it likes, and in one curve. No one
/// direction leads out of that: along the floor's normal the overlap with the wall is as high as the wall.
class ConcaveCorner {
 public:
  static constexpr std::size_t most = 8;  ///< faces that are told apart

  /// Whether the faces of one body may form one, as far as sums say.
  [[nodiscard]] static bool may_be_of(bool of_b, const PatchInput& input, const RimSums& sums) noexcept;

  /// `room`: for as many pieces as `find` is given.
  ConcaveCorner(bool of_b, const PatchInput& input, const Components& components, const Rim& rim, const RimSums& sums,
                std::span<CornerPiece> room) noexcept
      : of_b_(of_b), input_(input), components_(components), rim_(rim), sums_(sums), told_(room) {}

  /// Finds the faces of the body on which the pieces, all of that rim, lie: bundles of normals, far apart from each
  /// other, and of flat faces also levels. Two are one side where they meet at an edge, neither in front of the other,
  /// or where the bundles are wide: a surface that bends smoothly is not cut in two. False if there is no more than one
  /// side, or the time is up. Otherwise sorts `pieces` by sides; what has no normal comes last, and is on none.
  bool find(std::span<std::uint32_t> pieces, Watch& watch) noexcept;

  [[nodiscard]] std::span<const CornerSide> sides() const noexcept { return {sides_.data(), side_count_}; }
  /// Whether each side is a face that lies in front of all others. Else it may be one that stands on another, as a
  /// pillar does.
  [[nodiscard]] bool is_of_faces() const noexcept;
  /// What a side's lines leave the body through: its face; or, of several faces, at least in front of the others that
  /// all of it is in front of.
  [[nodiscard]] ExitRanges exits_of(std::size_t side, std::array<ExitRange, most>& room) const noexcept;

 private:
  using Pieces = std::span<const std::uint32_t>;

  [[nodiscard]] Vec3 normal_of(const RimPiece& piece) const noexcept;
  void look_up(Pieces pieces, Watch& watch) noexcept;
  bool seed(Watch& watch) noexcept;
  [[nodiscard]] bool any_in_front(Watch& watch) const noexcept;
  void gather(Watch& watch) noexcept;
  [[nodiscard]] double diagonal_of(std::size_t face, Pieces pieces, Watch& watch) const noexcept;
  bool part_levels(Pieces pieces, Watch& watch) noexcept;
  void compare(Pieces pieces, Watch& watch) noexcept;
  [[nodiscard]] bool are_wide(std::size_t i, std::size_t j) const noexcept;
  [[nodiscard]] bool are_one_side(std::size_t i, std::size_t j) const noexcept;
  template <class AreOne>
  std::size_t join(const AreOne& are_one) noexcept;
  void sum_up(Pieces pieces, Watch& watch) noexcept;

  bool of_b_;
  const PatchInput& input_;
  const Components& components_;
  const Rim& rim_;
  const RimSums& sums_;
  std::span<CornerPiece> told_;
  std::array<CornerFace, most> faces_;
  std::array<CornerSide, most> sides_;
  std::array<std::uint32_t, most + 1> side_of_{};              ///< of each face, and of no face
  std::array<std::array<bool, most>, most> is_in_front_of_{};  ///< the first of the second
  std::array<std::array<bool, most + 1>, most + 1> meet_{};    ///< along the rim
  std::size_t count_ = 0;
  std::size_t side_count_ = 0;
};

}  // namespace odds::query::patch
