// The checksum of saved files: XXH3 of 64 bits, at the speed of memory. It finds damage; it is no signature.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace odds::tree {

[[nodiscard]] std::uint64_t checksum(std::span<const std::byte> bytes) noexcept;

/// Checksums of the blocks of a stream: each of `block_bytes`, the last one perhaps shorter.
class BlockChecksums {
 public:
  explicit BlockChecksums(std::size_t block_bytes);
  ~BlockChecksums();
  BlockChecksums(const BlockChecksums&) = delete;
  BlockChecksums& operator=(const BlockChecksums&) = delete;

  void add(std::span<const std::byte> bytes);
  /// Ends the last block. Nothing is to be added after it.
  [[nodiscard]] std::vector<std::uint64_t> finish();

 private:
  struct State;
  void end_block();

  std::unique_ptr<State> state_;
  std::size_t block_bytes_;
  std::size_t in_block_ = 0;
  std::vector<std::uint64_t> checksums_;
};

}  // namespace odds::tree
