// What one collision with a primitive may spend, from the same settings that bound the queries between meshes.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "odds/query/deadline.hpp"
#include "odds/realtime/clock.hpp"
#include "ode/budget_clock.hpp"
#include "ode/frame/frame_share.hpp"
#include "ode/geom/geom_data.hpp"
#include "ode/statistics.hpp"

namespace odds::ode {

/// Work units and wall time of one collision; starts when it is made.
class Limit {
 public:
  /// `geom_class`: of the partner of the geom with the mesh. `choosing_us`: what is kept, of a short or a long
  /// time a share, for choosing contacts among what was found in the time that others ask about. `begun_ns`: when, by
  /// now(), if that was before.
  Limit(GeomData& data, int geom_class, double choosing_us = 0.0,
        std::optional<std::int64_t> begun_ns = std::nullopt) noexcept
      : clock_(realtime::without_waiting(budget_clock())), endings_(data.endings), geom_class_(geom_class) {
    const Settings& own = data.settings;
    const Settings settings = within_share(own);
    shared_time_ = settings.budget_us < own.budget_us;
    shared_units_ = settings.work_units != own.work_units;
    in_units_ = settings.work_units > 0;
    if (in_units_) units = settings.work_units;
    begun_with_ = units;
    const double ns = settings.budget_us * 1e3;
    timed_ = ns < 9e18;
    if (!timed_) return;
    time_ns_ = whole_ns_ = ns - std::min(static_cast<double>(endings_.of(geom_class)), longest_ending * ns);
    if (choosing_us > 0.0) {
      time_ns_ -= std::clamp(1e3 * choosing_us, shortest_choice * whole_ns_, longest_choice * whole_ns_);
    }
    start_ns_ = begun_ns ? *begun_ns : clock_();
    past_ns_ = start_ns_ + static_cast<std::int64_t>(ns);
  }

  [[nodiscard]] static std::int64_t now() noexcept { return realtime::without_waiting(budget_clock())(); }

  /// `share` of the time, in (0, 1]: less for what has to be worked on afterwards.
  [[nodiscard]] bool time_is_up(double share = 1.0) const noexcept { return timed_ && clock_() >= end_ns(share); }

  /// Whether nothing may be begun any more: contacts that are chosen have to do.
  [[nodiscard]] bool is_over() const noexcept { return timed_ && clock_() >= over_ns(); }

  /// Says what time_is_up() does. Good as long as this is.
  [[nodiscard]] query::Deadline up() noexcept {
    return {[](void* self) noexcept { return static_cast<const Limit*>(self)->time_is_up(); }, this};
  }

  /// Says whether all of the budget is gone, the part for its ending, too: what takes long on the way to its end gives
  /// up, but not because the machine was elsewhere for so long that it is late anyway. Good as long as this is.
  [[nodiscard]] query::Deadline past() noexcept {
    return {[](void* self) noexcept { return static_cast<const Limit*>(self)->is_past(); }, this};
  }

  /// The share of the time that is gone; 0 where there is no limit.
  [[nodiscard]] double used() const noexcept {
    if (!timed_) return 0.0;
    return time_ns_ > 0.0 ? static_cast<double>(clock_() - start_ns_) / time_ns_ : 1.0;
  }

  /// Whether so much of the time is left and no more than `share` of it is gone, or there is no limit.
  [[nodiscard]] bool has_time_left(double microseconds, double share = 1.0) const noexcept {
    return !timed_ || clock_() < std::min(end_ns(share), end_ns(1.0) - static_cast<std::int64_t>(1e3 * microseconds));
  }

  /// How many nodes a search may visit that looks at the clock itself.
  [[nodiscard]] std::uint64_t nodes_left() const noexcept { return in_units_ ? units : most_units; }

  /// How many nodes a search may visit within that share that does not take them from `units` itself, nor look at the
  /// clock: what is left of the units, and of that time, but always some.
  [[nodiscard]] std::uint64_t nodes_in_time(double share) const noexcept {
    constexpr double least = 20.0;  // from the root to a triangle and a few beside it
    constexpr double per_us = 6.0;  // with the triangles of leaves
    if (!timed_) return units;
    const auto in_time = static_cast<double>(end_ns(share) - clock_()) * 1e-3 * per_us;
    return std::min(units, static_cast<std::uint64_t>(std::clamp(in_time, least, 1e15)));
  }

  /// The collision's end: counts it if it was cut off, tells the frame. Gives `contacts` back.
  [[nodiscard]] int finish(bool complete, int contacts) const noexcept {
    note_ending();
    if (!complete) count(statistics().primitive_cut_off);
    if (current_share != nullptr) {
      const bool more_would_help = !complete && (units == 0 ? shared_units_ : shared_time_);
      const Outcome cut_short = contacts > 0 ? Outcome::enough : Outcome::starved;
      current_share->report(spent(), contacts, more_would_help ? cut_short : Outcome::finished);
    }
    return contacts;
  }
  /// The end of one that gave contacts of an earlier one.
  [[nodiscard]] int finish_carried(int contacts) const noexcept {
    if (current_share != nullptr) current_share->report(spent(), contacts, Outcome::carried);
    return contacts;
  }

  /// Nodes that a search has visited which does not take them from `units` itself. Where time is the limit, each search
  /// may visit as many as that allows.
  void spend(std::uint64_t nodes) noexcept {
    if (in_units_) {
      units -= std::min(units, nodes);
    } else {
      beside_ += nodes;
    }
  }

 private:
  // Of a short time no more than this share is kept for the ending.
  static constexpr double longest_ending = 0.4;
  static constexpr double longest_choice = 0.3;
  static constexpr double shortest_choice = 0.12;
  // Between two looks of one ray much less goes by.
  static constexpr std::int64_t elsewhere_ns = 3000;
  // A collision that ended before so much of its time was gone tells nothing of endings.
  static constexpr double pressed = 0.9;
  static constexpr std::uint64_t most_units = std::uint64_t{1} << 40;
  [[nodiscard]] std::int64_t end_ns(double share) const noexcept {
    return start_ns_ + static_cast<std::int64_t>(share * time_ns_);
  }
  [[nodiscard]] std::int64_t over_ns() const noexcept { return start_ns_ + static_cast<std::int64_t>(whole_ns_); }
  void note_ending() const noexcept {
    if (!timed_) return;
    const std::int64_t now = clock_();
    if (now > end_ns(pressed)) endings_.note(geom_class_, now - over_ns());
  }
  [[nodiscard]] bool is_past() const noexcept {
    if (!timed_) return false;
    const std::int64_t beyond_ns = clock_() - past_ns_;
    return beyond_ns >= 0 && beyond_ns < elsewhere_ns;
  }
  [[nodiscard]] std::uint64_t spent() const noexcept { return begun_with_ - units + beside_; }

  realtime::Clock clock_;
  EndingTimes& endings_;
  int geom_class_;
  std::int64_t start_ns_ = 0;
  std::int64_t past_ns_ = 0;
  double whole_ns_ = 0.0;
  double time_ns_ = 0.0;  ///< of it, until contacts are chosen
  bool timed_ = false;
  bool shared_time_ = false;  // the frame's, not the geoms' own
  bool shared_units_ = false;
  bool in_units_ = false;  // work is limited, not only time
  std::uint64_t beside_ = 0;
  std::uint64_t begun_with_ = most_units;

 public:
  std::uint64_t units = most_units;  ///< left; searches take from it
};

}  // namespace odds::ode
