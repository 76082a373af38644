// The bounding volumes that are offered by name. A test holds this list complete.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

namespace odds::volume {

/// `wide` is an engine of its own (boxes cut by slabs, eight to a node); the others are volumes of the generic
/// framework.
enum class Kind : std::uint8_t { aabb, obb, sphere, kdop14, kdop18, kdop26, hull, wide };

inline constexpr std::array<std::string_view, 8> kind_names = {"aabb",   "obb",    "sphere", "kdop14",
                                                               "kdop18", "kdop26", "hull",   "wide"};

/// Further words that are understood, never written.
inline constexpr std::array<std::pair<std::string_view, Kind>, 1> kind_aliases = {{{"kdop", Kind::kdop18}}};

[[nodiscard]] constexpr std::string_view name(Kind kind) noexcept { return kind_names[static_cast<std::size_t>(kind)]; }

/// All words that `kind_from_name` understands, the names first.
inline constexpr auto kind_words = [] {
  std::array<std::string_view, kind_names.size() + kind_aliases.size()> words{};
  for (std::size_t i = 0; i < kind_names.size(); ++i) words[i] = kind_names[i];
  for (std::size_t i = 0; i < kind_aliases.size(); ++i) words[kind_names.size() + i] = kind_aliases[i].first;
  return words;
}();

/// By name or alias.
[[nodiscard]] constexpr std::optional<Kind> kind_from_name(std::string_view text) noexcept {
  for (std::size_t i = 0; i < kind_names.size(); ++i) {
    if (kind_names[i] == text) return static_cast<Kind>(i);
  }
  for (const auto& [alias, kind] : kind_aliases) {
    if (alias == text) return kind;
  }
  return std::nullopt;
}

}  // namespace odds::volume
