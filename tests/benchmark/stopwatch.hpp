// Times single calls of an engine.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "benchmark/peer.hpp"
#include "benchmark/peer_times.hpp"

namespace odds::benchmark {

/// A clock whose own cost is taken off: to read the time of the thread takes as long as a quick query.
class Stopwatch {
 public:
  explicit Stopwatch(bool cpu_time) : clock_(cpu_time ? CLOCK_THREAD_CPUTIME_ID : CLOCK_MONOTONIC) {
    std::vector<double> empty;
    for (int i = 0; i < 1001; ++i) {
      const double start = clock_us(clock_);
      empty.push_back(clock_us(clock_) - start);
    }
    reading_us_ = quantile(std::move(empty), 0.5);
  }

  /// Microseconds of one call, nothing but it between the two readings; how many contacts, or 0 or 1 for the verdict.
  double time(Peer& peer, const math::Pose& pose, bool all, std::size_t& contacts) const {
    const double start = clock_us(clock_);
    contacts = all ? peer.contacts(pose) : static_cast<std::size_t>(peer.collide(pose));
    return std::max(1e-3, clock_us(clock_) - start - reading_us_);
  }

 private:
  clockid_t clock_;
  double reading_us_ = 0.0;
};

}  // namespace odds::benchmark
