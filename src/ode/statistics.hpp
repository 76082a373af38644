// Process-wide counters behind oddsGetStats(): relaxed atomics, so that collisions in several threads may count.
#pragma once

#include <atomic>

namespace odds::ode {

using Counter = std::atomic<unsigned long long>;

/// One counter per field of oddsStats; the meaning of each stands there.
struct Statistics {
  Counter queries{0};
  Counter queries_proved{0};
  Counter queries_estimated{0};
  Counter queries_budget{0};
  Counter contacts{0};
  Counter cell_pair_contacts{0};
  Counter primitive_queries{0};
  Counter primitive_cut_off{0};
  Counter unsupported{0};
  Counter lazy_pairs{0};
  Counter failed_pairs{0};
  Counter busy_pairs{0};
  Counter bad_poses{0};
  Counter caught{0};
  Counter live_geoms{0};
  Counter live_pairs{0};
  Counter lazy_partners{0};
  Counter changed_partners{0};
  Counter live_partners{0};
  Counter taken_over{0};
  Counter fallbacks{0};
};

[[nodiscard]] Statistics& statistics() noexcept;

inline void count(Counter& counter, unsigned long long by = 1) noexcept {
  counter.fetch_add(by, std::memory_order_relaxed);
}

}  // namespace odds::ode
