// What a Shape holds: the one place where the list of volumes becomes types.
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <type_traits>
#include <variant>
#include <vector>

#include "mesh/flat_faces.hpp"
#include "odds/query/shape.hpp"
#include "odds/tree/hierarchy.hpp"
#include "odds/tree/wide_tree.hpp"
#include "odds/volume/aabb.hpp"
#include "odds/volume/hull.hpp"
#include "odds/volume/kdop.hpp"
#include "odds/volume/obb.hpp"
#include "odds/volume/sphere.hpp"

namespace odds::query {

template <class... V>
struct Volumes {
  using AnyTree = std::variant<tree::Hierarchy<V>..., tree::WideTree>;
};

/// The volumes of the generic framework, in the order of volume::Kind; the wide engine comes after them.
using GenericVolumes =
    Volumes<volume::Aabb, volume::Obb, volume::Sphere, volume::Kdop14, volume::Kdop18, volume::Kdop26, volume::Hull>;
using AnyTree = GenericVolumes::AnyTree;
static_assert(std::variant_size_v<AnyTree> == volume::kind_names.size());

/// The kind of a volume of the generic framework.
template <class V>
inline constexpr volume::Kind kind_of = []<class... Tree>(std::type_identity<std::variant<Tree...>>) {
  std::size_t place = 0;
  std::size_t found = sizeof...(Tree);
  ((found = std::is_same_v<Tree, tree::Hierarchy<V>> ? place : found, ++place), ...);
  return static_cast<volume::Kind>(found);
}(std::type_identity<AnyTree>{});

struct Shape::Data {
  std::shared_ptr<const mesh::TriangleMesh> mesh;
  ShapeOptions options;
  ShapeSummary summary;
  bool solid = false;    ///< closed, oriented outwards
  bool polygons = true;  ///< false: the mesh is a box, and leaves hold no triangles
  AnyTree tree;

  /// The large flat faces of a solid, found when they are asked for first; of another body none. Thread-safe.
  [[nodiscard]] const std::vector<mesh::FlatFace>& flat_faces() const {
    std::call_once(looked_for_faces, [this] {
      if (solid && polygons) faces = mesh::find_flat_faces(*mesh);
    });
    return faces;
  }
  mutable std::once_flag looked_for_faces;
  mutable std::vector<mesh::FlatFace> faces;
};

}  // namespace odds::query
