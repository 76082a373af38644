// The points of a surface over a body's corners and edges, where no corner of the surface itself is deep.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "ode/collide/manifold_points.hpp"
#include "ode/geom/convex_body.hpp"

namespace odds::ode {

/// Corners of the body under the piece, or beside it where sides of the body lean over a little and the triangle goes
/// on: where one dips through a face. `depths`: of each corner the greatest so far.
void add_corners_below(const Piece& piece, const ConvexBody& body, const Vec3& direction, const Features& features,
                       ManifoldPoints& points, std::array<double, Features::most>& depths) noexcept;

/// Whether some corner of the body is not found so deep as it is below `depth` (metres) over the lowest point: the
/// surface ends before it, or falls away.
[[nodiscard]] bool some_are_missed(const ConvexBody& body, const Vec3& direction, const Features& features,
                                   double depth, const std::array<double, Features::most>& depths) noexcept;

/// Edges of the piece over a curved edge of the body: there it is the deepest where its lowest point is beside the
/// piece. Only those deeper than `least`, metres.
void add_curved_crossings(const Piece& piece, const ConvexBody& body, const Vec3& direction, double least,
                          ManifoldPoints& points) noexcept;

/// Edges of a body, seen along a direction.
class EdgesAlong {
 public:
  /// `far`: no point that is asked about is farther from the origin, metres.
  EdgesAlong(const Features& features, const Vec3& direction, double far) noexcept;

  /// Edges of the surface over edges of the body: the deepest place where a ridge lies across an edge.
  void add_crossings(const Piece& piece, ManifoldPoints& points) const noexcept;

 private:
  /// The plane through an edge, along the direction.
  struct Side {
    Vec3 normal;  ///< of the edge's length, seen along the direction
    double offset;
    double length;    ///< of the normal
    double rounding;  ///< of heights above it, in lengths of the normal
    [[nodiscard]] double of(const Vec3& point) const noexcept { return normal.dot(point) - offset; }
    /// Both are clearly on one side.
    [[nodiscard]] bool has_beside(const Vec3& a, const Vec3& b) const noexcept {
      const double of_a = of(a);
      const double of_b = of(b);
      return std::min(of_a, of_b) > rounding || std::max(of_a, of_b) < -rounding;
    }
  };

  void add_crossing(const Vec3& begin, const Vec3& edge, const Features::Edge& own, std::uint32_t triangle,
                    ManifoldPoints& points) const noexcept;

  std::span<const Features::Edge> edges_;
  Vec3 direction_;
  std::array<Side, Features::most> sides_;
};

}  // namespace odds::ode
