// Contacts that come late, and those that they follow on.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "odds/math/motion.hpp"
#include "odds/math/tolerances.hpp"
#include "odds/query/contact_patch.hpp"
#include "odds/query/held_contact.hpp"
#include "query/given_depth.hpp"

namespace odds::query {

/// How late contacts are, runs.
struct Lateness {
  static constexpr int long_ago = 1 << 20;
  int asked = 0;        ///< since the pose that they are about
  int last = long_ago;  ///< since the one before it whose contacts were kept: so long a depth may have come unknown
};

/// Whether there are contacts, and all push in much the same direction: a tool on the ground, but not a bolt in its
/// nut, which another turn of its thread would push elsewhere.
[[nodiscard]] inline bool push_one_way(std::span<const Contact> contacts) noexcept {
  return !contacts.empty() && std::all_of(contacts.begin(), contacts.end(), [&contacts](const Contact& contact) {
    return contact.normal.dot(contacts.front().normal) > tolerances::hasty_agreement;
  });
}

/// How far contacts are carried that were asked for `asked` runs ago, as parts of the smaller body's size. Those of
/// bodies that slide are new ones all the time, and where they have slid to hold better than none; where all push
/// `one_way`.
struct CarriedFar {
  double motion;
  double slip;

  static constexpr CarriedFar of(bool one_way, int asked) noexcept {
    return one_way && asked <= tolerances::late_runs ? CarriedFar{tolerances::slid_motion, tolerances::slid_slip}
                                                     : CarriedFar{tolerances::late_motion, tolerances::late_slip};
  }
};

/// Bodies that rest on each other rock by nanometres, and touch on one edge now, on another one then. A patch that is
/// late by ten runs knows one of them; so those of the patches before it stay where they have come apart by little, and
/// push again as soon as they touch. What came deep while nobody knew is pushed out gently (GivenDepth). Each follows
/// the bodies' motion. In A's mesh frame; `size`: of the smaller body, metres. No allocation.
class LateManifold {
 public:
  void forget() noexcept { count_ = 0; }

  /// All contacts that there are at `pose`, of B's mesh frame in A's, deepest first, and how many pairs of triangles
  /// they were made from. `pose_now`: that of this run. Where all push one way, of what came in some runs a share of
  /// one run is given at once.
  void keep(std::span<const Contact> contacts, const math::Pose& pose, const math::Pose& pose_now, double size,
            std::uint32_t made_from, const Lateness& lateness = {}) noexcept {
    one_way_ = push_one_way(contacts);
    std::size_t kept = std::min<std::size_t>(contacts.size(), most_contacts);
    std::array<Entry, most> now;
    for (std::size_t i = 0; i < kept; ++i) {
      now[i].held = HeldContact(contacts[i], pose);
      const double depth = now[i].held.parted(pose_now).depth;
      const double share = one_way_ ? depth / std::max(lateness.last, 1) : 0.0;
      double given = std::max(tolerances::late_least * size, share);
      for (std::size_t k = 0; k < count_; ++k) {
        const bool is_successor = held_[k].depth.holds() && is_same(held_[k].held, now[i].held, size);
        if (is_successor) given = std::max(given, held_[k].depth.given());
      }
      now[i].depth.begin(depth, std::min(contacts[i].depth, given));
    }
    for (std::size_t i = 0; i < count_ && kept < most; ++i) {
      const auto [depth, slip] = held_[i].held.parted(pose);
      // What overlaps would be among the contacts if it did; what is one of them has its successor.
      if (depth > 0.0 || depth < -tolerances::late_gap * size || slip > tolerances::late_slip * size) continue;
      const bool is_known = std::any_of(now.begin(), now.begin() + static_cast<std::ptrdiff_t>(kept),
                                        [&](const Entry& other) { return is_same(other.held, held_[i].held, size); });
      if (!is_known) now[kept++] = held_[i];
    }
    held_ = now;
    count_ = kept;
    pose_ = pose;
    made_from_ = made_from;
    asked_ = lateness.asked;
  }
  /// Whether all of each depth is given, but for what rounding took.
  [[nodiscard]] bool gives_all(const math::Pose& pose) const noexcept {
    constexpr double all = 1.0 - 1e-6;
    return std::all_of(held_.begin(), held_.begin() + static_cast<std::ptrdiff_t>(count_), [&pose](const Entry& entry) {
      return entry.depth.given() >= all * entry.held.parted(pose).depth;
    });
  }
  /// A run begins, at `pose`.
  void age(const math::Pose& pose, double size) noexcept {
    asked_ = std::min(asked_ + 1, Lateness::long_ago);
    for (Entry& entry : std::span(held_).first(count_)) {
      entry.depth.age(entry.held.parted(pose).depth, tolerances::late_least * size, tolerances::late_rise * size);
    }
  }

  /// Whether no point within `size` of the first contact has moved farther than they are carried, and one of them at
  /// least overlaps, or has come apart by less than `margin`, metres.
  [[nodiscard]] bool serves(const math::Pose& pose, double size, double margin = 0.0) const noexcept {
    if (count_ == 0) return false;
    if (!(math::motion_bound_about(held_[0].held.on_b(), pose_, pose, size) <= carried_far().motion * size)) {
      return false;
    }
    const double most_slip = carried_far().slip * size;
    return std::any_of(held_.begin(), held_.begin() + static_cast<std::ptrdiff_t>(count_), [&](const Entry& entry) {
      const auto [depth, slip] = entry.held.parted(pose);
      return depth > -margin && slip <= most_slip;
    });
  }

  /// Writes those that overlap at `pose`, or have come apart by less than `margin` (a depth below 0), as many as there
  /// is room for, the deepest first: one that is left out while the bodies come deeper there would push all at once
  /// when it is not. Returns how many.
  [[nodiscard]] std::size_t write(const math::Pose& pose, double size, std::span<Contact> contacts,
                                  double margin = 0.0) noexcept {
    struct Candidate {
      double depth;
      std::size_t entry;
    };
    std::array<Candidate, most> candidates;
    std::size_t overlapping = 0;
    const double most_slip = carried_far().slip * size;
    for (std::size_t i = 0; i < count_; ++i) {
      const auto [depth, slip] = held_[i].held.parted(pose);
      if (depth > -margin && slip <= most_slip) candidates[overlapping++] = {depth, i};
    }
    const std::size_t written = std::min(overlapping, contacts.size());
    const auto begin = candidates.begin();
    std::partial_sort(begin, begin + static_cast<std::ptrdiff_t>(written),
                      begin + static_cast<std::ptrdiff_t>(overlapping),
                      [](const Candidate& x, const Candidate& y) { return x.depth > y.depth; });
    for (std::size_t i = 0; i < written; ++i) {
      Entry& entry = held_[candidates[i].entry];
      entry.depth.hold();
      contacts[i] = entry.held.at(pose);
      contacts[i].depth = entry.depth.of(candidates[i].depth);
    }
    return written;
  }
  [[nodiscard]] std::uint32_t made_from() const noexcept { return made_from_; }

 private:
  static constexpr std::size_t most = 2 * most_contacts;

  struct Entry {
    HeldContact held;
    GivenDepth depth;
  };
  [[nodiscard]] CarriedFar carried_far() const noexcept { return CarriedFar::of(one_way_, asked_); }
  [[nodiscard]] static bool is_same(const HeldContact& x, const HeldContact& y, double size) noexcept {
    return (x.on_a() - y.on_a()).norm() <= tolerances::late_spacing * size &&
           x.normal().dot(y.normal()) > tolerances::hasty_agreement;
  }

  std::array<Entry, most> held_;
  std::size_t count_ = 0;
  std::uint32_t made_from_ = 0;
  int asked_ = 0;  ///< runs since `pose_`
  bool one_way_ = false;
  math::Pose pose_;
};

}  // namespace odds::query
