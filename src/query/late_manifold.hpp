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

namespace odds::query {

/// Bodies that rest on each other rock by nanometres, and touch on one edge now, on another one then. A patch that is
/// late by ten runs knows one of them; so those of the patches before it stay where they have come apart by little, and
/// push again as soon as they touch. Each follows the bodies' motion. In A's mesh frame; `size`: of the smaller body,
/// metres. No allocation.
class LateManifold {
 public:
  void forget() noexcept { count_ = 0; }

  /// All contacts that there are at `pose`, of B's mesh frame in A's, deepest first, and how many pairs of triangles
  /// they were made from.
  void keep(std::span<const Contact> contacts, const math::Pose& pose, double size, std::uint32_t made_from) noexcept {
    std::size_t kept = std::min<std::size_t>(contacts.size(), most_contacts);
    std::array<HeldContact, most> now;
    for (std::size_t i = 0; i < kept; ++i) now[i] = HeldContact(contacts[i], pose);
    for (std::size_t i = 0; i < count_ && kept < most; ++i) {
      const auto [depth, slip] = held_[i].parted(pose);
      // What overlaps would be among the contacts if it did; what is one of them has its successor.
      if (depth > 0.0 || depth < -tolerances::late_gap * size || slip > tolerances::late_slip * size) continue;
      const Vec3 place = held_[i].on_a();
      const bool is_known =
          std::any_of(now.begin(), now.begin() + static_cast<std::ptrdiff_t>(kept), [&](const HeldContact& other) {
            return (other.on_a() - place).norm() <= tolerances::late_spacing * size;
          });
      if (!is_known) now[kept++] = held_[i];
    }
    held_ = now;
    count_ = kept;
    pose_ = pose;
    made_from_ = made_from;
  }

  /// Whether no point within `size` of the first contact has moved farther than they are carried, and one of them at
  /// least overlaps.
  [[nodiscard]] bool serves(const math::Pose& pose, double size) const noexcept {
    if (count_ == 0) return false;
    if (!(math::motion_bound_about(held_[0].on_b(), pose_, pose, size) <= tolerances::late_motion * size)) return false;
    return std::any_of(held_.begin(), held_.begin() + static_cast<std::ptrdiff_t>(count_),
                       [&pose](const HeldContact& held) { return held.parted(pose).depth > 0.0; });
  }

  /// Writes those that overlap at `pose`, as many as there is room for, the latest first. Returns how many.
  [[nodiscard]] std::size_t write(const math::Pose& pose, std::span<Contact> contacts) const noexcept {
    std::size_t written = 0;
    for (std::size_t i = 0; i < count_ && written < contacts.size(); ++i) {
      const Contact now = held_[i].at(pose);
      if (now.depth > 0.0) contacts[written++] = now;
    }
    return written;
  }
  [[nodiscard]] std::uint32_t made_from() const noexcept { return made_from_; }

 private:
  static constexpr std::size_t most = 2 * most_contacts;

  std::array<HeldContact, most> held_;
  std::size_t count_ = 0;
  std::uint32_t made_from_ = 0;
  math::Pose pose_;
};

}  // namespace odds::query
