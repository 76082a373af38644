// Triangles as tests write them, and what must hold for every order of corners and of triangles.
#pragma once

#include <algorithm>
#include <array>
#include <ios>
#include <ostream>
#include <sstream>
#include <string>

#include "odds/primitive/triangle_triangle.hpp"

namespace odds::test {

using Corners = std::array<Vec3, 3>;

inline std::string text_of(const Corners& a, const Corners& b) {
  std::ostringstream text;
  text << std::hexfloat;
  for (const Corners& t : {a, b}) {
    for (const Vec3& p : t) text << "{" << p.x() << ", " << p.y() << ", " << p.z() << "} ";
    text << "| ";
  }
  return text.str();
}

/// How many of the 72 orders of corners and triangles are answered with "they meet".
inline int orders_that_meet(const Corners& a, const Corners& b) {
  int meeting = 0;
  std::array<std::size_t, 3> i = {0, 1, 2};
  do {
    std::array<std::size_t, 3> j = {0, 1, 2};
    do {
      const Corners p = {a[i[0]], a[i[1]], a[i[2]]};
      const Corners q = {b[j[0]], b[j[1]], b[j[2]]};
      meeting += primitive::triangles_intersect(p.data(), q.data()) ? 1 : 0;
      meeting += primitive::triangles_intersect(q.data(), p.data()) ? 1 : 0;
    } while (std::next_permutation(j.begin(), j.end()));
  } while (std::next_permutation(i.begin(), i.end()));
  return meeting;
}
inline constexpr int all_orders = 72;

}  // namespace odds::test
