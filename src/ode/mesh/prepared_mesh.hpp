// What geoms share of one mesh: the shape for queries, and what collisions with primitives need beside it.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "odds/query/answer.hpp"
#include "odds/query/shape.hpp"
#include "odds/tree/wide_tree.hpp"

namespace odds::ode {

/// Immutable; shareable among geoms and threads.
struct PreparedMesh {
  /// So many triangles that meet at a point are looked at in a collision.
  static constexpr std::size_t most_touching = 64;
  /// A corner at which more meet, as at the tip of a cone.
  struct Fan {
    Vec3 tip;
    Vec3 normal;  ///< unit: the mean of theirs, weighted by their angles there
  };

  std::shared_ptr<const query::Shape> shape;  ///< never null
  std::optional<tree::WideTree> own_tree;     ///< where the shape has other bounding volumes
  const tree::WideTree* wide_tree = nullptr;  ///< that, or the shape's; never null
  bool closed = false;    ///< every edge has its opposite, and something is enclosed: inside and outside are defined
  std::vector<Fan> fans;  ///< by the x of their tips
  double thin = 0.0;      ///< metres: triangles no higher may be nothing but rounding (is_thin); 0: there are none

  PreparedMesh() = default;
  PreparedMesh(const PreparedMesh&) = delete;  // it points into itself
  PreparedMesh& operator=(const PreparedMesh&) = delete;

  /// Precondition: `shape` is not null. May throw std::bad_alloc, std::length_error.
  static std::shared_ptr<const PreparedMesh> make(std::shared_ptr<const query::Shape> shape);

  [[nodiscard]] const mesh::TriangleMesh& mesh() const noexcept { return shape->mesh(); }
  [[nodiscard]] std::array<Vec3, 3> corners(std::uint32_t triangle) const noexcept {
    const mesh::Triangle& t = mesh().triangles()[triangle];
    return {mesh().vertices()[t[0]], mesh().vertices()[t[1]], mesh().vertices()[t[2]]};
  }
};

}  // namespace odds::ode
