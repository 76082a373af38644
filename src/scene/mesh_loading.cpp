// Finding, reading and building meshes.
#include "scene/mesh_loading.hpp"

#include <fmt/core.h>

#include <cstdlib>

#include "odds/mesh/made/by_name.hpp"
#include "odds/mesh/read.hpp"
#include "odds/query/saved_shape.hpp"

namespace odds::scene {
namespace {

// "${NAME}/rest" with the variable's value; empty if a variable is not set.
std::string fill_in_environment(const std::string& text) {
  std::string filled;
  std::size_t at = 0;
  while (true) {
    const std::size_t begin = text.find("${", at);
    const std::size_t end = begin == std::string::npos ? begin : text.find('}', begin);
    if (end == std::string::npos) return filled + text.substr(at);
    const char* value = std::getenv(text.substr(begin + 2, end - begin - 2).c_str());
    if (value == nullptr) return {};
    filled += text.substr(at, begin - at) + value;
    at = end + 1;
  }
}

// An error about a mesh that was made or read, with the line of the scene that asked for it.
Error at_scene(const Scene& scene, const Mesh& mesh, const Error& error) {
  return {scene.file, mesh.place.text(), fmt::format("mesh '{}': {}", mesh.name, error.message()),
          error.remedy.empty() ? "use another mesh" : ""};
}

}  // namespace

Result<std::filesystem::path> locate_mesh(const Scene& scene, const Mesh& mesh) {
  std::string tried;
  const auto there = [&](const std::filesystem::path& path) {
    std::error_code code;
    if (std::filesystem::is_regular_file(path, code)) return true;
    tried += (tried.empty() ? "" : ", ") + path.lexically_normal().string();
    return false;
  };
  if (const auto path = scene.base_directory / mesh.file; there(path)) return path;
  for (const std::string& entry : scene.search) {
    const std::string directory = fill_in_environment(entry);
    if (directory.empty()) continue;
    if (const auto path = scene.base_directory / directory / mesh.file; there(path)) return path;
  }
  const std::string remedy =
      mesh.package.empty()
          ? std::string("correct 'file', or add its directory to 'search'")
          : fmt::format("install the package '{}', or add the file's directory to 'search'", mesh.package);
  return Error{scene.file, mesh.place.text(),
               fmt::format("the file '{}' of the mesh '{}' is not there (tried {})", mesh.file, mesh.name, tried),
               remedy};
}

namespace {

/// A hierarchy that `odds build` saved, if it is what the scene needs.
Result<std::shared_ptr<const query::Shape>> load_saved(const Scene& scene, const Mesh& mesh,
                                                       const std::filesystem::path& path) {
  auto shape = query::load_shape(path);
  if (!shape) return at_scene(scene, mesh, shape.error());
  const auto refused = [&](const std::string& what, const std::string& remedy) {
    return at_scene(scene, mesh, {path.string(), "", what, remedy});
  };
  if (mesh.scale != 1.0) {
    return refused("a saved hierarchy is in metres, so a scale does not apply", "give the scale to `odds build`");
  }
  if (!shape.value()->has_polygons()) {
    return refused("its polygons were dropped, and a scene needs them", "build the file without --polygon-free");
  }
  if (shape.value()->volume() != scene.volume) {
    return refused(fmt::format("its bounding volume is {}, that of the scene {}", volume::name(shape.value()->volume()),
                               volume::name(scene.volume)),
                   "build the file with the scene's volume");
  }
  return shape;
}

}  // namespace

Result<std::shared_ptr<const query::Shape>> load_shape(const Scene& scene, const Mesh& mesh,
                                                       const std::function<void(double share)>& progress) {
  std::shared_ptr<const mesh::TriangleMesh> triangles;
  if (mesh.file.starts_with(mesh::made::prefix)) {
    Result<mesh::TriangleMesh> made = mesh::made::make_shape(mesh.file);
    if (!made) return at_scene(scene, mesh, made.error());
    triangles = std::make_shared<const mesh::TriangleMesh>(std::move(made).value());
  } else {
    const Result<std::filesystem::path> path = locate_mesh(scene, mesh);
    if (!path) return path.error();
    if (query::is_saved_shape(path.value())) return load_saved(scene, mesh, path.value());
    mesh::ReadOptions options;
    options.scale = mesh.scale;
    Result<mesh::TriangleMesh> read = mesh::read(path.value(), options);
    if (!read) return at_scene(scene, mesh, read.error());
    triangles = std::make_shared<const mesh::TriangleMesh>(std::move(read).value());
  }
  query::ShapeOptions options;
  options.volume = scene.volume;
  Result<std::shared_ptr<const query::Shape>> shape = query::Shape::build(triangles, options, progress);
  if (!shape) return at_scene(scene, mesh, shape.error());
  return shape;
}

}  // namespace odds::scene
