// Where flat faces of two trees lie on each other: a search for what else touches passes it over.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <utility>

#include "query/wide/box_kernel.hpp"

namespace odds::query::wide {

/// A few layers, each between two faces that overlap, along one or the other. What two surfaces have in common within
/// one is known to touch, or is the rim of what does.
class KnownFaces {
 public:
  static constexpr std::size_t most = 8;  ///< of four pairs of faces that lean; more are left out

  /// By its middle plane, normal . x = offset, in either tree's own frame.
  struct Layer {
    float normal[2][3];
    float offset[2];  ///< metres
    float half;       ///< of its thickness, metres
  };

  void add(const Layer& layer) noexcept {
    if (count_ < most) layers_[count_++] = layer;
  }
  /// Whether two triangles, both in the frame of A's tree, can meet within one of the layers only.
  [[nodiscard]] bool include(const tree::TriangleCorners& a, const tree::TriangleCorners& b) const noexcept {
    const auto can_meet_within = [&](const Layer& layer) noexcept {
      const auto [low_a, high_a] = heights(layer, a);
      const auto [low_b, high_b] = heights(layer, b);
      return std::min(high_a, high_b) <= layer.half && std::max(low_a, low_b) >= -layer.half;
    };
    return std::any_of(layers().begin(), layers().end(), can_meet_within);
  }
  [[nodiscard]] std::span<const Layer> layers() const noexcept { return std::span(layers_).first(count_); }

 private:
  [[nodiscard]] static std::pair<double, double> heights(const Layer& layer,
                                                         const tree::TriangleCorners& corners) noexcept {
    const Vec3 normal(layer.normal[0][0], layer.normal[0][1], layer.normal[0][2]);
    const double offset = layer.offset[0];
    return std::minmax(
        {normal.dot(corners[0]) - offset, normal.dot(corners[1]) - offset, normal.dot(corners[2]) - offset});
  }

  std::array<Layer, most> layers_;
  std::size_t count_ = 0;
};

/// How far nodes reach to either side of a layer's middle plane. The node's own slab tells of faces that are askew to
/// the tree's axes: with its normal m and cosine = n . m, n = cosine m + rest.
template <class K>
struct Heights {
  using F = typename K::F;
  using L = typename K::Lanes;
  F low;
  F high;

  template <class Volumes>
  ODDS_LANES_INLINE Heights(const Volumes& volumes, const float normal[3], float offset) noexcept {
    F n[3];
    F m[3];
    for (int i = 0; i < 3; ++i) {
      n[i] = L::all(normal[i]);
      m[i] = volumes.normal(i);
    }
    const F cosine = (m[0] * n[0] + m[1] * n[1]) + m[2] * n[2];
    F reach = L::abs(cosine) * volumes.thickness();
    F along = cosine * volumes.offset() - L::all(offset);
    for (int i = 0; i < 3; ++i) {
      reach = reach + L::abs(n[i] - cosine * m[i]) * volumes.half(i);
      along = along + n[i] * volumes.center(i);
    }
    low = along - reach;
    high = along + reach;
  }
};

/// The lanes of one side's node that a box of the other side can meet within the layer only.
template <class K>
[[nodiscard]] ODDS_LANES_INLINE unsigned lanes_within(const KnownFaces::Layer& layer, std::uint32_t side,
                                                      const typename K::Nodes& nodes,
                                                      const typename K::Boxes& boxes) noexcept {
  using L = typename K::Lanes;
  const Heights<K> of_nodes(nodes, layer.normal[side], layer.offset[side]);
  const Heights<K> of_box(boxes, layer.normal[1 - side], layer.offset[1 - side]);
  const auto high = L::min(of_nodes.high, of_box.high);
  const auto low = L::max(of_nodes.low, of_box.low);
  return L::less_equal(high, L::all(layer.half)) & L::less_equal(L::all(-layer.half), low);
}

}  // namespace odds::query::wide
