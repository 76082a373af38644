// What the incremental method of the wide engine keeps between calls: tested pairs of nodes, and how far the bodies may
// move before each must be tested again.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "odds/math/motion.hpp"
#include "odds/math/pose.hpp"
#include "odds/tree/wide_tree.hpp"
#include "query/wide/parting_plane.hpp"

namespace odds::query::wide {

/// One opened pair of nodes, or a pair of leaves: the bottom of the test tree as in Li and Chen 1998, with an expiry
/// instead of a test at every call. A pair that was found apart by a gap stays apart until the bodies have come nearer
/// by that gap; `travelled` sums up bounds of that motion, and an entry is looked at only once `travelled` reaches its
/// expiry. What was not looked into, because the search ended early, expires at once. Fixed capacity.
///
/// The pairs of leaves that met in the last search stand first: surfaces that cross go on crossing, so that even a
/// search that is soon ended finds most of the rim, and the others wait their turn from where the last search stopped.
///
/// Such a bound counts all motion, and where bodies slide on each other nearly all of it is along the surfaces. So two
/// leaves that are looked at again get a plane that parts them: they expire by what B moves towards it.
class KineticFront {
 public:
  struct Entry {
    tree::Slot a = 0;
    tree::Slot b = 0;
    std::uint8_t opened = 0;  ///< bits of the lanes below which other entries are
    bool met = false;         ///< two leaves with triangles that met when they were last looked at
    PartingPlanes::Which plane = PartingPlanes::none;  ///< that parts two leaves
  };
  static constexpr double at_once = -std::numeric_limits<double>::infinity();

  explicit KineticFront(std::uint32_t capacity)
      : entries_(capacity), expiries_(capacity), changed_(capacity), planes_(capacity) {}

  /// The next search begins from the roots.
  void restart() noexcept { clear(); }
  /// As if it were new.
  void reset() noexcept {
    clear();
    last_met_ = {};
    lost_work_ = 0;
  }

  /// Whether nothing can have expired since a search that found all apart: it would find all apart again.
  [[nodiscard]] bool is_apart(const math::Pose& pose, const math::Reaches& reaches) const noexcept {
    return size_ > 0 && travelled_ + math::approach_bound(pose_, pose, reaches) < next_expiry_;
  }
  /// Notes where B stands now; `reaches`: from the trees' origins. Starts from the roots if there is nothing yet, if
  /// the last search found no room, or if much of what is kept is of no use any more.
  void move_to(const math::Pose& pose, const math::Reaches& reaches) noexcept {
    const bool lost =
        last_.irreplaceable && lost_work_ >= patience && travelled_ > lost_after * reaches.of_the_moving();
    if (size_ == 0 || overflowed_ || lost || (!fresh_ && size_ > 2 * fresh_size_ + least_size)) {
      lost_work_ = 0;
      clear();
      fresh_ = true;
      travelled_ = 0.0;
      turned_ = 0.0;
      motion_ = 0.0;
      add({tree::WideTree::root, tree::WideTree::root, 0}, at_once);
    } else {
      const double motion = math::approach_bound(pose_, pose, reaches);
      motion_ = motion / std::max(runs_, 1);
      travelled_ += motion;
      turned_ += math::turn_bound(pose_, pose);
    }
    runs_ = 0;
    pose_ = pose;
    earliest_ = std::numeric_limits<double>::infinity();
  }
  /// One more run of the pair, whether it comes to a search or not.
  void begin_run() noexcept { runs_ = std::min(runs_ + 1, 1 << 20); }
  /// How a search from a front went.
  struct Outcome {
    std::uint32_t left_at = 0;        ///< where that begins which the search was going down into when it ended
    std::uint32_t resume_at = 0;      ///< where the next one begins, after these and the entries that met
    std::uint32_t next_crossing = 0;  ///< which of the entries that met is next
    bool explored = false;            ///< nothing is left that had expired, but for what met
    bool starved = false;             ///< its budget ended it
    bool irreplaceable = false;       ///< such a budget finds nothing without a front
    std::uint64_t work = 0;           ///< units that it took
    std::uint32_t looked_at = 0;      ///< of the entries that met before
    std::uint32_t still_met = 0;
  };
  /// A search has ended. The first to leave nothing unexplored after one from the roots leaves what is the measure of
  /// what is worth keeping.
  void note_end(const Outcome& outcome) noexcept {
    if (fresh_) fresh_size_ = size_;
    fresh_ = fresh_ && !outcome.explored;
    // Also where neighbours of what met last were found: they do not need this front.
    lost_work_ = outcome.starved && outcome.looked_at == 0 ? lost_work_ + outcome.work : 0;
    move_changed();
    const bool may_miss = !outcome.explored || fresh_ || overflowed_ || crossing_ > 0;
    next_expiry_ = may_miss ? at_once : earliest_;
    last_ = outcome;
  }
  /// How the last search went; nothing of it where the front has started over since.
  [[nodiscard]] const Outcome& last() const noexcept { return last_; }

  /// Whether no search has finished since the last one from the roots: there may be more that meets.
  [[nodiscard]] bool is_fresh() const noexcept { return fresh_; }
  [[nodiscard]] std::uint32_t size() const noexcept { return size_; }
  /// How many entries, from the first on, met in the last search.
  [[nodiscard]] std::uint32_t crossing() const noexcept { return crossing_; }
  [[nodiscard]] std::uint32_t left_at() const noexcept { return last_.left_at; }
  [[nodiscard]] std::uint32_t resume_at() const noexcept { return last_.resume_at; }
  [[nodiscard]] std::uint32_t next_crossing() const noexcept { return last_.next_crossing; }
  /// Whether the two leaves of an entry have triangles that meet.
  void set_met(std::uint32_t index, bool met) noexcept {
    if (met != entries_[index].met) changed_[changed_count_++] = index;
    entries_[index].met = met;
  }
  /// Two leaves with triangles that met in the last run.
  struct LastMet {
    tree::Slot a = 0;
    tree::Slot b = 0;
    bool is_entry = false;
    bool known = false;
  };
  [[nodiscard]] LastMet& last_met() noexcept { return last_met_; }
  /// What is apart by less than this is an entry of its own, metres: it expires within a few runs.
  [[nodiscard]] double skin() const noexcept {
    constexpr double runs = 8.0;  // of 4, 8 and 16 the best at touch; near each other none makes a difference
    return runs * motion_;
  }
  /// Such entries are no use where they would leave no room for others.
  [[nodiscard]] bool has_room_for_near() const noexcept { return size_ < entries_.size() / 2; }
  [[nodiscard]] double travelled() const noexcept { return travelled_; }
  [[nodiscard]] bool expired(std::uint32_t index) const noexcept { return !(travelled_ < expiries_[index]); }
  /// The first that has expired of those from `from` on, before `end`; `end`: none. Every search passes over each entry
  /// once, so that what they say together is when the first of all expires.
  [[nodiscard]] std::uint32_t next_expired(std::uint32_t from, std::uint32_t end) noexcept {
    constexpr std::uint32_t block = 8;  // minima of two apart, which the compiler makes wide
    const double* const e = expiries_.data();
    std::uint32_t i = from;
    for (; i + block <= end; i += block) {
      double least[block / 2];
      for (std::uint32_t k = 0; k < block / 2; ++k) least[k] = lesser(e[i + k], e[i + block / 2 + k]);
      const double first = lesser(lesser(least[0], least[1]), lesser(least[2], least[3]));
      if (!(travelled_ < first)) break;
      earliest_ = lesser(earliest_, first);
    }
    for (; i < end && travelled_ < e[i]; ++i) earliest_ = lesser(earliest_, e[i]);
    return i;
  }
  [[nodiscard]] double expiry(std::uint32_t index) const noexcept { return expiries_[index]; }
  [[nodiscard]] Entry& entry(std::uint32_t index) noexcept { return entries_[index]; }
  void set_expiry(std::uint32_t index, double expiry) noexcept {
    expiries_[index] = expiry;
    earliest_ = lesser(earliest_, expiry);
  }

  /// Whether the plane of two leaves that have expired still parts them; then they expire later.
  [[nodiscard]] bool is_parted(std::uint32_t index) noexcept {
    const PartingPlanes::Which which = entries_[index].plane;
    if (!PartingPlanes::is_plane(which)) return false;
    const PartingPlane& plane = planes_[which];
    const double gap = std::min(plane.gap(pose_, turned_), plane.until - travelled_);
    if (!(gap > 0.0)) return false;
    set_expiry(index, travelled_ + gap);
    return true;
  }
  /// Whether a plane between two leaves is worth looking for in this look at them. Not where B moves by much of a leaf
  /// in a run: then others are near each other soon.
  [[nodiscard]] bool takes_look(std::uint32_t index, const LaneNumbers& leaf_b) noexcept {
    constexpr double slow = 1.0 / 16.0;
    return motion_ < slow * static_cast<double>(std::sqrt(squared_radius(leaf_b))) &&
           planes_.takes_look(entries_[index].plane);
  }
  /// What was found at this pose.
  void note_parting(std::uint32_t index, const Parting& parting, const LaneNumbers& leaf_b) noexcept {
    constexpr float round_up = 1.00001F;
    if (!parting.parts) return planes_.give_up(entries_[index].plane);
    PartingPlane plane;
    for (int i = 0; i < 3; ++i) {
      plane.normal[i] = parting.normal[i];
      plane.center[i] = leaf_b.center(i);
    }
    plane.radius = std::sqrt(squared_radius(leaf_b)) * round_up;
    plane.limit = plane.along_normal(pose_) - static_cast<double>(parting.along);
    plane.turned = turned_;
    plane.until = travelled_ + static_cast<double>(parting.beside);
    planes_.keep(entries_[index].plane, plane);
  }

  void add(const Entry& entry, double expiry) noexcept {
    if (size_ == entries_.size()) {
      overflowed_ = true;  // searched, but not kept: the next search starts from the roots
      return;
    }
    if (entry.met) changed_[changed_count_++] = size_;
    earliest_ = lesser(earliest_, expiry);
    entries_[size_] = entry;
    expiries_[size_++] = expiry;
  }

 private:
  static constexpr std::uint32_t least_size = 64;
  /// Units of runs in a row that found nothing to meet and were ended by their budget, and the share of its reach
  /// that a body has moved since the front was new, after which all of it is stale: what opening it took is not
  /// worth keeping.
  static constexpr std::uint64_t patience = 200;
  static constexpr double lost_after = 0.1;

  void clear() noexcept {
    size_ = 0;
    crossing_ = 0;
    last_ = {};
    changed_count_ = 0;
    planes_.clear();
    last_met_.is_entry = false;
    overflowed_ = false;
    next_expiry_ = at_once;
  }
  static double lesser(double x, double y) noexcept { return x < y ? x : y; }
  void swap(std::uint32_t i, std::uint32_t j) noexcept {
    std::swap(entries_[i], entries_[j]);
    std::swap(expiries_[i], expiries_[j]);
  }
  /// Puts what meets now in front and what does no more behind, in any order and in time proportional to their number:
  /// a place is filled again only when it is its own entry's turn.
  void move_changed() noexcept {
    for (std::uint32_t k = 0; k < changed_count_; ++k) {
      const std::uint32_t i = changed_[k];
      while (crossing_ > 0 && !entries_[crossing_ - 1].met) --crossing_;
      if (i < crossing_ && !entries_[i].met) swap(i, --crossing_);
    }
    for (std::uint32_t k = 0; k < changed_count_; ++k) {
      const std::uint32_t i = changed_[k];
      while (crossing_ < size_ && entries_[crossing_].met) ++crossing_;
      if (i > crossing_ && entries_[i].met) swap(i, crossing_++);
    }
    changed_count_ = 0;
  }

  std::vector<Entry> entries_;
  std::vector<double> expiries_;
  std::vector<std::uint32_t> changed_;  ///< whose `met` the search that is under way has changed
  PartingPlanes planes_;
  std::uint32_t size_ = 0;
  std::uint32_t fresh_size_ = 0;
  std::uint32_t crossing_ = 0;
  Outcome last_;
  std::uint64_t lost_work_ = 0;
  double next_expiry_ = at_once;
  double earliest_ = at_once;  ///< expiry of what the search that is under way has passed over
  std::uint32_t changed_count_ = 0;
  bool fresh_ = false;
  bool overflowed_ = false;
  double travelled_ = 0.0;
  double turned_ = 0.0;  ///< sum of bounds of turns
  double motion_ = 0.0;  ///< a run, since the search before
  int runs_ = 0;         ///< since that one
  LastMet last_met_;
  math::Pose pose_;
};

}  // namespace odds::query::wide
