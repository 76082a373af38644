// The interval log whose figures an independent implementation printed into tests/report/data.
#pragma once

#include <cstdint>

#include "odds/report/hlog.hpp"

namespace odds::report {

/// Three series of 20,000 values each, from 20 us up, with a long tail and the corners of the buckets. Fixed for ever:
/// the files in tests/report/data were made from it.
inline Hlog golden_log() {
  Hlog log;
  log.start_epoch_s = 1'700'000'000.25;
  std::uint64_t state = 42;
  for (const char* tag : {"", "wake", "query"}) {
    HlogInterval interval{tag, static_cast<double>(log.intervals.size()), 1.0, Histogram()};
    for (int i = 0; i < 20'000; ++i) {
      state = state * 6'364'136'223'846'793'005ULL + 1'442'695'040'888'963'407ULL;
      const auto spread = static_cast<std::int64_t>(state >> 44);
      interval.histogram.record(20'000 + spread + (i % 1'000 == 0 ? 17 * spread : 0));
    }
    for (const std::int64_t corner :
         {0LL, 1LL, 1'023LL, 1'024LL, 2'047LL, 2'048LL, 4'095LL, 4'096LL, 3'600'000'000'000LL}) {
      interval.histogram.record(corner);
    }
    log.intervals.push_back(std::move(interval));
  }
  return log;
}

}  // namespace odds::report
