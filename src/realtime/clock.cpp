// The two real clocks: CLOCK_MONOTONIC, and the invariant time-stamp counter where the processor and the kernel trust
// it.
#include "odds/realtime/clock.hpp"

#include <time.h>

#if defined(__x86_64__)
#include <cpuid.h>
#include <x86intrin.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#endif

namespace odds::realtime {
namespace {

std::int64_t read_monotonic(void*) noexcept {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

/// The chosen clock with the scale that its readings need; made once, never changed.
struct Chosen {
  Clock clock = {&read_monotonic, nullptr};
  ClockChoice choice;
  std::uint64_t origin_ticks = 0;
  std::int64_t origin_ns = 0;
  std::uint64_t ns_per_tick_32 = 0;  ///< nanoseconds per tick times 2^32
};

#if defined(__x86_64__)

__extension__ using uint128 = unsigned __int128;

std::uint64_t read_ticks() noexcept {
  unsigned processor = 0;
  return __rdtscp(&processor);
}

std::int64_t ns_of(const Chosen& chosen, std::uint64_t ticks) noexcept {
  const auto since = static_cast<uint128>(ticks - chosen.origin_ticks);
  return chosen.origin_ns + static_cast<std::int64_t>((since * chosen.ns_per_tick_32) >> 32);
}

std::int64_t read_counter(void* state) noexcept { return ns_of(*static_cast<const Chosen*>(state), read_ticks()); }

std::int64_t read_counter_without_waiting(void* state) noexcept {
  return ns_of(*static_cast<const Chosen*>(state), __rdtsc());
}

bool processor_has_invariant_counter() noexcept {
  constexpr unsigned rdtscp_bit = 1U << 27;    // CPUID 8000'0001 EDX
  constexpr unsigned invariant_bit = 1U << 8;  // CPUID 8000'0007 EDX: constant rate in all power states
  unsigned a = 0;
  unsigned b = 0;
  unsigned c = 0;
  unsigned d = 0;
  if (__get_cpuid(0x80000001U, &a, &b, &c, &d) == 0 || (d & rdtscp_bit) == 0) return false;
  return __get_cpuid(0x80000007U, &a, &b, &c, &d) != 0 && (d & invariant_bit) != 0;
}

/// The kernel watches the counter and stops offering it once it caught it unstable or out of step between processors.
/// Where its opinion cannot be read (no sysfs), the measured agreement has to decide alone.
bool kernel_offers_counter() noexcept {
  std::FILE* file = std::fopen("/sys/devices/system/clocksource/clocksource0/available_clocksource", "re");
  if (file == nullptr) return true;
  char names[256] = {};
  const std::size_t length = std::fread(names, 1, sizeof names - 1, file);
  std::fclose(file);
  names[length] = '\0';
  return std::strstr(names, "tsc") != nullptr;
}

struct Moment {
  std::uint64_t ticks;
  std::int64_t ns;
};

/// Both clocks read as close together as 64 attempts allow: the narrowest bracket is the one least disturbed.
Moment read_both() noexcept {
  Moment best{};
  std::int64_t narrowest = INT64_MAX;
  for (int attempt = 0; attempt < 64; ++attempt) {
    const std::int64_t before = read_monotonic(nullptr);
    const std::uint64_t ticks = read_ticks();
    const std::int64_t after = read_monotonic(nullptr);
    if (after - before >= narrowest) continue;
    narrowest = after - before;
    best = {ticks, before + (after - before) / 2};
  }
  return best;
}

void wait_ns(std::int64_t ns) noexcept {
  const timespec duration{.tv_sec = 0, .tv_nsec = ns};
  nanosleep(&duration, nullptr);
}

double ticks_per_ns(const Moment& from, const Moment& to) noexcept {
  return static_cast<double>(to.ticks - from.ticks) / static_cast<double>(to.ns - from.ns);
}

void calibrate(Chosen& chosen) noexcept {
  constexpr std::int64_t half_ns = 5'000'000;
  // Brackets are about 20 ns wide, so an honest counter shows some 10 ppm over 5 ms; NTP slews by at most 500 ppm.
  constexpr double tolerance_ppm = 600.0;
  const Moment first = read_both();
  wait_ns(half_ns);
  const Moment middle = read_both();
  wait_ns(half_ns);
  const Moment last = read_both();
  if (last.ticks <= middle.ticks || middle.ticks <= first.ticks || last.ns <= middle.ns || middle.ns <= first.ns) {
    chosen.choice.reason = "the time-stamp counter did not advance with CLOCK_MONOTONIC";
    return;
  }
  const double rate = ticks_per_ns(first, last);
  const double ppm = std::abs(ticks_per_ns(middle, last) / ticks_per_ns(first, middle) - 1.0) * 1e6;
  chosen.choice.disagreement_ppm = ppm;
  if (!(ppm <= tolerance_ppm) || !(rate > 0.1 && rate < 20.0)) {
    chosen.choice.reason = "the time-stamp counter disagreed with CLOCK_MONOTONIC during calibration";
    return;
  }
  chosen.origin_ticks = last.ticks;
  chosen.origin_ns = last.ns;
  chosen.ns_per_tick_32 = static_cast<std::uint64_t>(std::llround(4294967296.0 / rate));
  chosen.choice.time_stamp_counter = true;
  chosen.choice.counter_hz = rate * 1e9;
  chosen.choice.reason = "invariant time-stamp counter, in agreement with CLOCK_MONOTONIC";
  chosen.clock = {&read_counter, &chosen};
}

void choose(Chosen& chosen) noexcept {
  if (!processor_has_invariant_counter()) {
    chosen.choice.reason = "the processor reports no invariant time-stamp counter";
  } else if (!kernel_offers_counter()) {
    chosen.choice.reason = "the kernel does not trust the time-stamp counter";
  } else {
    calibrate(chosen);
  }
}

#else

void choose(Chosen& chosen) noexcept { chosen.choice.reason = "no time-stamp counter is used on this architecture"; }

#endif

const Chosen& chosen_clock() noexcept {
  static Chosen chosen;
  static const bool done = (choose(chosen), true);  // the language makes the first call wait for one calibration
  static_cast<void>(done);
  return chosen;
}

}  // namespace

Clock monotonic_clock() noexcept { return {&read_monotonic, nullptr}; }

Clock fastest_clock() noexcept { return chosen_clock().clock; }

#if defined(__x86_64__)
Clock without_waiting(Clock clock) noexcept {
  return clock.now_ns == &read_counter ? Clock{&read_counter_without_waiting, clock.state} : clock;
}
#else
Clock without_waiting(Clock clock) noexcept { return clock; }
#endif

ClockChoice fastest_clock_choice() noexcept { return chosen_clock().choice; }

}  // namespace odds::realtime
