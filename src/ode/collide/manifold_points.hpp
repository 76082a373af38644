// The points of one manifold of a convex body: which of them are worth having, and which come first.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>

#include "ode/collide/manifold.hpp"

namespace odds::ode {

struct ManifoldPoint {
  Vec3 position;  // on the surface, body frame
  double depth;   // metres inside the body, against the direction
  std::uint32_t triangle;
};

// The points of one manifold as a source for select_manifold; only those with a depth worth having.
struct ManifoldPoints {
  static constexpr std::size_t most_points = 256;
  static constexpr std::size_t most_tips = 4;
  static constexpr double least_depth = 1e-3;  // of the deepest point of a manifold
  static constexpr double equally_deep = 1.0 - 1e-6;
  static constexpr double clearly_shallower = 0.99;

  std::array<ManifoldPoint, most_points + most_tips> all;
  std::size_t count = 0;
  Vec3 normal = Vec3::Zero();

  void add(const Vec3& position, double depth, std::uint32_t triangle, std::size_t most = most_points) noexcept {
    if (count < most) all[count++] = {position, depth, triangle};
  }
  // Drops points that touch only: they would push where nothing overlaps, and hide deeper ones at the same place.
  void keep_deep() noexcept {
    double deepest = 0.0;
    for (std::size_t i = 0; i < count; ++i) deepest = std::max(deepest, all[i].depth);
    const auto shallow = [deepest](const ManifoldPoint& p) { return p.depth < least_depth * deepest; };
    count = static_cast<std::size_t>(std::remove_if(all.begin(), all.begin() + count, shallow) - all.begin());
  }
  // Drops points that are nearer than `distance` to one that is clearly deeper.
  void keep_apart(double distance) noexcept {
    if (!(distance > 0.0)) return;
    std::sort(all.begin(), all.begin() + count,
              [](const ManifoldPoint& a, const ManifoldPoint& b) { return a.depth > b.depth; });
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count; ++i) {
      bool hidden = false;
      for (std::size_t k = 0; k < kept && !hidden; ++k) {
        if (!(all[k].depth * clearly_shallower > all[i].depth)) break;  // nor is any after it
        hidden = (all[k].position - all[i].position).norm() < distance;
      }
      if (!hidden) all[kept++] = all[i];
    }
    count = kept;
  }
  [[nodiscard]] const Vec3& position(std::uint32_t i) const noexcept { return all[i].position; }
  template <class Value>
  [[nodiscard]] std::uint32_t greatest(const Value& value) const noexcept {
    std::uint32_t best = no_item;
    double best_value = -std::numeric_limits<double>::infinity();
    for (std::uint32_t i = 0; i < count; ++i) {
      const double v = value(all[i]);
      if (v > best_value) {
        best_value = v;
        best = i;
      }
    }
    return best;
  }
  // Of the deepest the outermost: stable where a whole face lies on the surface.
  [[nodiscard]] std::uint32_t first() const noexcept {
    double deepest = 0.0;
    Vec3 middle = Vec3::Zero();
    for (std::size_t i = 0; i < count; ++i) {
      deepest = std::max(deepest, all[i].depth);
      middle += all[i].position / static_cast<double>(count);
    }
    return greatest([&](const ManifoldPoint& p) {
      return p.depth < equally_deep * deepest ? -1.0 : (p.position - middle).squaredNorm();
    });
  }
  [[nodiscard]] std::uint32_t farthest(const Vec3& from) const noexcept {
    return greatest([&](const ManifoldPoint& p) {
      const Vec3 d = p.position - from;
      return (d - d.dot(normal) * normal).squaredNorm() + deeper_at_one_place * p.depth * p.depth;
    });
  }
  [[nodiscard]] std::uint32_t extreme(const Vec3& direction) const noexcept {
    const double for_depth = deeper_at_one_place * direction.norm();
    return greatest([&](const ManifoldPoint& p) { return direction.dot(p.position) + for_depth * p.depth; });
  }
};

}  // namespace odds::ode
