// Cost of filling cells: one triangle inside one cell, and triangles that cross many.
#include <random>
#include <vector>

#include <benchmark/benchmark.h>

#include "odds/tree/well_filled_cells.hpp"

namespace {

using odds::Vec3;

// Argument: the triangles' size as a percentage of the box's half extent.
void add_triangles(benchmark::State& state) {
  const double size = 0.01 * static_cast<double>(state.range(0));
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const auto draw = [&] { return Vec3(unit(random), unit(random), unit(random)); };
  std::vector<Vec3> corners;
  for (int i = 0; i < 1024; ++i) {
    const Vec3 middle = (1.0 - size) * draw();
    for (int k = 0; k < 3; ++k) corners.push_back(middle + size * draw());
  }
  const odds::Mat3 axes = odds::Quat(0.3, 0.1, -0.5, 0.7).normalized().toRotationMatrix();
  for (Vec3& corner : corners) corner = axes * corner;
  odds::tree::CellCounter cells;
  cells.begin(Vec3::Zero(), axes, Vec3(1, 1, 1));
  std::size_t i = 0;
  for (auto _ : state) {
    cells.add(corners[i], corners[i + 1], corners[i + 2]);
    i = (i + 3) % corners.size();
  }
}
BENCHMARK(add_triangles)->Arg(1)->Arg(5)->Arg(20)->Arg(50)->Arg(100);

void begin_and_count(benchmark::State& state) {
  odds::tree::CellCounter cells;
  for (auto _ : state) {
    cells.begin(Vec3::Zero(), odds::Mat3::Identity(), Vec3(1, 1, 1));
    benchmark::DoNotOptimize(cells.count(0.5));
  }
}
BENCHMARK(begin_and_count);

}  // namespace
