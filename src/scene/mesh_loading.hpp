// From the meshes that a scene names to shapes that can be collided.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "odds/math/error.hpp"
#include "odds/query/shape.hpp"
#include "odds/scene/scene.hpp"

namespace odds::scene {

/// Where a mesh's file is: as given, relative to the scene, or in one of its search directories. The error lists what
/// was tried, and the package that holds it.
Result<std::filesystem::path> locate_mesh(const Scene& scene, const Mesh& mesh);

/// Reads or makes the mesh and builds its hierarchy, or loads one that was saved.
Result<std::shared_ptr<const query::Shape>> load_shape(const Scene& scene, const Mesh& mesh,
                                                       const std::function<void(double share)>& progress);

}  // namespace odds::scene
