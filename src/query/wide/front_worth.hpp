// Whether a kinetic front is worth its keep: searches from it against searches from the roots, by what they cost and
// by how often a budget ends them.
#pragma once

#include <algorithm>
#include <cstdint>

#include "odds/math/motion.hpp"
#include "odds/math/pose.hpp"
#include "odds/query/answer.hpp"
#include "query/wide/kinetic_front.hpp"

namespace odds::query::wide {

/// Of one search.
struct Work {
  std::uint64_t node_pairs = 0;
  std::uint64_t triangle_pairs = 0;

  /// What a run spent between two states of its account.
  [[nodiscard]] static Work between(const Cost& before, const Cost& after) noexcept {
    return {after.node_pairs - before.node_pairs, after.triangle_pairs - before.triangle_pairs};
  }
};

/// A front spares all that has not moved far enough to meet; what has, costs more than in a search from the roots, for
/// it is looked at one pair after the other and noted down. Of bodies that move by a thousandth of their size between
/// two runs, as in a hand that hurries, more has expired than has not.
///
/// So what searches cost is kept account of, of each kind as it is used. While the front is, a search from the roots is
/// made now and then, and as soon as the bodies move twice as fast as at the last one. Where the front costs more, it
/// rests: until the bodies move half as fast, or for a rest that is longer each time. It also rests where budgets end
/// most searches from it, and what met does not meet for long: those from the roots tell more then. By counted work, so
/// that the same runs choose the same on every machine. No allocation.
class FrontWorth {
 public:
  void reset() noexcept { *this = {}; }

  /// A search is about to begin, with B at `pose`; `reach` bounds the distance of B's surface from its tree's origin.
  /// Whether it had better be from the roots. `limited`: a budget may end it.
  [[nodiscard]] bool prefers_roots(const math::Pose& pose, double reach, bool limited) noexcept {
    const double motion = known_pose_ ? math::motion_bound(pose_, pose, reach) : 0.0;
    pose_ = pose;
    if (motion_.count >= trial && motion > std::max(jump * motion_.mean, far * reach)) {
      is_stale_ = true;  // little of what the front knows is left, and nothing is learnt from that
    } else if (known_pose_) {
      motion_.add(motion);
    }
    known_pose_ = true;
    pauses_ = limited && pause_ > 0;
    if (pauses_) {
      --pause_;
      return true;
    }
    if (rests_) {
      if (rest_ == 0 || motion_.mean < slower * rested_at_) end_rest();
      if (rests_) --rest_;
      return rests_;
    }
    if (front_.count < trial || is_stale_) return false;
    ++since_roots_;
    return since_roots_ > seldom || (since_roots_ > trial && motion_.mean > faster * roots_at_);
  }
  /// Whether what the front knows is of before a rest, or of another place.
  [[nodiscard]] bool is_stale() const noexcept { return is_stale_; }

  /// What a search from the roots took; `finished`: no budget ended it.
  void note_roots(const Work& spent, bool finished) noexcept {
    if (pauses_) return;  // of searches that budgets end nothing is learnt
    const double cost = cost_from_roots(spent);
    const bool other_motion = motion_.mean > faster * roots_at_ || motion_.mean < slower * roots_at_;
    since_roots_ = 0;
    roots_at_ = motion_.mean;
    if (!finished) {  // what the next search would take up is worth more than what this one cost
      roots_ = {};
      roots_.add(of_no_answer * cost);
      if (rests_) end_rest();
      return;
    }
    if (!rests_) {
      if (cost < 0.5 * roots_.mean) since_roots_ = seldom - trial;  // soon again: it may be so from here on
      roots_.mean = roots_.count == 0 || other_motion ? cost : 0.5 * (roots_.mean + cost);
      roots_.count = std::max(roots_.count, 1U);
      return consider();
    }
    if (++seen_in_rest_ == trial) roots_ = {};  // they were of other motion
    roots_.add(cost);
    if (seen_in_rest_ > 2 * trial && roots_.mean > dearer * front_.mean) end_rest();
  }
  /// What a search from the front took, which has `size` entries, and how it went; `is_new`: it had to be made.
  void note_front(const Work& spent, std::uint32_t size, bool is_new, const KineticFront::Outcome& outcome) noexcept {
    const bool is_first = is_stale_ || !has_front_;
    is_stale_ = false;
    has_front_ = true;
    if (is_no_use(outcome)) return begin_pause();
    if (outcome.starved) return;
    if (is_new && roots_.count == 0) {  // as many pairs as from the roots
      roots_.add(cost_from_roots(spent));
      roots_at_ = motion_.mean;
    }
    if (is_new && is_first) return;  // it is made once, and kept as long as it is of use
    front_.add(cost_from_front(spent, size));
    consider();
  }

  /// Nanoseconds of a 3 GHz processor, about: by least squares over 22,800 searches of four meshes, armadillo to gear,
  /// with steps of 3e-5 to 1e-2 of their size.
  [[nodiscard]] static double cost_from_roots(const Work& spent) noexcept {
    return 400.0 + 8.0 * static_cast<double>(spent.node_pairs) + 55.0 * static_cast<double>(spent.triangle_pairs);
  }
  [[nodiscard]] static double cost_from_front(const Work& spent, std::uint32_t size) noexcept {
    return 280.0 + 23.0 * static_cast<double>(spent.node_pairs) + 80.0 * static_cast<double>(spent.triangle_pairs) +
           0.7 * static_cast<double>(size);
  }

  static constexpr std::uint32_t trial = 4;  ///< searches before a kind is judged
  static constexpr std::uint32_t first_rest = 64;
  static constexpr std::uint32_t longest_rest = 8192;

 private:
  static constexpr double dearer = 1.1;
  static constexpr double slower = 0.5;
  static constexpr double faster = 2.0;
  static constexpr std::uint32_t seldom = 256;  ///< searches
  /// A search that ends without an answer costs more than its time.
  static constexpr double of_no_answer = 4.0;
  /// Times the motion before, and of the reach: so much at once is to another place.
  static constexpr double jump = 16.0;
  static constexpr double far = 0.05;

  /// Of the last ones most.
  struct Mean {
    double mean = 0.0;
    std::uint32_t count = 0;

    void add(double value) noexcept {
      constexpr std::uint32_t most = 8;
      count = std::min(count + 1, most);
      mean += (value - mean) / static_cast<double>(count);
    }
  };

  /// Where most runs are ended by their budget, and what met does not meet for long. Means over some 16 runs.
  [[nodiscard]] bool is_no_use(const KineticFront::Outcome& outcome) noexcept {
    constexpr double weight = 1.0 / 16.0;
    starved_ += weight * ((outcome.starved ? 1.0 : 0.0) - starved_);
    if (outcome.looked_at > 0) {
      const double still = static_cast<double>(outcome.still_met) / static_cast<double>(outcome.looked_at);
      still_met_ += weight * (still - still_met_);
    }
    if (starved_ < 0.1) next_pause_ = first_rest;
    return starved_ > 0.5 && still_met_ < 0.95;
  }
  /// Longer each time, until it is of use again.
  void begin_pause() noexcept {
    is_stale_ = true;
    starved_ = 0.25;  // on trial: soon given up again, or trusted
    still_met_ = 1.0;
    pause_ = next_pause_;
    next_pause_ = std::min(2 * next_pause_, longest_rest);
  }
  void consider() noexcept {
    if (front_.count < trial || roots_.count == 0) return;
    if (front_.mean <= roots_.mean) next_rest_ = first_rest;
    if (front_.mean > dearer * roots_.mean) begin_rest();
  }
  void begin_rest() noexcept {
    rests_ = true;
    is_stale_ = true;
    rest_ = next_rest_;
    next_rest_ = std::min(2 * next_rest_, longest_rest);
    rested_at_ = motion_.mean;
    seen_in_rest_ = 0;
  }
  void end_rest() noexcept {
    rests_ = false;
    front_ = {};
    since_roots_ = 0;
  }

  Mean front_;
  Mean roots_;
  Mean motion_;  ///< metres, from search to search
  math::Pose pose_;
  bool known_pose_ = false;
  bool rests_ = false;
  bool is_stale_ = false;
  bool has_front_ = false;
  bool pauses_ = false;      ///< in this search
  std::uint32_t rest_ = 0;   ///< searches that are cheaper from the roots
  std::uint32_t pause_ = 0;  ///< searches with a budget that ended most from the front
  std::uint32_t next_rest_ = first_rest;
  std::uint32_t next_pause_ = first_rest;
  double starved_ = 0.0;    ///< share of searches from the front
  double still_met_ = 1.0;  ///< share of entries that met, one search later
  std::uint32_t seen_in_rest_ = 0;
  std::uint32_t since_roots_ = 0;  ///< searches
  double roots_at_ = 0.0;          ///< motion when they were searched last, metres
  double rested_at_ = 0.0;         ///< motion, metres
};

}  // namespace odds::query::wide
