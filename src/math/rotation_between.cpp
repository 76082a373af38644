#include "math/rotation_between.hpp"

namespace odds::math {

Quat rotation_between(const Vec3& from, const Vec3& to) noexcept { return Quat::FromTwoVectors(from, to); }

}  // namespace odds::math
