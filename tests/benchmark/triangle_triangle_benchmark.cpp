// Cost of one triangle pair as leaves meet it: separated by a plane, crossing, grazing, in one plane; and distances.
#include <array>
#include <random>
#include <vector>

#include <benchmark/benchmark.h>

#include "odds/primitive/triangle_box.hpp"
#include "odds/primitive/triangle_distance.hpp"
#include "odds/primitive/triangle_triangle.hpp"

namespace {

using odds::Vec3;
using odds::primitive::triangles_intersect;
struct Pair {
  std::array<Vec3, 3> a;
  std::array<Vec3, 3> b;
};

enum Kind { apart, crossing, mixed, shared_corner, one_plane_exactly, one_plane_rounded };

std::vector<Pair> make_pairs(Kind kind) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const auto draw = [&] { return Vec3(unit(random), unit(random), unit(random)); };
  const odds::Mat3 turn = odds::Quat(0.3, 0.1, -0.5, 0.7).normalized().toRotationMatrix();
  std::vector<Pair> pairs;
  while (pairs.size() < 1024) {
    Pair p{{draw(), draw(), draw()}, {draw(), draw(), draw()}};
    if (kind == apart) {
      for (Vec3& corner : p.b) corner += Vec3(1.0, 0.5, 0.5);
    }
    if (kind == shared_corner) p.b[0] = p.a[0];
    for (auto* t : {&p.a, &p.b}) {
      for (Vec3& corner : *t) {
        // On a grid of 2^-20 the sum is exact.
        if (kind == one_plane_exactly) corner = Vec3((corner * 0x1p20).array().round()) * 0x1p-20;
        if (kind == one_plane_exactly || kind == one_plane_rounded) corner.z() = corner.x() + corner.y();
        if (kind == one_plane_rounded) corner = turn * corner;
      }
    }
    const bool meet = triangles_intersect(p.a.data(), p.b.data());
    if ((kind == apart && meet) || (kind == crossing && !meet)) continue;
    pairs.push_back(p);
  }
  return pairs;
}

void intersect(benchmark::State& state, Kind kind) {
  const std::vector<Pair> pairs = make_pairs(kind);
  std::size_t i = 0;
  for (auto _ : state) {
    const Pair& p = pairs[i++ & 1023];
    benchmark::DoNotOptimize(triangles_intersect(p.a.data(), p.b.data()));
  }
}
BENCHMARK_CAPTURE(intersect, apart, apart);
BENCHMARK_CAPTURE(intersect, crossing, crossing);
BENCHMARK_CAPTURE(intersect, mixed, mixed);
BENCHMARK_CAPTURE(intersect, shared_corner, shared_corner);
BENCHMARK_CAPTURE(intersect, one_plane_exactly, one_plane_exactly);
BENCHMARK_CAPTURE(intersect, one_plane_rounded, one_plane_rounded);

void segment_of_crossing(benchmark::State& state) {
  const std::vector<Pair> pairs = make_pairs(crossing);
  std::size_t i = 0;
  odds::primitive::IntersectionSegment segment;
  for (auto _ : state) {
    const Pair& p = pairs[i++ & 1023];
    benchmark::DoNotOptimize(odds::primitive::intersection_segment(p.a.data(), p.b.data(), segment));
  }
}
BENCHMARK(segment_of_crossing);

void distance_of_apart(benchmark::State& state) {
  const std::vector<Pair> pairs = make_pairs(apart);
  std::size_t i = 0;
  for (auto _ : state) {
    const Pair& p = pairs[i++ & 1023];
    benchmark::DoNotOptimize(odds::primitive::closest_points(p.a.data(), p.b.data()));
  }
}
BENCHMARK(distance_of_apart);

void triangle_against_box(benchmark::State& state) {
  const std::vector<Pair> pairs = make_pairs(mixed);
  const odds::Mat3 axes = odds::Quat(0.3, 0.1, -0.5, 0.7).normalized().toRotationMatrix();
  std::size_t i = 0;
  for (auto _ : state) {
    const Pair& p = pairs[i++ & 1023];
    benchmark::DoNotOptimize(odds::primitive::triangle_may_overlap_box(p.a.data(), p.b[0], axes, Vec3(0.3, 0.2, 0.1)));
  }
}
BENCHMARK(triangle_against_box);

}  // namespace
