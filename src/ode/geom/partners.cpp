// Finding, adding and forgetting partners.
#include "ode/geom/partners.hpp"

#include <bit>
#include <cmath>
#include <deque>
#include <limits>
#include <span>
#include <utility>

#include "ode/geom/pair_table.hpp"
#include "ode/last_error.hpp"
#include "ode/mesh/mesh_data.hpp"
#include "ode/pair_hash.hpp"
#include "ode/statistics.hpp"
#include "ode/vectors.hpp"

namespace odds::ode {

Settings neutral_settings() noexcept {
  Settings settings;
  settings.budget_us = std::numeric_limits<double>::infinity();
  settings.work_units = 0;
  settings.p_min = 0.0;
  settings.k_min = 1;
  settings.undecided_probability = 0.0;
  return settings;
}

Settings& partner_settings() noexcept {
  static Settings only = neutral_settings();
  return only;
}

// Never destroyed, like the other tables: clients may destroy geoms after all that is static here would be gone.
PartnerTable& partner_table() noexcept {
  static PartnerTable& only = *new PartnerTable;
  return only;
}

std::uint64_t PartnerTable::key_of(dGeomID geom) noexcept {
  return mixed(static_cast<std::uint64_t>(reinterpret_cast<std::uintptr_t>(geom)));
}

Partner* PartnerTable::find(dGeomID geom) const noexcept {
  Partner* const known = partners_.find(key_of(geom));
  return known != nullptr && known->geom_class == dGeomGetClass(geom) ? known : nullptr;
}

bool PartnerTable::knows_another(dGeomID geom) const noexcept {
  const Partner* const known = partners_.find(key_of(geom));
  return known != nullptr && known->geom_class != dGeomGetClass(geom);
}

void PartnerTable::free(Partner* partner) noexcept {
  if (partner == nullptr) return;
  if (partner->mesh != nullptr) pair_table().forget(*partner->mesh);
  delete partner;
  statistics().live_partners.fetch_sub(1, std::memory_order_relaxed);
}

bool PartnerTable::remove(dGeomID geom) noexcept {
  Partner* const partner = partners_.remove(key_of(geom));
  free(partner);
  return partner != nullptr;
}

Partner* PartnerTable::insert(std::unique_ptr<Partner> partner) {
  const std::uint64_t key = key_of(partner->geom);
  partners_.reserve(key);
  partners_.insert(key, partner.get());
  count(statistics().live_partners);
  return partner.release();
}

Partner* PartnerTable::put(std::unique_ptr<Partner> partner) {
  const std::lock_guard lock(writers_);
  partners_.reserve(key_of(partner->geom));  // what is known stays if there is no memory
  const Partner* const known = find(partner->geom);
  if (known != nullptr && known->mesh != nullptr && partner->mesh != nullptr &&
      known->mesh->settings != known->first_settings) {
    partner->mesh->settings = known->mesh->settings;
  }
  remove(partner->geom);
  return insert(std::move(partner));
}

Partner* PartnerTable::put_new(std::unique_ptr<Partner> partner) {
  const std::lock_guard lock(writers_);
  if (knows_another(partner->geom)) return nullptr;  // another thread may look at it now
  Partner* known = find(partner->geom);
  return known != nullptr ? known : insert(std::move(partner));
}

bool PartnerTable::forget(dGeomID geom) noexcept {
  try {
    const std::lock_guard lock(writers_);
    return remove(geom);
  } catch (...) {
    count(statistics().caught);
    return false;
  }
}

void PartnerTable::clear() noexcept {
  try {
    const std::lock_guard lock(writers_);
    partners_.remove_all(&PartnerTable::free);
  } catch (...) {
    count(statistics().caught);
  }
}

namespace {

// One counter for each address that data ever had: a few bytes, which geoms point to.
struct Changes {
  LinkedTable<std::atomic<std::uint64_t>, 1024> of_data;
  std::deque<std::atomic<std::uint64_t>> all;
  std::mutex writers;
};

Changes& changes() noexcept {
  static Changes& only = *new Changes;
  return only;
}

std::uint64_t key_of_data(dTriMeshDataID data) noexcept {
  return mixed(static_cast<std::uint64_t>(reinterpret_cast<std::uintptr_t>(data)));
}

}  // namespace

std::atomic<std::uint64_t>& changes_of(dTriMeshDataID data) {
  Changes& known = changes();
  const std::lock_guard lock(known.writers);
  const std::uint64_t key = key_of_data(data);
  if (std::atomic<std::uint64_t>* const counter = known.of_data.find(key)) return *counter;
  known.of_data.reserve(key);
  std::atomic<std::uint64_t>& counter = known.all.emplace_back(0);
  known.of_data.insert(key, &counter);
  return counter;
}

void note_changed(dTriMeshDataID data) noexcept {
  if (data == nullptr) return;
  if (std::atomic<std::uint64_t>* const counter = changes().of_data.find(key_of_data(data))) {
    counter->fetch_add(1, std::memory_order_relaxed);
  }
}

std::unique_ptr<Partner> make_partner(dGeomID geom, std::shared_ptr<const PreparedMesh> mesh) {
  auto partner = std::make_unique<Partner>(geom);
  partner->mesh = std::make_unique<GeomData>();
  partner->mesh->mesh = std::move(mesh);
  partner->mesh->settings = partner->first_settings = partner_settings();
  partner->mesh->number = next_geom_number();
  return partner;
}

namespace {

std::uint64_t hash_of(std::span<const dReal, 6> box) noexcept {
  std::uint64_t hash = 0;
  for (const double side : box) hash = hash_of_pair(hash, std::bit_cast<std::uint64_t>(side));
  return hash;
}

// Whether a convex geom still is what was registered: ODE's box around it is that around the registered points, placed
// by ODE's own pose, which need not be as rigid as `world_pose` makes it. Within a dGeomTransform ODE leaves the box
// where it was until the transform's own is asked for: one that was right, and is the same, tells of no other geom.
bool has_bounds_of(const ConvexShape& shape, dGeomID geom, std::atomic<std::uint64_t>& good_box) noexcept {
  if (!world_pose(geom)) return true;  // the collision itself answers bad poses
  const Vec3 place = vector_of(dGeomGetPosition(geom));
  const Mat3 turn = matrix_of(dGeomGetRotation(geom));
  dReal aabb[6];
  dGeomGetAABB(geom, aabb);
  const double tolerance = 1e-6 * shape.box_half_extents().norm() + 1e-12 * place.cwiseAbs().maxCoeff();
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 along = turn.row(axis).transpose();
    const double lower = place[axis] - shape.reach(-along);
    const double upper = place[axis] + shape.reach(along);
    const bool same =
        std::abs(aabb[2 * axis] - lower) <= tolerance && std::abs(aabb[2 * axis + 1] - upper) <= tolerance;
    if (!same) return hash_of(aabb) == good_box.load(std::memory_order_relaxed);
  }
  good_box.store(hash_of(aabb), std::memory_order_relaxed);
  return true;
}

}  // namespace

bool is_unchanged(Partner& partner) noexcept {
  if (partner.convex != nullptr) return has_bounds_of(*partner.convex, partner.geom, partner.good_box);
  if (partner.heightfield_data != nullptr) {
    return dGeomHeightfieldGetHeightfieldData(partner.geom) == partner.heightfield_data;
  }
  if (partner.trimesh_data == nullptr) return true;
  if (dGeomTriMeshGetData(partner.geom) != partner.trimesh_data) return false;
  if (partner.changes == nullptr) return true;  // what stands in need not be like it
  const mesh::TriangleMesh& mesh = partner.mesh->mesh->mesh();
  const std::size_t triangles = mesh.triangles().size();
  if (dGeomTriMeshGetTriangleCount(partner.geom) != static_cast<int>(triangles)) return false;
  // A mesh with one moved corner must not answer from what it was wherever the compared triangle is another's.
  if (partner.deformed.load(std::memory_order_relaxed)) return false;
  if (partner.changes->load(std::memory_order_relaxed) != partner.changes_seen) return false;
  if (!world_pose(partner.geom)) return true;  // the collision itself answers bad poses
  const std::uint32_t number =
      partner.next_check.fetch_add(1, std::memory_order_relaxed) % static_cast<std::uint32_t>(triangles);
  std::array<dVector3, 3> found;
  dGeomTriMeshGetTriangle(partner.geom, static_cast<int>(number), &found[0], &found[1], &found[2]);
  const std::array<Vec3, 3> known = partner.mesh->mesh->corners(number);
  // ODE's own pose, which need not be as rigid as `world_pose` makes it.
  const Vec3 place = vector_of(dGeomGetPosition(partner.geom));
  const Mat3 turn = matrix_of(dGeomGetRotation(partner.geom));
  // ODE's corners are rounded to single precision before they are placed.
  const double rounding = 1e-6 * (mesh.lower().cwiseAbs().cwiseMax(mesh.upper().cwiseAbs()).maxCoeff() +
                                  1e-6 * place.cwiseAbs().maxCoeff());
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 off = vector_of(found[i]) - place - turn * known[i];
    if ((off.array().abs() <= rounding).all()) continue;
    partner.deformed.store(true, std::memory_order_relaxed);
    return false;
  }
  return true;
}

GeomData* mesh_of_partner(dGeomID geom, volume::Kind volume) noexcept {
  Partner* partner = partner_table().find(geom);
  if (partner == nullptr && partner_table().knows_another(geom)) {
    count(statistics().changed_partners);
    return nullptr;
  }
  if (partner == nullptr && dGeomGetClass(geom) == dTriMeshClass) {
    oddsBuildParams params;
    oddsBuildParamsInit(&params);
    params.volume = static_cast<int>(volume);
    partner = adopt_trimesh(geom, &params, false);
    if (partner != nullptr) count(statistics().lazy_partners);
  }
  if (partner == nullptr) return nullptr;
  if (partner->mesh == nullptr) {  // it could not be read
    if (partner->trimesh_data != dGeomTriMeshGetData(geom)) count(statistics().changed_partners);
    return nullptr;
  }
  if (is_unchanged(*partner)) return partner->mesh.get();
  count(statistics().changed_partners);
  return nullptr;
}

}  // namespace odds::ode

int oddsSetStandIn(dGeomID geom, oddsMeshDataID data, int placeable) noexcept {
  using namespace odds::ode;
  const int number = geom != nullptr ? dGeomGetClass(geom) : -1;
  if (number != dTriMeshClass && number != dHeightfieldClass) {
    set_last_error("oddsSetStandIn: a mesh can stand in for a dTriMesh or a heightfield only");
    return 0;
  }
  if (oddsGetClass() < 0 || data == nullptr || data->prepared == nullptr) {
    set_last_error("oddsSetStandIn: the library is not initialised, or the mesh data is null or not built");
    return 0;
  }
  try {
    std::unique_ptr<Partner> partner = make_partner(geom, data->prepared);
    partner->placeable = number == dTriMeshClass || placeable != 0;
    if (number == dTriMeshClass) partner->trimesh_data = dGeomTriMeshGetData(geom);
    if (number == dHeightfieldClass) partner->heightfield_data = dGeomHeightfieldGetHeightfieldData(geom);
    partner_table().put(std::move(partner));
    return 1;
  } catch (...) {
    set_last_error("oddsSetStandIn: out of memory");
    return 0;
  }
}

int oddsForgetGeom(dGeomID geom) noexcept {
  if (odds::ode::partner_table().forget(geom)) return 1;
  odds::ode::set_last_error("oddsForgetGeom: nothing is known about this geom");
  return 0;
}
