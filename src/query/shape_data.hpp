// What a Shape holds: the one place where the list of volumes becomes types.
#pragma once

#include <memory>
#include <variant>

#include "odds/query/shape.hpp"
#include "odds/tree/hierarchy.hpp"
#include "odds/volume/aabb.hpp"
#include "odds/volume/hull.hpp"
#include "odds/volume/kdop.hpp"
#include "odds/volume/obb.hpp"
#include "odds/volume/sphere.hpp"

namespace odds::query {

/// In the order of volume::Kind.
using AnyHierarchy =
    std::variant<tree::Hierarchy<volume::Aabb>, tree::Hierarchy<volume::Obb>, tree::Hierarchy<volume::Sphere>,
                 tree::Hierarchy<volume::Kdop14>, tree::Hierarchy<volume::Kdop18>, tree::Hierarchy<volume::Kdop26>,
                 tree::Hierarchy<volume::Hull>>;
static_assert(std::variant_size_v<AnyHierarchy> == volume::kind_names.size());

struct Shape::Data {
  std::shared_ptr<const mesh::TriangleMesh> mesh;
  ShapeOptions options;
  ShapeSummary summary;
  bool solid = false;  ///< closed, oriented outwards
  AnyHierarchy hierarchy;
};

}  // namespace odds::query
