// Poses of B in A at chosen distances from first touch, for studies of accuracy.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

#include "odds/math/error.hpp"
#include "odds/math/pose.hpp"
#include "odds/math/random.hpp"
#include "odds/query/pair.hpp"
#include "odds/query/shape.hpp"

namespace odds::report {

enum class Procedure : std::uint8_t {
  distance,  ///< random rotation and direction, then a fixed distance (Trenkel, Weller and Zachmann 2007)
  tumbling,  ///< A fixed, B rotated about z at random, moved along x (Klein and Zachmann 2003)
  nested,    ///< B inside A, both centres in one place, turned by up to 0.2 degrees, then moved outwards to first touch
};

inline constexpr std::array<Procedure, 3> procedures = {Procedure::distance, Procedure::tumbling, Procedure::nested};
[[nodiscard]] std::string_view name(Procedure procedure) noexcept;

/// Poses that are judged together. Numbers are parts of the size, see PoseMaker::size. Above 0 B is clear of its first
/// touch, below it has moved on beyond it. With the distance procedure positive numbers are distances of the surfaces
/// (0 .. 0.1 % more), all others are ways travelled from the first touch; with it least == greatest.
struct PoseBand {
  std::string_view name;
  std::string_view group;  ///< "near", "touch", "shallow", "deep"; tumbling: "apart", "overlap"
  double least = 0.0;
  double greatest = 0.0;  ///< a pose's number is uniform in [least, greatest)
};

[[nodiscard]] std::span<const PoseBand> pose_bands(Procedure procedure) noexcept;

/// One pose. Written to a file and read again (rotation normalised) it is the same pose bit for bit.
struct MadePose {
  std::uint64_t index = 0;
  std::uint32_t band = 0;           ///< into pose_bands
  double offset = 0.0;              ///< distance or travel that was aimed at, part of the size
  Vec3 translation = Vec3::Zero();  ///< metres
  Quat rotation = Quat::Identity();
  [[nodiscard]] math::Pose pose() const;
};

/// Makes pose number i from (seed, i) alone: index % bands is its band, index / bands numbers the random line along
/// which B comes. Bodies come towards each other's centres (of their bounding boxes); the first touch is found by steps
/// of 1/64 of the size (nested: 1/4096) and bisection with the exact search, so a feature thinner than a step may be
/// passed over. One maker per thread.
class PoseMaker {
 public:
  /// Both shapes must be of the wide engine; anything else is refused.
  static Result<PoseMaker> make(std::shared_ptr<const query::Shape> a, std::shared_ptr<const query::Shape> b,
                                Procedure procedure, std::uint64_t seed);

  /// Refuses only bodies that never met on a thousand random lines.
  [[nodiscard]] Result<MadePose> pose(std::uint64_t index);

  /// The smaller of the two bounding boxes' diagonals, metres.
  [[nodiscard]] double size() const noexcept { return size_; }

 private:
  struct Line {  ///< B's path: rotation, unit direction away from A, distance of the centres at the last clear place
    Quat rotation = Quat::Identity();
    Vec3 direction = Vec3::UnitX();
    double touch = 0.0;  ///< nested: minus that distance, and the direction is that back to A's centre
  };
  PoseMaker(query::Pair pair, Procedure procedure, std::uint64_t seed);
  [[nodiscard]] Result<Line> line(std::uint64_t number);
  [[nodiscard]] Line draw_line(math::Random& random) const;
  [[nodiscard]] bool find_touch(Line& line);
  [[nodiscard]] double travel_to_distance(const Line& line, double distance) const;
  [[nodiscard]] MadePose at(const Line& line, double travel) const;
  [[nodiscard]] bool collides(const Line& line, double distance);

  query::Pair pair_;
  Procedure procedure_;
  std::uint64_t seed_;
  double size_ = 0.0;
  double reach_ = 0.0;  ///< of both bodies together: farther apart they cannot touch
  Vec3 center_a_ = Vec3::Zero();
  Vec3 center_b_ = Vec3::Zero();
  std::uint64_t line_number_ = ~std::uint64_t{0};  ///< of `line_`, which the next index often needs again
  Line line_;
};

}  // namespace odds::report
