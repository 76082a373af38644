// What a pair keeps between its construction and its end.
#pragma once

#include <array>
#include <memory>
#include <optional>

#include "odds/query/pair.hpp"
#include "query/bottom_slice.hpp"
#include "query/carried_contacts.hpp"
#include "query/ending_reserve.hpp"
#include "query/known_depth.hpp"
#include "query/known_direction.hpp"
#include "query/recalibration.hpp"
#include "query/wide/searches.hpp"
#include "query/within.hpp"

namespace odds::query {

/// All scratch memory, and the last answer.
struct Pair::Implementation {
  Implementation(std::shared_ptr<const Shape> shape_a, std::shared_ptr<const Shape> shape_b, const PairOptions& options)
      : a(std::move(shape_a)),
        b(std::move(shape_b)),
        queue(options.queue_capacity),
        hits(options.hit_capacity),
        slice(a->volume() == volume::Kind::wide ? 1 : options.slice_capacity),
        front(a->volume() == volume::Kind::wide ? options.slice_capacity : 1),
        patches(options.hit_capacity),
        wide(wide::searches_for(options.instruction_set)),
        polygon_free(!a->has_polygons() || !b->has_polygons()) {}

  std::shared_ptr<const Shape> a;
  std::shared_ptr<const Shape> b;
  BucketQueue queue;
  HitList hits;
  BottomSlice slice;         ///< of the incremental method with volumes of the generic framework
  wide::KineticFront front;  ///< of the same with the wide engine
  bool has_witness = false;
  TrianglePair witness;  ///< the pair of triangles that proved the last incremental hit
  PatchBuilder patches;
  const wide::Searches* wide;
  Within within = Within::neither;        ///< as last looked at, where no surfaces met
  bool within_is_of_front = false;        ///< that was where the front is, and no run has been elsewhere since
  bool polygon_free;                      ///< every query has to be
  Recalibration recalibration;            ///< of stated probabilities
  Vec3 previous_normal = Vec3::Zero();    ///< of the last run's first contact, in A's frame; zero: none
  Vec3 previous_position = Vec3::Zero();  ///< of that contact
  Vec3 came = Vec3::Zero();  ///< how B came to where it met A since they were apart, unit, A's frame; zero: unknown
  std::optional<math::Pose> apart_at;  ///< PosedMeshes::pose() when they were apart last; none: they touched since
  std::optional<math::Pose> known_at;  ///< the same of the last run, or of a later word that they were apart
  bool apart_last = false;             ///< they were apart there
  KnownDepth known_depth;
  KnownDirection known_direction;
  CarriedContacts carried;
  EndingReserve ending;
  std::array<Contact, most_contacts> rough;  ///< contacts that there was no time to make with care
  Answer answer;
};

}  // namespace odds::query
