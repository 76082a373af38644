// The real sleep; the loop itself is a template.
#include "odds/realtime/periodic_loop.hpp"

#include <time.h>

#include <cerrno>

namespace odds::realtime {
namespace {

void sleep_until_monotonic(void*, std::int64_t deadline_ns) noexcept {
  const timespec deadline{.tv_sec = deadline_ns / 1'000'000'000, .tv_nsec = deadline_ns % 1'000'000'000};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &deadline, nullptr) == EINTR) {
  }
}

}  // namespace

TimeSource real_time() noexcept { return {monotonic_clock(), &sleep_until_monotonic, nullptr}; }

}  // namespace odds::realtime
