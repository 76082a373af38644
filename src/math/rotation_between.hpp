// The shortest rotation from one direction to another.
#pragma once

#include "odds/math/types.hpp"

namespace odds::math {

/// The rotation by the smallest angle that takes the direction of `from` to that of `to`; neither may be zero. Of
/// opposite directions, about some axis across them. Eigen's `FromTwoVectors`, which is compiled in this room alone:
/// the decomposition behind its rare case takes a compiler as long as the whole of an ordinary file.
[[nodiscard]] Quat rotation_between(const Vec3& from, const Vec3& to) noexcept;

}  // namespace odds::math
