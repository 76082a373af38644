// Where two bodies are in contact, exactly: what places of contact are judged by.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "odds/math/pose.hpp"
#include "odds/primitive/triangle_triangle.hpp"
#include "odds/query/pair.hpp"

namespace odds::report {

/// The curves in which two posed surfaces cross and, where both bodies are solid, the space that both fill. Every point
/// of it is as good a place for one contact as any other. Both shapes must outlive it.
class ContactRegion {
 public:
  /// `crossings`: all pairs of triangles that meet in this pose of B's mesh frame in A's.
  ContactRegion(const query::Shape& a, const query::Shape& b, const math::Pose& b_in_a,
                std::span<const query::TrianglePair> crossings);

  /// From a point in A's mesh frame, metres; 0 in the common space, infinite if nothing crosses. Inside is what two of
  /// three rays leave through an odd number of triangles.
  [[nodiscard]] double distance(const Vec3& point) const;

 private:
  const query::Shape& a_;
  const query::Shape& b_;
  math::Pose a_in_b_;
  std::vector<primitive::IntersectionSegment> curves_;  ///< A's mesh frame
};

}  // namespace odds::report
