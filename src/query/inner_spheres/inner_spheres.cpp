// Packing: balls on the medial axis, those that fill most.
#include "odds/query/inner_spheres.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "odds/query/pair.hpp"
#include "odds/query/ray.hpp"
#include "query/spread_step.hpp"

namespace odds::query {
namespace {

constexpr std::size_t samples = 2048;  // points of the surface under which balls are sought
// Units of all distance searches together: from the middle of a round body all of its surface is nearest. What balls
// they were enough for are spread over all of the surface.
constexpr std::uint64_t most_units = 3000000;
constexpr int most_shrinks = 40;       // they converge in some 5
constexpr double shrunk = 1e-6;        // relative: nearer than that, the ball is empty
constexpr double least_radius = 1e-6;  // of the mesh
constexpr double point_size = 1e-9;    // of the mesh: a triangle so small stands for a point
constexpr double least_gain = 1e-3;    // of the volume: what fills less is left out ...
constexpr double least_of_best = 0.1;  // ... if it is less than that of what the best ball fills: in a plate all do
constexpr std::size_t depths = 2;      // points below each sample that tell what is filled

struct Ball {
  Vec3 center;
  double radius;
};

Result<std::shared_ptr<const Shape>> wide_shape(const std::shared_ptr<const Shape>& shape) {
  if (shape->volume() == volume::Kind::wide) return shape;
  const mesh::TriangleMesh& mesh = shape->mesh();
  auto copy =
      mesh::TriangleMesh::adopt(mesh.vertex_array(), mesh.triangle_array(), mesh.name(), mesh.lower(), mesh.upper());
  if (!copy) return copy.error();
  return Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(copy).value()));
}

/// Nearest points of a surface, by the distance search between it and a point.
class Surface {
 public:
  static Result<Surface> make(const std::shared_ptr<const Shape>& shape) {
    const double size = point_size * shape->mesh().size();
    auto mesh = mesh::TriangleMesh::make({Vec3::Zero(), Vec3(size, 0, 0), Vec3(0, size, 0)}, {{0, 1, 2}}, "point");
    if (!mesh) return mesh.error();
    auto point = Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(mesh).value()));
    if (!point) return point.error();
    auto pair = Pair::make(shape, point.value());
    if (!pair) return pair.error();
    return Surface(std::move(pair).value());
  }

  /// The nearest point within a distance, and how far the surface is at least.
  [[nodiscard]] DistanceAnswer nearest(const Vec3& point, double within) noexcept {
    const DistanceAnswer answer =
        pair_.distance({Mat3::Identity(), point}, {.within = within, .budget = Budget::work(units_left_)});
    const std::uint64_t spent = answer.cost.node_pairs + answer.cost.triangle_pairs;
    units_left_ -= std::min(spent, units_left_ - 1);
    return answer;
  }
  /// Whether there are units for another ball.
  [[nodiscard]] bool may_go_on() const noexcept { return units_left_ > 1; }

 private:
  explicit Surface(Pair pair) : pair_(std::move(pair)) {}
  Pair pair_;
  std::uint64_t units_left_ = most_units;
};

/// A point of the surface, and which way is in.
struct Sample {
  Vec3 place;
  Vec3 inward;
};

// Evenly by area; within its triangle by a sequence that fills the plane evenly (Roberts 2018).
std::vector<Sample> spread(const mesh::TriangleMesh& mesh) {
  const auto corner = [&](const mesh::Triangle& t, std::size_t i) { return mesh.vertices()[t[i]]; };
  std::vector<double> area_until;
  double area = 0.0;
  for (const mesh::Triangle& t : mesh.triangles()) {
    area += 0.5 * (corner(t, 1) - corner(t, 0)).cross(corner(t, 2) - corner(t, 0)).norm();
    area_until.push_back(area);
  }
  std::vector<Sample> all;
  all.reserve(samples);
  for (std::size_t i = 0; i < samples; ++i) {
    const double at = area * (static_cast<double>(i) + 0.5) / samples;
    const auto found = std::upper_bound(area_until.begin(), area_until.end(), at);
    if (found == area_until.end()) continue;
    const mesh::Triangle& t = mesh.triangles()[static_cast<std::size_t>(found - area_until.begin())];
    double u = std::fmod(0.5 + 0.7548776662466927 * static_cast<double>(i), 1.0);
    double v = std::fmod(0.5 + 0.5698402909980532 * static_cast<double>(i), 1.0);
    if (u + v > 1.0) {
      u = 1.0 - u;
      v = 1.0 - v;
    }
    const Vec3 first = corner(t, 1) - corner(t, 0);
    const Vec3 second = corner(t, 2) - corner(t, 0);
    const Vec3 normal = first.cross(second);
    const double length = normal.norm();
    if (!(length > 0.0)) continue;
    all.push_back({corner(t, 0) + u * first + v * second, -normal / length});
  }
  return all;
}

// The greatest ball that touches the surface at the sample and holds none of it: shrunk until nothing is nearer to its
// centre than the sample.
std::optional<Ball> ball_under(const Shape& shape, Surface& surface, const Sample& sample) {
  const double size = shape.mesh().size();
  const mesh::TriangleMesh& mesh = shape.mesh();
  const double farthest = std::max(mesh.lower().cwiseAbs().maxCoeff(), mesh.upper().cwiseAbs().maxCoeff());
  const double lifted = std::max(1e-7 * size, 8.0 * 0x1p-53 * farthest);  // off the triangle that the ray starts from
  const auto across = cast_ray(shape, sample.place + lifted * sample.inward, sample.inward, 2.0 * size);
  if (!across) return std::nullopt;
  double radius = 0.5 * (across->distance + lifted);
  Vec3 center = sample.place + radius * sample.inward;
  for (int i = 0; i < most_shrinks; ++i) {
    const DistanceAnswer nearest = surface.nearest(center, radius * (1.0 - shrunk));
    if (!nearest.proved) return std::nullopt;  // the units are spent
    if (!std::isfinite(nearest.upper)) return Ball{center, radius * (1.0 - shrunk)};
    // The ball through both points that touches the surface at the sample.
    const Vec3 apart = nearest.on_a - sample.place;
    const double smaller = apart.squaredNorm() / (2.0 * apart.dot(sample.inward));
    if (!(smaller > 0.0) || !(smaller < radius)) return Ball{center, nearest.upper};
    radius = smaller;
    center = sample.place + radius * sample.inward;
  }
  return std::nullopt;
}

/// A point within the solid, and the volume for which it stands, relative.
struct Inside {
  Vec3 place;
  double weight;
};

// Below a sample there is stuff down to its ball's centre: points along that way, by its length.
void add_points_below(const Sample& sample, double radius, std::size_t index, std::vector<Inside>& points) {
  for (std::size_t i = 0; i < depths; ++i) {
    const double part = std::fmod(0.5 + 0.6180339887498949 * static_cast<double>(depths * index + i), 1.0);
    points.push_back({sample.place + part * radius * sample.inward, radius});
  }
}

// The ball that fills most of what is not yet filled, again and again: within 1 - 1/e of the best (Nemhauser, Wolsey
// and Fisher 1978). What a ball adds only falls as others are kept, so that most need not be looked at again.
std::vector<Ball> filling(const std::vector<Ball>& balls, std::vector<Inside> points, std::size_t most) {
  const auto fills = [](const Ball& ball, const Inside& point) {
    return (point.place - ball.center).squaredNorm() < ball.radius * ball.radius;
  };
  const auto gain_of = [&](const Ball& ball) {
    double gain = 0.0;
    for (const Inside& point : points) gain += fills(ball, point) ? point.weight : 0.0;
    return gain;
  };
  double all = 0.0;
  for (const Inside& point : points) all += point.weight;
  std::vector<double> gains;
  for (const Ball& ball : balls) gains.push_back(gain_of(ball));
  std::vector<bool> current(balls.size(), true);
  std::vector<Ball> kept;
  double least = 0.0;
  while (kept.size() < most) {
    std::size_t best = 0;
    for (;;) {
      best = static_cast<std::size_t>(std::max_element(gains.begin(), gains.end()) - gains.begin());
      if (current[best]) break;
      gains[best] = gain_of(balls[best]);
      current[best] = true;
    }
    if (kept.empty()) least = std::min(least_gain * all, least_of_best * gains[best]);
    if (!(gains[best] > least) && !kept.empty()) break;
    kept.push_back(balls[best]);
    std::erase_if(points, [&](const Inside& point) { return fills(balls[best], point); });
    gains[best] = 0.0;
    current.assign(balls.size(), false);
    current[best] = true;
  }
  return kept;
}

// Halves along the longest side until a part is one group.
void arrange(std::span<Ball> balls) {
  if (balls.size() <= InnerSpheres::group_size) return;
  Vec3 lower = balls.front().center;
  Vec3 upper = lower;
  for (const Ball& ball : balls) {
    lower = lower.cwiseMin(ball.center);
    upper = upper.cwiseMax(ball.center);
  }
  Eigen::Index axis = 0;
  (upper - lower).maxCoeff(&axis);
  const std::size_t groups = (balls.size() + InnerSpheres::group_size - 1) / InnerSpheres::group_size;
  const std::size_t half = groups / 2 * InnerSpheres::group_size;
  std::stable_sort(balls.begin(), balls.end(),
                   [axis](const Ball& p, const Ball& q) { return p.center[axis] < q.center[axis]; });
  arrange(balls.first(half));
  arrange(balls.subspan(half));
}

/// Trilinear: a sphere at a corner belongs to it alone, one in the middle to all alike. A box thinner than `least_side`
/// has no two corners there.
std::array<double, InnerSpheres::corners> shares_of_corners(const Vec3& point, const Vec3& lower, const Vec3& upper,
                                                            double least_side) {
  std::array<double, InnerSpheres::corners> shares;
  shares.fill(1.0);
  for (int axis = 0; axis < 3; ++axis) {
    const double side = upper[axis] - lower[axis];
    const double t = side > least_side ? (point[axis] - lower[axis]) / side : 0.0;
    for (std::size_t i = 0; i < shares.size(); ++i) shares[i] *= ((i >> axis) & 1U) != 0 ? t : 1.0 - t;
  }
  return shares;
}

}  // namespace

Result<InnerSpheres> InnerSpheres::pack(const std::shared_ptr<const Shape>& shape, std::uint32_t count) {
  if (!shape) return Error{"", "", "inner spheres need a shape", "build the shape first"};
  const std::string& name = shape->mesh().name();
  if (!shape->has_polygons()) return Error{name, "", "a shape without polygons has no inside", "keep its polygons"};
  if (!shape->is_solid()) {
    return Error{name, "", "the mesh is not closed, or its triangles do not face outwards: it has no inside",
                 "'odds inspect' says what is wrong with it"};
  }
  if (count < fewest || count > most) return Error{name, "", "8 to 512 inner spheres are possible", "ask for so many"};
  auto wide = wide_shape(shape);
  if (!wide) return wide.error();
  auto surface = Surface::make(wide.value());
  if (!surface) return surface.error();
  std::vector<Ball> balls;
  std::vector<Inside> points;
  const std::vector<Sample> all = spread(shape->mesh());
  const std::size_t step = spread_step(std::max<std::size_t>(all.size(), 1));
  for (std::size_t i = 0, next = 0; i < all.size() && surface.value().may_go_on();
       ++i, next = (next + step) % all.size()) {
    const auto ball = ball_under(*wide.value(), surface.value(), all[next]);
    if (!ball || !(ball->radius > least_radius * shape->mesh().size())) continue;
    add_points_below(all[next], ball->radius, balls.size(), points);
    balls.push_back(*ball);
  }
  if (balls.empty()) {
    return Error{name, "", "the mesh has no room for a sphere", "it is too thin for its size"};
  }
  std::vector<Ball> kept = filling(balls, std::move(points), count);
  arrange(kept);

  InnerSpheres made;
  Vec3 lower = kept.front().center;
  Vec3 upper = lower;
  for (const Ball& ball : kept) {
    const double cube = ball.radius * ball.radius * ball.radius;
    made.centers_.push_back(ball.center);
    made.radii_.push_back(ball.radius);
    lower = lower.cwiseMin(ball.center);
    upper = upper.cwiseMax(ball.center);
    made.cubes_ += cube;
    made.thickness_ += cube * ball.radius;
  }
  made.thickness_ /= made.cubes_;
  for (const Vec3& center : made.centers_)
    made.corner_shares_.push_back(shares_of_corners(center, lower, upper, 0.5 * made.thickness_));
  for (std::size_t first = 0; first < kept.size(); first += group_size) {
    Group group;
    group.first = static_cast<std::uint32_t>(first);
    group.count = static_cast<std::uint32_t>(std::min(group_size, kept.size() - first));
    for (std::uint32_t i = 0; i < group.count; ++i) group.center += kept[first + i].center / group.count;
    for (std::uint32_t i = 0; i < group.count; ++i) {
      const Ball& ball = kept[first + i];
      group.radius = std::max(group.radius, (ball.center - group.center).norm() + ball.radius);
    }
    group.radius *= 1.0 + 1e-12;
    made.groups_.push_back(group);
  }
  return made;
}

}  // namespace odds::query
