// What the incremental method of the wide engine keeps between calls: tested pairs of nodes, and how far the bodies may
// move before each must be tested again.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "odds/math/motion.hpp"
#include "odds/math/pose.hpp"
#include "odds/tree/wide_tree.hpp"

namespace odds::query::wide {

/// One opened pair of nodes, or a pair of leaves: the bottom of the test tree as in Li and Chen 1998, with an expiry
/// instead of a test at every call. A pair that was found apart by a gap stays apart until some point of B has moved by
/// that gap; `travelled` sums up bounds of that motion, and an entry is looked at only once `travelled` reaches its
/// expiry. What was not looked into, because the search ended early, expires at once. Fixed capacity.
class KineticFront {
 public:
  struct Entry {
    tree::Slot a = 0;
    tree::Slot b = 0;
    std::uint32_t opened = 0;  ///< bits of the lanes below which other entries are
  };
  static constexpr double at_once = -std::numeric_limits<double>::infinity();

  explicit KineticFront(std::uint32_t capacity) : entries_(capacity), expiries_(capacity) {}

  void reset() noexcept { size_ = 0; }

  /// Notes where B stands now; `reach` bounds the distance of B's surface from its tree's origin. Starts from the roots
  /// if there is nothing yet, if the last search found no room, or if much of what is kept is of no use any more.
  void move_to(const math::Pose& pose, double reach) noexcept {
    if (size_ == 0 || overflowed_ || size_ > 2 * fresh_size_ + least_size) {
      size_ = 0;
      overflowed_ = false;
      fresh_ = true;
      travelled_ = 0.0;
      add({tree::WideTree::root, tree::WideTree::root, 0}, at_once);
    } else {
      travelled_ += math::motion_bound(pose_, pose, reach);
    }
    pose_ = pose;
  }
  /// A search from the roots has ended: what it left is the measure of what is worth keeping.
  void note_end() noexcept {
    if (fresh_) fresh_size_ = size_;
    fresh_ = false;
  }

  [[nodiscard]] std::uint32_t size() const noexcept { return size_; }
  [[nodiscard]] double travelled() const noexcept { return travelled_; }
  [[nodiscard]] bool expired(std::uint32_t index) const noexcept { return !(travelled_ < expiries_[index]); }
  [[nodiscard]] Entry& entry(std::uint32_t index) noexcept { return entries_[index]; }
  void set_expiry(std::uint32_t index, double expiry) noexcept { expiries_[index] = expiry; }

  void add(const Entry& entry, double expiry) noexcept {
    if (size_ == entries_.size()) {
      overflowed_ = true;  // searched, but not kept: the next search starts from the roots
      return;
    }
    entries_[size_] = entry;
    expiries_[size_++] = expiry;
  }

 private:
  static constexpr std::uint32_t least_size = 64;

  std::vector<Entry> entries_;
  std::vector<double> expiries_;
  std::uint32_t size_ = 0;
  std::uint32_t fresh_size_ = 0;
  bool fresh_ = false;
  bool overflowed_ = false;
  double travelled_ = 0.0;
  math::Pose pose_;
};

}  // namespace odds::query::wide
