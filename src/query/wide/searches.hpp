// The searches of the wide engine: exact, time-critical, incremental, nearest points and rays, compiled once for each
// instruction set.
#pragma once

#include <array>
#include <optional>

#include "odds/primitive/triangle_distance.hpp"
#include "odds/query/pair.hpp"
#include "odds/query/ray.hpp"
#include "odds/query/request.hpp"
#include "primitive/watertight_ray.hpp"
#include "query/counted_ray.hpp"
#include "query/patch/eight.hpp"
#include "query/search/search.hpp"
#include "query/wide/encounter.hpp"
#include "query/wide/extents.hpp"
#include "query/wide/half_spaces.hpp"
#include "query/wide/kinetic_front.hpp"
#include "query/wide/known_faces.hpp"
#include "query/wide/many_sides.hpp"
#include "query/wide/near_segment.hpp"
#include "query/wide/outermost.hpp"
#include "query/wide/sweep.hpp"

namespace odds::query::wide {

/// Whether a search from the roots can find more than what earlier runs have left, where that does not last. With less
/// it hardly gets to any leaves.
[[nodiscard]] inline bool is_enough_from_roots(const Budget& budget) noexcept {
  return budget.work_units >= 500 && budget.microseconds >= 25.0;
}

/// All that a search reads and writes.
struct Task {
  const Encounter& encounter;
  const Request& request;
  std::uint32_t wanted;  ///< hits after which the search may stop
  BucketQueue* queue;    ///< of the time-critical search; others need none
  HitList& hits;         ///< triangles by their indices in the meshes
  Spending& spending;
  SearchResult& result;
  /// Of the incremental search: as many hits of what met before stand for all of it, and half as much work again goes
  /// to what may have begun to meet.
  std::uint32_t sample = no_feature;
  std::uint32_t apart = 0;  ///< exact tests so far of triangles that do not meet
  Sweep* sweep = nullptr;   ///< of a search in instalments
};

/// The same for the distance.
struct NearestTask {
  const Encounter& encounter;
  Spending& spending;
  double bound;  ///< what is not nearer is of no interest, metres; sinks to the distance of the nearest points found
  double lower = 0.0;     ///< proved, if the search did not finish
  bool finished = false;  ///< nothing nearer than `bound` exists
  bool found = false;
  primitive::ClosestPoints points = {};  ///< in A's tree frame, if found
  TrianglePair triangles = {};
};

/// The first crossing of a ray with one tree, of those farther than `after`.
struct RayTask {
  const mesh::TriangleMesh& mesh;
  const tree::WideTree& tree;
  Vec3 origin;     ///< tree's frame, metres
  Vec3 direction;  ///< unit
  double length;   ///< finite, metres
  RayAllowance allowance;
  RayEffort& effort;  ///< what it took
  /// The same ray in the mesh's frame, where it is to slip through no edge; null: crossings are those of
  /// primitive::distance_along_ray.
  const primitive::WatertightRay* watertight = nullptr;
  double after = -1.0;  ///< metres; as long as that is negative, also at 0
};

using RayHits = std::array<std::optional<RayHit>, 2>;

/// A leaf, its parent and the parent of that; the root repeats where there are fewer.
using SlotsAbout = std::array<tree::Slot, 3>;

/// In the frame of the tree.
struct Place {
  const tree::WideTree& tree;
  Vec3f at;
};

/// One instruction set's searches. Each of two trees starts from the pair of roots, which is known to overlap.
struct Searches {
  const char* instruction_set;
  void (*exact)(Task& task) noexcept;
  void (*time_critical)(Task& task) noexcept;
  /// From what the front knows; the front has been moved to the encounter's pose.
  void (*incremental)(Task& task, KineticFront& front) noexcept;
  /// What meets beside faces that are known; within the spending's start.
  void (*beside_faces)(Task& task, const KnownFaces& faces) noexcept;
  /// The nearest points; the bodies may be apart.
  void (*nearest)(NearestTask& task) noexcept;
  std::optional<RayHit> (*ray)(const RayTask& task) noexcept;
  RayHits (*two_rays)(const RayTask& first, const RayTask& second) noexcept;
  /// The leaves that places in two trees belong to, and the next larger nodes about them.
  std::array<SlotsAbout, 2> (*slots_about)(const Place& a, const Place& b) noexcept;
  /// What of a node, of a leaf, is within half-spaces.
  void (*children_within)(const tree::WideNode& node, const HalfSpaces& spaces, HalfSpaces::Sides sides,
                          LanesWithin& within) noexcept;
  void (*triangles_within)(const tree::WideLeaf& leaf, unsigned count, const Vec3f& center, const HalfSpaces& spaces,
                           HalfSpaces::Sides sides, LanesWithin& within) noexcept;
  /// How far what is in a node, in a leaf, reaches along a direction.
  void (*extents_of_children)(const tree::WideNode& node, const Vec3f& direction, Extents& extents) noexcept;
  void (*extents_of_triangles)(const tree::WideLeaf& leaf, const Vec3f& center, const Vec3f& direction,
                               Extents& extents) noexcept;
  /// How near what is in a node, in a leaf, may be to a segment.
  void (*children_near)(const tree::WideNode& node, const SegmentInTree& segment, float (&least)[tree::wide_lanes],
                        float (&by_boxes)[tree::wide_lanes]) noexcept;
  void (*triangles_near)(const tree::WideLeaf& leaf, unsigned count, const Vec3f& from, const SegmentInTree& segment,
                         float (&least)[tree::wide_lanes]) noexcept;
  /// Which of a body's many sides a ball is not wholly within, and the way out of the body.
  bool (*sides_near)(std::span<const EightSides> sides, const Vec3& center, double radius,
                     std::uint8_t* lanes) noexcept;
  double (*way_out)(std::span<const EightSides> sides, const Vec3& point, const Vec3& direction) noexcept;
  /// The outermost of points along a direction, from a point across a direction.
  std::uint32_t (*outermost_along)(std::span<const EightPoints> points, const Vec3& direction, double per_depth,
                                   double least_depth, std::size_t step) noexcept;
  std::uint32_t (*outermost_from)(std::span<const EightPoints> points, const Vec3& from, const Vec3& normal,
                                  double per_depth, double least_depth, std::size_t step) noexcept;
  patch::Kernels patch;
};

/// Null where the program was not built with them.
[[nodiscard]] const Searches* avx2_searches() noexcept;
[[nodiscard]] const Searches* avx512_searches() noexcept;
/// Null where the program was not built with them or this processor lacks them.
[[nodiscard]] const Searches* searches_for(InstructionSet set) noexcept;

}  // namespace odds::query::wide
