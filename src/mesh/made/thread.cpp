#include "mesh/made/thread.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace odds::mesh::made {
namespace {

const double slope = std::sqrt(3.0);       // of a flank: 60 degrees from the axis
constexpr double crest_half = 1.0 / 16.0;  // of the pitch
constexpr double root_from_crest = 3.0 / 8.0;

constexpr std::int64_t lowest = std::numeric_limits<std::int64_t>::min();
constexpr std::int64_t highest = std::numeric_limits<std::int64_t>::max();

/// A vertex of a column and the number of its row counted along the helix; neighbours of one row are joined by an edge,
/// so that crests and roots are unbroken.
struct Knot {
  std::int64_t row;
  std::uint32_t vertex;
};

using Column = std::vector<Knot>;

/// Joins two columns by advancing on the side whose next row is lower.
void stitch(Surface& surface, const Column& left, const Column& right, std::int64_t right_shift, bool inwards) {
  std::size_t i = 0;
  std::size_t j = 0;
  const auto row = [](const Column& column, std::size_t at, std::int64_t shift) {
    const std::int64_t plain = column[at].row;
    return plain == lowest || plain == highest ? plain : plain + shift;
  };
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    surface.triangle(a, inwards ? c : b, inwards ? b : c);
  };
  while (i + 1 < left.size() || j + 1 < right.size()) {
    const bool left_next =
        j + 1 == right.size() || (i + 1 < left.size() && row(left, i + 1, 0) <= row(right, j + 1, right_shift));
    if (left_next) {
      add(left[i].vertex, right[j].vertex, left[i + 1].vertex);
      ++i;
    } else {
      add(left[i].vertex, right[j].vertex, right[j + 1].vertex);
      ++j;
    }
  }
}

}  // namespace

double ThreadProfile::least() const { return 0.5 * diameter - (root_from_crest - crest_half) * slope * pitch + offset; }

double ThreadProfile::radius(double phase) const {
  const double from_crest = std::abs(phase - std::floor(phase) - 0.5);
  const double flank = 0.5 * diameter + 2.0 * offset - (from_crest - crest_half) * slope * pitch;
  return std::clamp(flank, least(), greatest());
}

std::vector<double> ThreadProfile::rows(std::uint32_t rows) const {
  const double shift = offset / (pitch * slope);
  const std::array<double, 5> corners = {0.5 - root_from_crest - shift, 0.5 - crest_half - shift,
                                         0.5 + crest_half + shift, 0.5 + root_from_crest + shift,
                                         1.5 - root_from_crest - shift};
  std::vector<double> phases;
  for (std::size_t part = 0; part < 4; ++part) {
    for (std::uint32_t k = 0; k < rows; ++k) {
      phases.push_back(corners[part] + (corners[part + 1] - corners[part]) * k / rows);
    }
  }
  for (double& phase : phases) phase -= std::floor(phase);
  std::sort(phases.begin(), phases.end());
  return phases;
}

ThreadEnds add_thread(Surface& surface, const ThreadProfile& profile, double height, std::uint32_t around,
                      std::uint32_t rows, bool inwards, const std::function<double(double z, double radius)>& limit) {
  const std::vector<double> phases = profile.rows(rows);
  const auto per_turn = static_cast<std::int64_t>(phases.size());
  const double sliver = 1e-3 * profile.pitch;  // rows nearer to an end than this are left out
  std::vector<Column> columns(around);
  ThreadEnds ends;
  for (std::uint32_t c = 0; c < around; ++c) {
    const double turn = static_cast<double>(c) / around;
    const double angle = 2.0 * std::numbers::pi * turn;
    const auto add = [&](double z, double phase) {
      const double radius = limit(z, profile.radius(phase));
      return surface.add({radius * std::cos(angle), radius * std::sin(angle), z});
    };
    columns[c].push_back({lowest, add(0.0, -turn)});
    for (std::int64_t lap = -1; static_cast<double>(lap) * profile.pitch < height; ++lap) {
      for (std::int64_t k = 0; k < per_turn; ++k) {
        const double phase = phases[static_cast<std::size_t>(k)];
        const double z = profile.pitch * (static_cast<double>(lap) + phase + turn);
        if (z <= sliver || z >= height - sliver) continue;
        columns[c].push_back({lap * per_turn + k, add(z, phase)});
      }
    }
    columns[c].push_back({highest, add(height, height / profile.pitch - turn)});
    ends.low.push_back(columns[c].front().vertex);
    ends.high.push_back(columns[c].back().vertex);
  }
  for (std::uint32_t c = 0; c < around; ++c) {
    // After a full turn the helix has risen by one pitch: the first column's rows count one turn less.
    const bool seam = c + 1 == around;
    stitch(surface, columns[c], columns[seam ? 0 : c + 1], seam ? -per_turn : 0, inwards);
  }
  return ends;
}

Ring add_hexagon(Surface& surface, double across_flats, double z, std::uint32_t around) {
  Ring ring;
  constexpr double sixth = std::numbers::pi / 3.0;
  for (std::uint32_t i = 0; i < around; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / around;
    const double in_side = sixth * (i % (around / 6)) / (around / 6) - 0.5 * sixth;
    const double radius = 0.5 * across_flats / std::cos(in_side);
    ring.push_back(surface.add({radius * std::cos(angle), radius * std::sin(angle), z}));
  }
  return ring;
}

std::optional<std::pair<std::string, std::string>> thread_fault(double diameter, double pitch, double length,
                                                                double across_flats, std::uint32_t around) {
  using Fault = std::pair<std::string, std::string>;
  if (pitch > diameter / 3.0) return Fault{"the pitch is more than a third of the diameter", "give a finer pitch"};
  if (length < pitch) return Fault{"the thread is shorter than one pitch", "give a greater length or a finer pitch"};
  if (length > 1000.0 * pitch) return Fault{"the thread is longer than 1000 pitches", "give a coarser pitch"};
  if (across_flats <= 1.2 * diameter) {
    return Fault{"across_flats is not greater than 1.2 diameters, so the thread would cut the hexagon",
                 "give a wider hexagon"};
  }
  if (around % 6 != 0) return Fault{"around is not a multiple of 6, so it would miss the hexagon's corners", "give 48"};
  return std::nullopt;
}

}  // namespace odds::mesh::made
