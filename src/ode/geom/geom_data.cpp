// Creating geoms of the class; the callbacks that ODE makes about a single geom.
#include "ode/geom/geom_data.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <new>
#include <string>
#include <utility>

#include "odds/ode/geom.hpp"
#include "ode/geom/pair_table.hpp"
#include "ode/geom/partners.hpp"
#include "ode/geom/registry.hpp"
#include "ode/last_error.hpp"
#include "ode/mesh/mesh_data.hpp"
#include "ode/statistics.hpp"

namespace odds::ode {
namespace {

// Positions beyond the range of mesh coordinates have no use and would overflow in products.
constexpr double farthest_position = 1e15;
// ODE keeps rotations orthonormal to rounding (1e-15 in doubles, 1e-6 in a single-precision build). Up to `repairable`
// the nearest rotation is meant; beyond it the matrix is not a rotation.
constexpr double exact_enough = 1e-12;
constexpr double repairable = 1e-3;

}  // namespace

std::uint64_t next_geom_number() noexcept {
  static constinit std::atomic<std::uint64_t> last{0};
  return last.fetch_add(1, std::memory_order_relaxed) + 1;
}

Settings combine(const Settings& a, const Settings& b) noexcept {
  const auto smaller_limit = [](unsigned long x, unsigned long y) {
    return x == 0 ? y : (y == 0 ? x : std::min(x, y));
  };
  Settings both;
  both.budget_us = std::min(a.budget_us, b.budget_us);
  both.work_units = smaller_limit(a.work_units, b.work_units);
  both.p_min = std::max(a.p_min, b.p_min);
  both.k_min = std::max(a.k_min, b.k_min);
  both.max_contacts = std::min(a.max_contacts, b.max_contacts);
  both.carry_motion = std::min(a.carry_motion, b.carry_motion);
  both.margin_m = std::max(a.margin_m, b.margin_m);
  both.late_contacts = a.late_contacts && b.late_contacts;
  both.method = std::min(a.method, b.method);
  both.estimator = std::min(a.estimator, b.estimator);
  both.undecided_policy = std::max(a.undecided_policy, b.undecided_policy);
  both.undecided_probability = std::max(a.undecided_probability, b.undecided_probability);
  return both;
}

GeomData& own_data(dGeomID geom) noexcept {
  if (dGeomGetClass(geom) < dFirstUserClass) return *partner_table().find(geom)->mesh;
  return **static_cast<GeomData**>(dGeomGetClassData(geom));
}

GeomData* known_data(dGeomID geom) noexcept {
  const int our_class = oddsGetClass();
  if (our_class < 0 || geom == nullptr) return nullptr;
  if (dGeomGetClass(geom) == our_class) return &own_data(geom);
  const Partner* partner = partner_table().find(geom);
  return partner != nullptr ? partner->mesh.get() : nullptr;
}

GeomData* find_data(dGeomID geom, const char* caller) noexcept {
  if (GeomData* known = known_data(geom)) return known;
  try {
    set_last_error(std::string(caller) +
                   (oddsGetClass() < 0
                        ? ": the library is not initialised; call oddsInitODE first"
                        : ": not a geom made by dCreateOddsMesh, nor one with a mesh that stands in for it"));
  } catch (...) {
    set_last_error("not a geom made by dCreateOddsMesh");
  }
  return nullptr;
}

bool is_position(const Vec3& point) noexcept { return (point.array().abs() <= farthest_position).all(); }

std::optional<math::Pose> world_pose(dGeomID geom) noexcept {
  if (dGeomGetClass(geom) == dHeightfieldClass) {
    const Partner* partner = partner_table().find(geom);
    if (partner != nullptr && !partner->placeable) return math::Pose();  // ODE aborts if it is asked for its pose
  }
  const dReal* p = dGeomGetPosition(geom);
  const dReal* r = dGeomGetRotation(geom);
  math::Pose pose;
  pose.translation = Vec3(p[0], p[1], p[2]);
  pose.rotation << r[0], r[1], r[2], r[4], r[5], r[6], r[8], r[9], r[10];
  if (!is_position(pose.translation)) return std::nullopt;
  if (pose.is_rigid(exact_enough)) return pose;
  if (!pose.is_rigid(repairable)) return std::nullopt;
  pose.rotation = Quat(pose.rotation).normalized().toRotationMatrix();
  return pose;
}

void compute_aabb(dGeomID geom, dReal aabb[6]) noexcept {
  const std::optional<math::Pose> pose = world_pose(geom);
  if (!pose) {
    // A NaN would abort ODE's hash space. A point at the origin keeps every space sane; the collider reports the pose.
    std::fill_n(aabb, 6, dReal{0});
    return;
  }
  const mesh::TriangleMesh& mesh = own_data(geom).mesh->mesh();
  const Vec3 local_center = 0.5 * (mesh.lower() + mesh.upper());
  const Vec3 local_half = (mesh.upper() - local_center).cwiseMax(local_center - mesh.lower());
  const Vec3 center = *pose * local_center;
  Vec3 half = pose->rotation.cwiseAbs() * local_half;
  // Some roundings of the sums above, so that the box surely holds the mesh.
  half += Vec3::Constant(8e-16 * (center.cwiseAbs().maxCoeff() + pose->translation.cwiseAbs().maxCoeff() +
                                  local_center.cwiseAbs().sum() + half.maxCoeff()));
  half += Vec3::Constant(own_data(geom).settings.margin_m);
  for (int axis = 0; axis < 3; ++axis) {
    aabb[2 * axis] = static_cast<dReal>(center[axis] - half[axis]);
    aabb[2 * axis + 1] = static_cast<dReal>(center[axis] + half[axis]);
    if constexpr (sizeof(dReal) < sizeof(double)) {
      aabb[2 * axis] = std::nextafter(aabb[2 * axis], -dInfinity);
      aabb[2 * axis + 1] = std::nextafter(aabb[2 * axis + 1], dInfinity);
    }
  }
}

void destroy_data(dGeomID geom) noexcept {
  auto** slot = static_cast<GeomData**>(dGeomGetClassData(geom));
  if (*slot == nullptr) return;
  pair_table().forget(**slot);
  delete *slot;
  *slot = nullptr;
  statistics().live_geoms.fetch_sub(1, std::memory_order_relaxed);
}

Result<Library> Library::open(unsigned flags) {
  if (oddsInitODE(flags) == 0) return Error{"", "", oddsGetLastError(), ""};
  return Library();
}

Result<Geom> Geom::make(dSpaceID space, std::shared_ptr<const query::Shape> shape) {
  const std::unique_ptr<oddsMeshData> data(oddsMeshDataFromShape(std::move(shape)));
  const dGeomID id = data != nullptr ? dCreateOddsMesh(space, data.get()) : nullptr;
  if (id == nullptr) return Error{"", "", oddsGetLastError(), ""};
  return Geom(id);
}

}  // namespace odds::ode

dGeomID dCreateOddsMesh(dSpaceID space, oddsMeshDataID mesh_data) noexcept {
  using namespace odds::ode;
  if (oddsGetClass() < 0) {
    set_last_error("dCreateOddsMesh: the library is not initialised; call oddsInitODE first");
    return nullptr;
  }
  if (mesh_data == nullptr || mesh_data->prepared == nullptr) {
    set_last_error("dCreateOddsMesh: the mesh data is null or not built; call one of oddsMeshDataBuild... first");
    return nullptr;
  }
  auto* data = new (std::nothrow) GeomData;
  if (data == nullptr) {
    set_last_error("dCreateOddsMesh: out of memory");
    return nullptr;
  }
  data->mesh = mesh_data->prepared;
  data->number = next_geom_number();
  const dGeomID geom = dCreateGeom(oddsGetClass());
  *static_cast<GeomData**>(dGeomGetClassData(geom)) = data;
  count(statistics().live_geoms);
  if (space != nullptr) dSpaceAdd(space, geom);
  return geom;
}
