// From intersecting triangle pairs to a few good contacts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "odds/math/pose.hpp"
#include "odds/math/types.hpp"
#include "odds/mesh/triangle_mesh.hpp"
#include "odds/query/answer.hpp"
#include "odds/query/deadline.hpp"

namespace odds::query {

namespace patch {
struct Kernels;  // private to src/query
}

constexpr int most_contacts =
    8;  ///< of one pair; more cost a solver more than they give (ODE's exact step grows cubically)

/// Two triangles that intersect or touch: indices into the two meshes.
struct TrianglePair {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
};

/// A ray cast into one mesh, so that the depth inside the rim of a deep overlap is measured and not guessed from the
/// triangles at its rim. Null: not available.
struct DepthProbe {
  /// Finds the surface crossing nearest to `origin` along the unit vector `direction`, both in the mesh's own frame, at
  /// a distance in [0, max_distance]; writes distance (metres) and triangle and returns true, or returns false.
  bool (*ray)(const void* self, const Vec3& origin, const Vec3& direction, double max_distance, double* distance,
              std::uint32_t* triangle) noexcept = nullptr;
  const void* self = nullptr;

  explicit operator bool() const noexcept { return ray != nullptr; }
};

/// A ray for a probe, in that mesh's own frame, and what it found.
struct ProbeRay {
  Vec3 origin = Vec3::Zero();
  Vec3 direction = Vec3::UnitX();  ///< unit
  double max_distance = 0.0;       ///< metres
  bool found = false;
  double distance = 0.0;  ///< metres, in [0, max_distance]
  std::uint32_t triangle = 0;
};

/// What contacts are made from. All points in A's mesh frame and metres, except B's vertices, which are in B's own
/// frame.
struct PatchInput {
  std::span<const TrianglePair> hits;  ///< in the order found; may be a part of all pairs if a budget was short
  std::span<const Vec3> vertices_a;
  std::span<const mesh::Triangle> triangles_a;
  std::span<const Vec3> vertices_b;  ///< B's own frame
  std::span<const mesh::Triangle> triangles_b;
  math::Pose pose_b_in_a;
  bool solid_a = false;                     ///< closed and consistently oriented outwards; otherwise a two-sided sheet
  bool solid_b = false;                     ///< the same for B
  bool found_all = false;                   ///< the hits are all pairs that meet: a rim ends only where a sheet does
  Vec3 reference_a = Vec3::Zero();          ///< centre of A's body; says on which side of a sheet the bodies are
  Vec3 reference_b = Vec3::Zero();          ///< centre of B's body, in A's frame
  const Vec3* previous_normal = nullptr;    ///< unit; the first contact's normal of the last run, in A's frame, or null
  const Vec3* previous_position = nullptr;  ///< where that contact was, in A's frame, or null
  /// How B came to where it met A, unit, in A's frame, or null: it stays on its side of a sheet.
  const Vec3* came = nullptr;
  /// Direction of the last patch of bodies that have hardly moved since, or null: that of a patch made in a hurry.
  const Vec3* known_normal = nullptr;
  /// Where the hits are a part of all pairs: how deep the bodies are believed to be in each other, metres. What is left
  /// of a rim, and no deeper than that along the known normal, or that on which most of the rim agrees, has that
  /// direction. 0: the hits are all, and what else there is of the rim says how deep.
  double believed_depth = 0.0;
  std::uint32_t most_pairs = 65536;  ///< of the hits; of more, a sample is taken that is spread over all
  int max_contacts = 4;              ///< 1 .. most_contacts (clamped)
  DepthProbe probe_a;                ///< optional
  DepthProbe probe_b;                ///< optional
  /// Casts a ray with the probe of A and one with that of B in less time than one after the other takes, or null. Finds
  /// what `DepthProbe::ray` of each does.
  void (*probe_both)(const DepthProbe& a, ProbeRay& ray_a, const DepthProbe& b, ProbeRay& ray_b) noexcept = nullptr;
  /// Of the instruction set that a pair runs on, or null: of the best. All give the same bits.
  const patch::Kernels* kernels = nullptr;
};

/// Makes contacts: at most eight, one normal per patch, the deepest first, then those that span the largest area, so
/// that every prefix is a usable set.
///
/// The normal of a patch is the vector area of the rim (the closed curve in which the two surfaces cross). By Stokes'
/// theorem it is the exact area-weighted mean of the normals of B's surface inside A, and minus that of A's inside B:
/// the direction along which a translation of A reduces the common volume fastest. It needs the rim only, does not
/// depend on how the surfaces are cut into triangles, is the face normal for a vertex or a face on a face, and the
/// cross product of the edges for an edge on an edge. Where the rim is incomplete or has no area, the candidate
/// direction of least overlap is taken; where the hits are a part of all (`believed_depth`), a direction that is known
/// better goes before that.
///
/// Where faces of one body form a concave corner (a floor and its walls, all of one mesh), no direction leads out of
/// one rim over all of them: each face, or each few about an edge, has a patch of its own, of its part of the rim.
///
/// All memory is taken by the constructor; `build` is noexcept and does not allocate, lock, or make a system call. The
/// same input gives the same bits, unless a deadline expires. One builder per thread.
class PatchBuilder {
 public:
  /// Takes up to `hit_capacity` pairs (8 .. 65536, clamped); further ones in the input are left out. May throw
  /// bad_alloc.
  explicit PatchBuilder(std::size_t hit_capacity);
  ~PatchBuilder();
  PatchBuilder(PatchBuilder&&) noexcept;
  PatchBuilder& operator=(PatchBuilder&&) noexcept;

  /// Contacts in A's mesh frame, valid until the next call. Empty only if no hit has indices in range; every number
  /// finite. After `deadline` has expired it makes one patch of what it has of the rim, hastily: some 20 microseconds
  /// if it is let, and after `last` has expired, too, the best of what it knows by then, within about four.
  [[nodiscard]] std::span<const Contact> build(const PatchInput& input, const Deadline& deadline = {},
                                               const Deadline& last = {}) noexcept;
  /// Whether the last `build` was done before its deadline.
  [[nodiscard]] bool finished() const noexcept;
  /// How many pairs of triangles its contacts were made from.
  [[nodiscard]] std::uint32_t pairs_used() const noexcept;

 private:
  struct Scratch;
  std::unique_ptr<Scratch> scratch_;
};

}  // namespace odds::query
