// Pairs of meshes that engines are compared on.
#pragma once

#include <string>
#include <vector>

#include "benchmark/peer.hpp"
#include "odds/math/error.hpp"

namespace odds::benchmark {

struct Workload {
  std::string name;
  MeshPair meshes;
  bool nested = false;  ///< B is a smaller copy inside A: compared in the class `nested` only
};

/// Two copies of a mesh: a file, or a made shape as "made:NAME:key=value".
[[nodiscard]] Result<Workload> two_copies(const std::string& mesh);
[[nodiscard]] Result<Workload> unlike_pair(const std::string& a, const std::string& b);
/// The mesh, and inside it its copy scaled by 0.994 about the middle of its box.
[[nodiscard]] Result<Workload> nested_copies(const std::string& mesh);

/// Made shapes of some 60,000 triangles; meshes of Debian's openfoam-examples that are installed; nested copies.
[[nodiscard]] Result<std::vector<Workload>> default_workloads();

}  // namespace odds::benchmark
