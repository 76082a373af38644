// Two bodies that came close: what the query said, and the points of contact before they become rows of the solver.
#pragma once

#include <cstdint>
#include <span>

#include "odds/math/types.hpp"
#include "odds/query/answer.hpp"

namespace odds::ode {

/// Index of a body in its world, in order of addition.
struct BodyId {
  std::uint32_t index = 0;
  friend bool operator==(BodyId, BodyId) = default;
};

/// What the solver is told about one point of contact. SI.
struct Surface {
  double stiffness_n_per_m = 0.0;  ///< of this point: its share of the pair's; > 0
  double damping_ns_per_m = 0.0;   ///< likewise; >= 0
  double friction = 0.0;           ///< Coulomb's mu; 0: no rows
  double rolling_m = 0.0;          ///< torque against rolling, per normal force: a lever arm; 0: no rows
  double spinning_m = 0.0;         ///< torque against spinning about the normal, per normal force; 0: no row
  /// Speed after an impact, per speed before; 0: none. A penalty bounces only where it does not push: its spring is
  /// told to the solver as a speed, of which a bounce would give a share too.
  double restitution = 0.0;
  double restitution_from_m_per_s = 0.0;  ///< slower impacts do not bounce
  bool pushes = true;                     ///< false: depth makes no force, only approach is stopped
  /// Step * stiffness + damping of this point before an effect has made it softer, N s/m; 0: none has. By this the
  /// greatest correcting velocity bounds its force, so that a soft point carries as much as a hard one, only deeper.
  double weight_of_law_ns_per_m = 0.0;
  Vec3 surface_velocity = Vec3::Zero();  ///< m/s, world: how a's surface is carried along over b's
};

/// One point of contact, world frame.
struct ContactPoint {
  Vec3 position_m = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ();  ///< unit, into a
  double depth_m = 0.0;         ///< >= 0
  Vec3 velocity_m_per_s =
      Vec3::Zero();  ///< of a against b at this point; may be zero unless the world was asked for it
  Surface surface;
};

/// A pair of bodies whose boxes meet, after its query.
struct Meeting {
  BodyId a;
  BodyId b;
  query::Verdict verdict = query::Verdict::clear;
  query::Basis basis = query::Basis::proved;
  double probability = 0.0;          ///< of a hit, [0, 1]
  double stiffness_n_per_m = 0.0;    ///< of the pair, by the world's law; its contacts share it
  double damping_ns_per_m = 0.0;     ///< likewise
  std::span<ContactPoint> contacts;  ///< may be changed; what is not finite afterwards is left out
  std::span<ContactPoint> room;      ///< begins with `contacts`, which may be made shorter, or longer up to its end
};

/// Called within World::step for each meeting, before its contacts become rows. Must not allocate, lock or throw.
struct MeetingHook {
  void (*call)(void* self, Meeting& meeting) noexcept = nullptr;  ///< null: nobody is called
  void* self = nullptr;
};

}  // namespace odds::ode
