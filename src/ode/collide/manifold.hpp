// Reducing many points of one contact patch to few: the deepest first, then whatever spans the largest area.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "odds/math/types.hpp"
#include "odds/query/answer.hpp"

namespace odds::ode {

constexpr std::size_t most_contacts = 8;
constexpr std::uint32_t no_item = query::no_feature;
/// So much, per metre of depth, a Source counts a deeper item for as if it were farther away: of two above each other
/// the deeper is taken, and not whichever the last bit prefers.
constexpr double deeper_at_one_place = 1e-9;

/// Writes at most `chosen.size()` (and most_contacts) items, no place twice, so that every prefix is a good set: the
/// first, the farthest from it, then always the point that adds the largest triangle to the polygon so far. Points
/// closer to the polygon than `separation` (metres, in the plane across `normal`, a unit vector) add nothing and end
/// the choice. Returns how many were written. A Source has, of its items: `first()`, `farthest(point)` (in that plane),
/// `extreme(direction)`, each an item or no_item, and `position(item)`.
template <class Source>
std::size_t select_manifold(const Source& source, const Vec3& normal, double separation,
                            std::span<std::uint32_t> chosen) noexcept {
  const std::size_t limit = chosen.size() < most_contacts ? chosen.size() : most_contacts;
  const auto across = [&normal](const Vec3& v) -> Vec3 { return v - v.dot(normal) * normal; };
  std::size_t count = 0;
  const auto take = [&](std::uint32_t item) { chosen[count++] = item; };
  if (limit == 0) return count;
  const std::uint32_t first = source.first();
  if (first == no_item) return count;
  take(first);
  if (limit == 1) return count;
  const std::uint32_t second = source.farthest(source.position(first));
  if (second == no_item || across(source.position(second) - source.position(first)).norm() <= separation) return count;
  take(second);

  struct Side {  // of the polygon, counter-clockwise about `normal`
    std::uint32_t from;
    std::uint32_t outermost;  // the item farthest beyond this side
    double area;              // twice the area it would add; 0 if it is not beyond by more than `separation`
  };
  const auto side = [&](std::uint32_t from, std::uint32_t to) -> Side {
    const Vec3 edge = across(source.position(to) - source.position(from));
    const Vec3 outward = edge.cross(normal);
    const std::uint32_t outermost = source.extreme(outward);
    if (outermost == no_item) return {from, no_item, 0.0};
    const double area = outward.dot(source.position(outermost) - source.position(from));
    return {from, outermost, area > separation * edge.norm() ? area : 0.0};
  };
  std::array<Side, most_contacts> polygon;
  std::size_t corners = 2;
  polygon[0] = side(first, second);
  polygon[1] = side(second, first);
  while (count < limit) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < corners; ++i) {
      if (polygon[i].area > polygon[best].area) best = i;
    }
    if (!(polygon[best].area > 0.0)) return count;
    const std::uint32_t added = polygon[best].outermost;
    const std::uint32_t to = polygon[(best + 1) % corners].from;
    for (std::size_t i = corners; i > best + 1; --i) polygon[i] = polygon[i - 1];
    polygon[best] = side(polygon[best].from, added);
    polygon[best + 1] = side(added, to);
    ++corners;
    take(added);
    // The deepest may lie within what the others span. As a corner that points inwards it would have sides beyond which
    // other corners lie, which would be taken again.
    if (polygon[0].from != first || corners < 4) continue;
    const std::uint32_t last = polygon[corners - 1].from;
    const Vec3 before = source.position(first) - source.position(last);
    const Vec3 after = source.position(polygon[1].from) - source.position(first);
    if (before.cross(after).dot(normal) >= 0.0) continue;
    polygon[corners - 1] = side(last, polygon[1].from);
    --corners;
    for (std::size_t i = 0; i < corners; ++i) polygon[i] = polygon[i + 1];
  }
  return count;
}

}  // namespace odds::ode
