// Meshes for the eye: vertex clustering.
#include <algorithm>
#include <cmath>
#include <map>

#include "odds/report/run_replay.hpp"

namespace odds::report {
namespace {

using Cell = std::array<std::int32_t, 3>;

/// Of vertices that belong to a triangle; the others may lie anywhere, and are not shown.
std::vector<bool> used_vertices(const mesh::TriangleMesh& mesh) {
  std::vector<bool> used(mesh.vertices().size(), false);
  for (const mesh::Triangle& t : mesh.triangles()) {
    for (const std::uint32_t vertex : t) used[vertex] = true;
  }
  return used;
}

ReplayMesh whole(const mesh::TriangleMesh& mesh) {
  const std::vector<bool> used = used_vertices(mesh);
  std::vector<std::uint32_t> place(used.size(), 0);
  ReplayMesh shown;
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (!used[i]) continue;
    place[i] = static_cast<std::uint32_t>(shown.vertices.size());
    const Vec3& v = mesh.vertices()[i];
    shown.vertices.push_back({static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())});
  }
  for (const mesh::Triangle& t : mesh.triangles()) shown.triangles.push_back({place[t[0]], place[t[1]], place[t[2]]});
  return shown;
}

ReplayMesh clustered(const mesh::TriangleMesh& mesh, const std::vector<bool>& used, double cell_m) {
  struct Cluster {
    std::uint32_t index = 0;
    Vec3 sum = Vec3::Zero();
    double count = 0.0;
  };
  std::map<Cell, Cluster> clusters;
  std::vector<std::uint32_t> cluster_of(used.size(), 0);
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (!used[i]) continue;
    const Vec3& v = mesh.vertices()[i];
    const Vec3 at = ((v - mesh.lower()) / cell_m).cwiseMax(0.0).cwiseMin(1e9);
    const Cell cell = {static_cast<std::int32_t>(at.x()), static_cast<std::int32_t>(at.y()),
                       static_cast<std::int32_t>(at.z())};
    Cluster& cluster =
        clusters.try_emplace(cell, Cluster{static_cast<std::uint32_t>(clusters.size()), Vec3::Zero(), 0.0})
            .first->second;
    cluster.sum += v;
    cluster.count += 1.0;
    cluster_of[i] = cluster.index;
  }
  ReplayMesh small;
  small.vertices.resize(clusters.size());
  for (const auto& [cell, cluster] : clusters) {
    const Vec3 mean = cluster.sum / cluster.count;
    small.vertices[cluster.index] = {static_cast<float>(mean.x()), static_cast<float>(mean.y()),
                                     static_cast<float>(mean.z())};
  }
  for (const mesh::Triangle& t : mesh.triangles()) {
    const mesh::Triangle merged = {cluster_of[t[0]], cluster_of[t[1]], cluster_of[t[2]]};
    if (merged[0] != merged[1] && merged[1] != merged[2] && merged[2] != merged[0]) small.triangles.push_back(merged);
  }
  return small;
}

}  // namespace

ReplayMesh simplified(const mesh::TriangleMesh& mesh, std::size_t most_triangles) {
  ReplayMesh small;
  if (mesh.triangles().size() <= most_triangles) {
    small = whole(mesh);
  } else {
    // A surface of n triangles crosses about n / 2 cells: begin there, and coarsen until it fits.
    const std::vector<bool> used = used_vertices(mesh);
    double cell_m = mesh.size() / std::sqrt(static_cast<double>(std::max<std::size_t>(most_triangles, 1)));
    small = clustered(mesh, used, cell_m);
    while (small.triangles.size() > most_triangles) small = clustered(mesh, used, cell_m *= 1.3);
  }
  small.triangles_of_mesh = mesh.triangles().size();
  return small;
}

}  // namespace odds::report
