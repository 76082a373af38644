// Filling and reading the look-up table of equation (4.16).
#include "odds/probability/balls_table.hpp"

#include <algorithm>
#include <cmath>

#include "probability/interpolated_counts.hpp"

namespace odds::probability {
namespace {

constexpr int highest = 255;

int quantised(double probability) noexcept { return static_cast<int>(std::lround(probability * highest)); }

}  // namespace

BallsTable::BallsTable() {
  for (int cells = 1; cells <= max_cells; ++cells) {
    first_row_[static_cast<std::size_t>(cells)] = static_cast<std::uint32_t>(rows_.size());
    for (int fewer = 1; fewer <= cells; ++fewer) {
      // The row's least value is that for s_B = s_A and x = 10; it only grows with s_A.
      if (quantised(probability::probability_of_shared_cells(cells, fewer, fewer, max_shared_cells)) == highest) break;
      append_rows(cells, fewer);
    }
  }
  first_row_[max_cells + 1] = static_cast<std::uint32_t>(rows_.size());
  rows_.shrink_to_fit();
  values_.shrink_to_fit();
}

void BallsTable::append_rows(int cells, int fewer) {
  std::array<std::array<std::uint8_t, max_cells + 1>, max_shared_cells + 1> table;
  int end = fewer;  // the s_B from which on every value is 1, or one past the last
  for (; end <= cells; ++end) {
    const SharedCellTails tails = probability::shared_cell_tails(cells, fewer, end);
    for (std::size_t x = 1; x <= max_shared_cells; ++x) {
      table[x][static_cast<std::size_t>(end)] = static_cast<std::uint8_t>(quantised(tails.at_least[x]));
    }
    if (table[max_shared_cells][static_cast<std::size_t>(end)] == highest) break;
  }
  for (std::size_t x = 1; x <= max_shared_cells; ++x) {
    const auto from = table[x].begin() + fewer;
    const auto to = table[x].begin() + end;
    const auto first = std::find_if(from, to, [](std::uint8_t v) { return v > 0; });
    const auto last = std::find(first, to, std::uint8_t{highest});
    rows_.push_back({static_cast<std::uint32_t>(values_.size()), static_cast<std::uint16_t>(first - table[x].begin()),
                     static_cast<std::uint16_t>(last - first)});
    values_.insert(values_.end(), first, last);
  }
}

const BallsTable& BallsTable::shared() {
  static const BallsTable table;
  return table;
}

double BallsTable::value(const Row& row, int more) const noexcept {
  if (more < row.first) return 0.0;
  const auto place = static_cast<std::size_t>(more - row.first);
  return place < row.count ? values_[row.offset + place] * (1.0 / highest) : 1.0;
}

double BallsTable::probability_of_shared_cells(int cells, int filled_a, int filled_b, int least) const noexcept {
  cells = std::clamp(cells, 1, max_cells);
  filled_a = std::clamp(filled_a, 0, cells);
  filled_b = std::clamp(filled_b, 0, cells);
  const int fewer = std::min(filled_a, filled_b);
  const int more = std::max(filled_a, filled_b);
  if (least <= 0) return 1.0;
  if (least > fewer) return 0.0;
  const std::size_t row = first_row_[static_cast<std::size_t>(cells)] +
                          static_cast<std::size_t>((fewer - 1) * max_shared_cells + std::min(least, 10) - 1);
  return row < first_row_[static_cast<std::size_t>(cells) + 1] ? value(rows_[row], more) : 1.0;
}

SharedCellTails BallsTable::shared_cell_tails(int cells, int filled_a, int filled_b) const noexcept {
  SharedCellTails tails;
  for (int x = 0; x <= max_shared_cells; ++x) {
    tails.at_least[x] = probability_of_shared_cells(cells, filled_a, filled_b, x);
  }
  return tails;
}

double BallsTable::collision_probability(int cells, int filled_a, int filled_b, double lower_bound) const noexcept {
  return likeliest_collision(shared_cell_tails(cells, filled_a, filled_b), lower_bound);
}

double BallsTable::collision_probability(const CellCounts& counts, double lower_bound) const noexcept {
  return likeliest_collision(
      interpolate(counts, [this](int cells, int a, int b) noexcept { return shared_cell_tails(cells, a, b); }),
      lower_bound);
}

std::size_t BallsTable::size_in_bytes() const noexcept {
  return sizeof(*this) + rows_.capacity() * sizeof(Row) + values_.capacity() * sizeof(std::uint8_t);
}

}  // namespace odds::probability
