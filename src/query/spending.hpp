// Keeps a query's accounts: work units, the deadline, and the gaps between polls of the clock.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "odds/query/answer.hpp"
#include "odds/query/budget.hpp"
#include "odds/realtime/clock.hpp"
#include "odds/realtime/stall_ledger.hpp"
#include "query/ending_reserve.hpp"

namespace odds::query {

/// Made at the start of a query. `allows(n)` is asked before every n units of work; `may_go_on()` polls the clock and
/// is asked after every piece of work that `pair` bounds (a node pair's children, one row of a leaf pair).
class Spending {
 public:
  /// What of the time is kept for what follows a search; of a short time no more than `most_ending_ns`, and
  /// `most_search_ending_ns` for the search.
  struct Kept {
    std::int64_t search_ns = EndingReserves{}.search.ns();  ///< the last piece of one without a proof, and its answer
    std::int64_t contacts_ns = 0;                           ///< contacts, once there is a hit to make them from
    std::int64_t last_contact_ns = 0;                       ///< a contact of a hit that comes last
    bool pieces_are_long = false;                           ///< a pair of volumes takes a microsecond
    bool timed = true;                                      ///< how long all takes is told also without a limit
  };
  /// A look at the clock costs as much as opening a pair does: of the processor's own, which tells what work takes, no
  /// more are taken than it needs. A clock that counts its looks is looked at every time.
  enum class Looks : std::uint8_t { always, as_needed };

  explicit Spending(const Budget& budget) noexcept : Spending(budget, Kept{}) {}
  Spending(const Budget& budget, const Kept& kept) noexcept
      : Spending(budget, kept, is_own(budget.clock) ? Looks::as_needed : Looks::always) {}
  Spending(const Budget& budget, const Kept& kept, Looks looks) noexcept
      : clock_(budget.clock.now_ns != nullptr ? budget.clock : realtime::fastest_clock()),
        polled_clock_(realtime::without_waiting(clock_)),
        measured_(kept.timed || std::isfinite(budget.microseconds)),
        start_ns_(measured_ ? polled_clock_() : 0),
        ledger_(start_ns_),
        kept_(kept),
        units_left_(budget.work_units),
        looks_as_needed_(looks == Looks::as_needed) {
    if (std::isfinite(budget.microseconds)) {
      timed_ = true;
      const double ns = std::clamp(budget.microseconds * 1e3, 0.0, 1e15);
      deadline_ns_ = start_ns_ + static_cast<std::int64_t>(ns);
      search_deadline_ns_ = last_moment_ns_ = deadline_ns_ - search_kept_ns(false);
    }
  }

  /// True if `units` more fit into the work budget.
  [[nodiscard]] bool allows(std::uint64_t units) const noexcept { return units <= units_left_; }

  [[nodiscard]] std::uint64_t units_left() const noexcept { return units_left_; }

  void spend_node_pairs(std::uint32_t n) noexcept {
    cost_.node_pairs += n;
    note(n);
  }
  void spend_triangle_pairs(std::uint32_t n) noexcept {
    cost_.triangle_pairs += n;
    note(n);
  }
  /// Something that takes as long as `units` and is none was done: the clock is looked at so much sooner.
  void hasten_poll(std::uint32_t units) noexcept { unpolled_units_ += units; }
  /// What was spent so far; times are filled in by `close`.
  [[nodiscard]] const Cost& so_far() const noexcept { return cost_; }
  void note_full_queue() noexcept { ++cost_.queue_full; }

  /// From now on the search ends early enough for contacts to be made from what it found.
  void keep_time_for_contacts() noexcept;

  /// Polls the clock if there is a deadline. False once the search should stop.
  [[nodiscard]] bool may_go_on() noexcept {
    const std::int64_t now = look(Part::all);
    if (now < search_deadline_ns_) return true;
    told_to_stop_ = true;
    return false;
  }
  /// The same, but looks at the clock only when `units` were spent since the last look.
  [[nodiscard]] bool may_go_on_after(std::uint32_t units) noexcept { return unpolled_units_ < units || may_go_on(); }
  /// The same, or only when so many were spent that a small part of the time may be over: where no unit takes much
  /// longer than one of an opened pair.
  [[nodiscard]] bool may_go_on_in_time(std::uint32_t units) noexcept {
    return unpolled_units_ < std::max(units, patience_) || may_go_on();
  }
  /// Looks before a test of two triangles; or not, as above.
  [[nodiscard]] bool may_test_triangles() noexcept {
    if (unpolled_units_ + units_of_a_test > patience_) return may_go_on();
    unpolled_units_ += units_of_a_test;
    return true;
  }
  /// Whether the last look at the clock found the search's end near: time to ask the caches for what the answer needs.
  [[nodiscard]] bool nears_end() const noexcept { return nears_end_; }
  /// A search that changes its manner after a start has up to these shares, in [0, 1], of time and work for it.
  void begin_start(double time_share, double work_share) noexcept {
    patience_ = 0;
    // No limit becomes 2^64 as a double, which does not fit back into 64 bits.
    const auto all = static_cast<double>(units_left_);
    const double of_budget = work_share * all;
    start_units_end_ = of_budget < all ? units_left_ - static_cast<std::uint64_t>(of_budget) : 0;
    if (timed_) {
      start_deadline_ns_ = start_ns_ + static_cast<std::int64_t>(time_share * static_cast<double>(allowance_ns()));
    }
  }
  [[nodiscard]] bool start_may_go_on_after(std::uint32_t units) noexcept {
    if (units_left_ <= start_units_end_) return false;
    if (unpolled_units_ < std::max(units, patience_)) return true;
    // Of a very short time the share may be more than the search has before its answer has to be made.
    return look(Part::start) < std::min(start_deadline_ns_, search_deadline_ns_);
  }
  /// From now on contacts are finished as `reserve` expects, which must outlive this and learns how long it took:
  /// `may_finish_contacts` says when that begins. `hasty_ns` before it they are made hastily: `may_make_contacts` says
  /// when to begin with that.
  void reserve_for_contacts(EndingReserve& reserve, std::int64_t hasty_ns = 0) noexcept {
    if (!timed_) return;
    if (contacts_ended_) note_contacts_ending(poll());
    contacts_reserve_ = &reserve;
    spare_looks_ = 0;
    last_moment_ns_ = deadline_ns_ - kept_ns(reserve.ns());
    contacts_deadline_ns_ = last_moment_ns_ - hasty_ns;
  }
  /// There is no time left but for ending: `reserve` learns how long that takes from the search's last piece on.
  void end_from_last_piece(EndingReserve& reserve) noexcept {
    if (!timed_) return;
    const bool looked_lately = unpolled_units_ < least_patience;
    const std::int64_t now = contacts_ended_ || !looked_lately ? poll() : 0;
    if (contacts_ended_) note_contacts_ending(now);
    contacts_reserve_ = &reserve;
    last_moment_ns_ = looked_lately ? last_piece_ns_ : std::max(last_piece_ns_, now - usual_piece_ns);
    contacts_ended_ = true;
  }
  [[nodiscard]] bool may_make_contacts() noexcept { return poll_of_contacts() < contacts_deadline_ns_; }
  /// The same for pieces of half a microsecond: looks each time only when a few of them may take what is left.
  [[nodiscard]] bool may_go_on_making() noexcept {
    if (spare_looks_ > 0) {
      --spare_looks_;
      return true;
    }
    const bool may = may_make_contacts();
    spare_looks_ = looks_to_spare();
    return may;
  }
  /// How many of the next such looks may be left out.
  [[nodiscard]] std::int64_t looks_to_spare() const noexcept {
    constexpr std::int64_t most = 3;
    constexpr std::int64_t longest_piece_ns = 4'000;  // where others are at work, too
    const std::int64_t now = start_ns_ + ledger_.gross_ns();
    return timed_ && looks_as_needed_
               ? std::clamp<std::int64_t>((contacts_deadline_ns_ - now) / longest_piece_ns - 1, 0, most)
               : 0;
  }
  [[nodiscard]] bool may_finish_contacts() noexcept { return poll_of_contacts() < last_moment_ns_; }
  /// Microseconds for contacts before they have to be made hastily; infinite without a deadline.
  [[nodiscard]] double left_for_contacts_us() noexcept {
    if (!timed_) return std::numeric_limits<double>::infinity();
    const std::int64_t now = poll();  // after a stall the deadline is another one
    return static_cast<double>(contacts_deadline_ns_ - now) * 1e-3;
  }
  /// Microseconds until the deadline, which may be past; infinite without one.
  [[nodiscard]] double left_us() noexcept {
    if (!timed_) return std::numeric_limits<double>::infinity();
    return static_cast<double>(deadline_ns_ - poll()) * 1e-3;
  }

  /// From the moment that the search should have heard that its time was up until `close`, so that its last piece is in
  /// it. 0: it was not told to stop, or there was a stall, after which caches are another's.
  [[nodiscard]] std::int64_t ending_ns() const noexcept { return ending_ns_; }

  /// Closes the accounts; the last thing a query does.
  [[nodiscard]] Cost close() noexcept {
    cost_.longest_unpolled_units = std::max(cost_.longest_unpolled_units, unpolled_units_);
    if (!measured_) return cost_;
    const std::int64_t now = clock_();
    note_time(now);
    if (told_to_stop_ && ledger_.stalls() == 0) ending_ns_ = now - std::max(search_deadline_ns_, start_ns_);
    note_contacts_ending(now);
    cost_.gross_us = static_cast<double>(ledger_.gross_ns()) * 1e-3;
    // Without polls a long gap is the query's own work, not a stall.
    cost_.stall_us = timed_ ? static_cast<double>(ledger_.stall_ns()) * 1e-3 : 0.0;
    if (timed_ && now > deadline_ns_) {
      cost_.overshoot_us = static_cast<double>(now - deadline_ns_) * 1e-3;
      cost_.net_overshoot_us = static_cast<double>(std::max<std::int64_t>(now - deadline_ns_ - excused_ns_, 0)) * 1e-3;
    }
    return cost_;
  }

  static constexpr std::int64_t least_ending_ns = 600;

  /// Of the time, for the search, once a hit was found and contacts are wanted.
  static constexpr double search_share = 0.5;
  /// The same of a time that is short for contacts, which are made of a few hits then.
  static constexpr double short_search_share = 0.4;
  static constexpr std::int64_t short_ns = 50'000;

 private:
  /// Some three pieces of work.
  static constexpr std::int64_t notice_ns = 400;
  /// Units that may be spent between two looks while there is time. Of an opened pair one takes 4 to 6 ns, of one that
  /// no cache knows 25 to 40: an eighth of what is left is over by then, or at worst all. Near its end a search is to
  /// hear of it at once, for what it hears late it keeps more time for.
  static constexpr std::uint32_t most_patience = 144;
  static constexpr std::uint32_t least_patience = 24;
  static constexpr std::int64_t slow_unit_ns = 40;
  static constexpr std::int64_t near_end_ns = 800;
  static constexpr std::int64_t slowest_unit_ns = 1'000;
  /// An exact test takes up to 0.2 us.
  static constexpr std::uint32_t units_of_a_test = 24;
  static constexpr std::int64_t usual_piece_ns = 200;

  [[nodiscard]] static bool is_own(const realtime::Clock& clock) noexcept {
    return clock.now_ns == nullptr || clock.now_ns == realtime::fastest_clock().now_ns;
  }

  /// Looks at the clock before more of a search, or of its start.
  enum class Part : std::uint8_t { start, all };
  [[nodiscard]] std::int64_t look(Part part) noexcept {
    const std::uint32_t units = unpolled_units_;
    const std::int64_t before = last_piece_ns_;
    const std::int64_t now = last_piece_ns_ = poll();
    nears_end_ = now >= search_deadline_ns_ - notice_ns;
    if (!timed_ || !looks_as_needed_) return now;
    // A slow machine is known by what the last pieces took; not by a stall, which is the longest to be believed.
    if (now - before > units * unit_ns_ && units >= least_patience) {
      unit_ns_ = std::min((now - before) / units, slowest_unit_ns);
    }
    const std::int64_t end =
        part == Part::all ? search_deadline_ns_ : std::min(start_deadline_ns_, search_deadline_ns_);
    const std::int64_t left = (end - near_end_ns - now) / unit_ns_;
    patience_ = left >= least_patience ? static_cast<std::uint32_t>(std::min<std::int64_t>(left, most_patience)) : 0;
    return now;
  }

  [[nodiscard]] std::int64_t allowance_ns() const noexcept { return deadline_ns_ - start_ns_; }

  /// The time now, or 0, before every deadline, where there is none.
  [[nodiscard]] std::int64_t poll() noexcept {
    cost_.longest_unpolled_units = std::max(cost_.longest_unpolled_units, unpolled_units_);
    unpolled_units_ = 0;
    if (!timed_) return 0;
    const std::int64_t now = std::max(polled_clock_(), start_ns_ + ledger_.gross_ns());
    note_time(now);
    return now;
  }

  /// Whoever had the processor had its caches too: what is still to come takes up to twice as long.
  [[nodiscard]] bool caches_are_cold() const noexcept { return ledger_.stalls() > 0; }

  [[nodiscard]] static std::int64_t kept_ns(std::int64_t ending_ns, std::int64_t most_ns, bool cold) noexcept {
    return std::min((cold ? 2 : 1) * ending_ns, most_ns);
  }
  [[nodiscard]] std::int64_t kept_ns(std::int64_t ending_ns) const noexcept {
    return kept_ns(ending_ns, most_ending_ns(), caches_are_cold());
  }
  /// What the first stall adds to what is kept.
  [[nodiscard]] std::int64_t more_when_cold_ns(std::int64_t ending_ns) const noexcept {
    return kept_ns(ending_ns, most_ending_ns(), true) - kept_ns(ending_ns, most_ending_ns(), false);
  }
  [[nodiscard]] std::int64_t search_kept_ns(bool cold) const noexcept;
  [[nodiscard]] std::int64_t most_search_ending_ns() const noexcept;
  [[nodiscard]] std::int64_t most_ending_ns() const noexcept {
    return std::max(least_ending_ns, allowance_ns() * 3 / 10);
  }

  void end_earlier() noexcept;

  /// Of a stall only what lies beyond the moment when the query had to end excuses it: what was before that was time
  /// that it could still react to.
  void note_time(std::int64_t now) noexcept {
    const std::int64_t stalled_before = ledger_.stall_ns();
    ledger_.poll(now);
    const std::int64_t stalled = ledger_.stall_ns() - stalled_before;
    if (stalled == 0) return;
    if (now > last_moment_ns_) excused_ns_ += std::min(stalled, now - last_moment_ns_);
    if (timed_ && ledger_.stalls() == 1) end_earlier();
  }

  /// To be compared with a deadline that is read afterwards: after a stall it is another one.
  [[nodiscard]] std::int64_t poll_of_contacts() noexcept {
    const std::int64_t now = poll();
    contacts_ended_ = contacts_ended_ || (contacts_reserve_ != nullptr && now >= last_moment_ns_);
    return now;
  }

  /// After a stall, caches are another's: such an ending says nothing of the next.
  void note_contacts_ending(std::int64_t now) noexcept {
    if (contacts_ended_ && ledger_.stalls() == 0)
      contacts_reserve_->note(std::max<std::int64_t>(now - last_moment_ns_, 0));
    contacts_ended_ = false;
  }

  void note(std::uint32_t units) noexcept {
    units_left_ -= std::min<std::uint64_t>(units, units_left_);
    unpolled_units_ += units;
  }

  realtime::Clock clock_;
  realtime::Clock polled_clock_;  ///< to wait for all work before each look made queries a quarter longer
  bool measured_;                 ///< whether the clock is read at all
  std::int64_t start_ns_;
  std::int64_t deadline_ns_ = std::numeric_limits<std::int64_t>::max();
  std::int64_t search_deadline_ns_ = std::numeric_limits<std::int64_t>::max();
  std::int64_t start_deadline_ns_ = std::numeric_limits<std::int64_t>::max();
  std::uint64_t start_units_end_ = 0;
  std::int64_t contacts_deadline_ns_ = std::numeric_limits<std::int64_t>::max();
  std::int64_t last_moment_ns_ = std::numeric_limits<std::int64_t>::max();  ///< to begin to end in
  std::int64_t last_piece_ns_ = start_ns_;  ///< when the search last asked whether it may go on
  EndingReserve* contacts_reserve_ = nullptr;
  bool contacts_wait_ = false;   ///< time is kept for them
  bool contacts_ended_ = false;  ///< they were told to be finished
  std::int64_t excused_ns_ = 0;
  realtime::StallLedger ledger_;
  Kept kept_;
  std::uint64_t units_left_;
  std::uint32_t unpolled_units_ = 0;
  std::uint32_t patience_ = 0;  ///< units that may be spent before the next look, while that can do no harm
  std::int64_t unit_ns_ = slow_unit_ns;
  std::int64_t spare_looks_ = 0;
  bool looks_as_needed_;
  bool timed_ = false;
  bool nears_end_ = false;
  bool told_to_stop_ = false;
  std::int64_t ending_ns_ = 0;
  Cost cost_;
};

}  // namespace odds::query
