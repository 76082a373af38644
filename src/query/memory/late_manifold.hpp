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
#include "query/known/given_depth.hpp"
#include "query/ray/budgeted_ray.hpp"

namespace odds::query {

/// How late contacts are, runs.
struct Lateness {
  static constexpr int long_ago = 1 << 20;
  int asked = 0;        ///< since the pose that they are about
  int last = long_ago;  ///< since the one before it whose contacts were kept: so long a depth may have come unknown
  bool turns = false;   ///< the bodies turned against each other when they were asked for
};

/// Whether there are contacts, and all push in much the same direction: a tool on the ground, but not a bolt in its
/// nut, which another turn of its thread would push elsewhere.
[[nodiscard]] inline bool push_one_way(std::span<const Contact> contacts) noexcept {
  return !contacts.empty() && std::all_of(contacts.begin(), contacts.end(), [&contacts](const Contact& contact) {
    return contact.normal.dot(contacts.front().normal) > tolerances::hasty_agreement;
  });
}

/// Whether late contacts about `from` are of use at `to`, poses of B's mesh frame in A's: a point of B where the bodies
/// touched, in its frame, has not gone far, and the bodies have hardly turned against each other. Those that turn touch
/// elsewhere soon: a bolt in its nut on one turn of its thread, then on another one.
[[nodiscard]] inline bool are_carried(const Vec3& place_on_b, const math::Pose& from, const math::Pose& to,
                                      double size) noexcept {
  return math::turn_between(from, to) <= tolerances::late_turn &&
         (to * place_on_b - from * place_on_b).norm() <= tolerances::slid_motion * size;
}

/// Bodies that rest on each other rock by nanometres, and touch on one edge now, on another one then. A patch that is
/// late by ten runs knows one of them; so those of the patches before it stay where they have come apart by little, and
/// push again as soon as they touch. What came deep while nobody knew is pushed out gently (GivenDepth). Each follows
/// the bodies' motion; one that slides along is measured anew now and then, or is none. In A's mesh frame; `size`: of
/// the smaller body, metres. No allocation.
class LateManifold {
 public:
  void forget() noexcept { count_ = 0; }

  /// All contacts that there are at `pose`, of B's mesh frame in A's, deepest first, and how many pairs of triangles
  /// they were made from. `pose_now`: that of this run. Of bodies that slide, of what came in some runs a share of one
  /// run is given at once.
  void keep(std::span<const Contact> contacts, const math::Pose& pose, const math::Pose& pose_now, double size,
            std::uint32_t made_from, const Lateness& lateness = {}) noexcept {
    const bool slides = !lateness.turns && push_one_way(contacts);
    std::size_t kept = std::min<std::size_t>(contacts.size(), most_contacts);
    std::array<Entry, most> now;
    for (std::size_t i = 0; i < kept; ++i) {
      now[i].held = HeldContact(contacts[i], pose);
      now[i].measured = lateness.asked;
      const double depth = now[i].held.parted(pose_now).depth;
      const double share = slides ? depth / std::max(lateness.last, 1) : 0.0;
      double given = std::max(tolerances::late_least * size, share);
      for (std::size_t k = 0; k < count_; ++k) {
        const bool is_successor = held_[k].depth.holds() && is_same(held_[k].held, now[i].held, size);
        if (is_successor) given = std::max(given, held_[k].depth.given());
      }
      now[i].depth.begin(depth, std::min(contacts[i].depth, given));
    }
    for (std::size_t i = 0; i < count_ && kept < most; ++i) {
      const bool is_newer = held_[i].measured < lateness.asked;
      const auto [depth, slip] = held_[i].held.parted(is_newer ? pose_now : pose);
      // What overlaps would be among the contacts if it did; what is one of them has its successor.
      if (depth > 0.0 && !is_newer) continue;
      if (depth < -tolerances::late_gap * size || slip > tolerances::late_slip * size) continue;
      const bool is_known = std::any_of(now.begin(), now.begin() + static_cast<std::ptrdiff_t>(kept),
                                        [&](const Entry& other) { return is_same(other.held, held_[i].held, size); });
      if (!is_known) now[kept++] = held_[i];
    }
    held_ = now;
    count_ = kept;
    pose_ = pose;
    made_from_ = made_from;
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
    for (Entry& entry : std::span(held_).first(count_)) {
      entry.measured = std::min(entry.measured + 1, Lateness::long_ago);
      entry.depth.age(entry.held.parted(pose).depth, tolerances::late_least * size, tolerances::late_rise * size);
    }
  }

  /// Those that have slid, and overlap or are within `margin` of it, metres, the deepest first: `measure(held)` looks
  /// how deep they are now, and changes `held` (Seen::surface), says that it is no contact any more (Seen::none), or
  /// has no time for any more of them (Seen::unknown).
  template <class Measure>
  void measure_slid(const math::Pose& pose, double size, double margin, Measure measure) noexcept {
    for (std::size_t i = deepest_slid(pose, size, margin); i < count_; i = deepest_slid(pose, size, margin)) {
      Entry& entry = held_[i];
      const auto [depth, slip] = entry.held.parted(pose);
      const Seen seen = slip <= tolerances::slid_slip * size ? measure(entry.held) : Seen::none;
      if (seen == Seen::unknown) return;
      // One that was not put where the bodies are now would be asked about for ever.
      if (seen == Seen::surface && entry.held.parted(pose).slip < tolerances::slid_measured * size) {
        entry.depth.correct(entry.held.depth(), entry.held.depth() - depth, entry.measured);
        entry.measured = 0;
      } else {
        entry = held_[--count_];
      }
    }
  }

  /// Whether the bodies have moved no farther than they are carried, and one of them at least overlaps, or has come
  /// apart by less than `margin`, metres.
  [[nodiscard]] bool serves(const math::Pose& pose, double size, double margin = 0.0) const noexcept {
    if (count_ == 0 || !are_carried(held_[0].held.on_b(), pose_, pose, size)) return false;
    const double most_slip = tolerances::late_slip * size;
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
    const double most_slip = tolerances::late_slip * size;
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
    int measured = 0;  ///< runs since the pose that it was found at
  };
  /// The end if there is none.
  [[nodiscard]] std::size_t deepest_slid(const math::Pose& pose, double size, double margin) const noexcept {
    std::size_t found = count_;
    double deepest = -std::max(margin, tolerances::unmeasured_depth * size);
    for (std::size_t i = 0; i < count_; ++i) {
      const auto [depth, slip] = held_[i].held.parted(pose);
      if (!(depth > deepest) || slip < tolerances::slid_measured * size) continue;
      found = i;
      deepest = depth;
    }
    return found;
  }
  [[nodiscard]] static bool is_same(const HeldContact& x, const HeldContact& y, double size) noexcept {
    return (x.on_a() - y.on_a()).norm() <= tolerances::late_spacing * size &&
           x.normal().dot(y.normal()) > tolerances::hasty_agreement;
  }

  std::array<Entry, most> held_;
  std::size_t count_ = 0;
  std::uint32_t made_from_ = 0;
  math::Pose pose_;
};

}  // namespace odds::query
