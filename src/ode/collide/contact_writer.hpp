// Writes contacts into the caller's array by ODE's rules.
#pragma once

#include <ode/ode.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "odds/math/types.hpp"
#include "odds/query/answer.hpp"

namespace odds::ode {

/// ODE passes the number of places in the low 16 bits. CONTACTS_UNIMPORTANT, above them, allows any contacts, not
/// fewer: programs that rest bodies on what they get set it, too.
[[nodiscard]] inline int room_for(int flags, int max_contacts) noexcept {
  return std::min(flags & 0xffff, max_contacts);
}

/// Fills the array that starts at `contacts` with a stride of `skip` bytes.
class ContactWriter {
 public:
  ContactWriter(dGeomID g1, dGeomID g2, int limit, dContactGeom* contacts, int skip) noexcept
      : g1_(g1), g2_(g2), limit_(limit), bytes_(reinterpret_cast<char*>(contacts)), skip_(skip) {}

  [[nodiscard]] int count() const noexcept { return count_; }
  [[nodiscard]] bool full() const noexcept { return count_ >= limit_; }
  void clear() noexcept { count_ = 0; }

  /// World frame, unit normal into g1, depth >= 0 in metres. Refused: a full array, a contact that is not finite (so
  /// that a NaN never enters a simulation), and one without a direction, at which ODE's solver aborts.
  bool add(const Vec3& position, const Vec3& normal, double depth, std::uint32_t triangle_1,
           std::uint32_t triangle_2) noexcept {
    return depth >= 0.0 && add_signed(position, normal, depth, triangle_1, triangle_2);
  }
  /// The same of bodies that may not touch: a negative depth is a gap.
  bool add_signed(const Vec3& position, const Vec3& normal, double depth, std::uint32_t triangle_1,
                  std::uint32_t triangle_2) noexcept {
    const bool sound = position.allFinite() && normal.allFinite() && std::abs(depth) < dInfinity;
    if (full() || !sound || normal == Vec3::Zero()) return false;
    auto* contact = reinterpret_cast<dContactGeom*>(bytes_ + static_cast<std::ptrdiff_t>(count_) * skip_);
    for (int axis = 0; axis < 3; ++axis) {
      contact->pos[axis] = static_cast<dReal>(position[axis]);
      contact->normal[axis] = static_cast<dReal>(normal[axis]);
    }
    contact->pos[3] = 0;
    contact->normal[3] = 0;
    contact->depth = static_cast<dReal>(depth);
    contact->g1 = g1_;
    contact->g2 = g2_;
    contact->side1 = triangle_1 == query::no_feature ? -1 : static_cast<int>(triangle_1);
    contact->side2 = triangle_2 == query::no_feature ? -1 : static_cast<int>(triangle_2);
    ++count_;
    return true;
  }

  /// One that was written.
  [[nodiscard]] const dContactGeom& operator[](int i) const noexcept {
    return *reinterpret_cast<const dContactGeom*>(bytes_ + i * skip_);
  }

 private:
  dGeomID g1_;
  dGeomID g2_;
  int limit_;
  char* bytes_;
  std::ptrdiff_t skip_;
  int count_ = 0;
};

}  // namespace odds::ode
