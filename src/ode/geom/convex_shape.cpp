// Checking and searching convex polyhedra.
#include "ode/geom/convex_shape.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

#include "query/wide/searches.hpp"

namespace odds::ode {
namespace {

constexpr double same_plane = 1e-6;  // of the size: rounding of the client's arrays
constexpr std::size_t most_face_exits = 32;
constexpr std::size_t most_uncut_exits = 12;
constexpr std::size_t few_directions = 6;  // of edges: a tetrahedron's

Error refusal(const std::string& what, const std::string& remedy) { return {"convex", "", what, remedy}; }

}  // namespace

Result<HalfSpace> ConvexShape::face_of(std::span<const Vec3> points, std::span<const unsigned> corners,
                                       const Vec3& inside, std::size_t number) {
  Vec3 twice_area = Vec3::Zero();
  Vec3 middle = Vec3::Zero();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3& a = points[corners[i]];
    const Vec3& b = points[corners[(i + 1) % corners.size()]];
    twice_area += (a - inside).cross(b - inside);
    middle += a / static_cast<double>(corners.size());
  }
  const double length = twice_area.norm();
  if (!(length > 0.0)) {
    return refusal("face " + std::to_string(number) + " has no area", "leave it out");
  }
  // Clockwise faces are welcome: outwards is away from the inner point.
  const double sign = twice_area.dot(middle - inside) < 0.0 ? -1.0 : 1.0;
  HalfSpace face;
  face.normal = sign / length * twice_area;
  face.offset = face.normal.dot(middle);
  return face;
}

ConvexShape::ConvexShape() noexcept {
  static constinit std::atomic<std::uint64_t> last{0};
  number_ = last.fetch_add(1, std::memory_order_relaxed) + 1;
}

Result<std::shared_ptr<const ConvexShape>> ConvexShape::make(std::span<const Vec3> points, const unsigned* polygons,
                                                             std::size_t face_count) {
  if (polygons == nullptr || points.size() < 4 || points.size() > most_points || face_count < 4 ||
      face_count > most_faces) {
    return refusal("null array, or not 4 .. 4096 points and 4 .. 1024 faces", "give the arrays of dCreateConvex");
  }
  Vec3 lower = points[0];
  Vec3 upper = points[0];
  Vec3 sum = Vec3::Zero();
  for (const Vec3& point : points) {
    if (!point.allFinite()) return refusal("a point is not finite", "check the coordinates");
    lower = lower.cwiseMin(point);
    upper = upper.cwiseMax(point);
    sum += point;
  }
  const std::shared_ptr<ConvexShape> shape(new ConvexShape);
  shape->points_.assign(points.begin(), points.end());
  shape->center_ = sum / static_cast<double>(points.size());
  const double size = (upper - lower).norm();
  for (std::size_t f = 0; f < face_count; ++f) {
    const std::span<const unsigned> corners(polygons + 1, *polygons);
    const auto out_of_range = [&](unsigned corner) { return corner >= points.size(); };
    if (corners.size() < 3 || corners.size() > points.size() ||
        std::any_of(corners.begin(), corners.end(), out_of_range)) {
      return refusal("face " + std::to_string(f) + " has too few corners or an index out of range",
                     "polygons is, for each face, a count followed by as many indices");
    }
    Result<HalfSpace> face = face_of(points, corners, shape->center_, f);
    if (!face.ok()) return face.error();
    for (const Vec3& point : points) {
      if (face.value().normal.dot(point) - face.value().offset > same_plane * size) {
        return refusal("it is not convex: a point lies outside of face " + std::to_string(f), "use a mesh instead");
      }
    }
    const auto same = [&](const HalfSpace& other) {
      return face.value().normal.dot(other.normal) > 1.0 - 1e-12;  // of a convex body, so it is the same plane
    };
    if (std::none_of(shape->faces_.begin(), shape->faces_.end(), same)) shape->faces_.push_back(face.value());
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const auto [from, to] = std::minmax(corners[i], corners[(i + 1) % corners.size()]);
      shape->edges_.push_back({from, to});
    }
    polygons += 1 + corners.size();
  }
  std::sort(shape->edges_.begin(), shape->edges_.end());
  if (const auto open = shape->open_edge(same_plane * size)) {
    return refusal("it is not closed: the edge of points " + std::to_string((*open)[0]) + " and " +
                       std::to_string((*open)[1]) + " is on one face only",
                   "give all faces");
  }
  shape->edges_.erase(std::unique(shape->edges_.begin(), shape->edges_.end()), shape->edges_.end());
  for (const auto& [from, to] : shape->edges_) {
    const Vec3 direction = (points[to] - points[from]).normalized();
    const auto parallel = [&](const Vec3& other) { return std::abs(direction.dot(other)) > 1.0 - 1e-12; };
    auto& known = shape->edge_directions_;
    if (known.size() <= few_directions && std::none_of(known.begin(), known.end(), parallel))
      known.push_back(direction);
  }
  const auto beside_center = [&](const HalfSpace& face) { return face.offset - face.normal.dot(shape->center_); };
  const auto has_volume = [&](const HalfSpace& face) { return beside_center(face) > same_plane * size; };
  if (!std::all_of(shape->faces_.begin(), shape->faces_.end(), has_volume)) {
    return refusal("it has no volume", "give a solid");
  }
  for (const Vec3& point : points) {
    std::vector<Vec3> normals;
    for (const HalfSpace& face : shape->faces_) {
      if (std::abs(face.normal.dot(point) - face.offset) <= same_plane * size) normals.push_back(face.normal);
    }
    for (const Vec3& a : normals) {
      const auto faces_away = [&a](const Vec3& b) { return a.dot(b) < -same_plane; };
      shape->leans_ = shape->leans_ || std::any_of(normals.begin(), normals.end(), faces_away);
    }
  }
  shape->sides_ = shape->faces_;
  shape->box_center_ = 0.5 * (lower + upper);
  shape->box_half_extents_ = 0.5 * (upper - lower);
  shape->prepare_climbing();
  shape->prepare_many_sides();
  return std::shared_ptr<const ConvexShape>(shape);
}

// An edge is on two polygons, or on two planes: faces that are parted need not share corners. Where a face is missing,
// the sides hold more than the body, up to infinity.
std::optional<std::array<unsigned, 2>> ConvexShape::open_edge(double tolerance) const noexcept {
  const auto is_on = [&](const HalfSpace& face, unsigned corner) {
    return std::abs(face.normal.dot(points_[corner]) - face.offset) <= tolerance;
  };
  for (auto edge = edges_.begin(); edge != edges_.end();) {
    const auto next = std::upper_bound(edge, edges_.end(), *edge);
    const auto planes = std::count_if(faces_.begin(), faces_.end(), [&](const HalfSpace& face) {
      return next - edge == 1 && is_on(face, (*edge)[0]) && is_on(face, (*edge)[1]);
    });
    if (next - edge == 1 && planes < 2) return *edge;
    edge = next;
  }
  return std::nullopt;
}

Vec3 ConvexShape::farthest(const Vec3& direction) const noexcept {
  if (climbs_) return points_[climb(direction)];
  const Vec3* best = &points_.front();
  double greatest = direction.dot(*best);
  for (const Vec3& point : points_) {
    const double value = direction.dot(point);
    if (value <= greatest) continue;
    greatest = value;
    best = &point;
  }
  return *best;
}

// Of a convex body no corner is lower than all its neighbours but the lowest.
unsigned ConvexShape::climb(const Vec3& direction) const noexcept {
  unsigned at = starts_[start_of(direction)];
  double greatest = direction.dot(points_[at]);
  for (bool higher = true; higher;) {
    higher = false;
    const unsigned from = at;
    for (unsigned i = neighbours_at_[from]; i < neighbours_at_[from + 1]; ++i) {
      const double value = direction.dot(points_[neighbours_[i]]);
      if (!(value > greatest)) continue;
      greatest = value;
      at = neighbours_[i];
      higher = true;
    }
  }
  return at;
}

// By the greatest component, and the halves of the others.
std::size_t ConvexShape::start_of(const Vec3& direction) noexcept {
  Eigen::Index axis = 0;
  const double most = direction.cwiseAbs().maxCoeff(&axis);
  const auto part = [&](Eigen::Index other) {
    const double part_of_most = direction[other];
    return part_of_most < -0.5 * most ? 0U : part_of_most < 0.0 ? 1U : part_of_most < 0.5 * most ? 2U : 3U;
  };
  const std::size_t side = 2U * static_cast<std::size_t>(axis) + (direction[axis] < 0.0 ? 1U : 0U);
  return (side * 4U + part((axis + 1) % 3)) * 4U + part((axis + 2) % 3);
}

// Whether climbing along edges finds what looking at all points does: not where faces are parted and share no corners,
// nor where a face is a little dented.
void ConvexShape::prepare_climbing() {
  constexpr std::size_t few_points = 32;
  if (points_.size() <= few_points) return;
  neighbours_at_.assign(points_.size() + 1, 0);
  for (const auto& [a, b] : edges_) {
    ++neighbours_at_[a + 1];
    ++neighbours_at_[b + 1];
  }
  std::partial_sum(neighbours_at_.begin(), neighbours_at_.end(), neighbours_at_.begin());
  neighbours_.resize(2 * edges_.size());
  std::vector<unsigned> next(neighbours_at_.begin(), neighbours_at_.end() - 1);
  for (const auto& [a, b] : edges_) {
    neighbours_[next[a]++] = b;
    neighbours_[next[b]++] = a;
  }
  const double size = box_half_extents_.norm();
  const auto finds = [&](const Vec3& direction) {
    const double error = direction.dot(farthest(direction) - points_[climb(direction)]);
    return error <= 1e-12 * size * direction.norm();
  };
  starts_.fill(edges_.front()[0]);
  std::array<bool, start_count> is_set{};
  bool all = true;
  const auto look = [&](const Vec3& direction) {
    all = all && finds(direction);
    const std::size_t start = start_of(direction);
    if (!is_set[start]) starts_[start] = climb(direction);
    is_set[start] = true;
  };
  for (const HalfSpace& face : faces_) {
    look(face.normal);
    look(-face.normal);
  }
  for (const Vec3& point : points_) look(point - center_);
  climbs_ = all;
}

// Of few sides each says itself whether it cuts a triangle.
void ConvexShape::prepare_many_sides() {
  constexpr std::size_t few_sides = 32;
  if (faces_.size() <= few_sides) return;
  using query::wide::EightSides;
  faces_by_eight_.resize((faces_.size() + EightSides::count - 1) / EightSides::count);
  for (std::size_t i = 0; i < faces_.size(); ++i) {
    faces_by_eight_[i / EightSides::count].set(i % EightSides::count, faces_[i].normal, faces_[i].offset);
  }
  many_sides_ = faces_by_eight_;
}

double ConvexShape::way_through(const Vec3& point, const Vec3& direction) const noexcept {
  if (many_sides_.empty()) return ConvexBody::way_through(point, direction);
  return query::wide::searches_for(query::InstructionSet::best)->way_out(many_sides_, point, direction);
}

// Across an edge of the surface and one of the body: of a body that has few directions of edges, any of them, as of a
// box; else the edge of two faces that both cut a piece. (What the refinement finds alone is often a longer way.)
void ConvexShape::add_crossings(std::span<const Piece* const> patch, ExitList& exits) const noexcept {
  constexpr std::size_t most_edges = 8;  // of the surface; more add nothing but time
  std::size_t edges = 0;
  for (const Piece* piece : patch) {
    for (std::size_t i = 0; i < piece->count; ++i) {
      if (piece->side[i] != Piece::own_edge) continue;
      if (edges++ == most_edges) return;
      const Vec3 edge = piece->corners[(i + 1) % piece->count] - piece->corners[i];
      const auto add = [&](const Vec3& along) {
        const Vec3 across = edge.cross(along);
        if (across.norm() > 1e-6 * edge.norm()) exits.add_facing(across);
      };
      if (edge_directions_.size() <= few_directions) {
        std::for_each(edge_directions_.begin(), edge_directions_.end(), add);
        continue;
      }
      for (std::size_t a = 0; a < piece->count; ++a) {
        for (std::size_t b = 0; b < a; ++b) {
          if (piece->side[a] == Piece::own_edge || piece->side[b] == Piece::own_edge) continue;
          add(faces_[static_cast<std::size_t>(piece->side[a])].normal.cross(
              faces_[static_cast<std::size_t>(piece->side[b])].normal));
        }
      }
    }
  }
}

// Through the faces that the surface enters by, and the way that the refinement finds. One that lies wholly within has
// entered by none: the nearest ones are tried.
void ConvexShape::add_exits(std::span<const Piece* const> patch, bool refined, ExitList& exits) const noexcept {
  if (refined) add_refined_exit(*this, patch, exits);
  std::array<std::int16_t, most_face_exits> used;
  std::size_t count = 0;
  for (const Piece* piece : patch) {
    for (std::size_t i = 0; i < piece->count && count < used.size(); ++i) {
      const std::int16_t side = piece->side[i];
      if (side == Piece::own_edge || std::find(used.begin(), used.begin() + count, side) != used.begin() + count) {
        continue;
      }
      used[count++] = side;
      exits.add(-faces_[static_cast<std::size_t>(side)].normal);
    }
  }
  if (patch.empty()) return;
  // One that lies below the surface altogether, as the face on which the body rests, is cut by none.
  const Vec3& within = patch.front()->corners[0];
  std::array<double, most_faces> way;
  for (std::size_t i = 0; i < faces_.size(); ++i) way[i] = faces_[i].offset - faces_[i].normal.dot(within);
  std::array<std::uint16_t, most_faces> nearest;
  const auto end = nearest.begin() + static_cast<std::ptrdiff_t>(faces_.size());
  std::iota(nearest.begin(), end, std::uint16_t{0});
  const std::size_t most = count > 0 ? most_uncut_exits : most_face_exits;
  const auto last = nearest.begin() + static_cast<std::ptrdiff_t>(std::min(most, faces_.size()));
  std::partial_sort(nearest.begin(), last, end,
                    [&](std::uint16_t a, std::uint16_t b) { return way[a] != way[b] ? way[a] < way[b] : a < b; });
  std::for_each(nearest.begin(), last, [&](std::uint16_t face) {
    const auto side = static_cast<std::int16_t>(face);
    if (std::find(used.begin(), used.begin() + count, side) == used.begin() + count) exits.add(-faces_[face].normal);
  });
  add_crossings(patch, exits);
}

// Of too many corners the lowest are kept.
void ConvexShape::add_features(const Vec3& up, double depth, Features& features) const noexcept {
  std::array<double, most_points> height;
  double lowest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < points_.size(); ++i) {
    height[i] = up.dot(points_[i]);
    lowest = std::min(lowest, height[i]);
  }
  const double highest = lowest + depth;
  std::array<std::uint16_t, Features::most> kept;  // a heap, the highest on top
  std::size_t count = 0;
  const auto is_lower = [&](std::uint16_t a, std::uint16_t b) { return height[a] < height[b]; };
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (height[i] > highest) continue;
    if (count == kept.size()) {
      if (!(height[i] < height[kept[0]])) continue;
      std::pop_heap(kept.begin(), kept.end(), is_lower);
      --count;
    }
    kept[count++] = static_cast<std::uint16_t>(i);
    std::push_heap(kept.begin(), kept.begin() + static_cast<std::ptrdiff_t>(count), is_lower);
  }
  std::sort(kept.begin(), kept.begin() + static_cast<std::ptrdiff_t>(count), is_lower);
  for (const std::uint16_t i : std::span(kept).first(count)) features.add_corner(points_[i]);
  for (const auto& [from, to] : edges_) {
    if (features.edge_count == Features::most) return;
    if (std::min(height[from], height[to]) <= highest) features.add_edge(points_[from], points_[to]);
  }
}

}  // namespace odds::ode
