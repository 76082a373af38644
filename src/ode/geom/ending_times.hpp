// How long collisions with ODE's own bodies take after their time is up.
#pragma once

#include <ode/ode.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>

namespace odds::ode {

/// What of a budget must be kept, by the class of the partner, so that all but about one in twenty collisions end
/// within it: the step that hears that the time is up is finished, contacts are chosen and written. How long this takes
/// depends on the machine and on the mesh, so it is learnt. Any number of threads at once: one may overwrite what
/// another has just learnt, which does no harm.
class EndingTimes {
 public:
  EndingTimes() noexcept {
    for (std::atomic<std::int64_t>& time : ns_) time.store(first_ns, std::memory_order_relaxed);
  }

  /// Nanoseconds. `geom_class`: of the partner.
  [[nodiscard]] std::int64_t of(int geom_class) const noexcept {
    return ns_[index(geom_class)].load(std::memory_order_relaxed);
  }

  /// One took so long, of a collision that used what time it had before.
  void note(int geom_class, std::int64_t took_ns) noexcept {
    if (took_ns > longest_ns) return;  // the machine was elsewhere
    std::atomic<std::int64_t>& time = ns_[index(geom_class)];
    const std::int64_t kept = time.load(std::memory_order_relaxed);
    const std::int64_t rise = std::clamp((took_ns - kept) / 2, std::int64_t{16}, most_rise_ns);
    time.store(std::clamp(kept + (took_ns > kept ? rise : -fall_ns), least_ns, most_ns), std::memory_order_relaxed);
  }

 private:
  static constexpr std::size_t classes = dConvexClass + 1;  // and one for all others
  static constexpr std::int64_t first_ns = 800;
  static constexpr std::int64_t least_ns = 300;
  static constexpr std::int64_t most_ns = 4000;
  static constexpr std::int64_t longest_ns = 20000;
  static constexpr std::int64_t most_rise_ns = 100;
  static constexpr std::int64_t fall_ns = 4;

  [[nodiscard]] static std::size_t index(int geom_class) noexcept {
    return std::min(static_cast<std::size_t>(geom_class), classes);
  }

  std::array<std::atomic<std::int64_t>, classes + 1> ns_;
};

}  // namespace odds::ode
