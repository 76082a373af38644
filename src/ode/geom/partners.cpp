// Finding, adding and forgetting partners.
#include "ode/geom/partners.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include "ode/geom/pair_table.hpp"
#include "ode/last_error.hpp"
#include "ode/mesh/mesh_data.hpp"
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

PartnerTable& partner_table() noexcept {
  static PartnerTable only;
  return only;
}

std::size_t PartnerTable::bucket_of(dGeomID geom) noexcept {
  auto key = static_cast<std::uint64_t>(reinterpret_cast<std::uintptr_t>(geom));
  key = (key >> 4) * 0x9e3779b97f4a7c15u;
  return static_cast<std::size_t>((key >> 40) % bucket_count);
}

Partner* PartnerTable::find(dGeomID geom) const noexcept {
  Partner* partner = buckets_[bucket_of(geom)].load(std::memory_order_acquire);
  while (partner != nullptr && partner->geom != geom) partner = partner->next.load(std::memory_order_acquire);
  return partner;
}

bool PartnerTable::remove(dGeomID geom) noexcept {
  Bucket* link = &buckets_[bucket_of(geom)];
  while (Partner* here = link->load(std::memory_order_relaxed)) {
    if (here->geom == geom) {
      link->store(here->next.load(std::memory_order_relaxed), std::memory_order_release);
      if (here->mesh != nullptr) pair_table().forget(*here->mesh);
      delete here;
      statistics().live_partners.fetch_sub(1, std::memory_order_relaxed);
      return true;
    }
    link = &here->next;
  }
  return false;
}

Partner* PartnerTable::insert(std::unique_ptr<Partner> partner) noexcept {
  Bucket& bucket = buckets_[bucket_of(partner->geom)];
  partner->next.store(bucket.load(std::memory_order_relaxed), std::memory_order_relaxed);
  bucket.store(partner.get(), std::memory_order_release);
  count(statistics().live_partners);
  return partner.release();
}

Partner* PartnerTable::put(std::unique_ptr<Partner> partner) {
  const std::lock_guard lock(writers_);
  remove(partner->geom);
  return insert(std::move(partner));
}

Partner* PartnerTable::put_new(std::unique_ptr<Partner> partner) {
  const std::lock_guard lock(writers_);
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
    for (Bucket& bucket : buckets_) {
      while (const Partner* first = bucket.load(std::memory_order_relaxed)) remove(first->geom);
    }
  } catch (...) {
    count(statistics().caught);
  }
}

void PartnerTable::note_deformed(dTriMeshDataID data) noexcept {
  for (const Bucket& bucket : buckets_) {
    for (Partner* here = bucket.load(std::memory_order_acquire); here != nullptr;
         here = here->next.load(std::memory_order_acquire)) {
      if (here->trimesh_data == data) here->deformed.store(true, std::memory_order_relaxed);
    }
  }
}

std::unique_ptr<Partner> make_partner(dGeomID geom, std::shared_ptr<const PreparedMesh> mesh) {
  auto partner = std::make_unique<Partner>();
  partner->geom = geom;
  partner->mesh = std::make_unique<GeomData>();
  partner->mesh->mesh = std::move(mesh);
  partner->mesh->settings = partner_settings();
  partner->mesh->number = next_geom_number();
  return partner;
}

bool is_unchanged(Partner& partner) noexcept {
  if (partner.trimesh_data == nullptr) return true;
  const mesh::TriangleMesh& mesh = partner.mesh->mesh->mesh();
  const std::size_t triangles = mesh.triangles().size();
  if (dGeomTriMeshGetData(partner.geom) != partner.trimesh_data) return false;
  if (dGeomTriMeshGetTriangleCount(partner.geom) != static_cast<int>(triangles)) return false;
  // A mesh with one moved corner must not answer from what it was wherever the compared triangle is another's.
  if (partner.deformed.load(std::memory_order_relaxed)) return false;
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
  if (partner == nullptr && dGeomGetClass(geom) == dTriMeshClass) {
    oddsBuildParams params;
    oddsBuildParamsInit(&params);
    params.volume = static_cast<int>(volume);
    partner = adopt_trimesh(geom, &params, false);
    if (partner != nullptr) count(statistics().lazy_partners);
  }
  if (partner == nullptr || partner->mesh == nullptr) return nullptr;
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
