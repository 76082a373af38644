// The world: ODE's bodies, one contact callback, and the care that keeps a tick free of allocations and surprises.
#include "odds/ode/world.hpp"

#include <ode/ode.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "odds/ode/geom.hpp"
#include "ode/geom/broad_phase.hpp"
#include "ode/mesh/mass_properties.hpp"
#include "ode/vectors.hpp"
#include "ode/world/contact_rows.hpp"
#include "ode/world/contact_work.hpp"
#include "ode/world/coupling_joint.hpp"
#include "ode/world/first_look.hpp"
#include "ode/world/meeting_answer.hpp"
#include "ode/world/penalty.hpp"
#include "ode/world/solver_messages.hpp"
#include "ode/world/world_body.hpp"
#include "ode/world/world_frame.hpp"
#include "ode/world/world_options.hpp"

namespace odds::ode {
namespace {

constexpr unsigned long fixed_bit = 1;
constexpr unsigned long dynamic_bit = 2;
// Depths and lever arms beyond this overflow in ODE's solver, which then ends the program.
constexpr double farthest_m = 1e7;
constexpr double rigid_within = 1e-6;  // of a pose given from outside: R^T R - I

Error no_shape(const std::string& name) {
  return {name, "", "its shape is null", "build one with query::Shape::build"};
}

// Geoms know their place in the list of bodies.
BodyId id_of(dGeomID geom) {
  return {static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(dGeomGetData(geom)))};
}

}  // namespace

struct World::Implementation {
  explicit Implementation(Library ode_library, const WorldOptions& world_options)
      : library(std::move(ode_library)), options(world_options) {}

  Implementation(const Implementation&) = delete;
  Implementation& operator=(const Implementation&) = delete;
  ~Implementation() {
    bodies.clear();  // geoms before their space, and before the library
    if (contacts != nullptr) dJointGroupDestroy(contacts);
    if (world != nullptr) dWorldDestroy(world);
    if (threading != nullptr) dThreadingFreeImplementation(threading);
    if (space != nullptr) dSpaceDestroy(space);
  }

  Library library;
  MessageHandler message_handler;
  WorldOptions options;
  dThreadingImplementationID threading = nullptr;  // ODE's own is one for all worlds: two at once would end it
  dWorldID world = nullptr;
  dSpaceID space = nullptr;
  dJointGroupID contacts = nullptr;
  std::vector<std::unique_ptr<Body>> bodies;
  std::uint32_t dynamic_bodies = 0;
  std::uint64_t broad_phases = 0;   // so far; also those left out, after which nobody knows what was near
  StepSummary summary;              // of the call of step() under way
  std::uint32_t part = 0;           // of a step: the next one
  std::uint32_t contacts_made = 0;  // of the step under way
  MeetingHook hook;
  FrameBudget frame;
  dGeomID attention = nullptr;    // the body that a hand holds
  std::vector<Momentum> momenta;  // of all bodies, before the solver; empty unless asked for

  Result<Body*> add(std::shared_ptr<const query::Shape> shape, const math::Pose& pose, const std::string& name);
  std::optional<Error> prepare_pairs();
  void warm_up_solver();
  void add_contact(const ContactPoint& point, const dContactGeom& found, dBodyID a, dBodyID b);
  void note_momenta();
  void note_contacts();
  void apply_damping();
  void hold_to_limits(Body& body);
  static void near(void* self, dGeomID a, dGeomID b) noexcept;
};

Result<Body*> World::Implementation::add(std::shared_ptr<const query::Shape> shape, const math::Pose& pose,
                                         const std::string& name) {
  if (shape == nullptr) return no_shape(name);
  if (!pose.is_rigid(rigid_within))
    return Error{name, "", "its pose is not a finite rigid pose", "correct position and orientation"};
  const double reach_m = shape->mesh().lower().cwiseAbs().cwiseMax(shape->mesh().upper().cwiseAbs()).norm();
  if (!(pose.translation.norm() + reach_m <= farthest_m))
    return Error{name, "", "it reaches farther than 10,000 km from the origin",
                 "correct its position, and check the mesh's unit of length"};
  Result<Geom> geom = Geom::make(space, shape);
  if (!geom) return geom.error();
  bodies.push_back(std::make_unique<Body>(
      Body{name, std::move(shape), std::move(geom).value(), nullptr, {}, nullptr, {pose, {}, {}}}));
  Body& body = *bodies.back();
  dGeomSetData(body.geom.id(), reinterpret_cast<void*>(std::uintptr_t{bodies.size() - 1}));
  body.last_good.velocity_m_per_s.setZero();
  body.last_good.angular_velocity_rad_per_s.setZero();
  if (!configure(body.geom.id(), options.query)) {
    Error error{name, "", oddsGetLastError(), "correct the query's settings"};
    bodies.pop_back();
    return error;
  }
  return &body;
}

void World::Implementation::apply_damping() {
  for (const auto& body : bodies) {
    if (body->body == nullptr) continue;
    dBodySetLinearDampingThreshold(body->body, 0.0);
    dBodySetAngularDampingThreshold(body->body, 0.0);
    dBodySetLinearDamping(body->body, -std::expm1(-options.damping.linear_per_s * options.step_s));
    dBodySetAngularDamping(body->body, -std::expm1(-options.damping.angular_per_s * options.step_s));
  }
}

std::optional<Error> World::Implementation::prepare_pairs() {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    for (std::size_t j = i + 1; j < bodies.size(); ++j) {
      if (bodies[i]->body == nullptr && bodies[j]->body == nullptr) continue;
      if (oddsPreparePair(bodies[i]->geom.id(), bodies[j]->geom.id()) == 0) {
        const bool one_volume = bodies[i]->shape->volume() == bodies[j]->shape->volume();
        return Error{
            "", "", "'" + bodies[i]->name + "' and '" + bodies[j]->name + "' cannot be collided: " + oddsGetLastError(),
            one_volume ? "free memory, or use fewer bodies" : "use one bounding volume for all bodies"};
      }
    }
  }
  return std::nullopt;
}

// Fills the joint group and the solver's memory once with the most contacts a step may have, then undoes the motion.
void World::Implementation::warm_up_solver() {
  constexpr std::uint32_t most_solved = 64;  // the exact solver's time grows with the cube
  const CountedMessages messages;            // nobody's contacts
  reserve_solver(world, options, dynamic_bodies);

  std::vector<BodyState> before;
  std::vector<Body*> moving;
  for (const auto& body : bodies) {
    before.push_back(state_of(*body));
    if (body->body != nullptr) moving.push_back(body.get());
  }
  const auto contact_at = [&](std::uint32_t i) {
    dContactGeom geom{};
    const double angle = 2.4 * i;  // golden angle: no two normals alike
    const Vec3 direction(std::cos(angle), std::sin(angle), 1.0);
    Eigen::Map<Vec3>(geom.normal) = direction.normalized();
    const Body& body = *moving[i % moving.size()];
    Eigen::Map<Vec3>(geom.pos) = vector_of(dBodyGetPosition(body.body)) - 1e-3 * direction;
    ContactPoint point = contact_point(geom, 1, options.contact, false, body.body, nullptr);
    if (options.angular_friction) point.surface.rolling_m = point.surface.spinning_m = 1e-3;
    add_contact(point, geom, body.body, nullptr);
  };
  const ContactModel asked = options.contact;
  options.contact.friction = 1.0;
  for (const std::uint32_t count :
       {std::min(most_solved, options.max_contacts_per_step), options.max_contacts_per_step}) {
    summary = {};
    contacts_made = 0;
    for (std::uint32_t i = 0; i < count; ++i) contact_at(i);
    if (count <= most_solved) {
      options.solver == Solver::exact ? dWorldStep(world, options.step_s) : dWorldQuickStep(world, options.step_s);
    }
    dJointGroupEmpty(contacts);
  }
  options.contact = asked;
  contacts_made = 0;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    place(*bodies[i], before[i]);
    if (bodies[i]->coupling) bodies[i]->coupling->forget_wrench();
  }
}

void World::Implementation::near(void* self, dGeomID a, dGeomID b) noexcept {
  auto& world = *static_cast<Implementation*>(self);
  std::array<dContactGeom, most_contacts_per_pair> found;
  const int most = std::max(1, world.options.query.max_contacts);  // ODE refuses to be asked for none
  const int count = dCollide(a, b, most, found.data(), sizeof(dContactGeom));
  const dBodyID body_a = dGeomGetBody(a);
  const dBodyID body_b = dGeomGetBody(b);
  const ContactModel& model = world.options.contact;
  const bool velocity = world.options.contact_velocity || model.friction > 0.0 || model.law == ContactLaw::penalty;
  const ContactModel pair = of_pair(model, world.options.step_s, body_a, body_b);
  std::array<ContactPoint, 2 * most_contacts_per_pair> points;  // as many again for effects to add
  for (int i = 0; i < count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    points[at] = contact_point(found[at], count, pair, velocity, body_a, body_b);
  }
  const auto made = std::span(points).first(static_cast<std::size_t>(std::max(0, count)));
  Meeting meeting{.a = id_of(a),
                  .b = id_of(b),
                  .stiffness_n_per_m = pair.stiffness_n_per_m,
                  .damping_ns_per_m = pair.damping_ns_per_m,
                  .contacts = made,
                  .room = points};
  note_answer(a, b, meeting, world.summary);
  ++world.summary.meetings;
  if (world.hook.call != nullptr) world.hook.call(world.hook.self, meeting);
  if (!model.responds) return;
  dContactGeom geoms{};
  geoms.g1 = a;
  geoms.g2 = b;
  for (const ContactPoint& point : meeting.contacts) world.add_contact(point, geoms, body_a, body_b);
}

void World::Implementation::add_contact(const ContactPoint& point, const dContactGeom& found, dBodyID a, dBodyID b) {
  if (!can_be_solved(point) || contacts_made >= options.max_contacts_per_step) {
    ++summary.contacts_left_out;
    return;
  }
  const Surface& surface = point.surface;
  const double most = options.contact.max_correcting_velocity_m_per_s;
  const dContact contact = options.contact.law == ContactLaw::penalty
                               ? penalty_rows(point, found, a, b, options.step_s, most)
                               : contact_rows(point, found, options.step_s, most);
  dJointAttach(dJointCreateContact(world, contacts, &contact), a, b);
  ++summary.contacts;
  ++contacts_made;
  summary.friction_rows += surface.friction > 0.0 ? 2U : 0U;
  summary.angular_rows += (surface.rolling_m > 0.0 ? 2U : 0U) + (surface.spinning_m > 0.0 ? 1U : 0U);
  summary.max_depth_m = std::max(summary.max_depth_m, point.depth_m);
}

void World::Implementation::note_momenta() {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (bodies[i]->body == nullptr) continue;
    momenta[i] = momentum_without_contacts(bodies[i]->body, bodies[i]->mass, options.gravity_m_per_s2, options.step_s);
  }
}

void World::Implementation::note_contacts() {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    Body& body = *bodies[i];
    if (body.body == nullptr) continue;
    const Wrench pull = body.coupling ? body.coupling->wrench() : Wrench{};
    const ContactEffect effect = effect_of_contacts(momenta[i], body.body, body.mass, pull, options.step_s);
    body.contact_impulse_ns += effect.impulse_ns;
    summary.contact_work_j += effect.work_j;
  }
}

void World::Implementation::hold_to_limits(Body& body) {
  const BodyState state = state_of(body);
  const Vec3& v = state.velocity_m_per_s;
  if (!state.pose.rotation.allFinite() || !state.pose.translation.allFinite() || !v.allFinite() ||
      !state.angular_velocity_rad_per_s.allFinite()) {
    place(body, {body.last_good.pose, Vec3::Zero(), Vec3::Zero()});
    ++summary.bodies_recovered;
    return;
  }
  const double speed = v.norm();
  if (speed > options.max_speed_m_per_s) {
    const Vec3 slower = v * (options.max_speed_m_per_s / speed);
    dBodySetLinearVel(body.body, slower.x(), slower.y(), slower.z());
    // ODE has moved it with the speed that it shall not have.
    const Vec3 center = body.last_good.pose * body.mass.center_m + options.step_s * slower;
    dBodySetPosition(body.body, center.x(), center.y(), center.z());
    ++summary.bodies_slowed;
  }
  body.last_good = state_of(body);
}

World::World(std::unique_ptr<Implementation> implementation) : implementation_(std::move(implementation)) {}
World::~World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

Result<World> World::make(const WorldOptions& options) {
  if (auto error = check(options)) return *error;
  Result<Library> library = Library::open();
  if (!library) return library.error();
  auto made = std::make_unique<Implementation>(std::move(library).value(), options);
  if (made->options.clock.now_ns == nullptr) made->options.clock = realtime::fastest_clock();
  made->threading = dThreadingAllocateSelfThreadedImplementation();
  if (made->threading == nullptr) return Error{"world", "", "out of memory", "free memory"};
  made->world = dWorldCreate();
  dWorldSetStepThreadingImplementation(made->world, dThreadingImplementationGetFunctions(made->threading),
                                       made->threading);
  made->space = dSimpleSpaceCreate(nullptr);  // the hash space and sweep-and-prune allocate where boxes overlap
  dSpaceSetCleanup(made->space, 0);
  made->contacts = dJointGroupCreate(0);
  dWorldSetContactMaxCorrectingVel(made->world, dInfinity);  // each contact is bounded where its rows are made
  World world(std::move(made));
  world.set_contact(options.contact);
  world.set_gravity(options.gravity_m_per_s2);
  dWorldSetQuickStepNumIterations(world.implementation_->world, std::max(1, options.iterations));
  return world;
}

Result<BodyId> World::add_fixed(std::shared_ptr<const query::Shape> shape, const math::Pose& pose,
                                const std::string& name) {
  Implementation& self = *implementation_;
  Result<Body*> body = self.add(std::move(shape), pose, name);
  if (!body) return body.error();
  dGeomSetCategoryBits(body.value()->geom.id(), fixed_bit);
  dGeomSetCollideBits(body.value()->geom.id(), dynamic_bit);
  place(*body.value(), body.value()->last_good);
  return BodyId{static_cast<std::uint32_t>(self.bodies.size() - 1)};
}

Result<BodyId> World::add_dynamic(std::shared_ptr<const query::Shape> shape, const math::Pose& pose,
                                  const MassSpec& mass, const std::string& name) {
  Implementation& self = *implementation_;
  if (shape == nullptr) return no_shape(name);
  const oddsMeshDataID data = oddsMeshDataFromShape(shape);
  const bool closed = data != nullptr && oddsMeshDataIsClosed(data) != 0;
  oddsMeshDataDestroy(data);
  Result<MassProperties> properties = mass_properties(shape->mesh(), closed, mass, name);
  if (!properties) return properties.error();
  Result<Body*> added = self.add(std::move(shape), pose, name);
  if (!added) return added.error();
  Body& body = *added.value();
  body.mass = properties.value();
  body.principal = principal_axes(body.mass.inertia_kg_m2);
  body.body = dBodyCreate(self.world);
  give_mass(body.body, body.mass);
  dBodySetGyroscopicMode(body.body, 0);      // its explicit term feeds energy to fast spins
  dBodySetFiniteRotationMode(body.body, 1);  // fast turns stay rotations
  dBodySetMaxAngularSpeed(body.body, self.options.max_spin_rad_per_s);
  dGeomSetBody(body.geom.id(), body.body);
  const Vec3 offset = -body.mass.center_m;  // ODE's bodies have their origin at the centre of mass
  dGeomSetOffsetPosition(body.geom.id(), offset.x(), offset.y(), offset.z());
  dGeomSetCategoryBits(body.geom.id(), dynamic_bit);
  dGeomSetCollideBits(body.geom.id(), fixed_bit | dynamic_bit);
  ++self.dynamic_bodies;
  place(body, body.last_good);
  self.apply_damping();
  return BodyId{static_cast<std::uint32_t>(self.bodies.size() - 1)};
}

void World::add_coupling(BodyId id) {
  Body& body = *implementation_->bodies.at(id.index);
  if (body.body != nullptr && !body.coupling) {
    body.coupling = std::make_unique<CouplingJoint>(implementation_->world, body.body);
    implementation_->attention = body.geom.id();
  }
}

std::optional<Error> World::prepare() {
  Implementation& self = *implementation_;
  if (auto error = self.prepare_pairs()) return error;
  Result<FrameBudget> frame = make_frame_budget(self.options, self.bodies.size());
  if (!frame) return frame.error();
  self.frame = std::move(frame).value();
  for (const auto& body : self.bodies) body->contact_impulse_ns.setZero();
  if (self.options.contact_work) self.momenta.resize(self.bodies.size());
  if (self.dynamic_bodies > 0) self.warm_up_solver();
  dSpaceClean(self.space);
  return std::nullopt;
}

void World::look() noexcept {
  ++implementation_->broad_phases;  // what it finds is newer than where the last step saw anything apart
  if (options().contact.enabled) first_look(implementation_->space, options().query);
}

StepSummary World::step() noexcept {
  Implementation& self = *implementation_;
  const CountedMessages messages;
  self.summary = {};
  const std::uint32_t parts = self.options.parts;
  const bool solves = self.part + 1 == parts;
  const bool collides = parts == 1 || !solves;
  const std::int64_t start_ns = self.options.clock();
  if (collides) ++self.broad_phases;
  if (collides && self.options.contact.enabled) {
    collide_frame(self.space, &self, &Implementation::near, self.frame.get(), self.attention, self.part + 2 >= parts,
                  self.broad_phases, self.summary);
  }
  self.part = solves ? 0 : self.part + 1;
  const std::int64_t collided_ns = self.options.clock();
  self.summary.collision_us = 1e-3 * static_cast<double>(collided_ns - start_ns);
  if (!solves) return self.summary;
  self.contacts_made = 0;
  if (self.dynamic_bodies == 0) return self.summary;
  const double h = self.options.step_s;
  const bool measures = self.options.contact_work && self.momenta.size() == self.bodies.size();
  if (measures) self.note_momenta();
  for (const auto& body : self.bodies) {
    if (body->coupling) body->coupling->begin_step(body->mass.center_m, h);
  }
  ++self.summary.solver_calls;
  self.summary.bodies_stepped = self.dynamic_bodies;
  const std::uint32_t complaints = messages.count();
  self.options.solver == Solver::exact ? dWorldStep(self.world, h) : dWorldQuickStep(self.world, h);
  self.summary.solver_messages = messages.count() - complaints;
  dJointGroupEmpty(self.contacts);
  if (measures) self.note_contacts();
  for (const auto& body : self.bodies) {
    if (body->body == nullptr) continue;
    self.hold_to_limits(*body);
    leave_fluids(*body);
  }
  self.summary.step_us = 1e-3 * static_cast<double>(self.options.clock() - collided_ns);
  return self.summary;
}

bool World::had_no_turn(BodyId a, BodyId b) const noexcept {
  const Implementation& self = *implementation_;
  return self.frame && ode::had_no_turn(*self.frame, self.bodies[a.index]->geom.id(), self.bodies[b.index]->geom.id());
}

void World::abandon_step() noexcept {
  Implementation& self = *implementation_;
  if (self.part == 0) return;
  dJointGroupEmpty(self.contacts);
  self.contacts_made = 0;
  self.part = 0;
  if (self.frame) oddsFrameBudgetSetParts(self.frame.get(), frame_parts(self.options));
}

void World::set_coupling(BodyId id, const Coupling& coupling) noexcept {
  Body& body = *implementation_->bodies[id.index];
  if (body.coupling) body.coupling->set(coupling);
}

Wrench World::coupling_wrench(BodyId id) const noexcept {
  const Body& body = *implementation_->bodies[id.index];
  return body.coupling ? body.coupling->wrench() : Wrench{};
}
Vec3 World::contact_impulse(BodyId id) const noexcept { return implementation_->bodies[id.index]->contact_impulse_ns; }
void World::apply(BodyId id, const Wrench& wrench) noexcept {
  const Body& body = *implementation_->bodies[id.index];
  if (body.body == nullptr || !wrench.force_n.allFinite() || !wrench.torque_nm.allFinite()) return;
  dBodyAddForce(body.body, wrench.force_n.x(), wrench.force_n.y(), wrench.force_n.z());
  dBodyAddTorque(body.body, wrench.torque_nm.x(), wrench.torque_nm.y(), wrench.torque_nm.z());
}

Wrench World::applied(BodyId id) const noexcept {
  const dBodyID body = implementation_->bodies[id.index]->body;
  return body == nullptr ? Wrench{} : Wrench{vector_of(dBodyGetForce(body)), vector_of(dBodyGetTorque(body))};
}

void World::add_drag(BodyId id, const Drag& drag) noexcept {
  Body& body = *implementation_->bodies[id.index];
  const double sum = drag.force_ns_per_m + drag.torque_nms_per_rad + drag.flow_m_per_s.sum();
  if (body.body == nullptr || !std::isfinite(sum)) return;
  body.fluids.add(drag);
  const Wrench now =
      body.fluids.over_one_step(state_of(body), body.mass.mass_kg, body.principal, implementation_->options.step_s);
  apply(id, {now.force_n - body.of_fluids.force_n, now.torque_nm - body.of_fluids.torque_nm});
  body.of_fluids = now;
}

BodyState World::state(BodyId id) const noexcept { return state_of(*implementation_->bodies[id.index]); }

void World::set_state(BodyId id, const BodyState& state) noexcept {
  if (!state.pose.is_rigid(rigid_within) || !state.velocity_m_per_s.allFinite() ||
      !state.angular_velocity_rad_per_s.allFinite())
    return;
  Body& body = *implementation_->bodies[id.index];
  const WorldOptions& options = implementation_->options;
  const double moved = (state.pose.translation - state_of(body).pose.translation).norm();
  if (moved > options.max_speed_m_per_s * options.step_s) forget_place(body.geom.id());  // it has not come that way
  place(body, state);
}

const MassProperties& World::mass(BodyId id) const noexcept { return implementation_->bodies[id.index]->mass; }
const std::shared_ptr<const query::Shape>& World::shape(BodyId id) const noexcept {
  return implementation_->bodies[id.index]->shape;
}
bool World::is_dynamic(BodyId id) const noexcept { return implementation_->bodies[id.index]->body != nullptr; }
std::uint32_t World::body_count() const noexcept { return static_cast<std::uint32_t>(implementation_->bodies.size()); }

void World::set_meeting_hook(const MeetingHook& hook) noexcept { implementation_->hook = hook; }

void World::set_contact(const ContactModel& contact) noexcept {
  if (!fault_of(contact)) implementation_->options.contact = contact;
}

void World::set_gravity(const Vec3& g) noexcept {
  if (!g.allFinite()) return;  // ODE would end the program
  implementation_->options.gravity_m_per_s2 = g;
  dWorldSetGravity(implementation_->world, g.x(), g.y(), g.z());
}

void World::set_damping(const Damping& damping) noexcept {
  if (!is_in_range(damping)) return;
  implementation_->options.damping = damping;
  implementation_->apply_damping();
}

void World::set_step(double step_s) noexcept {
  if (!(step_s > 0.0) || !std::isfinite(step_s)) return;
  implementation_->options.step_s = step_s;
  implementation_->apply_damping();
}

const WorldOptions& World::options() const noexcept { return implementation_->options; }

}  // namespace odds::ode
