// A mesh by the word that a benchmark was given for it.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "odds/mesh/made/by_name.hpp"
#include "odds/mesh/read.hpp"

namespace odds::benchmark {

/// A made shape, or a file.
[[nodiscard]] inline Result<std::shared_ptr<const mesh::TriangleMesh>> mesh_of(const std::string& argument) {
  auto mesh = argument.starts_with(mesh::made::prefix) ? mesh::made::make_shape(argument) : mesh::read(argument);
  if (!mesh.ok()) return mesh.error();
  return std::make_shared<const mesh::TriangleMesh>(std::move(mesh).value());
}

}  // namespace odds::benchmark
