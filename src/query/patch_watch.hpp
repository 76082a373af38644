// Looks at the deadline now and then, and remembers that it has passed.
#pragma once

#include <cstddef>

#include "odds/query/contact_patch.hpp"

namespace odds::query::patch {

/// Loops ask `late(i)` every step; the deadline itself is asked every `between_polls` steps, about each half
/// microsecond.
class Watch {
 public:
  static constexpr std::size_t between_polls = 8;

  explicit Watch(const Deadline& deadline) noexcept : deadline_(deadline) {}

  [[nodiscard]] bool late() noexcept { return late_ = late_ || deadline_(); }
  [[nodiscard]] bool late(std::size_t step) noexcept {
    return step % between_polls == between_polls - 1 ? late() : late_;
  }

 private:
  const Deadline& deadline_;
  bool late_ = false;
};

}  // namespace odds::query::patch
