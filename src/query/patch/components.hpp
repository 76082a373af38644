// Which pieces of rim belong together: connected curves first, then curves that bound one overlap.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "query/patch/rim.hpp"
#include "query/patch/watch.hpp"

namespace odds::query::patch {

/// Sums over some pieces of rim. Vector area and moments are about `Rim::origin`, so that sums of sums are right.
struct RimSums {
  Vec3 lower = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 upper = Vec3::Constant(-std::numeric_limits<double>::infinity());
  Vec3 area = Vec3::Zero();       ///< half the sum of from x to
  Vec3 gap = Vec3::Zero();        ///< sum of to - from: zero if closed
  Vec3 moment = Vec3::Zero();     ///< sum of length * middle
  Vec3 normals_a = Vec3::Zero();  ///< sum of length * normal of A's triangle
  Vec3 normals_b = Vec3::Zero();  ///< sum of length * normal of B's triangle
  double heights_a = 0.0;         ///< sum of length * height of the middle over the origin along A's normal
  double heights_b = 0.0;         ///< the same of B
  double length = 0.0;
  std::uint32_t loose_ends = 0;  ///< joints that more pieces enter than leave, or the reverse

  void add(const RimPiece& piece, const PlacedPair& placed, const Vec3& origin) noexcept;
  void add(const RimSums& other) noexcept;
  [[nodiscard]] bool closed() const noexcept { return loose_ends == 0; }
  [[nodiscard]] double diagonal() const noexcept { return (upper - lower).norm(); }
  /// Of what there is of the rim: crumbs far from each other are no wider than they are long.
  [[nodiscard]] double width() const noexcept { return std::min(diagonal(), length); }
  /// Mean of the pieces' middles, weighted by length; the middle of the box if there is no length.
  [[nodiscard]] Vec3 centre(const Vec3& origin) const noexcept;
  /// Vector area about the centre: independent of `origin` also where the curve is open.
  [[nodiscard]] Vec3 vector_area(const Vec3& origin) const noexcept;
  /// How far the pieces reach out of one body along their own normals, from their centre, in the mean: 0 on one flat
  /// face, above 0 about an edge or a tip, and below 0 in a corner, whose faces lie over one another's planes; metres.
  [[nodiscard]] double bulge(bool of_b) const noexcept;
};

/// The pieces of one query, sorted by patch.
struct Rim {
  std::span<RimPiece> pieces;
  std::span<const PlacedPair> pairs;
  Vec3 origin = Vec3::Zero();
};

/// Finds the patches of a rim. All memory is taken at construction.
class Components {
 public:
  static constexpr std::uint32_t left_out = 0xffffffffU;
  static constexpr std::size_t most = 32;  ///< curves that are kept apart; of more, the shortest are left out

  static constexpr std::size_t most_compared = 4 * most;  ///< of the longest, that may be as long as one that is kept

  Components(std::size_t most_pieces, std::size_t most_pairs);

  /// Sets `component` of every piece to the index of its patch (or `left_out`) and `counts` of copies to false. Returns
  /// the sums of each patch; nothing if the time was up before it was done.
  std::span<const RimSums> group(const Rim& rim, bool solid_a, bool solid_b, Watch& watch) noexcept;

  /// The first pieces that were at the joints where a piece begins and ends; it may be itself. Once it was grouped.
  [[nodiscard]] std::array<std::uint32_t, 2> first_at_ends_of(std::uint32_t piece) const noexcept {
    return {joints_[ends_[piece].first].first_piece, joints_[ends_[piece].second].first_piece};
  }

 private:
  struct Joint {
    Vec3 position = Vec3::Zero();
    std::int32_t balance = 0;  ///< pieces that leave minus pieces that enter
    std::uint32_t first_piece = 0;
    std::uint32_t leads_to = left_out;  ///< where the first piece that leaves it ends
  };
  using Cell = std::array<std::uint64_t, 3>;
  static constexpr double same_points_per_cell = 256.0;
  static constexpr double near_border = 2.0 / same_points_per_cell;  ///< in cells; twice as far as two joints are one
  static constexpr double to_integer = 0x1.8p52;                     ///< added, it leaves no digits behind the point

  /// The cell of a point: its coordinates as integers, in the last bits of doubles.
  [[nodiscard]] static Cell cell_of(const Vec3& cells) noexcept {
    const auto index = [](double x) noexcept { return std::bit_cast<std::uint64_t>(x + to_integer); };
    return {index(cells.x()), index(cells.y()), index(cells.z())};
  }
  [[nodiscard]] std::size_t slot_of(const Cell& cell) const noexcept {
    // Multipliers of L'Ecuyer, Tables of Linear Congruential Generators, Math. of Computation 68, 1999.
    const std::uint64_t key =
        cell[0] * 2862933555777941757ULL + cell[1] * 3202034522624059733ULL + cell[2] * 3935559000370003845ULL;
    return static_cast<std::size_t>(key >> 32U) & joint_mask_;
  }
  /// The joint at a point, of those in a cell.
  [[nodiscard]] std::uint32_t find_joint(const Vec3& point, std::size_t slot) const noexcept {
    for (; joint_table_[slot] != 0; slot = (slot + 1) & joint_mask_) {
      const std::uint32_t joint = joint_table_[slot] - 1;
      if ((joints_[joint].position - point).cwiseAbs().maxCoeff() <= same_point_) return joint;
    }
    return left_out;
  }
  [[nodiscard]] std::uint32_t find_beyond(const Vec3& point, const Vec3& cells) const noexcept;
  std::uint32_t joint_at(const Vec3& point, std::uint32_t piece) noexcept;
  void prepare(const Rim& rim, Watch& watch) noexcept;
  void connect(const Rim& rim, Watch& watch) noexcept;
  bool is_copy(std::uint32_t from, std::uint32_t to) noexcept;
  bool is_another_copy(std::uint32_t from, std::uint32_t to) noexcept;
  void sum_up(const Rim& rim, Watch& watch) noexcept;
  void keep_the_longest(Watch& watch) noexcept;
  void spread_equals(std::span<std::uint32_t> sorted, Watch& watch) noexcept;
  std::span<const std::uint32_t> roots() noexcept;
  void join_open_curves(const Rim& rim, Watch& watch) noexcept;
  void join_holes(const Rim& rim, bool solid_a, bool solid_b, Watch& watch) noexcept;
  void join_neighbours(const Rim& rim, Watch& watch) noexcept;
  void join(std::uint32_t i, std::uint32_t j) noexcept;
  void settle(const Rim& rim, Watch& watch) noexcept;
  static std::uint32_t root(std::vector<std::uint32_t>& parents, std::uint32_t i) noexcept {
    while (parents[i] != i) {
      parents[i] = parents[parents[i]];
      i = parents[i];
    }
    return i;
  }

  std::vector<Joint> joints_;
  std::vector<std::uint32_t> joint_table_;                     ///< open addressing, 0: free, else joint + 1
  std::vector<std::uint64_t> copy_table_;                      ///< open addressing, 0: free, else (from + 1, to + 1)
  std::vector<std::uint64_t> triangle_table_;                  ///< open addressing, 0: free, else (triangle + 1, curve)
  std::vector<std::pair<std::uint32_t, std::uint32_t>> ends_;  ///< joints of each piece
  std::vector<std::uint32_t> piece_parents_;
  std::vector<std::uint32_t> curve_of_root_;
  std::vector<RimSums> curves_;
  std::vector<std::uint32_t> order_;
  std::vector<std::uint32_t> curve_parents_;
  std::vector<std::uint32_t> patch_of_curve_;
  std::vector<RimSums> patches_;
  std::array<std::uint32_t, most> roots_{};
  std::size_t joint_mask_ = 0;
  std::size_t copy_mask_ = 0;
  std::size_t joint_count_ = 0;
  std::size_t curve_count_ = 0;
  std::size_t kept_ = 0;
  double cells_per_metre_ = 1.0;
  double same_point_ = 0.0;
};

}  // namespace odds::query::patch
