// Bytes that stay where they are as long as somebody keeps them: a file in memory, or a copy.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include "odds/math/error.hpp"

namespace odds::tree {

/// The first byte stands at a multiple of 64.
struct KeptBytes {
  std::span<const std::byte> bytes;
  std::shared_ptr<const void> keeper;
};

/// Whether a file of `size` bytes is worth reading whole, by its first `first_bytes`, or all if there are fewer.
struct WorthReading {
  std::size_t first_bytes;
  bool (*is_worth)(std::span<const std::byte> first, std::uint64_t size) noexcept;
};

/// Maps a regular file for reading, its pages already asked for if it is worth that. The file must not be changed in
/// place while it is mapped (a file that is replaced by renaming another one is not changed).
[[nodiscard]] Result<KeptBytes> map_file(const std::filesystem::path& path, const WorthReading& worth);

/// A copy.
[[nodiscard]] KeptBytes copy_bytes(std::span<const std::byte> bytes);

}  // namespace odds::tree
