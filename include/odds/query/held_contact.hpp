// A contact that follows its two bodies.
#pragma once

#include <algorithm>
#include <cstdint>

#include "odds/math/pose.hpp"
#include "odds/query/answer.hpp"

namespace odds::query {

/// Two points, one fixed in each body, and the direction in which they were pushed apart: as the bodies move on, place
/// and depth follow. To first order that is exact; the direction is that of A's frame. All in A's mesh frame, metres.
class HeldContact {
 public:
  HeldContact() = default;
  /// `pose`: of B's mesh frame in A's, at which the contact was found.
  HeldContact(const Contact& contact, const math::Pose& pose) noexcept
      : contact_(contact),
        // The normal points into A: A's own surface has come that far against it.
        on_a_(contact.position - 0.5 * contact.depth * contact.normal),
        on_b_(pose.inverse() * Vec3(contact.position + 0.5 * contact.depth * contact.normal)) {}

  /// How the two points lie now.
  struct Parted {
    double depth;  ///< metres, along the normal; negative: they have come apart
    double slip;   ///< metres, across it
  };
  [[nodiscard]] Parted parted(const math::Pose& pose) const noexcept {
    const Vec3 across = pose * on_b_ - on_a_;
    const double depth = contact_.normal.dot(across);
    return {depth, (across - depth * contact_.normal).norm()};
  }
  /// The contact at a new pose; depth 0 if it has come apart.
  [[nodiscard]] Contact at(const math::Pose& pose) const noexcept {
    Contact now = contact_;
    const Vec3 on_b = pose * on_b_;
    now.position = 0.5 * (on_a_ + on_b);
    now.depth = std::max(contact_.normal.dot(on_b - on_a_), 0.0);
    return now;
  }
  /// As it was found, metres.
  [[nodiscard]] double depth() const noexcept { return contact_.depth; }
  [[nodiscard]] const Vec3& normal() const noexcept { return contact_.normal; }
  [[nodiscard]] std::uint32_t triangle_a() const noexcept { return contact_.triangle_a; }
  /// Its point of A's surface, in A's mesh frame.
  [[nodiscard]] const Vec3& on_a() const noexcept { return on_a_; }
  /// Its point of B's surface, in B's mesh frame.
  [[nodiscard]] const Vec3& on_b() const noexcept { return on_b_; }

 private:
  Contact contact_;
  Vec3 on_a_ = Vec3::Zero();
  Vec3 on_b_ = Vec3::Zero();
};

}  // namespace odds::query
