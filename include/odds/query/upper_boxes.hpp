// Boxes about the upper nodes of a shape's hierarchy, for pictures of what a search looks at.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "odds/math/types.hpp"
#include "odds/query/shape.hpp"

namespace odds::query {

/// The box along the mesh's axes about a node's bounding volume. Metres, the mesh's frame.
struct UpperBox {
  Vec3 center = Vec3::Zero();
  Vec3 half = Vec3::Zero();
  std::uint32_t first = 0;     ///< its children are the boxes from this one on ...
  std::uint32_t children = 0;  ///< ... so many; 0: a leaf, or one that was not opened
};

/// The root first; then, until no more than `most` are there, the children of the largest node, and so on. May throw
/// bad_alloc.
[[nodiscard]] std::vector<UpperBox> upper_boxes(const Shape& shape, std::size_t most);

}  // namespace odds::query
