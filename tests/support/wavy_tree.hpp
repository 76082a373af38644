// A wavy sphere anywhere, with its wide tree.
#pragma once

#include <memory>
#include <utility>
#include <variant>
#include <vector>

#include "odds/query/shape.hpp"
#include "odds/tree/wide_tree.hpp"
#include "query/shape_data.hpp"
#include "support/shapes.hpp"

namespace odds::testing {

struct WavyTree {
  explicit WavyTree(const Vec3& middle) {
    const auto sphere = wavy_sphere(24);
    std::vector<Vec3> vertices(sphere->vertices().begin(), sphere->vertices().end());
    for (Vec3& vertex : vertices) vertex += middle;
    std::vector<mesh::Triangle> triangles(sphere->triangles().begin(), sphere->triangles().end());
    mesh = std::make_shared<const mesh::TriangleMesh>(
        mesh::TriangleMesh::make(std::move(vertices), std::move(triangles)).value());
    shape = query::Shape::build(mesh).value();
    tree = &std::get<tree::WideTree>(shape->data().tree);
  }

  std::shared_ptr<const mesh::TriangleMesh> mesh;
  std::shared_ptr<const query::Shape> shape;
  const tree::WideTree* tree = nullptr;
};

}  // namespace odds::testing
