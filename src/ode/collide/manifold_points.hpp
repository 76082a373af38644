// The points of one manifold of a convex body: which of them are worth having, and which come first.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>

#include "ode/collide/manifold.hpp"
#include "query/wide/points_by_eight.hpp"
#include "query/wide/searches.hpp"

namespace odds::ode {

struct ManifoldPoint {
  Vec3 position;  // on the surface, body frame
  double depth;   // metres inside the body, against the direction
  std::uint32_t triangle;
};

// The points of one manifold; only those with a depth worth having.
struct ManifoldPoints {
  static constexpr std::size_t most_points = 256;
  static constexpr std::size_t most_tips = 4;
  static constexpr double least_depth = 1e-3;  // of the deepest point of a manifold
  static constexpr double clearly_shallower = 0.99;

  std::array<ManifoldPoint, most_points + most_tips> all;
  std::size_t count = 0;
  Vec3 normal = Vec3::Zero();

  void add(const Vec3& position, double depth, std::uint32_t triangle, std::size_t most = most_points) noexcept {
    if (count < most) all[count++] = {position, depth, triangle};
  }
  [[nodiscard]] double deepest() const noexcept {
    double depth = 0.0;
    for (std::size_t i = 0; i < count; ++i) depth = std::max(depth, all[i].depth);
    return depth;
  }
  // Drops points that touch only: they would push where nothing overlaps, and hide deeper ones at the same place.
  void keep_deep() noexcept {
    const auto shallow = [least = least_depth * deepest()](const ManifoldPoint& p) { return p.depth < least; };
    count = static_cast<std::size_t>(std::remove_if(all.begin(), all.begin() + count, shallow) - all.begin());
  }
  // Drops points that are nearer than `distance` to one that is clearly deeper. When `may_go_on()` says no, the deepest
  // have been looked at, and are kept.
  template <class MayGoOn>
  void keep_apart(double distance, const MayGoOn& may_go_on) noexcept {
    constexpr std::size_t between_looks = 8;
    if (!(distance > 0.0)) return;
    struct Ranked {  // points are too long to be moved about themselves
      double depth;
      std::uint32_t index;
    };
    std::array<Ranked, most_points + most_tips> ranked;
    for (std::uint32_t i = 0; i < count; ++i) ranked[i] = {all[i].depth, i};
    // A heap, the deepest on top: where time ends it, most need not be sorted.
    const auto comes_later = [](const Ranked& a, const Ranked& b) {
      return a.depth != b.depth ? a.depth < b.depth : a.index > b.index;
    };
    std::make_heap(ranked.begin(), ranked.begin() + count, comes_later);
    std::array<ManifoldPoint, most_points + most_tips> kept;
    std::size_t kept_count = 0;
    for (std::size_t i = 0; i < count && (i % between_looks != 0 || i == 0 || may_go_on()); ++i) {
      std::pop_heap(ranked.begin(), ranked.begin() + (count - i), comes_later);
      const ManifoldPoint& point = all[ranked[count - i - 1].index];
      bool hidden = false;
      for (std::size_t k = 0; k < kept_count && !hidden; ++k) {
        if (!(kept[k].depth * clearly_shallower > point.depth)) break;  // nor is any after it
        hidden = (kept[k].position - point.position).squaredNorm() < distance * distance;
      }
      if (!hidden) kept[kept_count++] = point;
    }
    std::copy_n(kept.begin(), kept_count, all.begin());
    count = kept_count;
  }
};

// Finished points as a source for select_manifold, which asks for the outermost of them up to seventeen times.
class ManifoldSource {
 public:
  explicit ManifoldSource(const ManifoldPoints& points) noexcept : points_(points) {
    for (std::size_t i = 0; i < points.count; ++i) {
      const ManifoldPoint& point = points.all[i];
      by_eight_.add(point.position, point.depth);
      deepest_ = std::max(deepest_, point.depth);
    }
  }
  [[nodiscard]] const Vec3& position(std::uint32_t i) const noexcept { return points_.all[i].position; }
  // Of the deepest the outermost: stable where a whole face lies on the surface.
  [[nodiscard]] std::uint32_t first() const noexcept {
    constexpr double equally_deep = 1.0 - 1e-6;
    Vec3 middle = Vec3::Zero();
    for (std::size_t i = 0; i < points_.count; ++i) middle += points_.all[i].position;
    middle /= static_cast<double>(std::max<std::size_t>(points_.count, 1));
    return kernels_.outermost_from(by_eight_.all(), middle, Vec3::Zero(), 0.0, equally_deep * deepest_, 1);
  }
  [[nodiscard]] std::uint32_t farthest(const Vec3& from) const noexcept {
    return kernels_.outermost_from(by_eight_.all(), from, points_.normal, deeper_at_one_place * deepest_, any_depth, 1);
  }
  [[nodiscard]] std::uint32_t extreme(const Vec3& direction) const noexcept {
    return kernels_.outermost_along(by_eight_.all(), direction, deeper_at_one_place * direction.norm(), any_depth, 1);
  }

 private:
  static constexpr double any_depth = std::numeric_limits<double>::lowest();

  const ManifoldPoints& points_;
  const query::wide::Searches& kernels_ = *query::wide::searches_for(query::InstructionSet::best);
  double deepest_ = 0.0;
  query::wide::PointsByEight<ManifoldPoints::most_points + ManifoldPoints::most_tips> by_eight_;
};

}  // namespace odds::ode
