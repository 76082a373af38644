// What the library keeps about geoms of ODE's own classes: the mesh that stands in for one, or its convex shape.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>

#include "ode/geom/convex_shape.hpp"
#include "ode/geom/geom_data.hpp"

namespace odds::ode {

struct Partner {
  dGeomID geom = nullptr;
  std::unique_ptr<GeomData> mesh;             ///< stands in for the geom; null for a convex shape
  std::shared_ptr<const ConvexShape> convex;  ///< null for a mesh
  dTriMeshDataID trimesh_data = nullptr;      ///< what `mesh` was read from, if it was read from the geom
  bool placeable = true;                      ///< false: a geom without a pose (only heightfields can be)
  std::atomic<std::uint32_t> next_check{0};   ///< triangle to compare with ODE's at the next collision
  std::atomic<bool> deformed{false};          ///< one was found elsewhere, or the client has said so
  std::atomic<Partner*> next{nullptr};        ///< in its bucket
};

/// `find` runs in the loop, wait-free, also while another thread inserts. `put` of a known geom, `forget` and `clear`
/// must not run while another thread collides that geom.
class PartnerTable {
 public:
  [[nodiscard]] Partner* find(dGeomID geom) const noexcept;
  /// Takes the place of what is known about that geom, whose pair workspaces are freed. May throw.
  Partner* put(std::unique_ptr<Partner> partner);
  /// As put, but leaves what is known about that geom and returns it. May throw.
  Partner* put_new(std::unique_ptr<Partner> partner);
  /// False if nothing is known about the geom.
  bool forget(dGeomID geom) noexcept;
  void clear() noexcept;
  /// The vertices of this data were moved: no partner that was read from it answers any more until it is read again.
  /// Not while another thread collides.
  void note_deformed(dTriMeshDataID data) noexcept;

 private:
  static constexpr std::size_t bucket_count = 4096;
  using Bucket = std::atomic<Partner*>;

  [[nodiscard]] static std::size_t bucket_of(dGeomID geom) noexcept;
  bool remove(dGeomID geom) noexcept;
  Partner* insert(std::unique_ptr<Partner> partner) noexcept;

  std::array<Bucket, bucket_count> buckets_ = {};
  std::mutex writers_;
};

[[nodiscard]] PartnerTable& partner_table() noexcept;

/// The settings of geoms that stand in for others: they leave every decision to the other geom of a pair. A takeover
/// changes them for the geoms adopted from then on.
[[nodiscard]] Settings& partner_settings() noexcept;
/// What they are without a takeover.
[[nodiscard]] Settings neutral_settings() noexcept;

/// A partner with a mesh and these settings, not yet in the table. May throw std::bad_alloc.
[[nodiscard]] std::unique_ptr<Partner> make_partner(dGeomID geom, std::shared_ptr<const PreparedMesh> mesh);

/// Whether the geom is still the one that was read: the same data, as many triangles, and the next of them where it
/// was, and every one that was compared before. A geom that was destroyed, and another that was made at its address, or
/// a mesh that was deformed, are found out so.
[[nodiscard]] bool is_unchanged(Partner& partner) noexcept;

/// Reads a dTriMesh, builds its hierarchy (or shares that of another geom of the same data), and puts it into the
/// table, in the place of what is known about the geom, or only if nothing is. Null with the last error set if that
/// fails. Allocates.
Partner* adopt_trimesh(dGeomID trimesh, const oddsBuildParams* params, bool replace) noexcept;

/// The mesh of a dTriMesh or heightfield in a collision, or null: not known and not readable, or changed since. A
/// dTriMesh that nobody prepared is read now, for the bounding volume of the other mesh, and counted (lazy_partners).
[[nodiscard]] GeomData* mesh_of_partner(dGeomID geom, volume::Kind volume) noexcept;

}  // namespace odds::ode
