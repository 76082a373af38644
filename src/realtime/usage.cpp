// Resource usage of a thread, by getrusage and the thread's own clock.
#include "odds/realtime/usage.hpp"

#include <sys/resource.h>

#include <ctime>

namespace odds::realtime {

ThreadUsage thread_usage() noexcept {
  rusage usage{};
  if (getrusage(RUSAGE_THREAD, &usage) != 0) return {};
  timespec ran{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &ran);
  return {static_cast<std::uint64_t>(usage.ru_minflt), static_cast<std::uint64_t>(usage.ru_majflt),
          static_cast<std::uint64_t>(usage.ru_nvcsw), static_cast<std::uint64_t>(usage.ru_nivcsw),
          std::int64_t{ran.tv_sec} * 1'000'000'000 + ran.tv_nsec};
}

}  // namespace odds::realtime
