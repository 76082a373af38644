// How long collisions with ODE's own bodies take after their time is up.
#pragma once

#include <ode/ode.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>

namespace odds::ode {

/// What of a budget must be kept, by the class of the partner, so that all but about one in twenty collisions end
/// within it, and all but a few in a thousand no later than a microsecond after it: the step that hears that the time
/// is up is finished, contacts are chosen and written. How long this takes depends on the machine and on the mesh, so
/// it is learnt. Any number of threads at once: one may overwrite what another has just learnt, which does no harm.
class EndingTimes {
 public:
  /// Nanoseconds. `geom_class`: of the partner.
  [[nodiscard]] std::int64_t of(int geom_class) const noexcept {
    const Learnt& learnt = learnt_[index(geom_class)];
    return learnt.usual_ns.load(std::memory_order_relaxed) + learnt.for_late.load(std::memory_order_relaxed) / per_ns;
  }

  /// One took so long, of a collision that used what time it had before.
  void note(int geom_class, std::int64_t took_ns) noexcept {
    if (took_ns > longest_ns) return;  // the machine was elsewhere
    Learnt& learnt = learnt_[index(geom_class)];
    const std::int64_t usual = learnt.usual_ns.load(std::memory_order_relaxed);
    const std::int64_t rise = std::clamp((took_ns - usual) / 2, std::int64_t{16}, most_rise_ns);
    learnt.usual_ns.store(std::clamp(usual + (took_ns > usual ? rise : -fall_ns), least_ns, most_ns),
                          std::memory_order_relaxed);
    const std::int64_t noted = learnt.noted.load(std::memory_order_relaxed);
    if (noted < until_usual) {  // what is usual is not known yet
      learnt.noted.store(noted + 1, std::memory_order_relaxed);
      return;
    }
    const std::int64_t for_late = learnt.for_late.load(std::memory_order_relaxed);
    const bool is_late = took_ns > usual + for_late / per_ns + late_ns;
    learnt.for_late.store(std::clamp(for_late + (is_late ? late_rise : -late_fall), std::int64_t{0}, most_for_late),
                          std::memory_order_relaxed);
  }

 private:
  static constexpr std::size_t classes = dConvexClass + 1;  // and one for all others
  static constexpr std::int64_t first_ns = 800;
  static constexpr std::int64_t least_ns = 300;
  static constexpr std::int64_t most_ns = 4000;
  static constexpr std::int64_t longest_ns = 20000;
  static constexpr std::int64_t most_rise_ns = 100;
  static constexpr std::int64_t fall_ns = 4;
  // What is beyond the usual changes slowly: it must not rise where the machine is elsewhere for some microseconds, as
  // it is once in several hundred endings.
  static constexpr std::int64_t until_usual = 64;
  static constexpr std::int64_t per_ns = 16;
  static constexpr std::int64_t late_ns = 1000;
  static constexpr std::int64_t late_rise = 80 * per_ns;
  static constexpr std::int64_t late_fall = 5;
  static constexpr std::int64_t most_for_late = 1000 * per_ns;

  struct Learnt {
    std::atomic<std::int64_t> usual_ns = first_ns;
    std::atomic<std::int64_t> for_late = 0;  ///< in 1 / per_ns
    std::atomic<std::int64_t> noted = 0;     ///< up to until_usual
  };

  [[nodiscard]] static std::size_t index(int geom_class) noexcept {
    return std::min(static_cast<std::size_t>(geom_class), classes);
  }

  std::array<Learnt, classes + 1> learnt_;
};

}  // namespace odds::ode
