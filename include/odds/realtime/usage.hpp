// What the operating system charged to one thread: page faults, context switches, time on a processor.
#pragma once

#include <cstdint>

namespace odds::realtime {

/// Counts since the thread began. Differences of two readings show what happened between them.
struct ThreadUsage {
  std::uint64_t minor_faults = 0;          ///< page faults served without I/O
  std::uint64_t major_faults = 0;          ///< page faults that had to read from a disk
  std::uint64_t voluntary_switches = 0;    ///< the thread waited: sleep, lock, I/O
  std::uint64_t involuntary_switches = 0;  ///< the scheduler took the processor away
  std::int64_t processor_ns = 0;           ///< time in which the thread ran, in the system's code too

  [[nodiscard]] friend ThreadUsage operator-(const ThreadUsage& later, const ThreadUsage& earlier) noexcept {
    return {later.minor_faults - earlier.minor_faults, later.major_faults - earlier.major_faults,
            later.voluntary_switches - earlier.voluntary_switches,
            later.involuntary_switches - earlier.involuntary_switches, later.processor_ns - earlier.processor_ns};
  }
};

/// Of the calling thread (getrusage, RUSAGE_THREAD, and CLOCK_THREAD_CPUTIME_ID). Two system calls, some hundred
/// nanoseconds each: read it around the work to be judged, not inside it.
[[nodiscard]] ThreadUsage thread_usage() noexcept;

}  // namespace odds::realtime
