// Where the meshes of a description are, and what they hold.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "odds/mesh/triangle_mesh.hpp"
#include "odds/scene/import.hpp"
#include "scene/import/xml_reader.hpp"

namespace odds::scene {

/// Mesh files by the way they are named in descriptions; each is read once.
class Resources {
 public:
  Resources(const std::filesystem::path& description, const ImportOptions& options)
      : description_(description), options_(options) {}

  [[nodiscard]] const std::filesystem::path& description() const { return description_; }
  /// In the file's own units. Throws ImportFailure, which names the description, the place of the collision and every
  /// path that was tried.
  /// Without vertices that no triangle uses; a closed one whose triangles face inwards is turned.
  std::shared_ptr<const mesh::TriangleMesh> mesh(const std::string& uri, haptics::Place place);
  /// How many files were so.
  [[nodiscard]] std::size_t inside_out() const { return inside_out_; }
  /// The mesh files that were read so far.
  [[nodiscard]] std::vector<std::filesystem::path> files() const;

 private:
  [[nodiscard]] std::filesystem::path locate(const std::string& uri, haptics::Place place) const;
  [[nodiscard]] std::vector<std::filesystem::path> candidates(const std::string& uri) const;
  [[nodiscard]] mesh::TriangleMesh outwards(mesh::TriangleMesh mesh);
  [[noreturn]] void fail(haptics::Place place, const std::string& what, const std::string& remedy) const;

  std::filesystem::path description_;
  const ImportOptions& options_;
  std::size_t inside_out_ = 0;
  std::map<std::filesystem::path, std::shared_ptr<const mesh::TriangleMesh>> read_;
};

}  // namespace odds::scene
