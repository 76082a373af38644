// The direction in which earlier runs of a pair pushed the bodies apart, for contacts that there is no time to judge.
#pragma once

#include <algorithm>

#include "odds/math/motion.hpp"
#include "odds/math/pose.hpp"
#include "odds/math/tolerances.hpp"

namespace odds::query {

/// Bodies that have hardly moved part in the same direction as before: a rim of which a few pieces are known, or a pair
/// of triangles, may point anywhere. A patch that was made of a part of the rim has one vote, for it errs now and then;
/// one of all of it decides.
class KnownDirection {
 public:
  /// Of the smaller body's size: what counts as hardly moved.
  static constexpr double near = 1e-3;
  static constexpr int enough = 3;  ///< votes more than others have had
  static constexpr int most = 8;    ///< that are remembered

  void forget() noexcept { votes_ = 0; }
  /// `normal` unit and into A, of a contact at `place` in A's mesh frame; `pose` of B's mesh frame in A's; `size` of
  /// the smaller body; `all`: whether the patch was made of all of the rim.
  void note(const Vec3& place, const Vec3& normal, const math::Pose& pose, double size, bool all) noexcept {
    if (!is_near(pose, size)) votes_ = 0;
    const bool agrees = votes_ > 0 && normal.dot(normal_) > tolerances::same_face;
    if (!agrees && !all && votes_ > 0) {
      --votes_;
      return;
    }
    votes_ = all ? most : std::min(agrees ? votes_ + 1 : 1, most);
    normal_ = normal;
    on_b_ = pose.inverse() * place;
    pose_ = pose;
  }
  /// Null if nothing is known, or if a point within `size` (metres) of the contact has moved farther than `near` of it.
  [[nodiscard]] const Vec3* at(const math::Pose& pose, double size) const noexcept {
    return votes_ >= enough && is_near(pose, size) ? &normal_ : nullptr;
  }
  /// Where the contact of that direction is now, in A's mesh frame.
  [[nodiscard]] Vec3 place(const math::Pose& pose) const noexcept { return pose * on_b_; }

 private:
  [[nodiscard]] bool is_near(const math::Pose& pose, double size) const noexcept {
    return math::motion_bound_about(on_b_, pose_, pose, size) <= near * size;
  }

  Vec3 normal_ = Vec3::UnitZ();
  Vec3 on_b_ = Vec3::Zero();
  math::Pose pose_;
  int votes_ = 0;
};

}  // namespace odds::query
