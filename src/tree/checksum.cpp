#define XXH_INLINE_ALL  // nothing to link, and the compiler sees the loop
#include "tree/checksum.hpp"

#include <xxhash.h>

#include <algorithm>

namespace odds::tree {

std::uint64_t checksum(std::span<const std::byte> bytes) noexcept { return XXH3_64bits(bytes.data(), bytes.size()); }

struct BlockChecksums::State {
  XXH3_state_t of_block;
};

BlockChecksums::BlockChecksums(std::size_t block_bytes) : state_(std::make_unique<State>()), block_bytes_(block_bytes) {
  XXH3_64bits_reset(&state_->of_block);
}

BlockChecksums::~BlockChecksums() = default;

void BlockChecksums::add(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const std::size_t taken = std::min(bytes.size(), block_bytes_ - in_block_);
    XXH3_64bits_update(&state_->of_block, bytes.data(), taken);
    in_block_ += taken;
    bytes = bytes.subspan(taken);
    if (in_block_ == block_bytes_) end_block();
  }
}

void BlockChecksums::end_block() {
  checksums_.push_back(XXH3_64bits_digest(&state_->of_block));
  XXH3_64bits_reset(&state_->of_block);
  in_block_ = 0;
}

std::vector<std::uint64_t> BlockChecksums::finish() {
  if (in_block_ != 0) end_block();
  return std::move(checksums_);
}

}  // namespace odds::tree
