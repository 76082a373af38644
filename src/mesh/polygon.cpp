#include "mesh/polygon.hpp"

#include <algorithm>

#include "odds/math/orient2d.hpp"

namespace odds::mesh {
namespace {

/// Vertices seen along an axis, from the side to which the polygon faces.
class View {
 public:
  View(std::span<const Vec3> vertices, std::span<const Triangle> fan) : vertices_(vertices) {
    const Vec3& first = vertices[fan.front()[0]];
    Vec3 normal = Vec3::Zero();  // twice the polygon's area, whatever its shape
    for (const Triangle& t : fan) normal += (vertices[t[1]] - first).cross(vertices[t[2]] - first);
    Eigen::Index axis = 0;
    const double most = normal.cwiseAbs().maxCoeff(&axis);
    if (!(most > 0.0)) return;
    u_ = (axis + 1) % 3;
    v_ = (axis + 2) % 3;
    side_ = normal[axis] > 0.0 ? 1 : -1;
  }

  [[nodiscard]] bool faces_nowhere() const { return side_ == 0; }
  /// 1: the corners turn as the polygon does. -1: the other way. Exact.
  [[nodiscard]] int turn(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    return side_ * math::orient2d(x(a), y(a), x(b), y(b), x(c), y(c));
  }
  /// Whether d lies beside the box of a, b and c: quickly, most do.
  [[nodiscard]] bool beside(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) const {
    return x(d) < std::min({x(a), x(b), x(c)}) || x(d) > std::max({x(a), x(b), x(c)}) ||
           y(d) < std::min({y(a), y(b), y(c)}) || y(d) > std::max({y(a), y(b), y(c)});
  }
  [[nodiscard]] bool same_place(std::uint32_t a, std::uint32_t b) const { return x(a) == x(b) && y(a) == y(b); }
  /// Whether d lies in the triangle a b c, which turns as the polygon does, or on a side of it.
  [[nodiscard]] bool holds(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) const {
    return turn(a, b, d) >= 0 && turn(b, c, d) >= 0 && turn(c, a, d) >= 0;
  }

 private:
  [[nodiscard]] double x(std::uint32_t vertex) const { return vertices_[vertex][u_]; }
  [[nodiscard]] double y(std::uint32_t vertex) const { return vertices_[vertex][v_]; }

  std::span<const Vec3> vertices_;
  Eigen::Index u_ = 0;
  Eigen::Index v_ = 1;
  int side_ = 0;
};

bool folds(const View& view, std::span<const Triangle> fan) {
  return std::any_of(fan.begin(), fan.end(), [&](const Triangle& t) { return view.turn(t[0], t[1], t[2]) < 0; });
}

class Cutter {
 public:
  Cutter(std::span<const Vec3> vertices, std::span<Triangle> fan, std::vector<RingCorner>& ring,
         std::uint64_t& looks_left)
      : view_(vertices, fan), fan_(fan), ring_(ring), looks_left_(looks_left) {
    ring_.clear();
    const auto add = [this](std::uint32_t vertex) {
      ring_.push_back({vertex, static_cast<std::uint32_t>(ring_.size() + 1)});
    };
    add(fan.front()[0]);
    add(fan.front()[1]);
    for (const Triangle& t : fan) add(t[2]);
    ring_.back().next = 0;
  }

  void run() {
    std::size_t refused = 0;
    std::size_t left = ring_.size();
    std::uint32_t before = 0;  // the corner in front of the one that is judged
    while (left > 3 && refused < left && looks_left_ > 0) {
      const std::uint32_t at = ring_[before].next;
      if (!is_ear(before)) {
        before = at;
        ++refused;
        continue;
      }
      const std::uint32_t after = ring_[at].next;
      put(ring_[before].vertex, ring_[at].vertex, ring_[after].vertex);
      ring_[before].next = after;
      before = after;  // from here on: else one corner would be in all triangles
      --left;
      refused = 0;
    }
    const std::size_t rest = done_;
    for (std::uint32_t at = ring_[before].next; ring_[at].next != before; at = ring_[at].next) {
      put(ring_[before].vertex, ring_[at].vertex, ring_[ring_[at].next].vertex);
    }
    if (folds(view_, fan_.subspan(rest))) restore();
  }

 private:
  void put(std::uint32_t a, std::uint32_t b, std::uint32_t c) { fan_[done_++] = {a, b, c}; }
  void restore() {
    for (std::size_t i = 0; i < fan_.size(); ++i) fan_[i] = {ring_[0].vertex, ring_[i + 1].vertex, ring_[i + 2].vertex};
  }

  [[nodiscard]] bool is_ear(std::uint32_t before) {
    const std::uint32_t at = ring_[before].next;
    const std::uint32_t after = ring_[at].next;
    const std::uint32_t a = ring_[before].vertex;
    const std::uint32_t b = ring_[at].vertex;
    const std::uint32_t c = ring_[after].vertex;
    if (view_.turn(a, b, c) <= 0) return false;
    for (std::uint32_t other = ring_[after].next; other != before; other = ring_[other].next) {
      if (looks_left_ == 0) return false;
      --looks_left_;
      const std::uint32_t d = ring_[other].vertex;
      if (view_.beside(a, b, c, d)) continue;
      // A slit to a hole passes its corners twice.
      if (view_.same_place(d, a) || view_.same_place(d, b) || view_.same_place(d, c)) continue;
      if (view_.holds(a, b, c, d)) return false;
    }
    return true;
  }

  View view_;
  std::span<Triangle> fan_;
  std::vector<RingCorner>& ring_;
  std::size_t done_ = 0;
  std::uint64_t& looks_left_;
};

}  // namespace

bool fan_folds(std::span<const Vec3> vertices, std::span<const Triangle> fan) {
  const View view(vertices, fan);
  return !view.faces_nowhere() && folds(view, fan);
}

void cut_ears(std::span<const Vec3> vertices, std::span<Triangle> fan, std::vector<RingCorner>& ring,
              std::uint64_t& looks_left) {
  Cutter(vertices, fan, ring, looks_left).run();
}

}  // namespace odds::mesh
