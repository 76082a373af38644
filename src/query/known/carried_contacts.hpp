// The contacts of the last patch that was made with care, for bodies that have hardly moved since.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "odds/math/motion.hpp"
#include "odds/query/contact_patch.hpp"
#include "odds/query/held_contact.hpp"
#include "query/posed_meshes.hpp"

namespace odds::query {

/// Bodies at rest tremble by nanometres: their contacts are the same but for the depth, which follows the motion. What
/// bodies rest on may be a part of their contacts: they show that it is enough by not moving, and are asked anew when
/// they do. What is carried is still proved: a pair of triangles that met when it was made has to meet now. Nothing
/// else can have come in deeper than the motion. No allocation.
class CarriedContacts {
 public:
  /// Runs within the motion that contacts are carried over, after which bodies are said to rest: slow ones move on.
  static constexpr int runs_of_rest = 8;
  /// Pairs of triangles that are tried as proof.
  static constexpr std::size_t most_proofs = 8;

  void forget() noexcept {
    count_ = 0;
    rest_runs_ = 0;
  }

  /// Notes a run that made its contacts anew. Whether the bodies rest: no point of B within `size` of `place`, in A's
  /// mesh frame, has moved by more than `motion` in so many of them.
  [[nodiscard]] bool rests(const Vec3& place, const math::Pose& pose, double motion, double size) noexcept {
    if (rest_runs_ == 0 ||
        !(math::motion_bound_about(rest_pose_.inverse() * place, rest_pose_, pose, size) <= motion)) {
      rest_runs_ = 0;
      rest_pose_ = pose;
    }
    rest_runs_ = std::min(rest_runs_ + 1, runs_of_rest);
    return rest_runs_ == runs_of_rest;
  }

  /// `wanted`: number of contacts that were asked for; `hits`: pairs of triangles that meet at `pose`, of B's mesh
  /// frame in A's; `part_of`: how many of them the contacts were made from, 0: all.
  void keep(std::span<const Contact> contacts, int wanted, std::span<const TrianglePair> hits, const math::Pose& pose,
            std::uint32_t part_of = 0) noexcept {
    part_of_ = part_of;
    count_ = std::min(contacts.size(), held_.size());
    for (std::size_t i = 0; i < count_; ++i) held_[i] = HeldContact(contacts[i], pose);
    wanted_ = wanted;
    pose_ = pose;
    keep_proofs(hits);
  }
  /// Others than those of the contacts: any pair of triangles that meets proves a hit.
  void keep_proofs(std::span<const TrianglePair> hits) noexcept {
    proof_count_ = std::min(hits.size(), most_proofs);
    for (std::size_t i = 0; i < proof_count_; ++i) proofs_[i] = hits[i * hits.size() / proof_count_];
  }

  /// Whether what is kept is an answer to the same question now: as many contacts, no point within `size` of the first
  /// of them has moved farther than `motion` (metres), and one of them at least still overlaps.
  [[nodiscard]] bool serve(const math::Pose& pose, int wanted, double motion, double size) const noexcept {
    if (count_ == 0 || wanted != wanted_ || !(motion > 0.0)) return false;
    if (!(math::motion_bound_about(held_[0].on_b(), pose_, pose, size) <= motion)) return false;
    return std::any_of(held_.begin(), held_.begin() + static_cast<std::ptrdiff_t>(count_),
                       [&pose](const HeldContact& held) { return held.parted(pose).depth > 0.0; });
  }

  /// How many pairs of triangles the contacts were made from, if those were a part; else 0.
  [[nodiscard]] std::uint32_t part_of() const noexcept { return part_of_; }

  /// Pairs of triangles, the likeliest first, of which one that still meets proves the hit.
  [[nodiscard]] std::span<TrianglePair> proofs() noexcept { return std::span(proofs_).first(proof_count_); }

  /// Writes the contacts at this pose, in the order in which they were made. Returns their number.
  std::size_t write(const math::Pose& pose, std::span<Contact, most_contacts> contacts) const noexcept {
    for (std::size_t i = 0; i < count_; ++i) contacts[i] = held_[i].at(pose);
    return count_;
  }

 private:
  std::array<HeldContact, most_contacts> held_;
  std::array<TrianglePair, most_proofs> proofs_;
  std::size_t count_ = 0;
  std::size_t proof_count_ = 0;
  int wanted_ = 0;
  std::uint32_t part_of_ = 0;
  math::Pose pose_;
  math::Pose rest_pose_;
  int rest_runs_ = 0;
};

}  // namespace odds::query
