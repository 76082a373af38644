#include "ode_scenes/arena.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <stdexcept>

#include "odds/mesh/made/by_name.hpp"
#include "odds/scene/simulation.hpp"
#include "ode/budget_clock.hpp"
#include "ode/mesh/mass_properties.hpp"
#include "ode/vectors.hpp"
#include "ode_scenes/bullet.hpp"
#include "support/value_or_throw.hpp"

namespace odds::ode_scenes {
namespace {

using testing::value_or_throw;

constexpr double step_s = 0.001;
constexpr int most_asked = 64;

/// ODE writes redundant contacts to stderr, thousands of times.
void swallow(int, const char*, va_list) {}

unsigned long units_of(double us) {
  return std::max(1UL, static_cast<unsigned long>(std::lround(scene::work_units_per_us * us)));
}

}  // namespace

std::string Collider::name() const {
  const char* const anchored = anchored_m > 0.0 ? ", anchored" : "";
  switch (kind) {
    case Kind::odds:
      return (!std::isfinite(budget_us) ? std::string("odds, no limit")
              : in_work                 ? fmt::format("odds, {} units", work_units())
                                        : fmt::format("odds, {:g} µs", budget_us)) +
             (look_ns > 0 ? " counted" : "") +
             (margin_m > 0.0 ? fmt::format(", margin {:g} mm", 1e3 * margin_m) : std::string()) +
             (frame_us > 0.0
                  ? fmt::format(", {:g} {} a frame", in_work ? static_cast<double>(units_of(frame_us)) : frame_us,
                                in_work ? "units" : "µs")
                  : std::string()) +
             anchored;
    case Kind::stock:
      return std::string("ODE's dTriMesh") + anchored;
    case Kind::primitive:
      return std::string("ODE's primitive") + anchored;
    case Kind::gimpact:
      return std::string("Bullet's GImpact") + anchored;
  }
  return "";
}

unsigned long Collider::work_units() const { return units_of(budget_us); }

/// A mesh in ODE's form; ODE keeps pointers to the arrays.
struct Arena::Data {
  explicit Data(Mesh of) : mesh(std::move(of)), id(dGeomTriMeshDataCreate()) {
    for (const Vec3& v : mesh->vertices()) vertices.insert(vertices.end(), {v.x(), v.y(), v.z()});
    for (const mesh::Triangle& t : mesh->triangles()) indices.insert(indices.end(), t.begin(), t.end());
    dGeomTriMeshDataBuildDouble(id, vertices.data(), 3 * sizeof(double), static_cast<int>(mesh->vertices().size()),
                                indices.data(), static_cast<int>(indices.size()), 3 * sizeof(dTriIndex));
    mass = value_or_throw(ode::mass_properties(*mesh, true, {.mass_kg = 0.0, .density_kg_per_m3 = 1.0}, mesh->name()));
  }
  ~Data() { dGeomTriMeshDataDestroy(id); }
  Data(const Data&) = delete;
  Data& operator=(const Data&) = delete;

  Mesh mesh;
  std::vector<double> vertices;
  std::vector<dTriIndex> indices;
  dTriMeshDataID id;
  ode::MassProperties mass;  // of density 1
};

Arena::Arena(const Collider& collider, const Physics& physics, double gravity)
    : collider_(collider), physics_(physics), gravity_(gravity), clock_(collider.look_ns) {
  if (oddsInitODE(0) == 0) throw std::runtime_error(oddsGetLastError());
  dSetMessageHandler(&swallow);
  dRandSetSeed(1);
  if (collider_.kind == Collider::Kind::odds) {
    oddsTakeOverParams params;
    oddsTakeOverParamsInit(&params);
    params.budget_us = collider_.in_work ? dInfinity : collider_.budget_us;
    if (collider_.in_work) params.work_units = collider_.work_units();
    if (collider_.look_ns > 0) ode::use_budget_clock(clock_.clock());
    if (oddsTakeOverTriMesh(&params) == 0) throw std::runtime_error(oddsGetLastError());
  }
  if (collider_.kind == Collider::Kind::gimpact) bullet_ = std::make_unique<Bullet>();
  world_ = dWorldCreate();
  space_ = dSimpleSpaceCreate(nullptr);
  joints_ = dJointGroupCreate(0);
  dWorldSetGravity(world_, 0, 0, gravity_);
  dWorldSetQuickStepNumIterations(world_, physics_.iterations);
  dWorldSetContactMaxCorrectingVel(
      world_, std::isfinite(physics_.max_correcting_velocity) ? physics_.max_correcting_velocity : dInfinity);
}

Arena::~Arena() {
  for (const Item& item : items_) oddsForgetGeom(item.geom);
  dJointGroupDestroy(joints_);
  dSpaceDestroy(space_);
  dWorldDestroy(world_);
  data_.clear();
  if (collider_.kind == Collider::Kind::odds) oddsGiveBackTriMesh();
  ode::use_budget_clock({});
  oddsCloseODE();
}

Arena::Data& Arena::data_of(const Mesh& mesh) {
  for (const auto& data : data_) {
    if (data->mesh == mesh) return *data;
  }
  return *data_.emplace_back(std::make_unique<Data>(mesh));
}

dGeomID Arena::add(const Mesh& mesh, const math::Pose& pose, double density) {
  Data& data = data_of(mesh);
  const dGeomID geom = dCreateTriMesh(space_, data.id, nullptr, nullptr, nullptr);
  dMatrix3 rotation;
  ode::to_ode(pose.rotation, rotation);
  if (density > 0.0) {
    const Mat3 inertia = density * data.mass.inertia_kg_m2;
    dMass mass;
    dMassSetParameters(&mass, density * data.mass.mass_kg, 0, 0, 0, inertia(0, 0), inertia(1, 1), inertia(2, 2),
                       inertia(0, 1), inertia(0, 2), inertia(1, 2));
    const dBodyID body = dBodyCreate(world_);
    dBodySetMass(body, &mass);
    dGeomSetBody(geom, body);
  }
  dGeomSetRotation(geom, rotation);
  dGeomSetPosition(geom, pose.translation.x(), pose.translation.y(), pose.translation.z());
  if (bullet_) bullet_->add(geom, *mesh);
  items_.push_back({geom, mesh});
  return geom;
}

dGeomID Arena::add(dGeomID primitive, const dMass& mass, const Vec3& position) {
  const dBodyID body = dBodyCreate(world_);
  dBodySetMass(body, &mass);
  dGeomSetBody(primitive, body);
  dGeomSetPosition(primitive, position.x(), position.y(), position.z());
  items_.push_back({primitive, nullptr});
  return primitive;
}

void Arena::prepare() {
  if (collider_.anchored_m > 0.0) {
    anchors_.reset(oddsFrictionAnchorsCreate(4096, collider_.anchored_m));
    if (!anchors_) throw std::runtime_error(oddsGetLastError());
  }
  if (collider_.kind != Collider::Kind::odds) return;
  for (std::size_t i = 0; i < items_.size(); ++i) {
    for (std::size_t j = i + 1; j < items_.size(); ++j) {
      if (!items_[i].mesh || !items_[j].mesh) continue;
      if (dGeomGetBody(items_[i].geom) == nullptr && dGeomGetBody(items_[j].geom) == nullptr) continue;
      if (oddsPreparePair(items_[i].geom, items_[j].geom) == 0) throw std::runtime_error(oddsGetLastError());
    }
  }
  if (collider_.frame_us > 0.0) {
    frame_.reset(oddsFrameBudgetCreate(4096));
    const bool good = collider_.in_work ? oddsFrameBudgetSetWork(frame_.get(), units_of(collider_.frame_us)) != 0
                                        : oddsFrameBudgetSetTime(frame_.get(), collider_.frame_us) != 0;
    if (!good) throw std::runtime_error(oddsGetLastError());
  }
  if (!(collider_.margin_m > 0.0)) return;
  for (const Item& item : items_) {
    if (item.mesh && dGeomOddsMeshSetMargin(item.geom, collider_.margin_m) == 0) {
      throw std::runtime_error(oddsGetLastError());
    }
  }
}

int Arena::collide(dGeomID a, dGeomID b, dContact* contacts) const {
  const bool meshes = dGeomGetClass(a) == dTriMeshClass && dGeomGetClass(b) == dTriMeshClass;
  if (meshes && bullet_) return bullet_->collide(a, b, physics_.most_contacts, contacts);
  return dCollide(a, b, physics_.most_contacts, &contacts[0].geom, sizeof(dContact));
}

void Arena::near(void* self, dGeomID a, dGeomID b) {
  auto& arena = *static_cast<Arena*>(self);
  const dBodyID body_a = dGeomGetBody(a);
  const dBodyID body_b = dGeomGetBody(b);
  if (body_a == nullptr && body_b == nullptr) return;
  if (body_a != nullptr && body_b != nullptr && dAreConnectedExcluding(body_a, body_b, dJointTypeContact) != 0) return;
  dContact contacts[most_asked];
  const double before = thread_us();
  const int count = arena.collide(a, b, contacts);
  if (count == 0) return;
  arena.collide_us.push_back(thread_us() - before);
  ContactCounts& counts = arena.counts;
  ++counts.collisions;
  counts.contacts += static_cast<std::uint64_t>(count);
  counts.most = std::max(counts.most, count);
  for (int i = 0; i < count; ++i) {
    dContact& contact = contacts[i];
    counts.sideways += std::abs(contact.geom.normal[2]) < 0.99 ? 1U : 0U;
    counts.deepest_m = std::max(counts.deepest_m, static_cast<double>(contact.geom.depth));
    contact.surface = {};
    contact.surface.mode = dContactApprox1;
    contact.surface.mu = arena.physics_.friction;
    if (arena.physics_.soft_erp > 0.0) {
      contact.surface.mode |= dContactSoftERP;
      contact.surface.soft_erp = arena.physics_.soft_erp;
    }
    oddsMakeSpeculative(&contact, step_s);
  }
  if (arena.anchors_ && oddsFrictionAnchorsHold(arena.anchors_.get(), body_a, body_b, contacts, count, step_s) == 0) {
    throw std::runtime_error(oddsGetLastError());
  }
  for (int i = 0; i < count; ++i) {
    const dJointID joint = dJointCreateContact(arena.world_, arena.joints_, &contacts[i]);
    dJointAttach(joint, body_a, body_b);
    // ODE makes the only body of a joint its first.
    arena.of_contacts_.push_back({body_a != nullptr ? body_a : body_b, body_a != nullptr ? body_b : nullptr, {}});
    dJointSetFeedback(joint, &arena.of_contacts_.back().forces);
  }
}

void Arena::step() {
  const double before = thread_us();
  oddsFrictionAnchorsNextStep(anchors_.get());
  if (frame_) {
    oddsSpaceCollide(space_, this, &Arena::near, frame_.get());
  } else {
    dSpaceCollide(space_, this, &Arena::near);
  }
  const double measuring = thread_us();
  note_velocities(before_);
  const double measured = thread_us();
  dWorldQuickStep(world_, step_s);
  const double stepped = thread_us();
  add_work_of_contacts();
  const double worked = thread_us();
  dJointGroupEmpty(joints_);
  frame_us.push_back(thread_us() - before - (measured - measuring) - (worked - stepped));
  ++steps_;
  if (steps_ % 10 == 0) look_at_depths();
}

void Arena::look_at_depths() {
  for (std::size_t i = 0; i < items_.size(); ++i) {
    for (std::size_t j = i + 1; j < items_.size(); ++j) {
      const Item& a = items_[i];
      const Item& b = items_[j];
      if (!a.mesh || !b.mesh || (dGeomGetBody(a.geom) == nullptr && dGeomGetBody(b.geom) == nullptr)) continue;
      dReal box_a[6];
      dReal box_b[6];
      dGeomGetAABB(a.geom, box_a);
      dGeomGetAABB(b.geom, box_b);
      bool apart = false;
      for (int axis = 0; axis < 6; axis += 2) {
        apart = apart || box_a[axis] > box_b[axis + 1] || box_b[axis] > box_a[axis + 1];
      }
      if (apart) continue;
      const double depth_m = truth_.depth(a.mesh, pose_of(a.geom), b.mesh, pose_of(b.geom));
      truly_deepest_m_ = std::max(truly_deepest_m_, depth_m);
      sum_of_depths_m_ += depth_m;
      overlaps_ += depth_m > 0.0 ? 1U : 0U;
    }
  }
}

void Arena::note_velocities(std::vector<Motion>& motions) const {
  motions.clear();
  for (const Item& item : items_) {
    const dBodyID body = dGeomGetBody(item.geom);
    if (body != nullptr) motions.push_back({body, velocity_of(body), spin_of(body)});
  }
}

void Arena::add_work_of_contacts() {
  note_velocities(after_);
  // An impulse adds itself times the mean of the velocities before and after, whatever else acts.
  const auto work_on = [this](dBodyID body, const dVector3 force, const dVector3 torque) {
    for (std::size_t i = 0; i < after_.size(); ++i) {
      if (after_[i].body != body) continue;
      return 0.5 * step_s *
             (ode::vector_of(force).dot(before_[i].velocity + after_[i].velocity) +
              ode::vector_of(torque).dot(before_[i].spin + after_[i].spin));
    }
    return 0.0;
  };
  for (const Joint& joint : of_contacts_) {
    work_j_ += work_on(joint.first, joint.forces.f1, joint.forces.t1);
    if (joint.second != nullptr) work_j_ += work_on(joint.second, joint.forces.f2, joint.forces.t2);
  }
  of_contacts_.clear();
  most_work_j_ = std::max(most_work_j_, work_j_);
}

double Arena::kinetic_energy() const {
  double sum = 0.0;
  for (const Item& item : items_) {
    const dBodyID body = dGeomGetBody(item.geom);
    if (body == nullptr) continue;
    dMass mass;
    dBodyGetMass(body, &mass);
    dVector3 spin;
    dBodyVectorFromWorld(body, dBodyGetAngularVel(body)[0], dBodyGetAngularVel(body)[1], dBodyGetAngularVel(body)[2],
                         spin);
    sum += 0.5 * mass.mass * velocity_of(body).squaredNorm();
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) sum += 0.5 * spin[i] * mass.I[4 * i + j] * spin[j];
    }
  }
  return sum;
}

double Arena::energy() const {
  double sum = kinetic_energy();
  for (const Item& item : items_) {
    const dBodyID body = dGeomGetBody(item.geom);
    if (body == nullptr) continue;
    dMass mass;
    dBodyGetMass(body, &mass);
    sum -= mass.mass * gravity_ * dBodyGetPosition(body)[2];
  }
  return sum;
}

double thread_us() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}

math::Pose pose_of(dGeomID geom) {
  return {ode::matrix_of(dGeomGetRotation(geom)), ode::vector_of(dGeomGetPosition(geom))};
}
Vec3 position_of(dBodyID body) { return ode::vector_of(dBodyGetPosition(body)); }
Vec3 velocity_of(dBodyID body) { return ode::vector_of(dBodyGetLinearVel(body)); }
Vec3 spin_of(dBodyID body) { return ode::vector_of(dBodyGetAngularVel(body)); }

Mesh made(const std::string& text, bool centred) {
  const mesh::TriangleMesh mesh = value_or_throw(mesh::made::make_shape(text));
  if (!centred) return std::make_shared<const mesh::TriangleMesh>(mesh);
  const ode::MassProperties mass =
      value_or_throw(ode::mass_properties(mesh, true, {.mass_kg = 0.0, .density_kg_per_m3 = 1.0}, mesh.name()));
  std::vector<Vec3> vertices(mesh.vertices().begin(), mesh.vertices().end());
  for (Vec3& v : vertices) v -= mass.center_m;
  return std::make_shared<const mesh::TriangleMesh>(value_or_throw(
      mesh::TriangleMesh::make(std::move(vertices), {mesh.triangles().begin(), mesh.triangles().end()}, mesh.name())));
}

}  // namespace odds::ode_scenes
