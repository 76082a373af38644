// What a pair keeps between its construction and its end.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "odds/query/pair.hpp"
#include "query/ending_reserve.hpp"
#include "query/flush/flush_contacts.hpp"
#include "query/known/carried_contacts.hpp"
#include "query/known/corner_contacts.hpp"
#include "query/known/hasty_memory.hpp"
#include "query/known/known_depth.hpp"
#include "query/known/known_direction.hpp"
#include "query/memory/late_contacts.hpp"
#include "query/memory/near_contacts.hpp"
#include "query/memory/recalibration.hpp"
#include "query/memory/scratch_pool.hpp"
#include "query/memory/within.hpp"
#include "query/search/bottom_slice.hpp"
#include "query/shape_data.hpp"
#include "query/wide/front_worth.hpp"
#include "query/wide/searches.hpp"

namespace odds::query {

/// Entries of a front between two shapes: no more than there are pairs of nodes and leaves.
[[nodiscard]] inline std::uint32_t front_capacity(const Shape& a, const Shape& b, std::uint32_t most) noexcept {
  const auto* const tree_a = std::get_if<tree::WideTree>(&a.data().tree);
  const auto* const tree_b = std::get_if<tree::WideTree>(&b.data().tree);
  if (tree_a == nullptr || tree_b == nullptr) return 1;  // the generic framework has its bottom slice
  const std::size_t places_a = tree_a->node_count() + tree_a->leaf_count();
  const std::size_t places_b = tree_b->node_count() + tree_b->leaf_count();
  const std::size_t possible = places_a <= most && places_b <= most ? places_a * places_b : most;
  return static_cast<std::uint32_t>(std::clamp<std::size_t>(possible, 64, most));
}

/// When a search found nothing to meet but flat faces that lie on each other.
struct NothingBeside {
  math::Pose pose;               ///< PosedMeshes::pose()
  std::uint32_t lost_faces = 0;  ///< FlushContacts::lost(): what is forgotten since would have been found
};

/// What one run leaves for the next, its part in the memory that runs work in, and the last answer.
struct Pair::Implementation {
  Implementation(std::shared_ptr<const Shape> shape_a, std::shared_ptr<const Shape> shape_b, const PairOptions& options)
      : a(std::move(shape_a)),
        b(std::move(shape_b)),
        scratch({options.queue_capacity, options.hit_capacity}),
        hits(options.hit_capacity),
        slice(a->volume() == volume::Kind::wide ? 1 : options.slice_capacity),
        front(front_capacity(*a, *b, options.slice_capacity)),
        wide(wide::searches_for(options.instruction_set)),
        polygon_free(!a->has_polygons() || !b->has_polygons()) {}
  /// For exact searches alone, in memory that is lent for each.
  struct Worker {};
  Implementation(Worker, std::shared_ptr<const Shape> shape_a, std::shared_ptr<const Shape> shape_b,
                 const PairOptions& options)
      : a(std::move(shape_a)),
        b(std::move(shape_b)),
        hits(options.hit_capacity),
        slice(1),
        front(1),
        wide(wide::searches_for(options.instruction_set)),
        polygon_free(false) {}

  std::shared_ptr<const Shape> a;
  std::shared_ptr<const Shape> b;
  // Every query asks for them.
  double size_a = a->mesh().size();  ///< metres
  double size_b = b->mesh().size();
  SharedScratch scratch;
  HitList hits;
  BottomSlice slice;         ///< of the incremental method with volumes of the generic framework
  wide::KineticFront front;  ///< of the same with the wide engine
  wide::FrontWorth front_worth;
  wide::Sweep sweep;  ///< of searches from the roots that short budgets end
  bool has_witness = false;
  TrianglePair witness;  ///< the pair of triangles that proved the last incremental hit
  const wide::Searches* wide;
  Within within = Within::neither;              ///< as last looked at, where no surfaces met
  bool within_is_of_front = false;              ///< that was where the front is, and no run has been elsewhere since
  bool polygon_free;                            ///< every query has to be
  Recalibration recalibration;                  ///< of stated probabilities
  Vec3 previous_normal = Vec3::Zero();          ///< of the last run's first contact, in A's frame; zero: none
  Vec3 previous_position = Vec3::Zero();        ///< of that contact
  FlushContacts flush;                          ///< of flat faces that lie on each other
  std::optional<NothingBeside> nothing_beside;  ///< but those faces
  HastyMemory haste;                            ///< of contacts that are guessed
  CornerContacts corners;                       ///< beside those
  bool haste_has_begun = false;                 ///< in this run
  std::uint32_t hasty_runs = 0;                 ///< that guessed or might have
  Vec3 came = Vec3::Zero();  ///< how B came to where it met A since they were apart, unit, A's frame; zero: unknown
  std::optional<math::Pose> apart_at;  ///< PosedMeshes::pose() when they were apart last; none: they touched since
  std::optional<math::Pose> known_at;  ///< the same of the last run, or of a later word that they were apart
  bool apart_last = false;             ///< they were apart there
  KnownDepth known_depth;
  KnownDirection known_direction;
  CarriedContacts carried;
  NearContacts near;
  EndingReserves endings;
  std::unique_ptr<LateContacts> late;           ///< or null
  std::array<Contact, most_contacts> contacts;  ///< the answer's
  Answer answer;
};

/// Of both bodies, metres.
[[nodiscard]] inline double smaller_size(const Pair::Implementation& pair) noexcept {
  return std::min(pair.size_a, pair.size_b);
}

/// Of the smaller body, as the larger one sees it: a large one that turns, or one far from its origin, carries that of
/// its own frame far, and the bodies have hardly moved. `pose`: PosedMeshes::pose().
[[nodiscard]] inline Vec3 centre_of_smaller(const math::Pose& pose, const Pair::Implementation& pair) noexcept {
  return pair.size_b <= pair.size_a ? pose.translation : pose.inverse().translation;
}

/// The pair's memory for as many contacts as are asked for.
[[nodiscard]] inline std::span<Contact> room_for_contacts(const Request& request, Pair::Implementation& pair) noexcept {
  return std::span(pair.contacts).first(std::min(static_cast<std::size_t>(request.max_contacts), pair.contacts.size()));
}

/// Pair::run of what is private.
void run_pair(Pair::Implementation& pair, const math::Pose& pose_b_in_a, const Request& request) noexcept;

}  // namespace odds::query
