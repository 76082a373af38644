// Resource usage of a thread, by getrusage.
#include "odds/realtime/usage.hpp"

#include <sys/resource.h>

namespace odds::realtime {

ThreadUsage thread_usage() noexcept {
  rusage usage{};
  if (getrusage(RUSAGE_THREAD, &usage) != 0) return {};
  return {static_cast<std::uint64_t>(usage.ru_minflt), static_cast<std::uint64_t>(usage.ru_majflt),
          static_cast<std::uint64_t>(usage.ru_nvcsw), static_cast<std::uint64_t>(usage.ru_nivcsw)};
}

}  // namespace odds::realtime
