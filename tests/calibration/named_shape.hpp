// Shapes by the name of a mesh.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "odds/mesh/made/by_name.hpp"
#include "odds/mesh/read.hpp"
#include "odds/query/shape.hpp"

namespace odds::calibration {

using SharedShape = std::shared_ptr<const query::Shape>;

/// A file or a made: name. Fails as reading and building do.
[[nodiscard]] inline Result<SharedShape> named_shape(const std::string& argument, volume::Kind volume) {
  auto mesh = argument.starts_with(mesh::made::prefix) ? mesh::made::make_shape(argument) : mesh::read(argument);
  if (!mesh.ok()) return mesh.error();
  query::ShapeOptions options;
  options.volume = volume;
  return query::Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(mesh).value()), options);
}

}  // namespace odds::calibration
