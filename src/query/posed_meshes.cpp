#include "query/posed_meshes.hpp"

#include "odds/primitive/triangle_triangle.hpp"

namespace odds::query {

bool PosedMeshes::meet(TrianglePair pair) const noexcept {
  const tree::TriangleCorners a = corners_a(pair.a);
  const tree::TriangleCorners b = corners_b(pair.b);
  return primitive::triangles_intersect(a.data(), b.data());
}

}  // namespace odds::query
