// One engine with two meshes loaded, as the comparison with other engines sees it.
#pragma once

#include <malloc.h>

#include <algorithm>
#include <cstddef>
#include <ctime>
#include <memory>
#include <string>
#include <vector>

#include "odds/math/pose.hpp"
#include "odds/mesh/triangle_mesh.hpp"

namespace odds::benchmark {

/// Microseconds by one of the system's clocks.
[[nodiscard]] inline double clock_us(clockid_t clock) noexcept {
  timespec now{};
  clock_gettime(clock, &now);
  return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}

/// What one mesh costs before the first query.
struct Footprint {
  double build_ms = 0.0;            ///< wall time of one build, median
  double build_cpu_ms = 0.0;        ///< time of all processors for one build, median
  double bytes_per_triangle = 0.0;  ///< growth of the heap by one build, the caller's mesh not counted
};

/// The same pointer twice: an engine that can share what it builds does.
struct MeshPair {
  std::shared_ptr<const mesh::TriangleMesh> a;
  std::shared_ptr<const mesh::TriangleMesh> b;
};

/// An engine ready to answer for poses of B's mesh frame in A's. For one thread.
class Peer {
 public:
  explicit Peer(std::string name) : name_(std::move(name)) {}
  virtual ~Peer() = default;
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;

  [[nodiscard]] const std::string& name() const noexcept { return name_; }
  [[nodiscard]] const Footprint& footprint() const noexcept { return footprint_; }
  /// Whether it is meant to profit from the previous answer; then `forget` is not called along a trajectory.
  [[nodiscard]] virtual bool is_coherent() const noexcept { return false; }
  /// Drops what the last answer left behind. Not timed.
  virtual void forget() noexcept {}
  [[nodiscard]] virtual bool collide(const math::Pose& pose_b_in_a) = 0;
  /// All contacts or pairs, as many as the engine's usual limit allows; how many.
  [[nodiscard]] virtual std::size_t contacts(const math::Pose& pose_b_in_a) = 0;

 protected:
  /// make() several times; keeps the first and notes what it took.
  template <class Make>
  auto build_measured(std::size_t triangles, int builds, const Make& make) {
    const std::size_t before = heap_bytes();
    std::vector<double> wall;
    std::vector<double> cpu;
    auto model = timed(make, wall, cpu);
    footprint_.bytes_per_triangle =
        static_cast<double>(heap_bytes() - before) / static_cast<double>(std::max<std::size_t>(1, triangles));
    for (int i = 1; i < builds; ++i) static_cast<void>(timed(make, wall, cpu));
    std::sort(wall.begin(), wall.end());
    std::sort(cpu.begin(), cpu.end());
    footprint_.build_ms = wall[wall.size() / 2];
    footprint_.build_cpu_ms = cpu[cpu.size() / 2];
    return model;
  }

 private:
  static std::size_t heap_bytes() {
    const struct mallinfo2 info = mallinfo2();
    return info.uordblks + info.hblkhd;
  }

  template <class Make>
  static auto timed(const Make& make, std::vector<double>& wall, std::vector<double>& cpu) {
    const double start_us = clock_us(CLOCK_MONOTONIC);
    const double start_cpu_us = clock_us(CLOCK_PROCESS_CPUTIME_ID);
    auto model = make();
    cpu.push_back(1e-3 * (clock_us(CLOCK_PROCESS_CPUTIME_ID) - start_cpu_us));
    wall.push_back(1e-3 * (clock_us(CLOCK_MONOTONIC) - start_us));
    return model;
  }

  std::string name_;
  Footprint footprint_;
};

}  // namespace odds::benchmark
