#include "mesh/made/car_panels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

namespace odds::mesh::made {
namespace {

constexpr double gap = 0.004;     // between neighbouring panels, metres
constexpr double sill = 0.22;     // height of the lower edge
constexpr double wheel_x = 1.35;  // distance of the axles from the middle

struct Knot {
  double at;
  double value;
};

double mix(double a, double b, double share) { return a + (b - a) * share; }

/// Smooth steps between knots; constant outside.
double through(std::span<const Knot> knots, double at) {
  if (at <= knots.front().at) return knots.front().value;
  for (std::size_t i = 1; i < knots.size(); ++i) {
    if (at > knots[i].at) continue;
    const double t = (at - knots[i - 1].at) / (knots[i].at - knots[i - 1].at);
    return mix(knots[i - 1].value, knots[i].value, t * t * (3.0 - 2.0 * t));
  }
  return knots.back().value;
}

double belt(double x) {
  static constexpr std::array<Knot, 5> knots = {{{-2.3, 0.86}, {-1.2, 0.93}, {0.6, 0.92}, {1.6, 0.80}, {2.3, 0.66}}};
  return through(knots, x);
}

double widest(double x) {
  static constexpr std::array<Knot, 6> knots = {
      {{-2.3, 0.66}, {-1.8, 0.84}, {-0.8, 0.88}, {0.8, 0.88}, {1.8, 0.84}, {2.3, 0.64}}};
  return through(knots, x);
}

/// Half the body's width below the belt: barrel-shaped, with a crease along the doors.
double half_width(double x, double z) {
  const double barrel = (z - 0.58) / 0.5;
  const double crease = (z - 0.70) / 0.04;
  return widest(x) * (1.0 - 0.10 * barrel * barrel) + 0.012 * std::exp(-crease * crease);
}

/// Lower edge of the sides, with the two wheel arches.
double lower_edge(double x) {
  double z = sill;
  for (const double axle : {-wheel_x, wheel_x}) {
    const double u = (x - axle) / 0.42;
    if (std::abs(u) < 1.0) z = sill + 0.44 * (1.0 - u * u * u * u);
  }
  return z;
}

double roof_height(double x) { return 1.38 - 0.10 * (x + 0.35) * (x + 0.35); }

Panel side(double rear, double front, double inset) {
  const auto position = [=](double s, double t) {
    const double x = mix(rear + gap, front - gap, s);
    // Skins inside keep off the edges of the outer one.
    const double z = mix(lower_edge(x) + 0.5 * inset, belt(x) - 0.5 * inset, t);
    return Vec3(x, -(half_width(x, z) - inset), z);
  };
  return {position, front - rear, 0.65};
}

Panel pillar(double foot, double foot_width, double top, double top_width) {
  const auto position = [=](double s, double t) {
    const double x_low = foot + foot_width * (s - 0.5);
    const double x_high = top + top_width * (s - 0.5);
    const double low_z = belt(x_low) + gap;
    const double low_y = half_width(x_low, low_z) - 0.01;
    const double bulge = 0.025 * std::sin(std::numbers::pi * t);
    return Vec3(mix(x_low, x_high, t), -(mix(low_y, 0.615, t) + bulge), mix(low_z, roof_height(x_high) - 0.09, t));
  };
  return {position, 0.5 * (foot_width + top_width), 0.45};
}

/// Bonnet or boot lid: from rear to front between the belts, arched across.
Panel lid(double rear, double front, double crown) {
  const auto position = [=](double s, double t) {
    const double x = mix(rear, front, s);
    const double across = 2.0 * t - 1.0;
    const double half = half_width(x, belt(x)) - gap;
    return Vec3(x, half * across, belt(x) + crown * (1.0 - across * across) + 0.004);
  };
  return {position, front - rear, 1.6};
}

Panel roof() {
  const auto position = [](double s, double t) {
    const double x = mix(-1.02, 0.30, s);
    const double across = 2.0 * t - 1.0;
    const double drop = 0.03 * across * across + 0.05 * std::pow(across, 8.0);
    return Vec3(x, 0.64 * across, roof_height(x) - drop);
  };
  return {position, 1.32, 1.3};
}

/// Bumper or tail: between two heights at one end of the car, bulging outwards. `end` is +1 in front, -1 at the rear.
Panel fascia(double end, double low, double high) {
  const auto position = [=](double s, double t) {
    const double z = mix(low, high, t);
    const double across = end * (2.0 * s - 1.0);
    const double up = (z - 0.45) / 0.4;
    const double x = end * (2.215 + 0.10 * (1.0 - across * across) - 0.03 * up * up);
    return Vec3(x, (half_width(end * 2.2, z) - gap) * across, z);
  };
  return {position, 1.4, high - low};
}

Panel floor_pan() {
  const auto position = [](double s, double t) {
    const double x = mix(-1.95, 1.95, s);
    const double y = mix(0.58, -0.58, t);
    const double tunnel = y / 0.13;
    const double ribs = 0.006 * std::cos(18.0 * x) * std::cos(14.0 * y);
    return Vec3(x, y, 0.235 + 0.12 * std::exp(-tunnel * tunnel) + ribs);
  };
  return {position, 3.9, 1.25};
}

/// Upright wall across the cabin.
Panel bulkhead(double x, double facing) {
  const auto position = [=](double s, double t) {
    const double y = facing * mix(-0.70, 0.70, s);
    const double z = mix(0.40, 0.86, t);
    return Vec3(x + 0.05 * std::cos(2.0 * y) + 0.02 * std::sin(8.0 * z), y, z);
  };
  return {position, 1.4, 0.46};
}

/// Half a drum over a wheel, from its inner side out to the fender.
Panel liner(double axle) {
  const auto position = [=](double s, double t) {
    const double angle = std::numbers::pi * (1.0 - s);
    const double y = mix(0.60, 0.735, t);
    return Vec3(axle + 0.39 * std::cos(angle), -y, 0.27 + 0.375 * std::sin(angle));
  };
  return {position, 1.2, 0.2};
}

Panel mirrored(const Panel& right) {
  Panel left = right;
  left.mirrored = !right.mirrored;
  left.position = [original = right.position](double s, double t) {
    const Vec3 p = original(s, t);
    return Vec3(p.x(), -p.y(), p.z());
  };
  return left;
}

}  // namespace

std::vector<Panel> car_panels() {
  const double door_split = -0.05;
  std::vector<Panel> panels;
  const std::vector<Panel> right = {
      side(0.87, 2.2, 0.0),          // front fender
      side(door_split, 0.87, 0.0),   // front door
      side(-0.92, door_split, 0.0),  // rear door
      side(-2.2, -0.92, 0.0),        // rear quarter
      side(0.02, 0.82, 0.07),        // inner skins of the doors
      side(-0.88, -0.12, 0.07),
      pillar(0.80, 0.10, 0.33, 0.07),
      pillar(-0.06, 0.12, -0.12, 0.09),
      pillar(-1.20, 0.40, -0.90, 0.20),
      liner(wheel_x),
      liner(-wheel_x),
  };
  for (const Panel& panel : right) {
    panels.push_back(panel);
    panels.push_back(mirrored(panel));
  }
  panels.push_back(lid(0.88, 2.19, 0.05));
  panels.push_back(lid(-2.19, -1.46, 0.03));
  panels.push_back(roof());
  panels.push_back(fascia(1.0, 0.24, 0.40));
  panels.push_back(fascia(1.0, 0.50, 0.65));
  panels.push_back(fascia(-1.0, 0.26, 0.84));
  panels.push_back(floor_pan());
  panels.push_back(bulkhead(0.82, 1.0));
  panels.push_back(bulkhead(-1.05, -1.0));
  return panels;
}

}  // namespace odds::mesh::made
