#include "tree/split.hpp"

#include <algorithm>
#include <array>

namespace odds::tree {
namespace {

constexpr int bin_count = 16;

struct Plane {
  int axis = -1;
  float position = 0.0F;
};

struct Bins {
  std::array<SplitBounds, bin_count> bounds;
  std::array<std::uint32_t, bin_count> counts{};
};

// Bins per metre; 0 along axes where centroids do not differ enough to be told apart.
Eigen::Array4f bin_scale(const SplitBounds& centroids) noexcept {
  Eigen::Array4f scale = Eigen::Array4f::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    const float extent = centroids.upper[axis] - centroids.lower[axis];
    if (!(extent > 0.0F)) continue;
    const float per_metre = static_cast<float>(bin_count) / extent;
    if (per_metre < std::numeric_limits<float>::max()) scale[axis] = per_metre;
  }
  return scale;
}

void fill(std::array<Bins, 3>& bins, std::span<const SplitReference> references, const Eigen::Array4f& lower,
          const Eigen::Array4f& scale) noexcept {
  for (const SplitReference& reference : references) {
    const Eigen::Array4f place = (reference.centroid() - lower) * scale;
    const Eigen::Array4i bin = place.max(0.0F).min(bin_count - 1.0F).cast<int>();
    for (int axis = 0; axis < 3; ++axis) {
      Bins& along = bins[static_cast<std::size_t>(axis)];
      const auto i = static_cast<std::size_t>(bin[axis]);
      along.bounds[i].add(reference.bounds);
      ++along.counts[i];
    }
  }
}

// The bin after which to split most cheaply, if that costs less than `best_cost`, which is then updated; else -1.
int cheapest(const Bins& bins, std::size_t count, double& best_cost) noexcept {
  std::array<double, bin_count> right_cost;
  SplitBounds right;
  std::uint32_t right_count = 0;
  for (std::size_t bin = bin_count - 1; bin > 0; --bin) {
    // An empty bin changes nothing: the plane before it is as good as the one after it.
    if (bins.counts[bin] == 0) continue;
    right.add(bins.bounds[bin]);
    right_count += bins.counts[bin];
    right_cost[bin] = right.half_area() * right_count;
  }
  int best = -1;
  SplitBounds left;
  std::uint32_t left_count = 0;
  int after = -1;  // the last bin with something in it
  for (std::size_t bin = 0; bin < bin_count; ++bin) {
    if (bins.counts[bin] == 0) continue;
    if (after >= 0) {
      const double cost = left.half_area() * left_count + right_cost[bin];
      if (cost < best_cost) {
        best_cost = cost;
        best = after;
      }
    }
    left.add(bins.bounds[bin]);
    left_count += bins.counts[bin];
    if (left_count == count) break;
    after = static_cast<int>(bin);
  }
  return best;
}

Plane best_plane(std::span<const SplitReference> references, const SplitBounds& centroids) noexcept {
  const Eigen::Array4f scale = bin_scale(centroids);
  std::array<Bins, 3> bins;
  fill(bins, references, centroids.lower, scale);
  Plane best;
  double best_cost = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    if (!(scale[axis] > 0.0F)) continue;
    const int bin = cheapest(bins[static_cast<std::size_t>(axis)], references.size(), best_cost);
    if (bin < 0) continue;
    const float extent = centroids.upper[axis] - centroids.lower[axis];
    best = {axis, centroids.lower[axis] + extent * (static_cast<float>(bin + 1) / bin_count)};
  }
  return best;
}

// Keeps the order on both sides.
std::size_t partition(std::span<SplitReference> references, std::span<SplitReference> scratch,
                      const Plane& plane) noexcept {
  std::size_t left = 0;
  std::size_t right = 0;
  for (const SplitReference& reference : references) {
    // Both are written and one is kept: which one, nobody can predict.
    const bool is_left =
        0.5F * (reference.bounds.lower[plane.axis] + reference.bounds.upper[plane.axis]) < plane.position;
    const SplitReference copy = reference;
    references[left] = copy;
    scratch[right] = copy;
    left += is_left ? 1 : 0;
    right += is_left ? 0 : 1;
  }
  std::copy_n(scratch.begin(), right, references.begin() + static_cast<std::ptrdiff_t>(left));
  return left;
}

}  // namespace

SplitBounds centroid_bounds(std::span<const SplitReference> references) noexcept {
  SplitBounds bounds;
  for (const SplitReference& reference : references) bounds.add(reference.centroid());
  return bounds;
}

std::size_t split(std::span<SplitReference> references, std::span<SplitReference> scratch, const SplitBounds& centroids,
                  bool at_median) noexcept {
  if (!at_median) {
    if (const Plane plane = best_plane(references, centroids); plane.axis >= 0) {
      const std::size_t left = partition(references, scratch, plane);
      if (left != 0 && left != references.size()) return left;
    }
  }
  int axis = 0;
  (centroids.upper - centroids.lower).head<3>().maxCoeff(&axis);
  const std::size_t half = references.size() / 2;
  std::nth_element(references.begin(), references.begin() + static_cast<std::ptrdiff_t>(half), references.end(),
                   [axis](const SplitReference& p, const SplitReference& q) {
                     const float at_p = p.centroid()[axis];
                     const float at_q = q.centroid()[axis];
                     return at_p != at_q ? at_p < at_q : p.triangle() < q.triangle();
                   });
  return half;
}

}  // namespace odds::tree
