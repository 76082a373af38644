// Balls into bins: how probably two surfaces share cells of a common grid, by counts alone (equations 4.15 and 4.16).
#pragma once

#include <algorithm>

namespace odds::probability {

/// Largest number of cells in a grid (8^3) and largest number of shared cells that collision_probability looks at.
inline constexpr int max_cells = 512;
inline constexpr int max_shared_cells = 10;

/// Cell counts in the overlap of two nodes, in cells of one common size. Not whole numbers, as (4.15) yields them.
struct CellCounts {
  double cells = 1.0;     ///< s: cells in the overlap, 1 to 512
  double filled_a = 0.0;  ///< s'_A: well-filled cells of A among them, 0 to s
  double filled_b = 0.0;  ///< s'_B: the same of B
};

/// s: the number of common cells in an overlap. The nodes' grids differ, so both are read in one cell size, that of the
/// larger node: s = clamp(512 V / max(V_A, V_B), 1, 512). Volumes in one unit, the larger > 0; never NaN.
[[nodiscard]] double cells_of_overlap(double overlap_volume, double larger_volume) noexcept;

/// (4.15) for one node: s' = s_node V / V_node well-filled cells of the node's own lie in the overlap, each worth
/// V_node / V_larger common cells; thus s' = s_node / 512 * s, which keeps the share of well-filled cells and never
/// exceeds s. `filled` of the node's 512 cells are well filled.
[[nodiscard]] double cells_in_overlap(int filled, double overlap_volume, double larger_volume) noexcept;

/// (4.15) for both nodes; volumes > 0 in one unit.
[[nodiscard]] CellCounts cells_in_overlap(int filled_a, int filled_b, double overlap_volume, double volume_a,
                                          double volume_b) noexcept;

/// (4.16): P[c >= least], the probability that at least `least` of `cells` bins receive both a light and a dark ball if
/// filled_a light and filled_b dark balls are thrown, no two of a colour into one bin:
/// P[c = t] = C(s_A, t) C(s - s_A, s_B - t) / C(s, s_B). Counts are clamped to 0 .. cells, cells to 1 .. 512.
/// Exactly 1 if least <= max(0, s_A + s_B - s), exactly 0 if least > min(s_A, s_B); else right to 1e-12 relatively.
/// Some 50 ns. noexcept, thread-safe, as all functions here.
[[nodiscard]] double probability_of_shared_cells(int cells, int filled_a, int filled_b, int least) noexcept;

/// The same for fractional counts, read so: s is rounded to a whole number (it is a rough measure of volume anyway),
/// and a count between n and n + 1 is n + 1 with its fraction as probability, else n. So the result is interpolated
/// between whole counts: continuous and non-decreasing in each count.
[[nodiscard]] double probability_of_shared_cells(const CellCounts& counts, int least) noexcept;

/// Probability that two nodes collide (Zachmann 2007): max over 1 <= x <= min(s_A, s_B, 10) of
/// P[c >= x] (1 - (1 - LB)^x), where `lower_bound` LB in [0, 1] is the probability of a collision inside one shared
/// cell. In [0, 1].
[[nodiscard]] double collision_probability(int cells, int filled_a, int filled_b, double lower_bound) noexcept;
[[nodiscard]] double collision_probability(const CellCounts& counts, double lower_bound) noexcept;

/// LB = (depth_A + depth_B) / (max depth_A + max depth_B): surely collides in a shared cell of two deepest nodes, never
/// in one of the roots. In [0, 1]; two trees of one level give 1.
[[nodiscard]] inline double collision_in_shared_cell(int depth_a, int depth_b, int max_depth_a,
                                                     int max_depth_b) noexcept {
  const int deepest = max_depth_a + max_depth_b;
  return deepest <= 0 ? 1.0 : std::clamp(static_cast<double>(depth_a + depth_b) / deepest, 0.0, 1.0);
}

/// All tails of (4.16) that collision_probability needs.
struct SharedCellTails {
  double at_least[max_shared_cells + 1];  ///< [x] = P[c >= x], 0 <= x <= 10
};
[[nodiscard]] SharedCellTails shared_cell_tails(int cells, int filled_a, int filled_b) noexcept;

}  // namespace odds::probability
