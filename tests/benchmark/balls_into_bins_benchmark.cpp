// The book's estimator by formula and by table, on counts as a traversal meets them, and the making of the table.
#include <random>
#include <vector>

#include <benchmark/benchmark.h>

#include "odds/probability/balls_table.hpp"

namespace {

using odds::probability::BallsTable;
using odds::probability::CellCounts;

std::vector<CellCounts> random_counts(bool whole) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<CellCounts> counts(4096);
  for (CellCounts& c : counts) {
    c.cells = 1.0 + 511.0 * unit(random);
    c.filled_a = 0.25 * c.cells * unit(random);
    c.filled_b = 0.25 * c.cells * unit(random);
    if (whole) c = {std::floor(c.cells), std::floor(c.filled_a), std::floor(c.filled_b)};
  }
  return counts;
}

void formula(benchmark::State& state) {
  const auto counts = random_counts(state.range(0) != 0);
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(odds::probability::collision_probability(counts[i++ & 4095], 0.3));
}
BENCHMARK(formula)->ArgName("whole")->Arg(0)->Arg(1);

void table(benchmark::State& state) {
  const auto counts = random_counts(state.range(0) != 0);
  const BallsTable& shared = BallsTable::shared();
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(shared.collision_probability(counts[i++ & 4095], 0.3));
}
BENCHMARK(table)->ArgName("whole")->Arg(0)->Arg(1);

void make_table(benchmark::State& state) {
  for (auto _ : state) {
    const BallsTable made;
    state.counters["bytes"] = static_cast<double>(made.size_in_bytes());
  }
}
BENCHMARK(make_table)->Unit(benchmark::kMillisecond);

}  // namespace
