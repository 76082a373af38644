// The rules of who may include whom.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "architecture/source_tree.hpp"

namespace odds::architecture {

/// The layer of a folder, from the ground up. An include goes to a lower layer or stays in its folder.
inline std::optional<int> layer_of(std::string_view folder) {
  constexpr std::pair<std::string_view, int> layers[] = {
      {"math", 0},  {"mesh", 1}, {"primitive", 1}, {"realtime", 1}, {"volume", 2}, {"tree", 3}, {"probability", 4},
      {"query", 5}, {"ode", 6},  {"haptics", 7},   {"scene", 8},    {"report", 8}, {"tool", 9}, {"preload", 9},
  };
  for (const auto& [name, layer] : layers) {
    if (name == folder) return layer;
  }
  return std::nullopt;
}

/// The rooms of a folder that has some, from its ground up. Files beside the rooms, and the folder's public headers,
/// are its ground: rooms include them, they include no room. An include goes to a lower room or stays in its own.
struct Room {
  std::string_view folder;
  std::string_view name;
  int level;
};
inline constexpr Room rooms[] = {
    {"query", "node_odds", 1}, {"query", "inner_spheres", 1},
    {"query", "search", 2},    {"query", "patch", 3},
    {"query", "wide", 4},      {"query", "shape", 5},
    {"query", "ray", 5},       {"query", "known", 6},
    {"query", "flush", 7},     {"query", "memory", 8},
    {"query", "contacts", 9},  {"query", "answer_odds", 9},
    {"query", "pair", 10},     {"ode", "mesh", 1},
    {"ode", "geom", 2},        {"ode", "frame", 3},
    {"ode", "collide", 4},     {"ode", "world", 5},
};
inline bool has_rooms(std::string_view folder) {
  return std::any_of(std::begin(rooms), std::end(rooms), [&](const Room& room) { return room.folder == folder; });
}
/// Of the ground (empty) 0.
inline std::optional<int> level_of(std::string_view folder, std::string_view room) {
  if (room.empty()) return 0;
  for (const Room& known : rooms) {
    if (known.folder == folder && known.name == room) return known.level;
  }
  return std::nullopt;
}

/// What stands between the first two slashes of a path below `folder`; empty if that is a file.
inline std::string_view room_below(std::string_view path, std::string_view folder) {
  if (!path.starts_with(folder) || path.size() <= folder.size() || path[folder.size()] != '/') return {};
  path.remove_prefix(folder.size() + 1);
  const std::size_t slash = path.find('/');
  return slash == std::string_view::npos ? std::string_view() : path.substr(0, slash);
}
/// The room of a file of src/; public headers are of the ground.
inline std::string_view room_of(std::string_view path, std::string_view folder) {
  constexpr std::string_view root = "src/";
  return path.starts_with(root) ? room_below(path.substr(root.size()), folder) : std::string_view();
}

/// "include/odds/query/pair.hpp" and "src/query/pair/pair.cpp" are in "query"; empty for a file outside the house.
inline std::string_view folder_of(std::string_view path) {
  for (const std::string_view root : {std::string_view("include/odds/"), std::string_view("src/")}) {
    if (!path.starts_with(root)) continue;
    path.remove_prefix(root.size());
    const std::size_t slash = path.find('/');
    return slash == std::string_view::npos ? std::string_view() : path.substr(0, slash);
  }
  return {};
}

struct Include {
  std::string_view name;  ///< without its brackets or quotes
  bool angled = false;
};

inline std::optional<Include> include_of(std::string_view line) {
  const auto skip_blanks = [&] {
    while (!line.empty() && (line.front() == ' ' || line.front() == '\t')) line.remove_prefix(1);
  };
  skip_blanks();
  if (!line.starts_with('#')) return std::nullopt;
  line.remove_prefix(1);
  skip_blanks();
  if (!line.starts_with("include")) return std::nullopt;
  line.remove_prefix(7);
  skip_blanks();
  if (line.empty() || (line.front() != '<' && line.front() != '"')) return std::nullopt;
  const bool angled = line.front() == '<';
  const std::size_t end = line.find(angled ? '>' : '"', 1);
  if (end == std::string_view::npos) return std::nullopt;
  return Include{line.substr(1, end - 1), angled};
}

/// The folder that an include leads to: of "odds/query/pair.hpp" and of the private "query/search/search.hpp" it is
/// "query"; of a name without a folder the includer's own; empty for what is not ours.
inline std::string_view target_of(const Include& include, std::string_view own_folder) {
  std::string_view name = include.name;
  const bool is_public = name.starts_with("odds/");
  if (include.angled && !is_public) return {};
  if (is_public) name.remove_prefix(5);
  const std::size_t slash = name.find('/');
  return slash == std::string_view::npos ? own_folder : name.substr(0, slash);
}

/// Libraries that must not show in a public header: whoever includes it would need them.
inline bool is_private_dependency(std::string_view include) {
  constexpr std::string_view prefixes[] = {"toml++", "toml.hpp", "nlohmann/",          "CLI/",   "fmt/", "ccd/",
                                           "zlib.h", "xxhash.h", "readerwriterqueue/", "pugixml"};
  return std::any_of(std::begin(prefixes), std::end(prefixes),
                     [&](auto prefix) { return include.starts_with(prefix); });
}

/// Everything wrong with the includes of one file of include/ or src/.
inline Violations judge_includes(const SourceFile& file) {
  const std::string_view folder = folder_of(file.path);
  const std::optional<int> own = layer_of(folder);
  if (!own) return {file.path + ": the folder has no layer; give it one in tests/architecture/include_rules.hpp"};
  const std::string_view room = has_rooms(folder) ? room_of(file.path, folder) : std::string_view();
  const std::optional<int> level = level_of(folder, room);
  if (!level) return {file.path + ": the room has no level; give it one in tests/architecture/include_rules.hpp"};
  const bool is_public = file.path.starts_with("include/");
  Violations found;
  for (const std::string_view line : lines(file.text)) {
    const std::optional<Include> include = include_of(line);
    if (!include) continue;
    const std::string shown = file.path + ": includes " + std::string(include->name);
    if (include->angled && include->name.starts_with("ode/") && folder != "ode") {
      found.push_back(shown + "; only ode/ may see ODE");
    }
    if (is_public && is_private_dependency(include->name)) found.push_back(shown + " in a public header");
    const std::string_view target = target_of(*include, folder);
    if (target.empty()) continue;
    if (is_public && !include->name.starts_with("odds/")) {
      found.push_back(shown + ", a private header, in a public one");
    }
    const std::optional<int> other = layer_of(target);
    if (!other) {
      found.push_back(shown + ", in a folder without a layer");
    } else if (target != folder && *other >= *own) {
      found.push_back(shown + ": up or sideways from layer " + std::to_string(*own) + " to " + std::to_string(*other));
    } else if (target == folder && has_rooms(folder) && !include->name.starts_with("odds/")) {
      const std::string_view its_room = room_below(include->name, folder);
      const std::optional<int> its_level = level_of(folder, its_room);
      if (!its_level || (its_room != room && *its_level >= *level)) {
        found.push_back(shown + ": up or sideways within " + std::string(folder) + "/");
      }
    }
  }
  return found;
}

}  // namespace odds::architecture
