// The bounding volumes that are offered by name. A test holds this list complete.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace odds::volume {

enum class Kind : std::uint8_t { aabb, obb, sphere };

inline constexpr std::array<std::string_view, 3> kind_names = {"aabb", "obb", "sphere"};

[[nodiscard]] constexpr std::string_view name(Kind kind) noexcept { return kind_names[static_cast<std::size_t>(kind)]; }

[[nodiscard]] constexpr std::optional<Kind> kind_from_name(std::string_view text) noexcept {
  for (std::size_t i = 0; i < kind_names.size(); ++i) {
    if (kind_names[i] == text) return static_cast<Kind>(i);
  }
  return std::nullopt;
}

}  // namespace odds::volume
