// A convex body as its collisions with a mesh see it: sides to cut the surface by, exact extents, corners, edges.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "odds/math/types.hpp"
#include "query/wide/many_sides.hpp"

namespace odds::ode {

/// The points x with normal . x <= offset; `normal` is a unit vector.
struct HalfSpace {
  Vec3 normal = Vec3::Zero();
  double offset = 0.0;
};

/// A triangle cut by the sides of a body, in the body's frame. Not set at first: a collision has room for more than a
/// hundred, and little time. What most have comes first, and so from few lines of the cache.
struct Piece {
  static constexpr std::size_t most_corners = 24;  ///< of more the flattest between two sides of the body are left out
  static constexpr std::int16_t own_edge = -1;
  Vec3 normal;         ///< unit, of the triangle
  double area;         ///< of the piece
  double plane_depth;  ///< of the body's lowest point below the plane of the triangle
  std::size_t count;
  std::uint32_t triangle;
  std::array<std::int16_t, most_corners> side;  ///< of the edge from corner i on: the side of the body that cut it, or
                                                ///< own_edge for an edge of the triangle
  std::array<Vec3, most_corners> corners;
};

/// Directions in which a body may leave a patch of surface.
class ExitList {
 public:
  static constexpr std::size_t most = 96;

  /// `facing`: where the surface faces; zero: all ways.
  explicit ExitList(const Vec3& facing) noexcept : facing_(facing) {}
  /// As it is; not of unit length, zero: left out.
  void add(const Vec3& direction) noexcept {
    const double length = direction.norm();
    if (count_ < most && length > 1e-300) all_[count_++] = direction / length;
  }
  /// With the sign that leads out of the surface; with both if it faces all ways.
  void add_facing(const Vec3& direction) noexcept {
    add(direction.dot(facing_) < 0.0 ? Vec3(-direction) : direction);
    if (facing_.isZero(0.0)) add(-direction);
  }
  [[nodiscard]] std::span<const Vec3> all() const noexcept { return {all_.data(), count_}; }

 private:
  std::array<Vec3, most> all_;
  std::size_t count_ = 0;
  Vec3 facing_;
};

/// Corners and edges of a body that may be the deepest in a surface.
struct Features {
  static constexpr std::size_t most = 48;
  struct Edge {
    Vec3 begin;
    Vec3 end;
    [[nodiscard]] Vec3 along() const noexcept { return end - begin; }
  };
  std::array<Vec3, most> corners;
  std::array<Edge, most> edges;
  std::size_t corner_count = 0;
  std::size_t edge_count = 0;

  void add_corner(const Vec3& corner) noexcept {
    if (corner_count < most) corners[corner_count++] = corner;
  }
  void add_edge(const Vec3& begin, const Vec3& end) noexcept {
    if (edge_count < most) edges[edge_count++] = {begin, end};
  }
};

/// Where a straight line goes over a curved edge.
struct OverEdge {
  double at;     ///< on the line, in lengths of what it was given by
  double depth;  ///< of the edge below it
};

/// All in the body's own frame, metres. Every function is noexcept, without allocation, and may be called from any
/// number of threads.
class ConvexBody {
 public:
  virtual ~ConvexBody() = default;

  /// Half-spaces whose intersection holds the body, and is the body unless it is curved.
  [[nodiscard]] std::span<const HalfSpace> sides() const noexcept { return sides_; }
  /// The same by eight, of a body that has many; else empty.
  [[nodiscard]] std::span<const query::wide::EightSides> many_sides() const noexcept { return many_sides_; }
  [[nodiscard]] const Vec3& center() const noexcept { return center_; }  ///< a point inside
  [[nodiscard]] const Vec3& box_center() const noexcept { return box_center_; }
  [[nodiscard]] const Vec3& box_half_extents() const noexcept { return box_half_extents_; }

  /// Tells bodies of one class and the same extents apart; 0 where there are no two such.
  [[nodiscard]] virtual std::uint64_t number() const noexcept { return 0; }
  /// The point of the body that is farthest along `direction` (any length).
  [[nodiscard]] virtual Vec3 farthest(const Vec3& direction) const noexcept = 0;
  /// The greatest of direction . x over the body.
  [[nodiscard]] double reach(const Vec3& direction) const noexcept { return direction.dot(farthest(direction)); }
  /// How far it is from an inner point along a unit vector to the border; 0 from outside.
  [[nodiscard]] virtual double way_through(const Vec3& point, const Vec3& direction) const noexcept;
  /// The nearest point of the body to one that the sides let pass though a curved body ends before it.
  [[nodiscard]] virtual Vec3 pull_in(const Vec3& point) const noexcept { return point; }
  /// Points of a manifold nearer than this to a deeper one add nothing: a curved body is shallow beside its line of
  /// contact. 0: any may add.
  [[nodiscard]] virtual double crowding() const noexcept { return 0.0; }
  /// Whether a tip may lean so far that a surface above it has it beside the section that the surface makes through the
  /// body. None does of whose faces at a corner no two face away from each other.
  [[nodiscard]] virtual bool may_lean() const noexcept { return false; }
  /// Whether a piece that the sides left over really meets the body.
  [[nodiscard]] virtual bool meets(const Piece&) const noexcept { return true; }
  /// Directions other than the surface's normals in which the body may leave a patch soonest; `refined`: also those
  /// that take some ten microseconds to find.
  virtual void add_exits(std::span<const Piece* const> patch, bool refined, ExitList& exits) const noexcept = 0;
  /// Corners and edges less than `depth` above the lowest point, where `up` (unit) points up.
  virtual void add_features(const Vec3& up, double depth, Features& features) const noexcept = 0;
  /// Where a line, seen along `up` (unit, points up), goes over a curved edge of the body that is low; how many. Those
  /// that are straight are features.
  virtual std::size_t over_curved_edge(const Vec3& /*begin*/, const Vec3& /*along*/, const Vec3& /*up*/,
                                       std::array<OverEdge, 2>& /*over*/) const noexcept {
    return 0;
  }

 protected:
  ConvexBody() = default;
  ConvexBody(const ConvexBody&) = default;
  ConvexBody& operator=(const ConvexBody&) = default;

  std::span<const HalfSpace> sides_;
  std::span<const query::wide::EightSides> many_sides_;
  Vec3 center_ = Vec3::Zero();
  Vec3 box_center_ = Vec3::Zero();
  Vec3 box_half_extents_ = Vec3::Zero();
};

/// Adds the direction that Minkowski portal refinement (libccd, capped iterations, no allocation) finds between the
/// body and the convex hull of a patch: the one between an edge of the body and an edge of the surface, among others.
void add_refined_exit(const ConvexBody& body, std::span<const Piece* const> patch, ExitList& exits) noexcept;

}  // namespace odds::ode
