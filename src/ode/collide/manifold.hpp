// Reducing many points of one contact patch to few: the deepest first, then whatever spans the largest area.
#pragma once

#include <algorithm>
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
/// `extreme(direction)`, each an item or no_item, and `position(item)`. Of more than `enough` items those that there is
/// time for: until `may_go_on()` says no.
template <class Source, class MayGoOn>
std::size_t select_manifold(const Source& source, const Vec3& normal, double separation,
                            std::span<std::uint32_t> chosen, const MayGoOn& may_go_on) noexcept {
  constexpr std::size_t enough = 3;  // to stand on
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
    Vec3 begin;               // the place of `from`
  };
  const auto side = [&](std::uint32_t from, std::uint32_t to) -> Side {
    const Vec3 begin = source.position(from);
    const Vec3 edge = across(source.position(to) - begin);
    const Vec3 outward = edge.cross(normal);
    const std::uint32_t outermost = source.extreme(outward);
    if (outermost == no_item) return {from, no_item, 0.0, begin};
    const double area = outward.dot(source.position(outermost) - begin);
    return {from, outermost, area > separation * edge.norm() ? area : 0.0, begin};
  };
  std::array<Side, most_contacts> polygon;
  std::size_t corners = 2;
  polygon[0] = side(first, second);
  polygon[1] = side(second, first);
  // So far that a neighbour is beyond the side of the other one.
  const auto points_inwards = [&](std::size_t corner) {
    const Vec3& place = polygon[corner].begin;
    const Vec3 before = place - polygon[(corner + corners - 1) % corners].begin;
    const Vec3 after = polygon[(corner + 1) % corners].begin - place;
    const double inwards = after.cross(before).dot(normal);
    return inwards > 0.0 && inwards > separation * std::min(across(before).norm(), across(after).norm());
  };
  while (count < limit) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < corners; ++i) {
      if (polygon[i].area > polygon[best].area) best = i;
    }
    if (!(polygon[best].area > 0.0) || (count >= enough && !may_go_on())) return count;
    const std::uint32_t added = polygon[best].outermost;
    take(added);
    if (count == limit) return count;
    const std::uint32_t to = polygon[(best + 1) % corners].from;
    for (std::size_t i = corners; i > best + 1; --i) polygon[i] = polygon[i - 1];
    polygon[best] = side(polygon[best].from, added);
    polygon[best + 1] = side(added, to);
    ++corners;
    // A corner may lie within what the others span: the deepest, or one that a Source gave for another a little farther
    // out. Pointing inwards it would have sides beyond which other corners lie, which would be taken again.
    for (std::size_t i = 0; i < corners && corners > 3; ++i) {
      if (!points_inwards(i)) continue;
      const std::size_t last = (i + corners - 1) % corners;
      polygon[last] = side(polygon[last].from, polygon[(i + 1) % corners].from);
      --corners;
      for (std::size_t k = i; k < corners; ++k) polygon[k] = polygon[k + 1];
      i = SIZE_MAX;  // its neighbours may do so now: from the first on
    }
  }
  return count;
}

}  // namespace odds::ode
