// Prepares the calling thread for real-time work, and says honestly what was granted.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace odds::realtime {

/// What to ask for; everything left out is not touched.
struct ThreadRequest {
  std::optional<int> fifo_priority = std::nullopt;  ///< SCHED_FIFO with this priority, 1 to 99
  bool lock_memory = false;                         ///< keep the whole process in memory (mlockall); process-wide
  std::optional<int> cpu = std::nullopt;            ///< run on this processor only
  std::optional<std::uint64_t> timer_slack_ns =
      std::nullopt;                      ///< how late timers may fire, > 0; the kernel's default is 50'000
  std::size_t prefault_stack_bytes = 0;  ///< touch this much stack now, so that no page fault comes later
};

/// One thing that was asked, and what came of it.
struct SetupLine {
  enum class Outcome : std::uint8_t { granted, partly, refused };
  std::string asked;  ///< "real-time priority SCHED_FIFO 50"
  Outcome outcome = Outcome::refused;
  std::string detail;  ///< what was really set, or why not and what would help; may be empty where granted in full

  /// "asked: granted", "asked: refused: detail".
  [[nodiscard]] std::string text() const;
};

[[nodiscard]] const char* name(SetupLine::Outcome outcome) noexcept;

/// Asks for all that `request` names, for the calling thread, and returns a line for each, in the order of the fields.
/// A refusal is never an error: the thread goes on as it was. What was granted is read back from the kernel, not
/// assumed. Allocates and makes system calls: call it before the loop starts. Threads made afterwards inherit priority
/// and processor, so start the others first.
[[nodiscard]] std::vector<SetupLine> set_up_this_thread(const ThreadRequest& request);

}  // namespace odds::realtime
