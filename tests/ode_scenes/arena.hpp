// A world of ODE in which the same bodies collide by one of several colliders, with everything measured.
#pragma once

#include <ode/ode.h>

#include <algorithm>
#include <cstdint>
#include <deque>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "odds/math/pose.hpp"
#include "odds/mesh/triangle_mesh.hpp"
#include "odds/ode/odds_frame.h"
#include "odds/ode/odds_friction.h"
#include "odds/ode/odds_ode.h"
#include "odds/realtime/clock.hpp"
#include "ode_scenes/truth.hpp"

namespace odds::ode_scenes {

using Mesh = std::shared_ptr<const mesh::TriangleMesh>;

/// Who makes the contacts.
struct Collider {
  enum class Kind {
    odds,       ///< a takeover of dTriMesh with a budget
    stock,      ///< ODE's own dTriMesh
    primitive,  ///< ODE's own primitives in place of the moving meshes, where the scene has them
    gimpact     ///< Bullet's GImpact between meshes
  };
  Kind kind = Kind::odds;
  double budget_us = 100.0;  ///< of odds
  bool in_work = false;      ///< as work units in place of microseconds: the same bits on every run, on any machine
  long look_ns = 0;       ///< so much time passes at each look at the clock, and else none: repeats, too; 0: true time
  double margin_m = 0.0;  ///< of odds: surfaces that part by less keep their contacts
  double frame_us = 0.0;  ///< of odds: limit of all collisions of a step together; 0: none
  double anchored_m = 0.0;  ///< friction holds places, and gives by so much; 0: speeds, as ODE's does

  [[nodiscard]] bool ours() const noexcept { return kind == Kind::odds; }
  [[nodiscard]] std::string name() const;
  [[nodiscard]] unsigned long work_units() const;  ///< 20 for a microsecond; budget_us must be finite
};

/// How contacts and solver are set.
struct Physics {
  const char* name;
  int iterations;
  double soft_erp;  ///< of contacts; 0: the world's
  double max_correcting_velocity;
  double friction;
  int most_contacts;  ///< asked of dCollide for each pair
};

/// The world file of gazebo-classic issue 3335: 100 iterations, soft ERP 1/11, correction at most 1 cm/s, mu 10.
inline constexpr Physics issue_3335{"gazebo-classic #3335", 100, 1.0 / 11.0, 0.01, 10.0, 16};
/// What a program of ODE has that sets nothing but friction: ERP 0.2, correction without bound; 50 iterations.
inline constexpr Physics ode_defaults{"ODE's defaults", 50, 0.0, std::numeric_limits<double>::infinity(), 1.0, 64};

/// What the contacts of a run were like.
struct ContactCounts {
  std::uint64_t collisions = 0;  ///< calls of dCollide that gave contacts
  std::uint64_t contacts = 0;
  std::uint64_t sideways = 0;  ///< |n.z| < 0.99, in scenes whose true normals are vertical
  int most = 0;                ///< of one collision
  double deepest_m = 0.0;

  [[nodiscard]] double sideways_percent() const noexcept {
    return 100.0 * static_cast<double>(sideways) / std::max(1.0, static_cast<double>(contacts));
  }
  /// Of a collision.
  [[nodiscard]] double mean() const noexcept {
    return static_cast<double>(contacts) / std::max(1.0, static_cast<double>(collisions));
  }
};

class Bullet;  // meshes of Bullet beside ODE's; only where Bullet is installed

/// One thread at a time, and one arena at a time: a takeover is the process's.
class Arena {
 public:
  Arena(const Collider& collider, const Physics& physics, double gravity = -9.81);
  ~Arena();
  Arena(const Arena&) = delete;
  Arena& operator=(const Arena&) = delete;

  /// A mesh that stands still, or, with a density, moves. Its frame must be that of its centre of mass if it moves.
  dGeomID add(const Mesh& mesh, const math::Pose& pose, double density = 0.0);
  /// A geom of ODE's own with the mass given.
  dGeomID add(dGeomID primitive, const dMass& mass, const Vec3& position);
  /// Takes the memory of all pairs; after the last add.
  void prepare();

  void step();

  [[nodiscard]] dWorldID world() const noexcept { return world_; }
  [[nodiscard]] dSpaceID space() const noexcept { return space_; }
  [[nodiscard]] const Collider& collider() const noexcept { return collider_; }
  /// Kinetic and potential, joule, of all moving bodies.
  [[nodiscard]] double energy() const;
  [[nodiscard]] double kinetic_energy() const;
  [[nodiscard]] double time_s() const noexcept { return 0.001 * static_cast<double>(steps_); }

  ContactCounts counts;
  /// Joule: what the impulses of all contacts have added to the bodies' energy since the start, at most. Contacts that
  /// push apart what was pushed together give back what they took: on balance they add none.
  [[nodiscard]] double most_work_of_contacts() const noexcept { return most_work_j_; }
  /// The same, at the end.
  [[nodiscard]] double work_of_contacts() const noexcept { return work_j_; }
  /// Metres: how deep meshes really lay in each other, at most, looked at in every tenth step.
  [[nodiscard]] double truly_deepest_m() const noexcept { return truly_deepest_m_; }
  /// The mean of all pairs that overlapped when it was looked.
  [[nodiscard]] double mean_true_depth_m() const noexcept {
    return overlaps_ > 0 ? sum_of_depths_m_ / static_cast<double>(overlaps_) : 0.0;
  }

  std::vector<double> collide_us;  ///< thread time of each dCollide between two meshes that gave contacts
  std::vector<double> frame_us;    ///< thread time of each step: spaces, contacts, solver
  double damping_per_s = 0.0;      ///< of all bodies' velocities

  struct Item {
    dGeomID geom = nullptr;
    Mesh mesh;  ///< null: a primitive
  };
  [[nodiscard]] const std::vector<Item>& items() const noexcept { return items_; }

 private:
  struct Data;
  static void near(void* self, dGeomID a, dGeomID b);
  int collide(dGeomID a, dGeomID b, dContact* contacts) const;
  struct Motion;
  /// Of all bodies, in the order of their geoms.
  void note_velocities(std::vector<Motion>& motions) const;
  /// By the contacts of this step, whose joints are still there.
  void add_work_of_contacts();
  void look_at_depths();
  Data& data_of(const Mesh& mesh);

  Collider collider_;
  Physics physics_;
  double gravity_;
  realtime::ManualClock clock_;  ///< of collisions that are counted
  dWorldID world_;
  dSpaceID space_;
  dJointGroupID joints_;
  std::vector<std::unique_ptr<Data>> data_;
  std::vector<Item> items_;
  std::unique_ptr<Bullet> bullet_;
  std::unique_ptr<oddsFrameBudget, decltype(&oddsFrameBudgetDestroy)> frame_{nullptr, &oddsFrameBudgetDestroy};
  std::unique_ptr<oddsFrictionAnchors, decltype(&oddsFrictionAnchorsDestroy)> anchors_{nullptr,
                                                                                       &oddsFrictionAnchorsDestroy};
  struct Motion {
    dBodyID body;
    Vec3 velocity;
    Vec3 spin;
  };
  struct Joint {
    dBodyID first;   ///< that of the feedback's f1; never null
    dBodyID second;  ///< null: the world
    dJointFeedback forces;
  };
  std::vector<Motion> before_, after_;
  std::deque<Joint> of_contacts_;  ///< ODE keeps pointers to them
  double work_j_ = 0.0;
  double most_work_j_ = 0.0;
  Truth truth_;
  double truly_deepest_m_ = 0.0;
  double sum_of_depths_m_ = 0.0;
  std::uint64_t overlaps_ = 0;
  std::uint64_t steps_ = 0;
};

/// Microseconds of this thread.
[[nodiscard]] double thread_us();

[[nodiscard]] math::Pose pose_of(dGeomID geom);
[[nodiscard]] Vec3 position_of(dBodyID body);
[[nodiscard]] Vec3 velocity_of(dBodyID body);
[[nodiscard]] Vec3 spin_of(dBodyID body);

/// A made mesh by name, moved so that its centre of mass is its origin. Ends the program if there is none.
[[nodiscard]] Mesh made(const std::string& text, bool centred = true);

}  // namespace odds::ode_scenes
