// What the library keeps about geoms of ODE's own classes: the mesh that stands in for one, or its convex shape.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>

#include "ode/geom/convex_shape.hpp"
#include "ode/geom/geom_data.hpp"
#include "ode/geom/linked_table.hpp"

namespace odds::ode {

struct Partner {
  explicit Partner(dGeomID known) noexcept : geom(known), geom_class(dGeomGetClass(known)) {}

  dGeomID geom;
  std::unique_ptr<GeomData> mesh;             ///< stands in for the geom
  Settings first_settings;                    ///< what `mesh` had when it was made: its own may be set since
  std::shared_ptr<const ConvexShape> convex;  ///< null for a mesh; of a dTriMesh that cannot be read both are
  dTriMeshDataID trimesh_data = nullptr;      ///< of a dTriMesh, when `mesh` was read from it or set to stand in for it
  dHeightfieldDataID heightfield_data = nullptr;  ///< likewise of a heightfield
  /// How often the client has said that it changed that data, and how often it had when it was read; null: not read.
  const std::atomic<std::uint64_t>* changes = nullptr;
  std::uint64_t changes_seen = 0;
  bool placeable = true;                     ///< false: a geom without a pose (only heightfields can be)
  std::atomic<std::uint32_t> next_check{0};  ///< triangle to compare with ODE's at the next collision
  std::atomic<bool> deformed{false};         ///< one was found elsewhere
  std::atomic<std::uint64_t> good_box{0};    ///< hash of ODE's box around a convex when it was last that of its points
  int geom_class;                            ///< of another, something else is at the geom's address by now
};

/// `find` runs in the loop, without a lock, also while another thread puts or forgets other geoms. `put` of a known
/// geom, `forget` and `clear` must not run while another thread collides that geom.
class PartnerTable {
 public:
  [[nodiscard]] Partner* find(dGeomID geom) const noexcept;
  /// Whether something is known about a geom of another class that was at the address of this one, and not forgotten.
  [[nodiscard]] bool knows_another(dGeomID geom) const noexcept;
  /// Takes the place of what is known about that geom, whose pair workspaces are freed; settings that the client has
  /// made of it stay. May throw.
  Partner* put(std::unique_ptr<Partner> partner);
  /// As put, but leaves what is known about that geom and returns it; null if it is another's. May throw.
  Partner* put_new(std::unique_ptr<Partner> partner);
  /// False if nothing is known about the geom.
  bool forget(dGeomID geom) noexcept;
  void clear() noexcept;

 private:
  [[nodiscard]] static std::uint64_t key_of(dGeomID geom) noexcept;
  bool remove(dGeomID geom) noexcept;
  static void free(Partner* partner) noexcept;
  Partner* insert(std::unique_ptr<Partner> partner);

  LinkedTable<Partner, 4096> partners_;
  std::mutex writers_;
};

/// The counter of what a client says of a dTriMeshData, for all geoms of it; made at the first call. May throw.
[[nodiscard]] std::atomic<std::uint64_t>& changes_of(dTriMeshDataID data);
/// The client has changed this data: no geom that was read from it is what it was.
void note_changed(dTriMeshDataID data) noexcept;
/// The client is about to destroy this data.
void note_destroyed(dTriMeshDataID data) noexcept;

/// True: the hierarchy of data is kept while there is no geom of it, for the next one, until note_destroyed; for a
/// client of which every destruction is heard. False (default): it ends with the last geom.
void keep_hierarchies(bool keep) noexcept;

[[nodiscard]] PartnerTable& partner_table() noexcept;

/// The settings of geoms that stand in for others: they leave every decision to the other geom of a pair. A takeover
/// changes them for the geoms adopted from then on.
[[nodiscard]] Settings& partner_settings() noexcept;
/// What they are without a takeover.
[[nodiscard]] Settings neutral_settings() noexcept;

/// A partner with a mesh and these settings, not yet in the table. May throw std::bad_alloc.
[[nodiscard]] std::unique_ptr<Partner> make_partner(dGeomID geom, std::shared_ptr<const PreparedMesh> mesh);

/// Whether the geom is still the one that was read: the same data, which nobody has said was changed, as many
/// triangles, and the next of them where it was, and every one that was compared before; of a heightfield, the same
/// data; of a convex, the same box. A geom that was destroyed, and another that was made at its address, or a mesh that
/// was deformed, are found out so.
[[nodiscard]] bool is_unchanged(Partner& partner) noexcept;

/// Whether this thread makes a dTriMesh of its own now, to read another one.
[[nodiscard]] bool is_reading_trimesh() noexcept;

/// Reads a dTriMesh, builds its hierarchy (or shares that of another geom of the same data), and puts it into the
/// table, in the place of what is known about the geom, or only if nothing is. Null with the last error set if that
/// fails. Allocates.
Partner* adopt_trimesh(dGeomID trimesh, const oddsBuildParams* params, bool replace) noexcept;

/// The mesh of a dTriMesh or heightfield in a collision, or null: not known and not readable, or changed since. A
/// dTriMesh that nobody prepared is read now, for the bounding volume of the other mesh, and counted (lazy_partners).
[[nodiscard]] GeomData* mesh_of_partner(dGeomID geom, volume::Kind volume) noexcept;

}  // namespace odds::ode
