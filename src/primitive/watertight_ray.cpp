#include "primitive/watertight_ray.hpp"

#include <algorithm>
#include <cmath>

#include "odds/math/orient2d.hpp"

namespace odds::primitive {

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
  struct Seen {
    double x;  // the ray goes through 0, 0
    double y;
    double ahead;  // along the ray
  };
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
  const auto [nearest, farthest] = std::minmax({a.ahead, b.ahead, c.ahead});
  const bool is_sliver = !(std::abs(sum) > 0.0);
  const double distance =
      is_sliver ? nearest : std::clamp((wa * a.ahead + wb * b.ahead + wc * c.ahead) / sum, nearest, farthest);
  const bool no_area = (corners[1] - corners[0]).cross(corners[2] - corners[0]).squaredNorm() == 0.0;
  return no_area ? distance * (1.0 + no_area_is_farther) : distance;
}

}  // namespace odds::primitive
