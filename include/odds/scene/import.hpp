// Robot and world descriptions (URDF, SDFormat) turned into a scene: its text, and the meshes that belong to it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "odds/math/error.hpp"
#include "odds/mesh/triangle_mesh.hpp"

namespace odds::scene {

/// Whether imported bodies move.
enum class ImportMotion : std::uint8_t {
  as_described,  ///< as the description says
  fixed,         ///< none does
  dynamic,       ///< all do, also those attached to the world
};

struct ImportOptions {
  /// Folders of packages and models, for "package://NAME/..." and "model://NAME/...".
  std::map<std::string, std::filesystem::path, std::less<>> packages;
  ImportMotion motion = ImportMotion::as_described;
};

/// A mesh of the imported scene, in its body's frame, metres.
struct ImportedMesh {
  std::string file;  ///< relative to the scene: "meshes/NAME.obj", of harmless characters only
  mesh::TriangleMesh mesh;
};

/// What an import made.
struct ImportedScene {
  std::string text;  ///< of a scene file; what was assumed stands in it as comments
  std::vector<ImportedMesh> meshes;
  std::vector<std::string> assumptions;  ///< sentences: what the description did not say or this library does not do
  std::vector<std::filesystem::path> sources;  ///< the files that were read: the description and its meshes
  std::uint64_t models = 0;
  std::uint64_t links = 0;
  std::uint64_t joints = 0;
  std::uint64_t bodies = 0;
};

/// Reads a URDF (root element <robot>) or SDFormat (<sdf>) file: links, collision geometry, joints, masses, friction.
/// Links that fixed joints connect become one body; joints that move are held at zero. The meshes named in it are read;
/// wherever the description points, only mesh files are opened, and nothing is written. DOCTYPE and entities of its own
/// are not expanded. Files beyond 8 MiB, models nested deeper than 32, names beyond 256
/// bytes and more than 20 million triangles are refused.
/// Errors name file, line and column, and what to do. Thread-safe.
Result<ImportedScene> import_description(const std::filesystem::path& path, const ImportOptions& options = {});

/// Writes DIR/scene.toml and the meshes. DIR is made; files of the same names are replaced, each whole or not at all,
/// but none of `sources`: an error, before any file is written.
[[nodiscard]] std::optional<Error> write_imported(const ImportedScene& imported, const std::filesystem::path& folder);

}  // namespace odds::scene
