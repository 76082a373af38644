// Corners that were seen to lie in the other body, as contacts that follow the two.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "odds/math/tolerances.hpp"
#include "odds/query/held_contact.hpp"
#include "query/known/given_depth.hpp"

namespace odds::query {

/// A corner of one body of a pair, by CornerSearch's number.
struct SoughtCorner {
  std::uint32_t corner;
  bool of_b;
};

/// Contacts that are guessed where two triangles cross have no depth there, and lie on one side of where the bodies
/// meet: a body turns about them and sinks in. The corner that is deepest in the other body, measured there, holds it
/// from within. What came deep while nobody knew is pushed out gently (GivenDepth), and by no more than a guess may.
/// In A's mesh frame, metres; `size`: of the smaller body. No allocation.
class CornerContacts {
 public:
  static constexpr std::size_t most = 4;
  /// Runs from a look that has found a corner within the other body, or none, to the next one.
  static constexpr int after_a_find = 3;
  static constexpr int after_none = 8;

  void forget() noexcept { *this = {}; }
  /// A run begins, at `pose` of B's mesh frame in A's: what has gone elsewhere is forgotten.
  void age(const math::Pose& pose, double size) noexcept {
    looked_ = false;
    wait_ = std::max(wait_ - 1, 0);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      Entry& entry = held_[i];
      const auto [depth, slip] = entry.held.parted(pose);
      if (++entry.runs > oldest || depth < -tolerances::late_gap * size || slip > tolerances::late_slip * size)
        continue;
      entry.depth.age(depth, tolerances::late_least * size, tolerances::late_rise * size);
      held_[kept++] = entry;
    }
    count_ = kept;
  }

  /// Whether it is time to look for one.
  [[nodiscard]] bool is_due() const noexcept { return wait_ == 0; }
  /// Unit, into A: in which contacts pushed last, all of them; zero: they did not.
  [[nodiscard]] const Vec3& normal() const noexcept { return normal_; }
  void note_normal(const Vec3& normal) noexcept { normal_ = normal; }
  /// It is to be another one in A's frame.
  void turn(const Mat3& turned) noexcept { normal_ = turned * normal_; }
  /// A look may take two runs: a corner that a search has found, and nobody has measured yet.
  [[nodiscard]] const std::optional<SoughtCorner>& sought() const noexcept { return sought_; }
  void note_sought(const SoughtCorner& sought) noexcept { sought_ = sought; }
  /// Of bodies that are much alike in size, whose corner is asked for: by turns.
  [[nodiscard]] bool turns_to_b() noexcept { return to_b_ = !to_b_; }
  /// This run has looked for one.
  [[nodiscard]] bool has_looked() const noexcept { return looked_; }
  void note_look() noexcept { looked_ = true; }
  /// It has ended without one that is within the other body.
  void note_none() noexcept {
    sought_.reset();
    wait_ = after_none;
  }
  /// It has measured one, now: that takes the place of the same one's, or of the one that was measured first.
  void add(const Contact& contact, const math::Pose& pose, double size) noexcept {
    sought_.reset();
    wait_ = after_a_find;
    Entry now;
    now.held = HeldContact(contact, pose);
    double given = tolerances::late_least * size;
    std::size_t at = count_;
    for (std::size_t i = 0; i < count_ && at == count_; ++i) {
      if ((held_[i].held.on_b() - now.held.on_b()).norm() <= tolerances::late_spacing * size) at = i;
    }
    if (at < count_) {
      given = std::max(given, held_[at].depth.given());
    } else if (at == most) {
      const auto older = [](const Entry& x, const Entry& y) { return x.runs < y.runs; };
      at = static_cast<std::size_t>(std::max_element(held_.begin(), held_.end(), older) - held_.begin());
    }
    now.depth.begin(contact.depth, std::min(contact.depth, given));
    held_[at] = now;
    count_ = std::max(count_, at + 1);
  }

  [[nodiscard]] bool empty() const noexcept { return count_ == 0; }
  /// Puts those that overlap, and push as normal() does, before the `made` first of `contacts`; of these, those nearer
  /// than `near` to one of them go, and the last ones if there is no room. Returns how many there are then.
  [[nodiscard]] std::size_t put_before(std::span<Contact> contacts, std::size_t made, const math::Pose& pose,
                                       double size, double near) noexcept {
    for (Entry& entry : std::span(held_).first(count_)) {
      Contact now = entry.held.at(pose);
      if (!(now.depth > 0.0) || !(now.normal.dot(normal_) > tolerances::hasty_agreement) || contacts.empty()) continue;
      entry.depth.hold();
      now.depth = std::min(entry.depth.of(now.depth), tolerances::hasty_deepest * size);
      const auto begin = contacts.begin();
      const auto end = std::remove_if(begin, begin + static_cast<std::ptrdiff_t>(made), [&](const Contact& other) {
        return (other.position - now.position).norm() <= near;
      });
      made = std::min(static_cast<std::size_t>(end - begin) + 1, contacts.size());
      std::move_backward(begin, begin + static_cast<std::ptrdiff_t>(made - 1),
                         begin + static_cast<std::ptrdiff_t>(made));
      contacts.front() = now;
    }
    return made;
  }

 private:
  static constexpr int oldest = 16;  ///< runs: others have been measured since

  struct Entry {
    HeldContact held;
    GivenDepth depth;
    int runs = 0;  ///< since it was measured
  };

  std::array<Entry, most> held_;
  std::size_t count_ = 0;
  int wait_ = 0;  ///< runs
  bool looked_ = false;
  bool to_b_ = false;
  Vec3 normal_ = Vec3::Zero();
  std::optional<SoughtCorner> sought_;
};

}  // namespace odds::query
