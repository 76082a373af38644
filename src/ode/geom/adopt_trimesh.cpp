// Reading the triangles of a dTriMesh geom back through ODE's public interface.
#include <algorithm>
#include <array>
#include <exception>
#include <map>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "ode/geom/partners.hpp"
#include "ode/last_error.hpp"
#include "ode/mesh/mesh_data.hpp"
#include "ode/statistics.hpp"
#include "ode/vectors.hpp"

namespace odds::ode {
namespace {

struct IndexedMesh {
  std::vector<Vec3> vertices;
  std::vector<mesh::Triangle> triangles;
};

// A preload library hears of the second geom, too, and must not prepare it: that waits for this thread.
thread_local bool is_reading = false;

bool is_at_identity(dGeomID geom) noexcept {
  const dReal* position = dGeomGetPosition(geom);
  const dReal* rotation = dGeomGetRotation(geom);
  for (int row = 0; row < 3; ++row) {
    if (position[row] != 0) return false;
    for (int column = 0; column < 3; ++column) {
      if (rotation[4 * row + column] != (row == column ? 1 : 0)) return false;
    }
  }
  return true;
}

// dGeomTriMeshGetTriangle answers in the world frame. A geom at the identity gives the mesh frame without a rounding
// transform: the client's own where it stands there, as a new one does, else a second one on the same data. ODE keeps
// the pose record of the geom that was destroyed last for the next one, and a client may count on finding its own
// there (DART 6.12 reads a geom's pose after dGeomSetBody has given it up): a copy would take its place.
class AtIdentity {
 public:
  explicit AtIdentity(dGeomID trimesh) : copied_(!is_at_identity(trimesh)), id_(trimesh) {
    is_reading = true;
    if (copied_) id_ = dCreateTriMesh(nullptr, dGeomTriMeshGetData(trimesh), nullptr, nullptr, nullptr);
  }
  AtIdentity(const AtIdentity&) = delete;
  AtIdentity& operator=(const AtIdentity&) = delete;
  ~AtIdentity() {
    if (copied_) dGeomDestroy(id_);
    is_reading = false;
  }
  [[nodiscard]] dGeomID id() const noexcept { return id_; }

 private:
  bool copied_;
  dGeomID id_;
};

// Equal corners become one vertex again. What is not a number is in no order, and stays what it is, to be refused.
IndexedMesh read_triangles(dGeomID trimesh) {
  const AtIdentity source(trimesh);
  IndexedMesh result;
  std::map<std::array<double, 3>, std::uint32_t> index_of;
  const int count = dGeomTriMeshGetTriangleCount(source.id());
  result.triangles.reserve(static_cast<std::size_t>(std::max(count, 0)));
  for (int t = 0; t < count; ++t) {
    std::array<dVector3, 3> corners;
    dGeomTriMeshGetTriangle(source.id(), t, &corners[0], &corners[1], &corners[2]);
    mesh::Triangle triangle;
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3 corner = vector_of(corners[c]);
      const auto next = static_cast<std::uint32_t>(result.vertices.size());
      triangle[c] =
          corner.allFinite() ? index_of.try_emplace({corner.x(), corner.y(), corner.z()}, next).first->second : next;
      if (triangle[c] == next) result.vertices.push_back(corner);
    }
    result.triangles.push_back(triangle);
  }
  return result;
}

bool has_triangles(dGeomID geom) noexcept {
  return geom != nullptr && dGeomGetClass(geom) == dTriMeshClass && dGeomTriMeshGetData(geom) != nullptr &&
         dGeomTriMeshGetTriangleCount(geom) > 0;
}

struct KnownMesh {
  std::weak_ptr<const PreparedMesh> prepared;
  oddsBuildParams asked;                     // without a name
  std::shared_ptr<const PreparedMesh> kept;  // null, or the same
};

struct KnownMeshes {
  std::mutex mutex;
  std::map<dTriMeshDataID, KnownMesh> of_data;
  bool keep = false;
};

KnownMeshes& known_meshes() noexcept {
  static KnownMeshes& only = *new KnownMeshes;  // outlives what is static: that may still make geoms, or look at them
  return only;
}

bool is_alike(const oddsBuildParams& a, const oddsBuildParams& b) noexcept {
  return a.volume == b.volume && a.leaf_triangles == b.leaf_triangles && a.tau == b.tau;
}

// Geoms of the same data share one hierarchy. The data's address alone says little: it may be that of other data now.
std::shared_ptr<const PreparedMesh> prepared_like_before(dGeomID trimesh, const oddsBuildParams& params,
                                                         const KnownMeshes& known) {
  const auto found = known.of_data.find(dGeomTriMeshGetData(trimesh));
  if (found == known.of_data.end() || !is_alike(found->second.asked, params)) return nullptr;
  std::shared_ptr<const PreparedMesh> prepared = found->second.prepared.lock();
  if (prepared == nullptr) return nullptr;
  const std::size_t count = prepared->mesh().triangles().size();
  if (dGeomTriMeshGetTriangleCount(trimesh) != static_cast<int>(count)) return nullptr;
  const AtIdentity source(trimesh);
  for (std::uint32_t t = 0; t < count; ++t) {
    std::array<dVector3, 3> now;
    dGeomTriMeshGetTriangle(source.id(), static_cast<int>(t), &now[0], &now[1], &now[2]);
    const std::array<Vec3, 3> before = prepared->corners(t);
    for (std::size_t c = 0; c < 3; ++c) {
      if (before[c] != vector_of(now[c])) return nullptr;
    }
  }
  return prepared;
}

std::shared_ptr<const PreparedMesh> prepare(dGeomID trimesh, const oddsBuildParams& params) {
  KnownMeshes& known = known_meshes();
  const std::lock_guard lock(known.mutex);
  std::erase_if(known.of_data, [](const auto& entry) { return entry.second.prepared.expired(); });
  if (auto prepared = prepared_like_before(trimesh, params, known)) return prepared;
  IndexedMesh mesh = read_triangles(trimesh);
  oddsMeshData data;
  if (build_mesh_data(&data, std::move(mesh.vertices), std::move(mesh.triangles), &params) == 0) return nullptr;
  known.of_data[dGeomTriMeshGetData(trimesh)] = {
      data.prepared, {params.volume, params.leaf_triangles, params.tau, nullptr}, known.keep ? data.prepared : nullptr};
  return data.prepared;
}

// So that not every collision tries to read it again.
void note_unreadable(dGeomID trimesh) {
  auto partner = std::make_unique<Partner>(trimesh);
  partner->trimesh_data = dGeomTriMeshGetData(trimesh);
  partner_table().put_new(std::move(partner));
}

}  // namespace

bool is_reading_trimesh() noexcept { return is_reading; }

void note_destroyed(dTriMeshDataID data) noexcept {
  try {
    KnownMeshes& known = known_meshes();
    const std::lock_guard lock(known.mutex);
    known.of_data.erase(data);
  } catch (...) {
    count(statistics().caught);
  }
}

void keep_hierarchies(bool keep) noexcept {
  try {
    KnownMeshes& known = known_meshes();
    const std::lock_guard lock(known.mutex);
    known.keep = keep;
    for (auto& [data, mesh] : known.of_data) mesh.kept = keep ? mesh.prepared.lock() : nullptr;
  } catch (...) {
    count(statistics().caught);
  }
}

Partner* adopt_trimesh(dGeomID trimesh, const oddsBuildParams* params, bool replace) noexcept {
  if (!has_triangles(trimesh)) {
    set_last_error("not a dTriMesh geom with triangles; make one with dCreateTriMesh");
    return nullptr;
  }
  try {
    oddsBuildParams defaults;
    oddsBuildParamsInit(&defaults);
    defaults.name = "dTriMesh";
    const std::atomic<std::uint64_t>& changes = changes_of(dGeomTriMeshGetData(trimesh));
    const std::uint64_t changes_seen = changes.load(std::memory_order_relaxed);
    auto prepared = prepare(trimesh, params != nullptr ? *params : defaults);
    if (prepared == nullptr) {
      if (!replace) note_unreadable(trimesh);  // else the caller hears of it, and what is known stays
      return nullptr;
    }
    std::unique_ptr<Partner> partner = make_partner(trimesh, std::move(prepared));
    partner->trimesh_data = dGeomTriMeshGetData(trimesh);
    partner->changes = &changes;
    partner->changes_seen = changes_seen;
    return replace ? partner_table().put(std::move(partner)) : partner_table().put_new(std::move(partner));
  } catch (const std::exception& error) {
    set_last_error(std::string_view(error.what()));
  } catch (...) {
    set_last_error("reading a dTriMesh failed");
  }
  return nullptr;
}

}  // namespace odds::ode

int oddsPrepareTriMesh(dGeomID trimesh, const oddsBuildParams* params) noexcept {
  if (oddsGetClass() < 0) {
    odds::ode::set_last_error("oddsPrepareTriMesh: the library is not initialised; call oddsInitODE first");
    return 0;
  }
  return odds::ode::adopt_trimesh(trimesh, params, true) != nullptr ? 1 : 0;
}

int oddsMeshDataBuildFromTriMesh(oddsMeshDataID data, dGeomID trimesh, const oddsBuildParams* params) noexcept {
  using odds::ode::set_last_error;
  if (trimesh == nullptr || dGeomGetClass(trimesh) != dTriMeshClass || dGeomTriMeshGetData(trimesh) == nullptr) {
    set_last_error("oddsMeshDataBuildFromTriMesh: not a dTriMesh geom with data; make one with dCreateTriMesh");
    return 0;
  }
  try {
    odds::ode::IndexedMesh mesh = odds::ode::read_triangles(trimesh);
    return odds::ode::build_mesh_data(data, std::move(mesh.vertices), std::move(mesh.triangles), params);
  } catch (const std::exception& error) {
    set_last_error(std::string_view(error.what()));
  } catch (...) {
    set_last_error("oddsMeshDataBuildFromTriMesh: unknown failure");
  }
  return 0;
}
