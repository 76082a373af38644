// Cutting triangles by a body's sides, and the body's way out of the pieces.
#include "ode/collide/convex_patch.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "ode/geom/convex_shape.hpp"
#include "ode/mesh/triangle_corners.hpp"
#include "query/wide/points_by_eight.hpp"
#include "query/wide/searches.hpp"

namespace odds::ode {
namespace {

// Directions that the surface faces at less than this (cosine) do not lead out of it.
constexpr double least_facing = 0.05;
// A relative margin, so that among equal ways the first one considered wins whatever the rounding.
constexpr double clearly_shorter = 1.0 - 1e-6;
// What it takes to refine an exit, with what comes after it; and to list those of a body with many sides.
constexpr double refining_us = 24.0;
constexpr double listing_us = 3.0;
// More normals than these are compared one by one without asking whether they were tried.
constexpr std::size_t most_remembered = 8;

// What is left of a piece by a cut, which adds one corner at most.
struct Cut {
  std::size_t count = 0;
  std::array<Vec3, Piece::most_corners + 1> corners;
  std::array<std::int16_t, Piece::most_corners + 1> side;

  void add(const Vec3& corner, std::int16_t of_side) noexcept {
    if (count == corners.size()) return;
    corners[count] = corner;
    side[count++] = of_side;
  }
  // Of those between two sides of the body the corner that cuts off least without it. Edges of the triangle stay.
  void drop_flattest() noexcept {
    std::size_t flattest = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t before = (i + count - 1) % count;
      if (side[before] == Piece::own_edge || side[i] == Piece::own_edge) continue;
      const double area = (corners[i] - corners[before]).cross(corners[(i + 1) % count] - corners[i]).squaredNorm();
      if (area < least) {
        least = area;
        flattest = i;
      }
    }
    std::copy(corners.begin() + static_cast<std::ptrdiff_t>(flattest) + 1,
              corners.begin() + static_cast<std::ptrdiff_t>(count),
              corners.begin() + static_cast<std::ptrdiff_t>(flattest));
    std::copy(side.begin() + static_cast<std::ptrdiff_t>(flattest) + 1,
              side.begin() + static_cast<std::ptrdiff_t>(count), side.begin() + static_cast<std::ptrdiff_t>(flattest));
    --count;
  }
};

// Keeps the part of the piece in the half-space (Sutherland and Hodgman 1974). False if that is all of it.
bool cut(Piece& piece, const HalfSpace& half_space, std::int16_t number) noexcept {
  std::array<double, Piece::most_corners> above;
  bool any_above = false;
  for (std::size_t i = 0; i < piece.count; ++i) {
    above[i] = half_space.normal.dot(piece.corners[i]) - half_space.offset;
    any_above = any_above || above[i] > 0.0;
  }
  if (!any_above) return false;
  Cut kept;
  for (std::size_t i = 0; i < piece.count; ++i) {
    const std::size_t next = (i + 1) % piece.count;
    const Vec3& a = piece.corners[i];
    const Vec3& b = piece.corners[next];
    const auto crossing = [&]() -> Vec3 { return a + (above[i] / (above[i] - above[next])) * (b - a); };
    if (above[i] <= 0.0) {
      kept.add(a, piece.side[i]);
      if (above[next] > 0.0) kept.add(crossing(), number);
    } else if (above[next] <= 0.0) {
      kept.add(crossing(), piece.side[i]);
    }
  }
  if (kept.count > Piece::most_corners) kept.drop_flattest();
  piece.count = kept.count;
  std::copy_n(kept.corners.begin(), kept.count, piece.corners.begin());
  std::copy_n(kept.side.begin(), kept.count, piece.side.begin());
  return true;
}

// As sides in turn do, but most of them are passed over.
void cut_by_many(Piece& piece, const ConvexBody& body) noexcept {
  using query::wide::EightSides;
  Ball ball(piece);
  std::array<std::uint8_t, ConvexShape::most_faces / EightSides::count> near;
  const query::wide::Searches& kernels = *query::wide::searches_for(query::InstructionSet::best);
  if (!kernels.sides_near(body.many_sides(), ball.center, ball.radius, near.data())) piece.count = 0;
  for (std::size_t eight = 0; eight < body.many_sides().size() && piece.count >= 3; ++eight) {
    for (unsigned lanes = near[eight]; lanes != 0 && piece.count >= 3; lanes &= lanes - 1) {
      const std::size_t i = EightSides::count * eight + static_cast<std::size_t>(std::countr_zero(lanes));
      const HalfSpace& side = body.sides()[i];
      const double height = side.normal.dot(ball.center) - side.offset;
      if (height <= -ball.radius) continue;
      if (height > ball.radius) {
        piece.count = 0;
      } else if (cut(piece, side, static_cast<std::int16_t>(i)) && piece.count >= 3) {
        ball = Ball(piece);
      }
    }
  }
}

// Ways out of a patch. What bars one way bars most others that are no shorter: it is asked first, then the piece that
// seems to be the deepest.
class Ways {
 public:
  Ways(std::span<const Piece* const> patch, const ConvexBody& body) noexcept : patch_(patch), body_(body) {
    for (const Piece* piece : patch.first(std::min(patch.size(), most_samples))) samples_.add(piece->corners[0], 0.0);
  }

  // How far the body must go along `direction` to be clear of the patch; infinity if it is not less than `enough`.
  double depth_along(const Vec3& direction, double enough) noexcept {
    const auto bars = [&](const Piece& piece, double lowest) { return !(depth_of(piece, direction, lowest) < enough); };
    // No point of the body is lower than its lowest.
    if (barring_ < patch_.size() && bars(*patch_[barring_], direction.dot(low_))) return no_way;
    low_ = body_.farthest(-direction);
    const double lowest = direction.dot(low_);
    const std::uint32_t deepest = kernels_.outermost_along(samples_.all(), direction, 0.0, 0.0, 1);
    if (deepest != query::no_feature && bars(*patch_[deepest], lowest)) {
      barring_ = deepest;
      return no_way;
    }
    double depth = 0.0;
    for (std::size_t i = 0; i < patch_.size(); ++i) {
      depth = std::max(depth, depth_of(*patch_[i], direction, lowest));
      if (depth < enough) continue;
      barring_ = i;
      return no_way;
    }
    return depth;
  }

 private:
  static constexpr std::size_t most_samples = 128;
  static constexpr double no_way = std::numeric_limits<double>::infinity();
  [[nodiscard]] double depth_of(const Piece& piece, const Vec3& direction, double lowest) const noexcept {
    double depth = 0.0;
    bool goes_on_ahead = false;
    for (std::size_t i = 0; i < piece.count; ++i) {
      depth = std::max(depth, direction.dot(piece.corners[i]) - lowest);
      const std::int16_t side = piece.side[i];
      goes_on_ahead = goes_on_ahead || (side != Piece::own_edge &&
                                        body_.sides()[static_cast<std::size_t>(side)].normal.dot(direction) > 1e-9);
    }
    if (!goes_on_ahead) return depth;
    const double facing = direction.dot(piece.normal);
    return facing < least_facing ? no_way : std::max(depth, piece.plane_depth / facing);
  }

  std::span<const Piece* const> patch_;
  const ConvexBody& body_;
  std::size_t barring_ = std::numeric_limits<std::size_t>::max();
  Vec3 low_ = Vec3::Zero();  // a point of the body
  const query::wide::Searches& kernels_ = *query::wide::searches_for(query::InstructionSet::best);
  query::wide::PointsByEight<most_samples> samples_;  // a corner of each piece, the largest first
};

// Zero where they nearly cancel each other, as those of a mesh wholly within the body do, or of a plate that goes
// through it: what is left of them is rounding, or one side's being a little larger.
Vec3 mean_normal(std::span<const Piece* const> patch) noexcept {
  constexpr double cancelled = 0.2;  // of the area
  Vec3 sum = Vec3::Zero();
  double area = 0.0;
  for (const Piece* piece : patch) {
    sum += piece->area * piece->normal;
    area += piece->area;
  }
  const double length = sum.norm();
  return length > cancelled * area ? Vec3(sum / length) : Vec3(Vec3::Zero());
}

// How far the body's lowest point is below the plane in the middle of the patch.
double depth_below_middle(const Vec3& mean, std::span<const Piece* const> patch, const ConvexBody& body) noexcept {
  double height = 0.0;
  double area = 0.0;
  for (const Piece* piece : patch) {
    double sum = 0.0;
    for (std::size_t i = 0; i < piece->count; ++i) sum += mean.dot(piece->corners[i]);
    height += piece->area * sum / static_cast<double>(piece->count);
    area += piece->area;
  }
  return height / area + body.reach(-mean);
}

}  // namespace

bool cut_triangle(const PreparedMesh& mesh, std::uint32_t triangle, const math::Pose& mesh_in_body,
                  const ConvexBody& body, std::uint64_t sides, Piece& piece) noexcept {
  Corners corners = mesh.corners(triangle);
  for (Vec3& corner : corners) corner = mesh_in_body * corner;
  piece.triangle = triangle;
  piece.count = 3;
  for (std::size_t i = 0; i < 3; ++i) {
    piece.corners[i] = corners[i];
    piece.side[i] = Piece::own_edge;
  }
  if (has_many_sides(body)) {
    cut_by_many(piece, body);
  } else {
    for (; sides != 0 && piece.count >= 3; sides &= sides - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(sides));
      if (i >= body.sides().size()) break;
      cut(piece, body.sides()[i], static_cast<std::int16_t>(i));
    }
  }
  if (piece.count < 3) return false;
  piece.normal = unit_normal(corners);
  Vec3 twice_area = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < piece.count; ++i) {
    twice_area += (piece.corners[i] - piece.corners[0]).cross(piece.corners[i + 1] - piece.corners[0]);
  }
  piece.area = 0.5 * twice_area.norm();
  if (!(piece.area > 0.0) || piece.normal == Vec3::Zero() || !body.meets(piece)) return false;
  piece.plane_depth = piece.normal.dot(piece.corners[0]) + body.reach(-piece.normal);
  return true;
}

Exit shortest_exit(std::span<const Piece* const> patch, const ConvexBody& body, bool goes_on,
                   const Limit& limit) noexcept {
  const Vec3 mean = mean_normal(patch);
  const bool faces_all_ways = mean.isZero(0.0);
  Exit best = {faces_all_ways ? patch.front()->normal : mean, std::numeric_limits<double>::infinity()};
  const double beyond = goes_on && !faces_all_ways ? depth_below_middle(mean, patch, body) : 0.0;
  Ways ways(patch, body);
  const auto consider = [&](const Vec3& direction) {
    const double facing = direction.dot(mean);
    if (!faces_all_ways && facing < least_facing) return;
    const double enough = best.depth * clearly_shorter;
    const double least = beyond > 0.0 ? beyond / facing : 0.0;
    if (!(least < enough)) return;
    const double depth = std::max(least, ways.depth_along(direction, enough));
    if (depth < enough) best = {direction, depth};
  };
  // The surface's own normals first: they win every tie.
  std::array<Vec3, most_remembered> tried;
  std::size_t tried_count = 0;
  for (const Piece* piece : patch) {
    const auto seen = [piece](const Vec3& normal) { return normal.dot(piece->normal) > 1.0 - 1e-9; };
    if (std::any_of(tried.begin(), tried.begin() + tried_count, seen)) continue;
    if (tried_count > 0 && limit.time_is_up(time_for_exits)) break;
    consider(piece->normal);
    if (tried_count < tried.size()) tried[tried_count++] = piece->normal;
  }
  if (!limit.has_time_left(has_many_sides(body) ? listing_us : 0.0, time_for_exits)) return best;
  ExitList exits(mean);
  body.add_exits(patch, limit.has_time_left(refining_us), exits);
  for (const Vec3& direction : exits.all()) {
    if (limit.time_is_up(time_for_exits)) break;
    consider(direction);
  }
  return best;
}

}  // namespace odds::ode
