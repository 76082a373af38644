// package://, model://, file:// and plain paths.
#include "scene/import/resources.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string_view>

#include "odds/mesh/read.hpp"
#include "odds/mesh/repair.hpp"

namespace odds::scene {
namespace {

namespace fs = std::filesystem;

/// An environment variable that lists folders, and where in each of them packages are.
struct PathVariable {
  const char* name;
  const char* inside;
};
constexpr std::array<PathVariable, 5> path_variables = {{{"ROS_PACKAGE_PATH", ""},
                                                         {"AMENT_PREFIX_PATH", "share"},
                                                         {"GZ_SIM_RESOURCE_PATH", ""},
                                                         {"IGN_GAZEBO_RESOURCE_PATH", ""},
                                                         {"GAZEBO_MODEL_PATH", ""}}};

std::vector<fs::path> folders_of_environment() {
  std::vector<fs::path> folders;
  for (const PathVariable& variable : path_variables) {
    const char* value = std::getenv(variable.name);
    std::string_view rest = value == nullptr ? "" : value;
    while (!rest.empty()) {
      const std::size_t end = std::min(rest.find(':'), rest.size());
      if (end > 0) folders.emplace_back(rest.substr(0, end));
      if (end > 0 && *variable.inside != '\0') folders.back() /= variable.inside;
      rest.remove_prefix(std::min(end + 1, rest.size()));
    }
  }
  return folders;
}

int hex_digit(char c) noexcept {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

/// "%20" and the like as the bytes that they stand for; what is no two digits stays, and so does a byte 0.
std::string decoded(std::string_view address) {
  std::string text;
  for (std::size_t i = 0; i < address.size(); ++i) {
    const int high = i + 2 < address.size() && address[i] == '%' ? hex_digit(address[i + 1]) : -1;
    const int low = high >= 0 ? hex_digit(address[i + 2]) : -1;
    const int byte = low >= 0 ? 16 * high + low : 0;
    text += byte > 0 ? static_cast<char>(byte) : address[i];
    if (byte > 0) i += 2;
  }
  return text;
}

}  // namespace

void Resources::fail(haptics::Place place, const std::string& what, const std::string& remedy) const {
  throw ImportFailure{{description_.string(), place.text(), what, remedy}};
}

std::vector<fs::path> Resources::candidates(const std::string& uri) const {
  const fs::path here = description_.parent_path();
  std::vector<fs::path> found;
  for (const std::string_view scheme : {"package://", "model://"}) {
    if (!uri.starts_with(scheme)) continue;
    const fs::path rest = uri.substr(scheme.size());
    const std::string name = rest.empty() ? std::string() : rest.begin()->string();
    fs::path inside;
    for (auto part = rest.begin(); part != rest.end(); ++part) {
      if (part != rest.begin()) inside /= *part;
    }
    if (const auto known = options_.packages.find(name); known != options_.packages.end()) {
      return {known->second / inside};
    }
    // A description usually lies in a folder of the package that it names.
    const fs::path absolute = fs::absolute(description_).parent_path();
    for (fs::path folder = absolute;; folder = folder.parent_path()) {
      if (folder.filename() == name) found.push_back(folder / inside);
      found.push_back(folder / name / inside);
      if (folder == folder.parent_path()) break;
    }
    for (const fs::path& folder : folders_of_environment()) {
      if (folder.filename() == name) found.push_back(folder / inside);
      found.push_back(folder / name / inside);
    }
    return found;
  }
  if (uri.starts_with("file://")) return {here / uri.substr(7)};  // an absolute path stays as it is
  return {here / uri};
}

fs::path Resources::locate(const std::string& uri, haptics::Place place) const {
  if (const std::size_t scheme = uri.find("://"); scheme != std::string::npos && !uri.starts_with("package://") &&
                                                  !uri.starts_with("model://") && !uri.starts_with("file://")) {
    fail(place, fmt::format("'{}': addresses of this kind are not followed", uri),
         "give a path, package://, model:// or file://");
  }
  std::vector<fs::path> tried = candidates(uri);
  // Programs write addresses with blanks as "%20", people as they are.
  if (const std::string plain = decoded(uri); plain != uri && uri.find("://") != std::string::npos) {
    const std::vector<fs::path> more = candidates(plain);
    tried.insert(tried.end(), more.begin(), more.end());
  }
  for (const fs::path& path : tried) {
    std::error_code code;
    if (fs::is_regular_file(path, code)) return path;  // as it is: behind a link ".." is not what was before it
  }
  const bool packaged = uri.starts_with("package://") || uri.starts_with("model://");
  fail(place,
       fmt::format("the mesh '{}' is not there (looked for {}{})", uri, tried.front().lexically_normal().string(),
                   tried.size() > 1 ? fmt::format(" and {} other places", tried.size() - 1) : ""),
       packaged ? "say where its package is: --package NAME=FOLDER" : "correct the path");
}

std::shared_ptr<const mesh::TriangleMesh> Resources::mesh(const std::string& uri, haptics::Place place) {
  const fs::path path = locate(uri, place);
  if (const auto known = read_.find(path); known != read_.end()) return known->second;
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension == ".dae" || extension == ".glb" || extension == ".gltf" || extension == ".fbx") {
    fail(place, fmt::format("'{}': {} files are not read", uri, extension.substr(1)),
         "convert the mesh to OBJ or STL, in metres with z up, and name that");
  }
  Result<mesh::TriangleMesh> read = mesh::read(path);
  if (!read) fail(place, read.error().message(), read.error().remedy.empty() ? "use another mesh" : "");
  // Each collision takes a copy: a million idle vertices would be a million in each. And a part that faces inwards, as
  // who mirrors it may leave it, would be a hole beside other parts of its body.
  Result<mesh::Repaired> lean = mesh::repair(
      read.value(),
      {.weld = false, .drop_degenerate = false, .drop_duplicates = false, .orient = true, .drop_unused = true});
  if (!lean) fail(place, lean.error().message(), "use another mesh");
  if (lean.value().log.turned_triangles > 0) ++turned_;
  return read_[path] = std::make_shared<const mesh::TriangleMesh>(std::move(lean).value().mesh);
}

std::vector<fs::path> Resources::files() const {
  std::vector<fs::path> files;
  for (const auto& [path, mesh] : read_) files.push_back(path);
  return files;
}

}  // namespace odds::scene
