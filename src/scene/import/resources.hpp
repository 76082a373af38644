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
  /// Without vertices that no triangle uses; triangles agree with their neighbours, and closed parts face outwards.
  std::shared_ptr<const mesh::TriangleMesh> mesh(const std::string& uri, haptics::Place place);
  /// In how many files some had to be turned for that.
  [[nodiscard]] std::size_t turned() const { return turned_; }
  /// The mesh files that were read so far.
  [[nodiscard]] std::vector<std::filesystem::path> files() const;

 private:
  [[nodiscard]] std::filesystem::path locate(const std::string& uri, haptics::Place place) const;
  [[nodiscard]] std::vector<std::filesystem::path> candidates(const std::string& uri) const;
  [[noreturn]] void fail(haptics::Place place, const std::string& what, const std::string& remedy) const;

  std::filesystem::path description_;
  const ImportOptions& options_;
  std::size_t turned_ = 0;
  std::map<std::filesystem::path, std::shared_ptr<const mesh::TriangleMesh>> read_;
};

}  // namespace odds::scene
