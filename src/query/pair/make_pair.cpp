// A pair's construction: what it is asked for is looked at, and all memory taken that its queries need.
#include <memory>
#include <string>
#include <utility>

#include "odds/query/pair.hpp"
#include "odds/realtime/clock.hpp"
#include "query/memory/pair_memory.hpp"
#include "query/shape_data.hpp"

namespace odds::query {

Result<Pair> Pair::make(std::shared_ptr<const Shape> a, std::shared_ptr<const Shape> b, const PairOptions& options) {
  if (!a || !b) return Error{"", "", "a pair needs two shapes", "build both shapes first"};
  if (a->volume() != b->volume()) {
    return Error{b->mesh().name(), "",
                 "its bounding volume is " + std::string(volume::name(b->volume())) + ", but that of " +
                     a->mesh().name() + " is " + std::string(volume::name(a->volume())),
                 "build both shapes with the same volume"};
  }
  if (options.queue_capacity < 64 || options.queue_capacity > (1U << 20U)) {
    return Error{"", "", "queue_capacity is " + std::to_string(options.queue_capacity), "choose 64 to 1048576"};
  }
  if (options.hit_capacity < 8 || options.hit_capacity > 65536) {
    return Error{"", "", "hit_capacity is " + std::to_string(options.hit_capacity), "choose 8 to 65536"};
  }
  if (options.slice_capacity < 64 || options.slice_capacity > (1U << 24U)) {
    return Error{"", "", "slice_capacity is " + std::to_string(options.slice_capacity), "choose 64 to 16777216"};
  }
  if (options.calibration_poses > 1'000'000) {
    return Error{"", "", "calibration_poses is " + std::to_string(options.calibration_poses), "choose 0 to 1000000"};
  }
  if (options.calibration_poses > 0 && !(a->has_polygons() && b->has_polygons())) {
    return Error{a->has_polygons() ? b->mesh().name() : a->mesh().name(), "",
                 "without polygons nothing is proved that odds could be learnt from",
                 "choose calibration_poses (--calibrate) 0, or shapes with polygons"};
  }
  if (wide::searches_for(options.instruction_set) == nullptr) {
    return Error{"", "", "this processor, or this build, lacks the instructions asked for",
                 "choose InstructionSet::best"};
  }
  static_cast<void>(realtime::fastest_clock());  // calibrates now, so that no query has to
  const bool may_be_late = options.late_contacts && a->has_polygons() && b->has_polygons();
  auto late = may_be_late ? std::make_unique<LateContacts>(a, b, options) : nullptr;
  Pair pair(std::make_unique<Implementation>(std::move(a), std::move(b), options));
  if (late) {
    Implementation& made = *pair.implementation_;
    made.flush = FlushContacts(made.a->data().flat_faces(), made.b->data().flat_faces(), made.wide->patch);
  }
  pair.implementation_->late = std::move(late);
  // Once through what a query ends with, so that the first real one does not wait for pages of code. How long that took
  // says nothing of other endings, and would differ from run to run.
  Request first;
  first.budget = {.microseconds = 1.0, .work_units = 64};
  first.max_contacts = 0;
  static_cast<void>(pair.run({}, first));
  pair.reset();
  pair.implementation_->endings = {};
  if (options.calibration_poses > 0) {
    pair.implementation_->recalibration = learn_recalibration(pair, options.calibration_poses);
    pair.reset();
  }
  return pair;
}

}  // namespace odds::query
