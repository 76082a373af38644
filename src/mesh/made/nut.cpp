#include "odds/mesh/made/nut.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "mesh/made/parameters.hpp"
#include "mesh/made/thread.hpp"

namespace odds::mesh::made {

std::span<const Field<Nut>> Nut::fields() {
  static constexpr std::array<Field<Nut>, 7> list = {
      {{"diameter", &Nut::diameter, 1e-5, 10.0, "nominal, metres"},
       {"pitch", &Nut::pitch, 1e-6, 3.0, "metres, at most a third of the diameter"},
       {"height", &Nut::height, 1e-6, 3e3, "metres, 1 to 1000 pitches"},
       {"across_flats", &Nut::across_flats, 1e-5, 100.0, "of the hexagon, metres"},
       {"clearance", &Nut::clearance, -0.15, 0.3, "to the bolt, metres, -0.05 to 0.1 pitches"},
       {"around", &Nut::around, 12, 1200, "facets around, a multiple of 6"},
       {"rows", &Nut::rows, 1, 16, "rows of facets on each crest, flank and root"}}};
  return list;
}

Result<TriangleMesh> make(const Nut& shape) {
  if (auto error = out_of_range(shape)) return *std::move(error);
  if (auto fault = thread_fault(shape.diameter, shape.pitch, shape.height, shape.across_flats, shape.around)) {
    return refuse(shape, fault->first, fault->second);
  }
  if (shape.clearance < -0.05 * shape.pitch || shape.clearance > 0.1 * shape.pitch) {
    return refuse(shape, "clearance is outside -0.05 .. 0.1 pitches, where the profile would lose its crest",
                  "give a value from " + number_text(-0.05 * shape.pitch) + " to " + number_text(0.1 * shape.pitch));
  }
  Surface surface;
  const ThreadProfile profile{shape.diameter, shape.pitch, shape.clearance};
  // Chords of the hole cut into it by this factor; widening keeps the clearance real.
  const double widening = 1.0 / std::cos(std::numbers::pi / shape.around);
  const double mouth = profile.greatest() + 0.1 * shape.pitch;
  const auto limit = [&](double z, double radius) {
    const double from_end = std::min(z, shape.height - z);
    return widening * std::max(radius, mouth - from_end);
  };
  const ThreadEnds thread = add_thread(surface, profile, shape.height, shape.around, shape.rows, true, limit);
  const Ring low = add_hexagon(surface, shape.across_flats, 0.0, shape.around);
  const Ring high = add_hexagon(surface, shape.across_flats, shape.height, shape.around);
  surface.connect(thread.low, low);
  surface.connect(low, high);
  surface.connect(high, thread.high);
  return surface.finish(title(shape));
}

}  // namespace odds::mesh::made
