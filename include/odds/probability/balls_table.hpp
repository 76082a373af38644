// The look-up table of equation (4.16): every probability of shared cells in one byte.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "odds/probability/balls_into_bins.hpp"

namespace odds::probability {

/// P[c >= x] for all whole s_A, s_B <= s <= 512 and x <= 10, in steps of 1/255. Symmetry halves it, and of each row
/// over s_B only the part is kept where the value is neither 0 nor 1 to half a step: about 25 MB instead of 1.3 GB of
/// doubles. Immutable once made; all look-ups are noexcept and thread-safe. It saves arithmetic and costs cache:
/// measure which of it and of the formulas in balls_into_bins.hpp serves you better.
class BallsTable {
 public:
  /// Largest distance of a value to that of probability_of_shared_cells.
  static constexpr double max_error = 0.5 / 255.0 + 1e-12;

  /// Computes the table, well under a second; allocates.
  BallsTable();

  /// One table for the whole program, made by the first call: make that call before any deadline runs.
  [[nodiscard]] static const BallsTable& shared();

  /// P[c >= least] to max_error, in [0, 1], non-decreasing in filled_a and filled_b. Arguments are clamped as in
  /// probability_of_shared_cells; least beyond 10 counts as 10, unless 0 is exact.
  [[nodiscard]] double probability_of_shared_cells(int cells, int filled_a, int filled_b, int least) const noexcept;

  /// The table's counterparts of the functions in balls_into_bins.hpp.
  [[nodiscard]] SharedCellTails shared_cell_tails(int cells, int filled_a, int filled_b) const noexcept;
  [[nodiscard]] double collision_probability(int cells, int filled_a, int filled_b, double lower_bound) const noexcept;
  [[nodiscard]] double collision_probability(const CellCounts& counts, double lower_bound) const noexcept;

  /// Memory that the table holds.
  [[nodiscard]] std::size_t size_in_bytes() const noexcept;

 private:
  // Values over s_B for one (s, s_A <= s_B, x): 0 before `first`, then `count` stored bytes, 1 after them.
  struct Row {
    std::uint32_t offset;
    std::uint16_t first;
    std::uint16_t count;
  };
  void append_rows(int cells, int fewer);
  [[nodiscard]] double value(const Row& row, int more) const noexcept;

  std::array<std::uint32_t, max_cells + 2> first_row_{};  // of each s; from the next one's start on all values are 1
  std::vector<Row> rows_;                                 // ten for each s_A, x = 1 .. 10
  std::vector<std::uint8_t> values_;
};

}  // namespace odds::probability
