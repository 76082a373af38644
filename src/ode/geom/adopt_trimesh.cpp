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

namespace odds::ode {
namespace {

struct IndexedMesh {
  std::vector<Vec3> vertices;
  std::vector<mesh::Triangle> triangles;
};

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
  explicit AtIdentity(dGeomID trimesh)
      : copied_(!is_at_identity(trimesh)),
        id_(copied_ ? dCreateTriMesh(nullptr, dGeomTriMeshGetData(trimesh), nullptr, nullptr, nullptr) : trimesh) {}
  AtIdentity(const AtIdentity&) = delete;
  AtIdentity& operator=(const AtIdentity&) = delete;
  ~AtIdentity() {
    if (copied_) dGeomDestroy(id_);
  }
  [[nodiscard]] dGeomID id() const noexcept { return id_; }

 private:
  bool copied_;
  dGeomID id_;
};

// Equal corners become one vertex again.
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
      const std::array<double, 3> key = {corners[c][0], corners[c][1], corners[c][2]};
      const auto [place, added] = index_of.try_emplace(key, static_cast<std::uint32_t>(result.vertices.size()));
      if (added) result.vertices.emplace_back(key[0], key[1], key[2]);
      triangle[c] = place->second;
    }
    result.triangles.push_back(triangle);
  }
  return result;
}

bool has_triangles(dGeomID geom) noexcept {
  return geom != nullptr && dGeomGetClass(geom) == dTriMeshClass && dGeomTriMeshGetData(geom) != nullptr &&
         dGeomTriMeshGetTriangleCount(geom) > 0;
}

// Geoms of the same data share one hierarchy. The data's address alone says little: it may be that of other data now.
std::shared_ptr<const PreparedMesh> prepared_like_before(
    dTriMeshDataID id, const IndexedMesh& mesh, int volume,
    std::map<dTriMeshDataID, std::weak_ptr<const PreparedMesh>>& known) {
  const auto found = known.find(id);
  if (found == known.end()) return nullptr;
  std::shared_ptr<const PreparedMesh> prepared = found->second.lock();
  if (prepared == nullptr || static_cast<int>(prepared->shape->volume()) != volume) return nullptr;
  const bool same = std::ranges::equal(prepared->mesh().vertices(), mesh.vertices) &&
                    std::ranges::equal(prepared->mesh().triangles(), mesh.triangles);
  return same ? prepared : nullptr;
}

std::shared_ptr<const PreparedMesh> prepare(dGeomID trimesh, const oddsBuildParams& params) {
  static std::mutex mutex;
  static std::map<dTriMeshDataID, std::weak_ptr<const PreparedMesh>> known;
  const std::lock_guard lock(mutex);
  std::erase_if(known, [](const auto& entry) { return entry.second.expired(); });
  const dTriMeshDataID id = dGeomTriMeshGetData(trimesh);
  IndexedMesh mesh = read_triangles(trimesh);
  if (auto prepared = prepared_like_before(id, mesh, params.volume, known)) return prepared;
  oddsMeshData data;
  if (build_mesh_data(&data, std::move(mesh.vertices), std::move(mesh.triangles), &params) == 0) return nullptr;
  known[id] = data.prepared;
  return data.prepared;
}

}  // namespace

Partner* adopt_trimesh(dGeomID trimesh, const oddsBuildParams* params, bool replace) noexcept {
  if (!has_triangles(trimesh)) {
    set_last_error("not a dTriMesh geom with triangles; make one with dCreateTriMesh");
    return nullptr;
  }
  try {
    oddsBuildParams defaults;
    oddsBuildParamsInit(&defaults);
    defaults.name = "dTriMesh";
    auto prepared = prepare(trimesh, params != nullptr ? *params : defaults);
    if (prepared == nullptr) return nullptr;
    std::unique_ptr<Partner> partner = make_partner(trimesh, std::move(prepared));
    partner->trimesh_data = dGeomTriMeshGetData(trimesh);
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
