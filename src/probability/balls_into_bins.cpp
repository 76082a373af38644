// The hypergeometric distribution from factorials with a scale, and its tails by recurrence.
#include "odds/probability/balls_into_bins.hpp"

#include <array>
#include <cmath>
#include <cstdint>

#include "probability/interpolated_counts.hpp"

namespace odds::probability {
namespace {

// n! = mantissa * 2^exponent, mantissa in [1/2, 1). Better than logarithms: nine of these lose 1e-15, while the
// logarithms of the largest are so large that their rounding alone would cost 1e-12.
struct ScaledFactorials {
  std::array<double, max_cells + 1> mantissa{};
  std::array<int, max_cells + 1> exponent{};
};

constexpr ScaledFactorials make_factorials() {
  ScaledFactorials table;
  std::uint64_t bits = std::uint64_t{1} << 63;  // the mantissa in units of 2^-64, rounded down: 2^-63 lost per step
  int exponent = 1;
  for (std::size_t n = 0; n <= max_cells; ++n) {
    if (n > 1) {
      const std::uint64_t low = (bits & 0xffffffffU) * n;
      std::uint64_t high = (bits >> 32) * n + (low >> 32);
      std::uint64_t rest = low & 0xffffffffU;
      while (high >= std::uint64_t{1} << 32) {
        rest = (rest >> 1) | ((high & 1U) << 31);
        high >>= 1;
        ++exponent;
      }
      bits = (high << 32) | rest;
    }
    table.mantissa[n] = static_cast<double>(bits >> 11) * 0x1p-53;
    table.exponent[n] = exponent;
  }
  return table;
}

constexpr ScaledFactorials factorials = make_factorials();

// Counts put in order, and the range of t in which P[c = t] > 0.
struct Counts {
  int cells;
  int a;
  int b;
  int first;
  int last;

  Counts(int s, int s_a, int s_b) noexcept
      : cells(std::clamp(s, 1, max_cells)),
        a(std::clamp(s_a, 0, cells)),
        b(std::clamp(s_b, 0, cells)),
        first(std::max(0, a + b - cells)),
        last(std::min(a, b)) {}

  // The likeliest t, between first and last.
  [[nodiscard]] int mode() const noexcept { return (a + 1) * (b + 1) / (cells + 2); }
  // P[c = t].
  [[nodiscard]] double exactly(int t) const noexcept {
    const int over[4] = {a, b, cells - a, cells - b};
    const int under[5] = {cells, t, a - t, b - t, cells - a - b + t};
    double numerator = 1.0;
    double denominator = 1.0;
    int exponent = 0;
    for (const int n : over) {
      numerator *= factorials.mantissa[static_cast<std::size_t>(n)];
      exponent += factorials.exponent[static_cast<std::size_t>(n)];
    }
    for (const int n : under) {
      denominator *= factorials.mantissa[static_cast<std::size_t>(n)];
      exponent -= factorials.exponent[static_cast<std::size_t>(n)];
    }
    return std::ldexp(numerator / denominator, exponent);
  }
  // P[c = t + 1] / P[c = t] as a fraction, exact.
  [[nodiscard]] double step_over(int t) const noexcept { return static_cast<double>((a - t) * (b - t)); }
  [[nodiscard]] double step_under(int t) const noexcept {
    return static_cast<double>((t + 1) * (cells - a - b + t + 1));
  }
};

constexpr double negligible = 0x1p-60;

// Sum from `t` away from the mode, upwards; terms only shrink there.
double sum_upwards(const Counts& counts, int t) noexcept {
  double term = counts.exactly(t);
  double sum = term;
  for (; t < counts.last && term > negligible * sum; ++t) {
    term *= counts.step_over(t) / counts.step_under(t);
    sum += term;
  }
  return sum;
}

double sum_downwards(const Counts& counts, int t) noexcept {
  double term = counts.exactly(t);
  double sum = term;
  for (; t > counts.first && term > negligible * sum; --t) {
    term *= counts.step_under(t - 1) / counts.step_over(t - 1);
    sum += term;
  }
  return sum;
}

}  // namespace

double cells_of_overlap(double overlap_volume, double larger_volume) noexcept {
  const double cells = max_cells * (overlap_volume / larger_volume);
  return cells > 1.0 ? std::min(cells, static_cast<double>(max_cells)) : 1.0;
}

double cells_in_overlap(int filled, double overlap_volume, double larger_volume) noexcept {
  const int known = std::clamp(filled, 0, max_cells);
  return known * (cells_of_overlap(overlap_volume, larger_volume) / max_cells);
}

CellCounts cells_in_overlap(int filled_a, int filled_b, double overlap_volume, double volume_a,
                            double volume_b) noexcept {
  const double larger = std::max(volume_a, volume_b);
  const double overlap = std::min({overlap_volume, volume_a, volume_b});  // an estimate may exceed what is possible
  return {cells_of_overlap(overlap, larger), cells_in_overlap(filled_a, overlap, larger),
          cells_in_overlap(filled_b, overlap, larger)};
}

double probability_of_shared_cells(int cells, int filled_a, int filled_b, int least) noexcept {
  const Counts counts(cells, filled_a, filled_b);
  if (least <= counts.first) return 1.0;
  if (least > counts.last) return 0.0;
  // Of the two tails the one that lies on its side of the mode is summed: no cancellation, terms that only shrink.
  if (least > counts.mode()) return std::min(sum_upwards(counts, least), 1.0);
  return std::max(1.0 - sum_downwards(counts, least - 1), 0.0);
}

SharedCellTails shared_cell_tails(int cells, int filled_a, int filled_b) noexcept {
  const Counts counts(cells, filled_a, filled_b);
  SharedCellTails tails;
  const int mode = counts.mode();
  // P[c = t] for t up to ten, and what lies beyond, from one term near the mode by recurrence both ways.
  double exactly[max_shared_cells + 1] = {};
  double beyond = 0.0;
  const int pivot = std::min(mode, max_shared_cells);
  if (pivot >= counts.first) {
    exactly[pivot] = counts.exactly(pivot);
    for (int t = pivot; t > counts.first; --t) {
      exactly[t - 1] = exactly[t] * (counts.step_under(t - 1) / counts.step_over(t - 1));
    }
    // With the mode beyond ten only the lower tails are needed.
    double term = exactly[pivot];
    for (int t = pivot; mode <= max_shared_cells && t < counts.last; ++t) {
      term *= counts.step_over(t) / counts.step_under(t);
      if (t < max_shared_cells) {
        exactly[t + 1] = term;
      } else {
        beyond += term;
        if (term <= negligible * beyond) break;
      }
    }
  }
  double below = 0.0;
  for (int x = 0; x <= max_shared_cells; ++x) {
    tails.at_least[x] = x <= counts.first ? 1.0 : std::max(1.0 - below, 0.0);
    below += exactly[x];
  }
  double above = beyond;
  for (int x = max_shared_cells; x > mode; --x) {
    above += exactly[x];
    tails.at_least[x] = x > counts.last ? 0.0 : (x <= counts.first ? 1.0 : std::min(above, 1.0));
  }
  return tails;
}

double probability_of_shared_cells(const CellCounts& counts, int least) noexcept {
  return interpolate(
      counts, [least](int cells, int a, int b) noexcept { return probability_of_shared_cells(cells, a, b, least); });
}

double collision_probability(int cells, int filled_a, int filled_b, double lower_bound) noexcept {
  return likeliest_collision(shared_cell_tails(cells, filled_a, filled_b), lower_bound);
}

double collision_probability(const CellCounts& counts, double lower_bound) noexcept {
  return likeliest_collision(
      interpolate(counts, [](int cells, int a, int b) noexcept { return shared_cell_tails(cells, a, b); }),
      lower_bound);
}

}  // namespace odds::probability
