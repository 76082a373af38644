#include "query/patch/summit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "odds/math/tolerances.hpp"

namespace odds::query::patch {
namespace {

using Place = Roof::Place;

double dot(const Place& x, const Place& y) noexcept { return x.u * y.u + x.v * y.v; }
Place along(const Place& from, double t, const Place& way) noexcept { return {from.u + t * way.u, from.v + t * way.v}; }

/// The planes that meet in a roof's place, a few of them.
struct Ridge {
  static constexpr std::size_t most = 4;
  std::array<Place, most> slopes;
  std::size_t count = 0;
  double height = std::numeric_limits<double>::infinity();

  Ridge(const Roof& roof, const Place& place, double rounding) noexcept : height(roof.at(place)) {
    for (const Roof::Plane& plane : roof) {
      if (count < most && plane.at(place) <= height + rounding && !has(plane.slope)) slopes[count++] = plane.slope;
    }
  }
  /// Triangles of a flat face have one plane.
  [[nodiscard]] bool has(const Place& slope) const noexcept {
    return std::any_of(slopes.begin(), slopes.begin() + static_cast<std::ptrdiff_t>(count), [&](const Place& known) {
      return std::abs(known.u - slope.u) + std::abs(known.v - slope.v) <=
             1e-12 * (1.0 + std::abs(slope.u) + std::abs(slope.v));
    });
  }
  /// How fast it rises, at least.
  [[nodiscard]] double rate(const Place& way) const noexcept {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < count; ++i) least = std::min(least, dot(slopes[i], way));
    return count > 0 ? least : 0.0;
  }
};

/// The point nearest to the origin of the convex hull of some points; the origin if it is inside.
Place nearest_to_origin(std::span<const Place> points) noexcept {
  const auto is_nearest = [&](const Place& p) noexcept {
    const double least = dot(p, p) * (1.0 - 1e-9);
    return std::all_of(points.begin(), points.end(), [&](const Place& q) noexcept { return dot(p, q) >= least; });
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (is_nearest(points[i])) return points[i];
    for (std::size_t j = 0; j < i; ++j) {
      const Place side = along(points[j], -1.0, points[i]);
      const double length = dot(side, side);
      const double t = length > 0.0 ? -dot(points[i], side) / length : 0.0;
      if (!(t > 0.0 && t < 1.0)) continue;
      const Place between = along(points[i], t, side);
      if (is_nearest(between)) return between;
    }
  }
  return {0.0, 0.0};
}

/// The way on which the sum of two roofs rises fastest; zero at the top.
Place steepest(const Ridge& a, const Ridge& b) noexcept {
  constexpr Place level{0.0, 0.0};
  std::array<Place, Ridge::most * Ridge::most> sums;
  std::size_t count = 0;
  for (std::size_t i = 0; i < std::max<std::size_t>(a.count, 1); ++i) {
    for (std::size_t j = 0; j < std::max<std::size_t>(b.count, 1); ++j) {
      sums[count++] = along(i < a.count ? a.slopes[i] : level, 1.0, j < b.count ? b.slopes[j] : level);
    }
  }
  return nearest_to_origin({sums.data(), count});
}

/// How far along a way another of a roof's planes becomes the lowest.
double way_to_next(const Roof& roof, const Ridge& ridge, const Place& place, const Place& way) noexcept {
  const double rate = ridge.rate(way);
  double least = std::numeric_limits<double>::infinity();
  for (const Roof::Plane& plane : roof) {
    const double above = plane.at(place) - ridge.height;
    const double closing = rate - dot(plane.slope, way);
    if (closing > 1e-12 * (1.0 + std::abs(rate))) least = std::min(least, std::max(above, 0.0) / closing);
  }
  return least;
}

double length_of(const Place& way) noexcept { return std::max(std::abs(way.u), std::abs(way.v)); }

/// How far to go next, along each axis.
class Stride {
 public:
  explicit Stride(double radius) noexcept : radius_(radius), length_(radius) {}

  [[nodiscard]] double length() const noexcept { return length_; }

  /// A step led out of the overlap.
  void led_out(const Place& from, const Place& to) noexcept {
    constexpr double shorter = 0.35;
    outside_ = to;
    knows_outside_ = true;
    length_ = shorter * length_of(along(to, -1.0, from));
  }
  /// A step led deeper: the next one is longer, but no farther than half-way to where a step led out, if it goes there.
  void went(const Place& from, const Place& to) noexcept {
    constexpr double longer = 4.0;
    constexpr double same_way = 0.8;  // cosine
    if (!(length_ < radius_)) return;
    const Place done = along(to, -1.0, from);
    const Place left = along(outside_, -1.0, to);
    const double room = length_of(left);
    if (knows_outside_ && dot(left, done) > same_way * std::sqrt(dot(left, left) * dot(done, done))) {
      length_ = std::min(std::sqrt(length_ * room), 0.5 * room);
    } else {
      length_ = std::min(radius_, longer * length_);
    }
  }

 private:
  double radius_;
  double length_;
  Place outside_{0.0, 0.0};
  bool knows_outside_ = false;
};

}  // namespace

void Roof::add(const Plane& plane) noexcept {
  const auto is_same = [&](const Plane& known) noexcept { return known.triangle == plane.triangle; };
  if (count_ < most && std::none_of(begin(), end(), is_same)) planes_[count_++] = plane;
}

void Roof::leave_out_below(const Place& place, double height, double rounding) noexcept {
  const auto kept = std::remove_if(planes_.begin(), planes_.begin() + static_cast<std::ptrdiff_t>(count_),
                                   [&](const Plane& plane) noexcept { return plane.at(place) < height - rounding; });
  count_ = static_cast<std::size_t>(kept - planes_.begin());
}

double Roof::at(const Place& place) const noexcept {
  double least = std::numeric_limits<double>::infinity();
  for (const Plane& plane : *this) least = std::min(least, plane.at(place));
  return least;
}

double Roof::steepness(const Place& place) const noexcept {
  double least = std::numeric_limits<double>::infinity();
  double squared = 0.0;
  for (const Plane& plane : *this) {
    const double height = plane.at(place);
    if (!(height < least)) continue;
    least = height;
    squared = dot(plane.slope, plane.slope);
  }
  return squared;
}

Place Summit::place_of(const Vec3& point) const noexcept {
  const Vec3 away = point - centre_;
  return {frame_.u.dot(away), frame_.v.dot(away)};
}

void Summit::add(const Witness& measured) noexcept {
  const auto add_plane = [this](const Vec3& normal, const Vec3& point, double sign, bool solid, std::uint32_t triangle,
                                Roof& roof) noexcept {
    const double facing = normal.dot(frame_.normal);
    // A wall bounds nothing above it, nor does the other side of a solid.
    if (!((solid ? sign * facing : std::abs(facing)) > tolerances::steep * normal.norm())) return;
    const Place slope{-sign * normal.dot(frame_.u) / facing, -sign * normal.dot(frame_.v) / facing};
    roof.add({sign * height_of(point) - dot(slope, place_of(point)), slope, triangle});
  };
  add_plane(normal_in_a(input_, measured.triangle_a), measured.on_a, -1.0, input_.solid_a, measured.triangle_a, of_a_);
  add_plane(normal_in_b(input_, measured.triangle_b), measured.on_b, 1.0, input_.solid_b, measured.triangle_b, of_b_);
}

/// Of heights: of what is large, and of what is far from A's origin.
double Summit::rounding_of(double radius) const noexcept {
  return std::max(1e-9 * radius, 4.0 * tolerances::on_plane * centre_.cwiseAbs().maxCoeff());
}

Place Summit::highest(const Place& from, double radius, Watch& watch) const noexcept {
  constexpr std::size_t most_ridges = 12;
  const double rounding = rounding_of(radius);
  Place place = from;
  for (std::size_t i = 0; i < most_ridges && !watch.late_before_next(i); ++i) {
    const Ridge a(of_a_, place, rounding);
    const Ridge b(of_b_, place, rounding);
    const Place way = steepest(a, b);
    const double fastest = std::max(std::abs(way.u), std::abs(way.v));
    if (!(fastest > 1e-9)) break;
    const auto room = [&](double at, double start, double rate) noexcept {
      return rate != 0.0 ? (std::copysign(radius, rate) - (at - start)) / rate
                         : std::numeric_limits<double>::infinity();
    };
    const double limit = std::min(room(place.u, from.u, way.u), room(place.v, from.v, way.v));
    const double next = std::min(way_to_next(of_a_, a, place, way), way_to_next(of_b_, b, place, way));
    place = along(place, std::min(next, limit), way);
    if (!(next < limit)) break;
  }
  return place;
}

/// Whether it can only be within a whole rim: what goes deep may lean out of it, as a spike does.
bool Summit::is_flat(double depth) const noexcept {
  return sums_.closed() && depth < tolerances::flat_within_rim * sums_.diagonal();
}

bool Summit::may_be_at(const Vec3& place, double depth) const noexcept {
  Vec3 beside = Vec3::Constant(depth);
  if (is_flat(depth)) {
    beside = depth * frame_.normal.cwiseAbs() + Vec3::Constant(tolerances::same_joint * sums_.diagonal());
  }
  return (place.array() >= (sums_.lower - beside).array()).all() &&
         (place.array() <= (sums_.upper + beside).array()).all();
}

bool Summit::measure(const Place& place, const Witness& best, bool may_lean, double reach, Watch& watch,
                     Witness& found) noexcept {
  const double top = of_b_.at(place);
  const double bottom = -of_a_.at(place);
  const bool known = std::isfinite(top) && std::isfinite(bottom);
  bool missed = false;
  const auto at = [&](double height) noexcept {
    const Vec3 point = centre_ + place.u * frame_.u + place.v * frame_.v + height * frame_.normal;
    if (is_flat(best.depth) && !may_be_at(point, best.depth)) return false;
    Witness there;
    const Probing told = probe_line(input_, point, frame_.normal, reach, watch, there);
    missed = told == Probing::missed;
    if (told == Probing::apart) add(there);  // how far they are apart there bounds how deep they are beside it
    if (told != Probing::overlap || !all_have(exits_, there)) return false;
    // What is deeper than all that is known allows, and does not begin before the point and end after it, is another
    // overlap on the same line, as of a crate with the wall behind the floor that it is on.
    const bool is_here = height_of(there.on_a) <= height && height <= height_of(there.on_b);
    if (known && !is_here && there.depth > top - bottom) return false;
    found = there;
    add(found);
    return true;
  };
  if (at(known ? 0.5 * (top + bottom) : height_of(best.middle()))) return true;
  if (!may_lean || !known || missed) return false;
  // A spike that leans may lie beside the middle: it is followed just inside of its own surface.
  const Place from = place_of(best.middle());
  const double inside = tolerances::inside_surface * std::hypot(place.u - from.u, place.v - from.v);
  const bool is_of_b = of_b_.steepness(place) > of_a_.steepness(place);
  return at(is_of_b ? top - inside : bottom + inside);
}

Witness Summit::climb(const Witness& start, const Witness& beside, double radius, double reach, Watch& watch) noexcept {
  constexpr int most_steps = 10;
  const double rounding = rounding_of(radius);
  const bool may_lean = start.depth > tolerances::flat_overlap * radius;
  bool may_begin_beside = may_lean && beside.depth < start.depth;  // until a step stayed within the overlap
  bool has_begun_beside = false;
  bool was_in_vain = false;
  Witness best = start;
  Witness here = start;
  Stride stride(radius);
  const double worth_going_to = 1.0 + tolerances::worth_a_step;
  for (int i = 0; i < most_steps && !watch.late(); ++i) {
    const Place from = place_of(here.middle());
    // Of surfaces that are not convex what was measured elsewhere may deny what is here.
    const auto leave_out_denied = [&]() noexcept {
      of_a_.leave_out_below(from, -height_of(here.on_a), rounding);
      of_b_.leave_out_below(from, height_of(here.on_b), rounding);
    };
    const auto leads_beyond = [&](const Place& place, double depth) noexcept {
      return allowed_at(place) > (1.0 + tolerances::level_overlap) * depth;
    };
    leave_out_denied();
    Place next = highest(from, radius, watch);
    if (!leads_beyond(next, best.depth)) break;
    has_begun_beside = has_begun_beside && std::isfinite(allowed_at(next));
    if (has_begun_beside) {
      // Only what gets deeper than the start counts: unless the overlap reaches as far as that, this way is in vain.
      const double part = (worth_going_to * best.depth - here.depth) / (allowed_at(next) - here.depth);
      next = along(from, std::min(part, 1.0), along(next, -1.0, from));
    } else if (stride.length() < radius) {
      const Place nearby = highest(from, stride.length(), watch);
      if (leads_beyond(nearby, here.depth)) {
        next = nearby;
      } else {
        stride = Stride(radius);
      }
    }
    const double way = length_of(along(next, -1.0, from));
    Witness found;
    if (way > 0.0 && measure(next, here, may_lean, reach, watch, found)) {
      may_begin_beside = false;
      if (found.depth > best.depth) best = found;
      if (found.depth > here.depth) {
        here = found;
        has_begun_beside = false;
        stride.went(from, place_of(here.middle()));
        continue;
      }
    }
    leave_out_denied();
    if (!leads_beyond(next, has_begun_beside ? best.depth : here.depth)) continue;  // as is known now
    if (has_begun_beside) break;
    // By a wall, which bounds nothing, the overlap may be as deep as anything: that ends with the length of the way.
    const bool is_bounded = allowed_at(from) <= worth_going_to * here.depth;
    const bool is_worth_more =
        allowed_at(next) > worth_going_to * best.depth && (is_bounded || way > tolerances::worth_a_step * radius);
    if (may_begin_beside && (was_in_vain || !is_worth_more)) {
      // At the side of a spike uphill leads out of it whatever the step.
      may_begin_beside = false;
      has_begun_beside = true;
      here = beside;
      continue;
    }
    if (!is_worth_more) break;
    was_in_vain = true;
    stride.led_out(from, next);
  }
  return best;
}

}  // namespace odds::query::patch
