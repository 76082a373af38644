// Looks at the deadline now and then, and remembers that it has passed.
#pragma once

#include <cstddef>

#include "odds/query/contact_patch.hpp"

namespace odds::query::patch {

/// Loops ask `late(i)` every step; the deadline itself is asked every `between_polls` steps, about each half
/// microsecond; also when it is known to have passed, for who asks keeps accounts of own work and of stalls.
class Watch {
 public:
  static constexpr std::size_t between_polls = 8;

  explicit Watch(const Deadline& deadline) noexcept : deadline_(deadline) {}

  [[nodiscard]] bool late() noexcept { return late_ = deadline_() || late_; }
  [[nodiscard]] bool late(std::size_t step) noexcept {
    return step % between_polls == between_polls - 1 ? late() : late_;
  }
  /// The same in a loop of `between_polls` steps at a time: every time but the first.
  [[nodiscard]] bool late_before_next(std::size_t step) noexcept { return step != 0 ? late() : late_; }
  /// The same in a loop whose steps take nanoseconds.
  [[nodiscard]] bool late_in_small_steps(std::size_t step) noexcept {
    return step % (4 * between_polls) == 4 * between_polls - 1 ? late() : late_;
  }

 private:
  const Deadline& deadline_;
  bool late_ = false;
};

}  // namespace odds::query::patch
