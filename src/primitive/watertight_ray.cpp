#include "primitive/watertight_ray.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "odds/math/orient2d.hpp"

namespace odds::primitive {
namespace {

/// A corner as the ray sees it.
struct Seen {
  double x;  // the ray goes through 0, 0
  double y;
  double ahead;  // along the ray
};

struct Reach {
  double nearest;
  double farthest;
};

/// Where the line across the triangle that the ray sees at 0 of the coordinate in which it is longer enters and leaves
/// the triangle: what the ray crosses lies between, however thin the triangle is seen. The ray goes through it.
Reach between_edges(const Seen& a, const Seen& b, const Seen& c) noexcept {
  const auto [left, right] = std::minmax({a.x, b.x, c.x});
  const auto [low, high] = std::minmax({a.y, b.y, c.y});
  const auto coordinate = right - left >= high - low ? &Seen::x : &Seen::y;
  Reach reach = {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  const auto take = [&](double ahead) {
    reach.nearest = std::min(reach.nearest, ahead);
    reach.farthest = std::max(reach.farthest, ahead);
  };
  const auto cross = [&](const Seen& p, const Seen& q) {
    const double from = p.*coordinate;
    const double to = q.*coordinate;
    if (from == 0.0) take(p.ahead);
    if ((from < 0.0 && to > 0.0) || (from > 0.0 && to < 0.0)) {
      take(std::lerp(p.ahead, q.ahead, from / (from - to)));
    }
  };
  cross(a, b);
  cross(b, c);
  cross(c, a);
  if (reach.nearest <= reach.farthest) return reach;
  // So small that its turns underflow: that the ray goes through it was not to be told.
  const auto [nearest, farthest] = std::minmax({a.ahead, b.ahead, c.ahead});
  return {nearest, farthest};
}

}  // namespace

WatertightRay::WatertightRay(const Vec3& origin, const Vec3& direction, bool front_only) noexcept
    : origin_(origin), direction_(direction), front_only_(front_only) {
  Eigen::Index longest = 0;
  direction_.cwiseAbs().maxCoeff(&longest);
  z_ = static_cast<int>(longest);
  x_ = (z_ + 1) % 3;
  y_ = (z_ + 2) % 3;
}

double WatertightRay::crossing(const Vec3 corners[3]) const noexcept {
  constexpr double none = -1.0;
  const auto see = [this](const Vec3& corner) -> Seen {
    const Vec3 offset = corner - origin_;
    const double ahead = offset[z_] / direction_[z_];
    return {offset[x_] - ahead * direction_[x_], offset[y_] - ahead * direction_[y_], ahead};
  };
  const Seen a = see(corners[0]);
  const Seen b = see(corners[1]);
  const Seen c = see(corners[2]);
  const auto turn = [](const Seen& p, const Seen& q) { return math::orient2d(0.0, 0.0, p.x, p.y, q.x, q.y); };
  const int ab = turn(a, b);
  const int bc = turn(b, c);
  const int ca = turn(c, a);
  const bool left = ab >= 0 && bc >= 0 && ca >= 0;
  const bool right = ab <= 0 && bc <= 0 && ca <= 0;
  if (left == right) return none;  // outside, or seen edge-on
  const bool from_behind = left == (direction_[z_] > 0.0);
  if (from_behind && front_only_) return none;
  const auto area = [](const Seen& p, const Seen& q) { return p.x * q.y - p.y * q.x; };
  const double wa = area(b, c);
  const double wb = area(c, a);
  const double wc = area(a, b);
  const double sum = wa + wb + wc;
  // Of a triangle that is seen edge-on the weights are nothing but rounding.
  const auto [nearest, farthest] = between_edges(a, b, c);
  const bool is_sliver = !(std::abs(sum) > 0.0);
  const double distance =
      is_sliver ? nearest : std::clamp((wa * a.ahead + wb * b.ahead + wc * c.ahead) / sum, nearest, farthest);
  const bool no_area = (corners[1] - corners[0]).cross(corners[2] - corners[0]).squaredNorm() == 0.0;
  return no_area ? distance * (1.0 + no_area_is_farther) : distance;
}

}  // namespace odds::primitive
