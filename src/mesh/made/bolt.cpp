#include "odds/mesh/made/bolt.hpp"

#include <algorithm>
#include <array>

#include "mesh/made/parameters.hpp"
#include "mesh/made/thread.hpp"

namespace odds::mesh::made {

std::span<const Field<Bolt>> Bolt::fields() {
  static constexpr std::array<Field<Bolt>, 7> list = {
      {{"diameter", &Bolt::diameter, 1e-5, 10.0, "nominal, metres"},
       {"pitch", &Bolt::pitch, 1e-6, 3.0, "metres, at most a third of the diameter"},
       {"length", &Bolt::length, 1e-6, 3e3, "of the thread, metres, 1 to 1000 pitches"},
       {"head", &Bolt::head, 1e-6, 10.0, "height of the head, metres"},
       {"across_flats", &Bolt::across_flats, 1e-5, 100.0, "of the hexagon, metres"},
       {"around", &Bolt::around, 12, 1200, "facets around, a multiple of 6"},
       {"rows", &Bolt::rows, 1, 16, "rows of facets on each crest, flank and root"}}};
  return list;
}

Result<TriangleMesh> make(const Bolt& shape) {
  if (auto error = out_of_range(shape)) return *std::move(error);
  if (auto fault = thread_fault(shape.diameter, shape.pitch, shape.length, shape.across_flats, shape.around)) {
    return refuse(shape, fault->first, fault->second);
  }
  Surface surface;
  const ThreadProfile profile{shape.diameter, shape.pitch, 0.0};
  const double tip = profile.least() - 0.1 * shape.pitch;
  const ThreadEnds thread = add_thread(surface, profile, shape.length, shape.around, shape.rows, false,
                                       [&](double z, double radius) { return std::min(radius, tip + z); });
  const double top = shape.length + shape.head;
  const Ring under = add_hexagon(surface, shape.across_flats, shape.length, shape.around);
  const Ring over = add_hexagon(surface, shape.across_flats, top, shape.around);
  surface.fan(surface.add({0.0, 0.0, 0.0}), thread.low, true);
  surface.connect(thread.high, under);
  surface.connect(under, over);
  surface.fan(surface.add({0.0, 0.0, top}), over, false);
  return surface.finish(title(shape));
}

}  // namespace odds::mesh::made
