#include "odds/mesh/made/gear.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "mesh/made/parameters.hpp"
#include "mesh/made/surface.hpp"

namespace odds::mesh::made {
namespace {

constexpr double pi = std::numbers::pi;

/// Half of a tooth: radius and half angle from the root to the tip.
struct FlankPoint {
  double radius;
  double half_angle;
};

/// Involute of the base circle; half angles from the tooth's thickness at the pitch circle.
std::vector<FlankPoint> flank(const SpurGear& gear) {
  const double pitch_radius = 0.5 * gear.module * gear.teeth;
  const double pressure = gear.pressure_angle * pi / 180.0;
  const double base_radius = pitch_radius * std::cos(pressure);
  const double root = pitch_radius - 1.25 * gear.module;
  const double tip = pitch_radius + gear.module;
  const auto involute = [](double angle) { return std::tan(angle) - angle; };
  const double half_at_pitch = 0.5 * (pi / gear.teeth - gear.backlash / pitch_radius);
  std::vector<FlankPoint> points;
  for (std::uint32_t k = 0; k <= gear.flank; ++k) {
    const double radius = root + (tip - root) * k / gear.flank;
    const double roll = radius > base_radius ? std::acos(base_radius / radius) : 0.0;
    points.push_back({radius, half_at_pitch + involute(pressure) - involute(roll)});
  }
  return points;
}

/// The cross-section at one height: the outline, the ring at the root circle, the bore, and each tooth's rungs.
struct Slice {
  Ring outline;
  Ring root;
  Ring bore;
  std::vector<std::array<std::uint32_t, 2>> rungs;  ///< right and left point, flank + 1 per tooth
};

Slice add_slice(Surface& surface, const SpurGear& gear, const std::vector<FlankPoint>& half_tooth, double z) {
  Slice slice;
  std::vector<double> root_angles;
  const auto add = [&](double radius, double angle) {
    return surface.add({radius * std::cos(angle), radius * std::sin(angle), z});
  };
  for (std::uint32_t tooth = 0; tooth < gear.teeth; ++tooth) {
    const double middle = 2.0 * pi * tooth / gear.teeth;
    for (const FlankPoint& p : half_tooth) {
      slice.rungs.push_back({add(p.radius, middle - p.half_angle), add(p.radius, middle + p.half_angle)});
    }
    const auto own = slice.rungs.end() - static_cast<std::ptrdiff_t>(half_tooth.size());
    for (auto rung = own; rung != slice.rungs.end(); ++rung) slice.outline.push_back((*rung)[0]);
    for (auto rung = slice.rungs.end(); rung != own;) slice.outline.push_back((*--rung)[1]);
    slice.root.push_back((*own)[0]);
    slice.root.push_back((*own)[1]);
    const double half = half_tooth.front().half_angle;
    root_angles.push_back(middle - half);
    root_angles.push_back(middle + half);
    const double space = 2.0 * pi / gear.teeth - 2.0 * half;
    for (std::uint32_t k = 1; k < gear.root; ++k) {
      const double angle = middle + half + space * k / gear.root;
      root_angles.push_back(angle);
      slice.root.push_back(add(half_tooth.front().radius, angle));
      slice.outline.push_back(slice.root.back());
    }
  }
  slice.bore = surface.add_circle(gear.bore, z, root_angles);
  return slice;
}

void add_teeth_faces(Surface& surface, const Slice& slice, std::size_t per_tooth, bool down) {
  for (std::size_t i = 0; i + 1 < slice.rungs.size(); ++i) {
    if ((i + 1) % per_tooth == 0) continue;  // the last rung of a tooth is its tip
    const auto& [right, left] = slice.rungs[i];
    const auto& [outer_right, outer_left] = slice.rungs[i + 1];
    if (down) {
      surface.quad(right, left, outer_left, outer_right);
    } else {
      surface.quad(right, outer_right, outer_left, left);
    }
  }
}

}  // namespace

std::span<const Field<SpurGear>> SpurGear::fields() {
  static constexpr std::array<Field<SpurGear>, 8> list = {
      {{"module", &SpurGear::module, 1e-6, 10.0, "pitch diameter per tooth, metres"},
       {"width", &SpurGear::width, 1e-6, 1e3, "metres"},
       {"bore", &SpurGear::bore, 1e-7, 1e3, "radius of the hole, metres"},
       {"pressure_angle", &SpurGear::pressure_angle, 14.0, 30.0, "degrees"},
       {"backlash", &SpurGear::backlash, 0.0, 1.0, "taken from each tooth's thickness, metres"},
       {"teeth", &SpurGear::teeth, 5, 1000, "number of teeth"},
       {"flank", &SpurGear::flank, 1, 64, "segments of a flank"},
       {"root", &SpurGear::root, 1, 64, "segments between two teeth"}}};
  return list;
}

Result<TriangleMesh> make(const SpurGear& shape) {
  if (auto error = out_of_range(shape)) return *std::move(error);
  const std::vector<FlankPoint> half_tooth = flank(shape);
  const auto thinner = [](const FlankPoint& a, const FlankPoint& b) { return a.half_angle < b.half_angle; };
  const auto [thinnest, thickest] = std::minmax_element(half_tooth.begin(), half_tooth.end(), thinner);
  if (thinnest->half_angle <= 0.0) {
    return refuse(shape, "the teeth would end in a point below their tip circle",
                  "give a smaller pressure_angle or backlash, or more teeth");
  }
  if (thickest->half_angle >= pi / shape.teeth) {
    return refuse(shape, "neighbouring teeth would meet at the root", "give a smaller pressure_angle or more teeth");
  }
  if (shape.bore >= 0.95 * half_tooth.front().radius) {
    return refuse(shape, "the bore reaches the roots of the teeth",
                  "give bore < " + number_text(0.95 * half_tooth.front().radius));
  }
  Surface surface;
  const Slice low = add_slice(surface, shape, half_tooth, 0.0);
  const Slice high = add_slice(surface, shape, half_tooth, shape.width);
  surface.connect(low.outline, high.outline);
  surface.connect(high.bore, low.bore);
  surface.connect(low.bore, low.root);
  surface.connect(high.root, high.bore);
  add_teeth_faces(surface, low, half_tooth.size(), true);
  add_teeth_faces(surface, high, half_tooth.size(), false);
  return surface.finish(title(shape));
}

}  // namespace odds::mesh::made
