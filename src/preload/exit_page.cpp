// Counters of collisions by partner, with a log-linear histogram of their times.
#include "preload/exit_page.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstdio>

#include "odds/ode/odds_ode.h"

namespace odds::preload {
namespace {

using Counter = std::atomic<std::uint64_t>;

// Sixteen buckets in each power of two of nanoseconds: a percentile is at most 6 % too great.
class Times {
 public:
  void add(std::int64_t ns) noexcept {
    const auto value = static_cast<std::uint64_t>(std::max<std::int64_t>(ns, 0));
    buckets_[bucket_of(value)].fetch_add(1, std::memory_order_relaxed);
    std::uint64_t seen = longest_.load(std::memory_order_relaxed);
    while (value > seen && !longest_.compare_exchange_weak(seen, value, std::memory_order_relaxed)) {
    }
  }
  void clear() noexcept {
    for (Counter& bucket : buckets_) bucket.store(0, std::memory_order_relaxed);
    longest_.store(0, std::memory_order_relaxed);
  }
  [[nodiscard]] double longest_us() const noexcept {
    return 1e-3 * static_cast<double>(longest_.load(std::memory_order_relaxed));
  }
  // The upper end of the bucket below which the share lies.
  [[nodiscard]] double percentile_us(double share) const noexcept {
    std::uint64_t all = 0;
    for (const Counter& bucket : buckets_) all += bucket.load(std::memory_order_relaxed);
    std::uint64_t below = 0;
    for (std::size_t i = 0; i < buckets_.size(); ++i) {
      below += buckets_[i].load(std::memory_order_relaxed);
      if (static_cast<double>(below) < share * static_cast<double>(all)) continue;
      return std::min(longest_us(), 1e-3 * static_cast<double>(upper_end(i)));
    }
    return 0.0;
  }

 private:
  static constexpr unsigned bits = 4;
  static constexpr std::size_t in_octave = std::size_t{1} << bits;
  [[nodiscard]] static std::size_t bucket_of(std::uint64_t ns) noexcept {
    if (ns < in_octave) return static_cast<std::size_t>(ns);
    const auto octave = static_cast<unsigned>(std::bit_width(ns)) - bits;  // >= 1
    return octave * in_octave + static_cast<std::size_t>((ns >> (octave - 1)) & (in_octave - 1));
  }
  [[nodiscard]] static std::uint64_t upper_end(std::size_t bucket) noexcept {
    const std::size_t octave = bucket / in_octave;
    if (octave == 0) return bucket;
    return ((in_octave + bucket % in_octave + 1) << (octave - 1)) - 1;
  }

  std::array<Counter, 64 * in_octave> buckets_ = {};
  Counter longest_{0};
};

struct PartnerCounts {
  const char* name;
  int number;
  Counter collisions{0};
  Counter touching{0};
  Counter contacts{0};
  Counter by_ode{0};
  Times times{};
};

std::array<PartnerCounts, 8>& all_counts() noexcept {
  static std::array<PartnerCounts, 8> counts = {{{.name = "dTriMesh", .number = dTriMeshClass},
                                                 {.name = "sphere", .number = dSphereClass},
                                                 {.name = "box", .number = dBoxClass},
                                                 {.name = "capsule", .number = dCapsuleClass},
                                                 {.name = "cylinder", .number = dCylinderClass},
                                                 {.name = "plane", .number = dPlaneClass},
                                                 {.name = "ray", .number = dRayClass},
                                                 {.name = "convex", .number = dConvexClass}}};
  return counts;
}

template <class... Values>
void print(std::string& page, const char* format, Values... values) {
  std::array<char, 256> line;
  const int length = std::snprintf(line.data(), line.size(), format, values...);
  page.append(line.data(), std::min(line.size() - 1, static_cast<std::size_t>(std::max(length, 0))));
}

}  // namespace

void note_collision(int partner_class, std::int64_t ns, int contacts, bool by_ode) noexcept {
  for (PartnerCounts& counts : all_counts()) {
    if (counts.number != partner_class) continue;
    counts.collisions.fetch_add(1, std::memory_order_relaxed);
    counts.touching.fetch_add(contacts > 0 ? 1 : 0, std::memory_order_relaxed);
    counts.contacts.fetch_add(static_cast<std::uint64_t>(contacts), std::memory_order_relaxed);
    counts.by_ode.fetch_add(by_ode ? 1 : 0, std::memory_order_relaxed);
    counts.times.add(ns);
    return;
  }
}

bool has_collisions() noexcept {
  const auto& all = all_counts();
  return std::any_of(all.begin(), all.end(),
                     [](const PartnerCounts& counts) { return counts.collisions.load(std::memory_order_relaxed) > 0; });
}

void forget_collisions() noexcept {
  for (PartnerCounts& counts : all_counts()) {
    for (Counter* counter : {&counts.collisions, &counts.touching, &counts.contacts, &counts.by_ode}) {
      counter->store(0, std::memory_order_relaxed);
    }
    counts.times.clear();
  }
  oddsResetStats();
}

std::string exit_page() {
  std::string page;
  print(page, "odds: collisions of dTriMesh geoms in this run (process %ld)\n", static_cast<long>(getpid()));
  print(page, "%-9s %11s %11s %8s %9s %9s %9s %9s %11s\n", "with", "collisions", "touching", "contacts", "p50 us",
        "p99 us", "p99.9 us", "max us", "left to ODE");
  for (const PartnerCounts& counts : all_counts()) {
    const auto collisions = counts.collisions.load(std::memory_order_relaxed);
    if (collisions == 0) continue;
    const auto touching = counts.touching.load(std::memory_order_relaxed);
    const double mean = touching > 0 ? static_cast<double>(counts.contacts.load(std::memory_order_relaxed)) /
                                           static_cast<double>(touching)
                                     : 0.0;
    print(page, "%-9s %11llu %11llu %8.1f %9.1f %9.1f %9.1f %9.1f %11llu\n", counts.name,
          static_cast<unsigned long long>(collisions), static_cast<unsigned long long>(touching), mean,
          counts.times.percentile_us(0.5), counts.times.percentile_us(0.99), counts.times.percentile_us(0.999),
          counts.times.longest_us(), static_cast<unsigned long long>(counts.by_ode.load(std::memory_order_relaxed)));
  }
  if (!has_collisions()) page += "none: no dTriMesh geom came near one of a class that is taken over\n";
  oddsStats stats;
  oddsGetStats(&stats);
  print(page,
        "dTriMesh with dTriMesh: %llu proved, %llu estimated, %llu ended by their budget; %llu of their contacts "
        "guessed\n",
        stats.queries_proved, stats.queries_estimated, stats.queries_budget, stats.cell_pair_contacts);
  print(page, "others ended by their budget: %llu; poses that were not finite: %llu\n", stats.primitive_cut_off,
        stats.bad_poses);
  print(page,
        "prepared inside the loop: %llu meshes, %llu pairs; pairs in use by two threads: %llu; changed meshes: %llu\n",
        stats.lazy_partners, stats.lazy_pairs, stats.busy_pairs, stats.changed_partners);
  return page;
}

}  // namespace odds::preload
