#include "odds/realtime/clock.hpp"

#include <time.h>

namespace odds::realtime {
namespace {

std::int64_t read_monotonic(void*) noexcept {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

}  // namespace

Clock monotonic_clock() noexcept { return {&read_monotonic, nullptr}; }

Clock fastest_clock() noexcept { return monotonic_clock(); }

}  // namespace odds::realtime
