#include "mesh/flat_faces.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "mesh/adjacency.hpp"
#include "odds/math/tolerances.hpp"

namespace odds::mesh {
namespace {

using Vec2 = Eigen::Vector2d;

double cross(const Vec2& p, const Vec2& q) { return p.x() * q.y() - p.y() * q.x(); }

/// A corner as it lies in the plane of its face.
struct Corner {
  Vec2 place;
  Vec3 point;
};

/// Andrew's monotone chain; counter-clockwise, without the points on its sides.
std::vector<Corner> convex_hull(std::vector<Corner> points) {
  std::sort(points.begin(), points.end(), [](const Corner& p, const Corner& q) {
    return p.place.x() != q.place.x() ? p.place.x() < q.place.x() : p.place.y() < q.place.y();
  });
  std::vector<Corner> hull;
  const auto add = [&hull](const Corner& point, std::size_t least) {
    while (hull.size() >= least + 2) {
      const Vec2& p = hull[hull.size() - 2].place;
      if (cross(hull.back().place - p, point.place - p) > 0.0) break;
      hull.pop_back();
    }
    hull.push_back(point);
  };
  for (const Corner& point : points) add(point, 0);
  const std::size_t lower = hull.size() - 1;
  for (auto point = points.rbegin() + 1; point != points.rend(); ++point) add(*point, lower);
  hull.pop_back();
  return hull;
}

double area_of(std::span<const Corner> polygon) {
  double twice = 0.0;
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    twice += cross(polygon[i - 1].place - polygon[0].place, polygon[i].place - polygon[0].place);
  }
  return 0.5 * twice;
}

/// Leaves out the corner that takes least of the area with it, while there are too many or it takes next to nothing.
void simplify(std::vector<Corner>& polygon, double nothing) {
  while (polygon.size() > 3) {
    std::size_t least = 0;
    double lost = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vec2& before = polygon[(i + polygon.size() - 1) % polygon.size()].place;
      const Vec2& after = polygon[(i + 1) % polygon.size()].place;
      const double area = 0.5 * cross(polygon[i].place - before, after - before);
      if (area < lost) {
        lost = area;
        least = i;
      }
    }
    if (polygon.size() <= FlatFace::most_corners && lost > nothing) return;
    polygon.erase(polygon.begin() + static_cast<std::ptrdiff_t>(least));
  }
}

/// How far points lie outside of a convex polygon, the farthest of them.
double reach_beyond(std::span<const Corner> polygon, std::span<const Corner> points) {
  double most = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2& from = polygon[i].place;
    const Vec2 side = (polygon[(i + 1) % polygon.size()].place - from).normalized();
    for (const Corner& point : points) most = std::max(most, -cross(side, point.place - from));
  }
  return most;
}

class Finder {
 public:
  explicit Finder(const TriangleMesh& mesh) : mesh_(mesh), first_(first_at_position(mesh.vertices())) {
    const std::span<const Triangle> triangles = mesh.triangles();
    welded_.reserve(triangles.size());
    for (const Triangle& t : triangles) welded_.push_back({first_[t[0]], first_[t[1]], first_[t[2]]});
    normals_.reserve(triangles.size());
    areas_.reserve(triangles.size());
    for (const Triangle& t : triangles) {
      const std::span<const Vec3> v = mesh.vertices();
      const Vec3 normal = (v[t[1]] - v[t[0]]).cross(v[t[2]] - v[t[0]]);
      const double length = normal.norm();
      normals_.push_back(length > 0.0 ? Vec3(normal / length) : Vec3(Vec3::Zero()));
      areas_.push_back(0.5 * length);
      surface_ += 0.5 * length;
    }
    link();
  }

  std::vector<FlatFace> run() {
    std::vector<std::uint32_t> order(areas_.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return areas_[a] != areas_[b] ? areas_[a] > areas_[b] : a < b; });
    std::vector<std::pair<double, FlatFace>> found;
    for (const std::uint32_t seed : order) {
      if (region_of_[seed] != nobody || normals_[seed].isZero()) continue;
      const double area = grow(seed);
      if (region_.size() < 2 || area < (is_sharp(seed) ? least_share : least_soft_share) * surface_) continue;
      FlatFace face;
      if (make_face(seed, area, face)) found.emplace_back(area, face);
    }
    std::stable_sort(found.begin(), found.end(), [](const auto& p, const auto& q) { return p.first > q.first; });
    if (found.size() > most_faces) found.resize(most_faces);
    std::vector<FlatFace> faces;
    faces.reserve(found.size());
    for (const auto& [area, face] : found) faces.push_back(face);
    for (FlatFace& front : faces) {
      for (const FlatFace& back : faces) {
        if (!(front.normal.dot(back.normal) < opposed)) continue;
        const Vec3 between = front.centre - back.centre;
        const double behind = front.normal.dot(between);
        const bool is_behind = behind > 0.0 && (between - behind * front.normal).norm() <= front.radius + back.radius;
        if (is_behind) front.thickness = std::min(front.thickness, behind);
      }
    }
    return faces;
  }

 private:
  static constexpr std::uint32_t nobody = ~std::uint32_t{0};
  static constexpr double sharp = 0.94;    // cosine of 20 degrees
  static constexpr double opposed = -0.9;  // of 154 degrees

  /// Neighbours across edges that two triangles share, wound alike.
  void link() {
    beside_.assign(welded_.size(), {nobody, nobody, nobody});
    region_of_.assign(welded_.size(), nobody);
    for_each_edge(sorted_edge_uses(welded_), [this](std::span<const EdgeUse> uses) {
      if (uses.size() != 2 || uses[0].forward == uses[1].forward) return;
      add_neighbour(uses[0].triangle, uses[1].triangle);
      add_neighbour(uses[1].triangle, uses[0].triangle);
    });
  }
  void add_neighbour(std::uint32_t triangle, std::uint32_t other) {
    for (std::uint32_t& place : beside_[triangle]) {
      if (place != nobody) continue;
      place = other;
      return;
    }
  }

  /// All triangles about `seed` that lie in its plane; their area.
  double grow(std::uint32_t seed) {
    region_.assign(1, seed);
    region_of_[seed] = seed;
    const Vec3 normal = normals_[seed];
    const double slack = tolerances::flat_face * mesh_.size();
    const double offset = normal.dot(mesh_.vertices()[mesh_.triangles()[seed][0]]);
    double area = areas_[seed];
    for (std::size_t i = 0; i < region_.size(); ++i) {
      for (const std::uint32_t next : beside_[region_[i]]) {
        if (next == nobody || region_of_[next] != nobody || !lies_in(next, normal, offset, slack)) continue;
        region_of_[next] = seed;
        region_.push_back(next);
        area += areas_[next];
      }
    }
    return area;
  }
  /// Whether the surface turns sharply all round the region that was grown last: else it may be one of the facets that
  /// a round body is cut into.
  [[nodiscard]] bool is_sharp(std::uint32_t seed) const {
    return std::all_of(region_.begin(), region_.end(), [&](std::uint32_t triangle) {
      return std::all_of(beside_[triangle].begin(), beside_[triangle].end(), [&](std::uint32_t other) {
        return other == nobody || region_of_[other] == seed || normals_[other].dot(normals_[seed]) < sharp;
      });
    });
  }
  [[nodiscard]] bool lies_in(std::uint32_t triangle, const Vec3& normal, double offset, double slack) const {
    if (!(normals_[triangle].dot(normal) > tolerances::same_face)) return false;
    const Triangle& t = mesh_.triangles()[triangle];
    return std::all_of(t.begin(), t.end(), [&](std::uint32_t vertex) {
      return std::abs(normal.dot(mesh_.vertices()[vertex]) - offset) <= slack;
    });
  }

  /// False: the region is not convex.
  bool make_face(std::uint32_t seed, double area, FlatFace& face) const {
    face.normal = normals_[seed];
    const Vec3 origin = mesh_.vertices()[mesh_.triangles()[seed][0]];
    const Vec3 u = face.normal.unitOrthogonal();
    const Vec3 v = face.normal.cross(u);
    std::vector<std::uint32_t> vertices;
    vertices.reserve(3 * region_.size());
    for (const std::uint32_t triangle : region_) {
      vertices.insert(vertices.end(), welded_[triangle].begin(), welded_[triangle].end());
    }
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    std::vector<Corner> corners;
    corners.reserve(vertices.size());
    double offset = 0.0;
    for (const std::uint32_t vertex : vertices) {
      const Vec3& point = mesh_.vertices()[vertex];
      corners.push_back({{u.dot(point - origin), v.dot(point - origin)}, point});
      offset += face.normal.dot(point) / static_cast<double>(vertices.size());
    }
    std::vector<Corner> hull = convex_hull(std::move(corners));
    if (hull.size() < 3) return false;
    constexpr double as_good_as = 1e-6;
    const double hull_area = area_of(hull);
    if (!(std::abs(hull_area - area) <= as_good_as * area)) return false;
    const std::vector<Corner> whole = hull;
    simplify(hull, as_good_as * hull_area);
    face.beyond = reach_beyond(hull, whole);
    face.offset = offset;
    for (const std::uint32_t vertex : vertices) {
      face.uneven = std::max(face.uneven, std::abs(face.normal.dot(mesh_.vertices()[vertex]) - offset));
    }
    face.triangle = seed;
    face.corner_count = hull.size();
    for (std::size_t i = 0; i < hull.size(); ++i) {
      face.corner[i] = hull[i].point;
      face.centre += hull[i].point / static_cast<double>(hull.size());
    }
    for (const Vec3& corner : face.corners()) face.radius = std::max(face.radius, (corner - face.centre).norm());
    return true;
  }

  const TriangleMesh& mesh_;
  std::vector<std::uint32_t> first_;
  std::vector<Triangle> welded_;
  std::vector<Vec3> normals_;
  std::vector<double> areas_;
  double surface_ = 0.0;
  std::vector<std::array<std::uint32_t, 3>> beside_;
  std::vector<std::uint32_t> region_of_;  ///< the seed of each triangle's region
  std::vector<std::uint32_t> region_;
};

}  // namespace

std::vector<FlatFace> find_flat_faces(const TriangleMesh& mesh) { return Finder(mesh).run(); }

}  // namespace odds::mesh
