// A physics world of meshes, built on ODE and the budgeted geom, without ODE's header: what the haptic loop steps.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "odds/math/error.hpp"
#include "odds/math/pose.hpp"
#include "odds/math/tolerances.hpp"
#include "odds/ode/meeting.hpp"
#include "odds/query/answer.hpp"
#include "odds/query/request.hpp"
#include "odds/query/shape.hpp"
#include "odds/realtime/clock.hpp"

namespace odds::ode {

/// By which law two bodies in contact push each other apart. Friction is the solver's, bounded by that force, in all.
enum class ContactLaw : std::uint8_t {
  compliant,   ///< a spring and damper solved implicitly with everything else: stable for every stiffness and damping
  penalty,     ///< the same spring as a force of the step's beginning, what haptic renderers do, with a damper that is
               ///< solved; stable while stiffness times the step's square stays below the mass that it moves
  constraint,  ///< no overlap is allowed: what there is, is reduced by a share in each step, at any load
};

/// What two bodies in contact do to each other.
struct ContactModel {
  bool enabled = true;   ///< false: nothing is collided at all
  bool responds = true;  ///< false: pairs are queried and meet (MeetingHook), but nothing pushes them apart
  ContactLaw law = ContactLaw::compliant;
  /// Of a whole pair: its contacts share it, so that their number is not felt; > 0. A constraint takes no notice of
  /// stiffness and damping: it makes its own of each pair (Meeting::stiffness_n_per_m), by which the pair yields by a
  /// millionth of what its mass would, at `error_reduction`.
  double stiffness_n_per_m = 20000.0;
  double damping_ns_per_m = 20.0;  ///< likewise; >= 0
  double error_reduction = 0.2;    ///< of a constraint: share of the overlap that a step takes away, (0, 1]
  double friction = 0.0;           ///< Coulomb's mu; 0: no friction rows at all
  /// How fast overlap may be pushed apart, > 0. But for a constraint it bounds the force of deep contacts, of a pair at
  /// rest to (step * stiffness + damping) times it: 40 N by the defaults, through which more than 4 kg sink.
  double max_correcting_velocity_m_per_s = 1.0;
};

/// How fast bodies lose speed, as rates of exponential decay, >= 0, finite. 0: not at all.
struct Damping {
  double linear_per_s = 0.0;
  double angular_per_s = 0.0;
};

enum class Solver : std::uint8_t {
  exact,      ///< dWorldStep: repeatable; cost grows with the cube of the number of contacts
  iterative,  ///< dWorldQuickStep: cost grows linearly; draws on ODE's process-wide random numbers
};

struct WorldOptions {
  [[nodiscard]] static query::Request with_contacts(int count) {
    query::Request request;
    request.method = query::Method::incremental;
    request.max_contacts = count;
    request.carry_motion = tolerances::resting_motion;
    return request;
  }

  double step_s = 0.001;  ///< > 0
  Vec3 gravity_m_per_s2 = Vec3::Zero();
  ContactModel contact;
  Damping damping;
  Solver solver = Solver::exact;
  int iterations = 20;  ///< of the iterative solver
  /// Method, estimator, budget (of each pair), p_min, k_min, max_contacts (of each pair, 0 .. 8) and carry_motion.
  query::Request query = with_contacts(8);
  /// All collisions of a step together, shared by importance (odds_frame.h); what is near to the coupled body matters
  /// most. Infinity and the greatest number: no limit.
  double frame_us = std::numeric_limits<double>::infinity();
  std::uint64_t frame_work_units = std::numeric_limits<std::uint64_t>::max();
  /// Calls of step() that make one step, 1 .. 64, for a loop whose ticks are shorter than that takes. More than one:
  /// all but the last collide, each within a frame's limits, pairs that had no turn yet; the last solves. Needs a
  /// frame.
  std::uint32_t parts = 1;
  std::uint32_t max_contacts_per_step = 64;  ///< of the whole world, 1 .. 1024; further ones are left out and counted
  double max_speed_m_per_s = 20.0;    ///< bodies are held to it, and to its way in a step: no tool flies away; > 0
  double max_spin_rad_per_s = 200.0;  ///< > 0
  bool contact_velocity = false;      ///< whether ContactPoint::velocity_m_per_s is wanted; friction computes it anyway
  bool angular_friction = false;      ///< whether to take memory for rows of rolling and spinning friction
  bool contact_work = false;          ///< whether StepSummary::contact_work_j and World::contact_impulse are wanted
  /// Of StepSummary::collision_us and step_us; null: realtime::fastest_clock(). Queries and frames, their budgets and
  /// times, always go by that one.
  realtime::Clock clock = {};
};

/// How a dynamic body gets its mass. The inertia follows from the mesh if that is closed, else from its bounding box.
struct MassSpec {
  double mass_kg = 0.0;               ///< 1e-9 to 1e12, or 0: from the density
  double density_kg_per_m3 = 1000.0;  ///< used if mass_kg is 0; needs a closed mesh
};

/// What add_dynamic made of a MassSpec.
struct MassProperties {
  double mass_kg = 0.0;
  Vec3 center_m = Vec3::Zero();           ///< of mass, in the mesh's frame
  Mat3 inertia_kg_m2 = Mat3::Identity();  ///< about the centre, axes of the mesh's frame
  bool from_closed_mesh = false;          ///< false: that of the bounding box
};

/// Pose of a body's mesh frame in the world, and motion of its centre of mass.
struct BodyState {
  math::Pose pose;
  Vec3 velocity_m_per_s = Vec3::Zero();
  Vec3 angular_velocity_rad_per_s = Vec3::Zero();
};

/// Force at the centre of mass, and torque; world frame.
struct Wrench {
  Vec3 force_n = Vec3::Zero();
  Vec3 torque_nm = Vec3::Zero();
};

/// A fluid about a body.
struct Drag {
  double force_ns_per_m = 0.0;      ///< against the speed relative to the flow; >= 0
  double torque_nms_per_rad = 0.0;  ///< against the spin; >= 0
  Vec3 flow_m_per_s = Vec3::Zero();
};

/// A spring and damper in six degrees of freedom between a body and a moving target. Solved together with the contacts
/// and implicitly in time, so that it is stable for every stiffness, damping and mass.
struct Coupling {
  math::Pose target;                            ///< where the mesh's frame should be
  Vec3 target_velocity_m_per_s = Vec3::Zero();  ///< of the target's origin
  Vec3 target_angular_velocity_rad_per_s = Vec3::Zero();
  double stiffness_n_per_m = 0.0;
  double damping_ns_per_m = 0.0;
  double angular_stiffness_nm_per_rad = 0.0;
  double angular_damping_nms_per_rad = 0.0;
  /// The spring pulls with no more, to within its way in a step, and with so much however stiff it is.
  double max_spring_force_n = std::numeric_limits<double>::infinity();
  double max_spring_torque_nm = std::numeric_limits<double>::infinity();
};

/// What one step did, or, of a step in parts, one call. Times in microseconds.
struct StepSummary {
  std::uint32_t queries = 0;                       ///< pairs of meshes that reached the budgeted query
  query::Verdict verdict = query::Verdict::clear;  ///< hit if any query said so
  query::Basis basis = query::Basis::proved;       ///< the weakest among the queries
  double probability = 0.0;                        ///< of a hit; the largest among the queries
  std::uint64_t node_pairs = 0;
  std::uint64_t triangle_pairs = 0;
  double query_gross_us = 0.0;
  double query_stall_us = 0.0;
  double query_overshoot_us = 0.0;      ///< largest of the queries
  double query_net_overshoot_us = 0.0;  ///< likewise
  std::uint32_t meetings = 0;           ///< pairs of bodies whose boxes met
  std::uint32_t contacts = 0;           ///< used
  std::uint32_t friction_rows = 0;      ///< of the solver, against sliding
  std::uint32_t angular_rows = 0;       ///< of the solver, against rolling and spinning
  std::uint32_t solver_calls = 0;       ///< of ODE's step: 1, or 0 where nothing can move
  std::uint32_t bodies_stepped = 0;     ///< dynamic ones; fixed bodies are never stepped
  /// What contacts did to the bodies' kinetic energy, joule; below zero they took it away. Measured from momenta, so
  /// that the damping of bodies counts too. 0 unless asked for.
  double contact_work_j = 0.0;
  std::uint32_t pairs_left_out = 0;     ///< for which the frame had no time left
  double frame_overshoot_us = 0.0;      ///< of the frame beyond its time, >= 0
  std::uint32_t contacts_left_out = 0;  ///< beyond max_contacts_per_step, or not finite
  /// With which ODE's solver complained, e.g. "LCP internal error": it gave up on a part of the contacts. They are
  /// written nowhere; what ODE says at other times goes to the program's own message handler, as before.
  std::uint32_t solver_messages = 0;
  double max_depth_m = 0.0;
  double collision_us = 0.0;        ///< broad phase, queries and contact joints; by the world's clock
  double step_us = 0.0;             ///< of the solver, by the world's clock; 0 where nothing can move
  std::uint32_t bodies_slowed = 0;  ///< held to the greatest speed
  std::uint32_t bodies_recovered =
      0;  ///< their state was not finite any more; put back to where they were last, at rest

  /// Several steps as one: what is a sum adds up; contacts, depth and overshoot keep the largest.
  void add(const StepSummary& next) noexcept;
};

/// Bodies, contacts and time. Set-up functions allocate and may fail; after prepare() nothing does. One thread at a
/// time; other worlds may step in other threads meanwhile.
class World {
 public:
  /// An empty world; holds ODE initialised while it lives. Refuses options out of the ranges that they state, with an
  /// error that says what to do; settings of `query` other than max_contacts are looked at when a body is added. For
  /// set-up, in any thread. May throw std::bad_alloc.
  static Result<World> make(const WorldOptions& options);
  ~World();
  World(World&&) noexcept;
  World& operator=(World&&) noexcept;

  /// A body that never moves. `name` stands in error messages. It may reach 10,000 km from the origin, no farther.
  Result<BodyId> add_fixed(std::shared_ptr<const query::Shape> shape, const math::Pose& pose, const std::string& name);
  /// A body that moves.
  Result<BodyId> add_dynamic(std::shared_ptr<const query::Shape> shape, const math::Pose& pose, const MassSpec& mass,
                             const std::string& name);
  /// Gives a dynamic body a coupling, which pulls from the next set_coupling on.
  void add_coupling(BodyId body);

  /// Takes all memory that steps need: workspaces of all pairs that can meet, and the solver's for the most contacts.
  /// Call it when all bodies are there. Later additions need another call.
  [[nodiscard]] std::optional<Error> prepare();

  /// Collides all bodies once where they are, without a budget and without consequence: what begins in another body or
  /// on it, and how deeply, is then known before a budget leaves time for a part of it only. Call it after prepare(),
  /// and after set_state() has put bodies elsewhere; never within a loop, for it takes its time.
  void look() noexcept;

  /// Collides, solves and moves all bodies by step_s; or does the next part of that (WorldOptions::parts). Does not
  /// call the solver if no body is dynamic.
  StepSummary step() noexcept;
  /// Whether the last step met these bodies' boxes and its frame had no time to ask whether the bodies meet. In
  /// proportion to the pairs of the frame.
  [[nodiscard]] bool had_no_turn(BodyId a, BodyId b) const noexcept;
  /// The next call of step() is a step's first part; contacts of one that was under way are dropped.
  void abandon_step() noexcept;

  void set_coupling(BodyId body, const Coupling& coupling) noexcept;
  /// What the coupling exerted on the body in the last step.
  [[nodiscard]] Wrench coupling_wrench(BodyId body) const noexcept;
  /// What contacts, and the damping of bodies, have given a body since prepare(), N s, world frame. Zero unless
  /// WorldOptions::contact_work. Differences of it over a time are the mean contact force of that time.
  [[nodiscard]] Vec3 contact_impulse(BodyId body) const noexcept;
  /// Adds a force at the centre of mass and a torque for the next step. World frame. What is not finite is ignored.
  void apply(BodyId body, const Wrench& wrench) noexcept;
  /// What has been added for the next step so far, drags of fluids included; zero for a fixed body. The force acts at
  /// the centre of mass; world frame.
  [[nodiscard]] Wrench applied(BodyId body) const noexcept;
  /// Adds the drag of a fluid for the next step. All fluids about a body act as one: its speeds decay towards their
  /// flow as they would within the step, and turn round at no strength. What is not finite is ignored.
  void add_drag(BodyId body, const Drag& drag) noexcept;

  [[nodiscard]] BodyState state(BodyId body) const noexcept;
  /// Puts a body somewhere, e.g. to begin a run anew. Ignored unless finite and rigid.
  void set_state(BodyId body, const BodyState& state) noexcept;
  [[nodiscard]] const MassProperties& mass(BodyId body) const noexcept;
  [[nodiscard]] const std::shared_ptr<const query::Shape>& shape(BodyId body) const noexcept;
  [[nodiscard]] bool is_dynamic(BodyId body) const noexcept;
  [[nodiscard]] std::uint32_t body_count() const noexcept;

  /// Whom to call for each meeting of a step.
  void set_meeting_hook(const MeetingHook& hook) noexcept;

  /// May be changed between steps. Ignored where a number is out of the range that ContactModel or Damping states, or
  /// where gravity is not finite.
  void set_contact(const ContactModel& contact) noexcept;
  void set_gravity(const Vec3& gravity_m_per_s2) noexcept;
  void set_damping(const Damping& damping) noexcept;
  /// Length of the next steps, seconds. Ignored unless positive and finite.
  void set_step(double step_s) noexcept;
  [[nodiscard]] const WorldOptions& options() const noexcept;

 private:
  struct Implementation;
  explicit World(std::unique_ptr<Implementation> implementation);
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace odds::ode
