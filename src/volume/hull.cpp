#include "odds/volume/hull.hpp"

#include <ccd/ccd.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "odds/math/float_sums.hpp"
#include "odds/volume/kdop.hpp"
#include "volume/point_to_hull.hpp"

namespace odds::volume {
namespace {

ODDS_KEEPS_ROUNDING Vec3 as_kept(const Vec3& point) { return point.cast<float>().cast<double>(); }

/// The vertices while they are chosen, as they will be kept: rounded to single precision.
class Vertices {
 public:
  [[nodiscard]] bool full() const noexcept { return size_ == Hull::most_vertices; }
  [[nodiscard]] std::span<const Vec3> all() const noexcept { return std::span(vertices_).first(size_); }

  void add(const Vec3& point) noexcept {
    const Vec3 kept = as_kept(point);
    if (full() || std::find(vertices_.begin(), vertices_.begin() + static_cast<std::ptrdiff_t>(size_), kept) !=
                      vertices_.begin() + static_cast<std::ptrdiff_t>(size_)) {
      return;
    }
    vertices_[size_++] = kept;
  }

 private:
  std::array<Vec3, Hull::most_vertices> vertices_;
  std::size_t size_ = 0;
};

void add_extremes(std::span<const Vec3> points, const Mat3& axes, Vertices& vertices) {
  for (const SlabNormal& slab : slab_normals<26>()) {
    const Vec3 normal = axes * Vec3(slab[0], slab[1], slab[2]);
    const Vec3* least = &points[0];
    const Vec3* greatest = &points[0];
    double lower = INFINITY;
    double upper = -INFINITY;
    for (const Vec3& point : points) {
      const double offset = normal.dot(point);
      if (offset < lower) {
        lower = offset;
        least = &point;
      }
      if (offset > upper) {
        upper = offset;
        greatest = &point;
      }
    }
    vertices.add(*least);
    vertices.add(*greatest);
  }
}

/// Adds the farthest points until all lie within `tolerance` or there is no room; the distance that is left.
/// `distances` (as many as points) holds upper bounds: they only shrink while the hull grows, so that most points need
/// no second look.
double add_farthest(std::span<const Vec3> points, std::span<double> distances, double tolerance, Vertices& vertices) {
  std::fill(distances.begin(), distances.end(), std::numeric_limits<double>::infinity());
  for (;;) {
    double worst = 0.0;
    std::size_t farthest = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (distances[i] <= worst) continue;
      distances[i] = distance_to_hull(points[i], vertices.all(), std::max(worst, 0.5 * tolerance));
      if (distances[i] <= worst) continue;
      worst = distances[i];
      farthest = i;
    }
    if (worst <= tolerance || vertices.full()) return worst;
    const std::size_t before = vertices.all().size();
    vertices.add(points[farthest]);
    if (vertices.all().size() == before) return worst;  // nothing but its rounding is left
  }
}

/// One question to GJK. libccd asks for the extreme points of both hulls along opposite directions in turn; each such
/// pair is a chance to prove separation. Lengths are given to libccd in units of both radii, since its tolerances are
/// absolute.
struct Question {
  const Hull& a;
  const Hull& b;
  const Mat3 rotation;
  const Vec3 translation;
  const double grown;  ///< inflations and margin
  const double scale;
  Vec3 direction = Vec3::Zero();  ///< the last one that A was asked for, unit
  double reach_a = 0.0;           ///< of A's vertices along it
  bool apart = false;             ///< proved
};

/// The vertex farthest along `direction`.
Vec3 extreme(const Hull& hull, const Vec3& direction) noexcept {
  std::size_t best = 0;
  double greatest = -INFINITY;
  for (std::size_t i = 0; i < hull.count_; ++i) {
    const double offset = direction.dot(hull.vertex(i));
    if (offset > greatest) {
      greatest = offset;
      best = i;
    }
  }
  return hull.vertex(best);
}

Vec3 unit(const ccd_vec3_t& direction) noexcept {
  const Vec3 vector(direction.v[0], direction.v[1], direction.v[2]);
  const double length = vector.norm();
  return length > 0.0 && std::isfinite(length) ? Vec3(vector / length) : Vec3::UnitX();
}

void hand_over(const Vec3& point, const Question& question, ccd_vec3_t* out) noexcept {
  const Vec3 scaled = (point - question.translation) * question.scale;
  for (int i = 0; i < 3; ++i) out->v[i] = scaled[i];
}

Question& question_of(const void* object) noexcept {
  return *const_cast<Question*>(static_cast<const Question*>(object));
}

extern "C" void extreme_of_a(const void* object, const ccd_vec3_t* direction, ccd_vec3_t* out) {
  Question& question = question_of(object);
  question.direction = unit(*direction);
  const Vec3 point = extreme(question.a, question.direction);
  question.reach_a = question.direction.dot(point);
  hand_over(point + question.grown * question.direction, question, out);
}

extern "C" void extreme_of_b(const void* object, const ccd_vec3_t* direction, ccd_vec3_t* out) {
  Question& question = question_of(object);
  const Vec3 opposite = unit(*direction);
  const Vec3 point =
      question.rotation * extreme(question.b, question.rotation.transpose() * opposite) + question.translation;
  // B begins beyond A's end, with room for what both are inflated by.
  if (opposite == -question.direction && -opposite.dot(point) - question.reach_a > question.grown) {
    question.apart = true;
  }
  hand_over(point, question, out);
}

extern "C" void first_direction(const void* object, const void*, ccd_vec3_t* out) {
  const Question& question = question_of(object);
  const Vec3 direction = question.rotation * question.b.box_.center_.cast<double>() + question.translation -
                         question.a.box_.center_.cast<double>();
  for (int i = 0; i < 3; ++i) out->v[i] = direction[i] * question.scale;
}

}  // namespace

Hull Hull::fit(std::span<const Vec3> points, const PrincipalAxes& axes) {
  Hull hull;
  hull.box_ = Obb::fit(points, axes);
  Vertices vertices;
  add_extremes(points, axes, vertices);
  std::array<double, 64> few;
  std::vector<double> many(points.size() > few.size() ? points.size() : 0);
  const std::span<double> distances = many.empty() ? std::span(few).first(points.size()) : std::span(many);
  const double radius = static_cast<double>(hull.box_.radius());
  const double left = add_farthest(points, distances, radius / 256.0, vertices);
  // Distances are rounded relative to the coordinates.
  const double coordinates = radius + static_cast<double>(math::length(hull.box_.center_));
  hull.inflation_ = rounded_up(left + 1e-14 * coordinates);

  std::array<Vec3, most_vertices> local;
  hull.count_ = static_cast<std::uint32_t>(vertices.all().size());
  for (std::size_t i = 0; i < hull.count_; ++i) {
    const Vec3f vertex = vertices.all()[i].cast<float>();
    hull.x_[i] = vertex[0];
    hull.y_[i] = vertex[1];
    hull.z_[i] = vertex[2];
    local[i] = axes.transpose() * (hull.vertex(i) - hull.box_.center_.cast<double>());
  }
  hull.fill_ = Kdop26::fit(std::span(local).first(hull.count_), Mat3::Identity()).fill_;
  return hull;
}

bool overlap(const Hull& a, const Hull& b, const RelativePose& pose) noexcept {
  if (!overlap(a.box_, b.box_, pose)) return false;
  const double size = static_cast<double>(a.radius()) + static_cast<double>(b.radius());
  const double grown =
      static_cast<double>(a.inflation_) + static_cast<double>(b.inflation_) + static_cast<double>(pose.margin);
  const double unit_length = size + grown;
  if (!(unit_length > 0.0)) return true;
  Question question{a, b, pose.rotation.cast<double>(), pose.translation.cast<double>(), grown, 1.0 / unit_length};
  ccd_t ccd;
  CCD_INIT(&ccd);
  ccd.first_dir = &first_direction;
  ccd.support1 = &extreme_of_a;
  ccd.support2 = &extreme_of_b;
  ccd.max_iterations = 24;
  static_cast<void>(ccdGJKIntersect(&question, &question, &ccd));
  return !question.apart;
}

}  // namespace odds::volume
