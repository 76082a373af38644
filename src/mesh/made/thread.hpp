// The helical surface that bolt and nut share. Private to mesh/made.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "mesh/made/surface.hpp"

namespace odds::mesh::made {

/// ISO 68-1 basic profile, moved outwards along its normal by `offset`. Lengths in metres; right-handed.
struct ThreadProfile {
  double diameter;
  double pitch;
  double offset;

  /// Distance from the axis where `phase` pitches have passed since the middle of a root (period 1).
  [[nodiscard]] double radius(double phase) const;
  /// The phases in [0, 1) where crests, flanks and roots meet, each part divided into `rows`, ascending.
  [[nodiscard]] std::vector<double> rows(std::uint32_t rows) const;
  [[nodiscard]] double greatest() const { return 0.5 * diameter + offset; }
  [[nodiscard]] double least() const;
};

struct ThreadEnds {
  Ring low;
  Ring high;
};

/// The surface between z = 0 and z = height, `around` columns of vertices; facing outwards, or inwards if `inwards`.
/// `limit(z, radius)` may change a vertex's distance from the axis (chamfers) and scale it.
ThreadEnds add_thread(Surface& surface, const ThreadProfile& profile, double height, std::uint32_t around,
                      std::uint32_t rows, bool inwards, const std::function<double(double z, double radius)>& limit);

/// A regular hexagon around z, given at `around` (multiple of 6) equal angles, a corner at angle 0.
Ring add_hexagon(Surface& surface, double across_flats, double z, std::uint32_t around);

/// What bolt and nut have to check alike; the first is what is wrong, the second what to do.
std::optional<std::pair<std::string, std::string>> thread_fault(double diameter, double pitch, double length,
                                                                double across_flats, std::uint32_t around);

}  // namespace odds::mesh::made
