// Queries are slower where something else has run in between.
#pragma once

#include <cstddef>
#include <vector>

namespace odds::testing {

/// Fills a core's own caches with something else, not one that cores share.
class CacheEmptier {
 public:
  void run() noexcept {
    volatile unsigned char* const bytes = bytes_.data();
    for (std::size_t i = 0; i < bytes_.size(); i += cache_line) bytes[i] = static_cast<unsigned char>(i);
  }

 private:
  static constexpr std::size_t cache_line = 64;
  std::vector<unsigned char> bytes_ = std::vector<unsigned char>(3U << 20U);  // beyond the second level's
};

}  // namespace odds::testing
