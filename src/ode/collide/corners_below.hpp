// The corners of a mesh below a plane, as a source for select_manifold.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include "ode/collide/limit.hpp"
#include "ode/collide/manifold.hpp"
#include "ode/mesh/prepared_mesh.hpp"
#include "query/shape/corner_search.hpp"
#include "query/wide/points_by_eight.hpp"

namespace odds::ode {

/// Places of corners, each once: a mesh without common vertices, as STL files have it, repeats them.
class GatheredVertices {
 public:
  static constexpr std::size_t most = 512;

  GatheredVertices() noexcept {
    places_.fill(nobody);
    seen_.fill(query::no_feature);
  }
  [[nodiscard]] bool is_full() const noexcept { return count() >= most; }
  [[nodiscard]] std::size_t count() const noexcept { return by_eight_.count(); }
  [[nodiscard]] std::uint32_t corner(std::size_t i) const noexcept { return corners_[i]; }
  [[nodiscard]] std::span<const query::wide::EightPoints> all() const noexcept { return by_eight_.all(); }
  /// How far one of them is from the first, at most, metres.
  [[nodiscard]] double size() const noexcept;

  /// Precondition: not full, but for one that may be added afterwards. `number`: of the mesh's vertex.
  void add(std::uint32_t number, std::uint32_t corner, const Vec3& position, double depth) noexcept {
    std::uint32_t& seen = seen_[number % seen_.size()];
    if (seen == number) return;
    seen = number;
    const auto bits_of = [](double x) { return std::bit_cast<std::uint64_t>(x + 0.0); };  // no -0, for it equals 0
    const std::uint64_t hash =
        (bits_of(position.x()) * factors[0] + bits_of(position.y()) * factors[1]) + bits_of(position.z()) * factors[2];
    std::size_t place = hash >> (64 - bits);
    for (; places_[place] != nobody; place = (place + 1) % places_.size()) {
      if (by_eight_.point(places_[place]) == position) return;
    }
    places_[place] = static_cast<std::uint16_t>(count());
    corners_[count()] = corner;
    by_eight_.add(position, depth);
  }

 private:
  static constexpr int bits = 10;  // half of the places remain free
  static constexpr std::uint64_t factors[3] = {0x9E3779B97F4A7C15U, 0xC2B2AE3D27D4EB4FU, 0x165667B19E3779F9U};
  static constexpr std::uint16_t nobody = 0xFFFF;

  query::wide::PointsByEight<most + 1> by_eight_;
  std::array<std::uint32_t, most + 1> corners_;
  std::array<std::uint16_t, std::size_t{1} << bits> places_;
  std::array<std::uint32_t, most> seen_;  ///< some of the vertices that were added, by their numbers' last bits
};

/// Of {x: normal . x <= offset}; places are in the wide tree's frame, metres. They are gathered, and where they are too
/// many, each that is asked for is searched for. Where there is no time for either, the deepest of all and those that
/// were gathered have to do. No allocation.
class CornersBelow {
 public:
  /// Corners that may be below, as those chosen from the last time; they count only where not all were gathered. With
  /// another `turn`, others are looked for beside them then.
  struct Known {
    std::span<const std::uint32_t> corners;
    std::uint32_t turn = 0;
  };

  /// Normal, unit, and offset in the mesh's frame. Mesh and limit must outlive it.
  CornersBelow(const PreparedMesh& mesh, const Vec3& normal, double offset, const Known& known, Limit& limit) noexcept;

  /// Whether nothing was left out for want of work or time.
  [[nodiscard]] bool is_complete() const noexcept { return is_gathered_ || (are_many_ && has_some_left()); }
  [[nodiscard]] Vec3 position(std::uint32_t corner) const noexcept { return search_.place(corner); }
  [[nodiscard]] double depth(std::uint32_t corner) const noexcept { return offset_ - normal_.dot(position(corner)); }

  /// Of the deepest vertices the outermost: stable where a whole face lies on the plane.
  [[nodiscard]] std::uint32_t first() const noexcept;
  [[nodiscard]] std::uint32_t farthest(const Vec3& from) const noexcept { return farthest_below(from, 0.0); }
  /// Of many corners one may be given that is a little less far out than another.
  [[nodiscard]] std::uint32_t extreme(const Vec3& direction) const noexcept;

 private:
  /// Of those that were gathered, microseconds.
  [[nodiscard]] double time_to_choose() const noexcept;
  [[nodiscard]] bool has_time_to_search() const noexcept;
  [[nodiscard]] bool has_some_left() const noexcept { return limit_.nodes_left() > 0 && has_time_to_search(); }
  /// False if they are too many, or it was ended. `is_any_known`: then what lies beside is looked for afterwards, which
  /// takes up to a half of few nodes; else there may be nothing but the deepest.
  [[nodiscard]] bool gather(bool is_any_known) noexcept;
  void add(std::uint32_t corner) noexcept {
    const Vec3 place = position(corner);
    gathered_.add(search_.vertex_of(corner), corner, place, offset_ - normal_.dot(place));
  }
  /// Beside what was gathered, if that is not all.
  void look_for_more(const Known& known) noexcept;
  /// Of those that the mesh has, what is below.
  void add_known(std::span<const std::uint32_t> known) noexcept;
  /// What is below of the triangles that meet at a corner. What rolls has come on to one of theirs, and if it were held
  /// where it was met last, which is behind it by now, it would roll faster and faster.
  void add_beside(std::uint32_t corner) noexcept;
  /// The deepest of those that were gathered.
  [[nodiscard]] std::uint32_t deepest_gathered() const noexcept;
  /// The deepest of those with -normal . x greater than `least`, as far as there is work and time.
  [[nodiscard]] std::uint32_t find_deeper(double least) const noexcept;
  /// One farther out than those that were gathered, across the normal, another way in each turn.
  [[nodiscard]] std::uint32_t find_farther_out(std::uint32_t turn) const noexcept;
  /// With the greatest value of those that exceed `least`, as far as there is work and time, but down to a leaf.
  template <class Value, class Bounds>
  [[nodiscard]] std::uint32_t search_over(double least, double excess, const Value& value,
                                          const Bounds& bounds) const noexcept;
  [[nodiscard]] std::uint32_t farthest_below(const Vec3& from, double least_depth) const noexcept;
  /// Its corner, of the item of those that were gathered.
  [[nodiscard]] std::uint32_t corner_of(std::uint32_t item) const noexcept {
    return item == no_item ? no_item : gathered_.corner(item);
  }
  /// Of many that were gathered, each so many-th eight has to do.
  [[nodiscard]] std::size_t step() const noexcept { return are_many_ ? sample : 1; }
  /// The corner of greatest value of those below by that depth, or one that is less by no more than `not_greater`.
  template <class Value, class Bounds, class MayGoOn>
  [[nodiscard]] std::uint32_t search(double least_depth, double not_greater, const Value& value, const Bounds& bounds,
                                     const MayGoOn& may_go_on) const noexcept;

  static constexpr std::size_t sample = 4;

  const tree::WideTree& tree_;
  const double size_;  ///< of the mesh, metres
  const query::CornerSearch search_;
  const Vec3 normal_;
  const double offset_;
  const double rounding_;  ///< of the offset, metres
  Limit& limit_;
  std::uint32_t deepest_ = no_item;
  bool is_gathered_ = false;
  bool are_many_ = false;
  double rough_ = 0.0;  ///< of many, one so much less far out will do, metres; besides what bounds are off
  GatheredVertices gathered_;
};

}  // namespace odds::ode
