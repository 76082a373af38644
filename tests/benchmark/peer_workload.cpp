#include "benchmark/peer_workload.hpp"

#include <filesystem>

#include "benchmark/mesh_argument.hpp"

namespace odds::benchmark {
namespace {

using SharedMesh = std::shared_ptr<const mesh::TriangleMesh>;

Result<SharedMesh> scaled(const mesh::TriangleMesh& mesh, double factor) {
  const Vec3 middle = 0.5 * (mesh.lower() + mesh.upper());
  std::vector<Vec3> vertices(mesh.vertices().begin(), mesh.vertices().end());
  for (Vec3& vertex : vertices) vertex = middle + factor * (vertex - middle);
  auto copy = mesh::TriangleMesh::make(std::move(vertices), {mesh.triangles().begin(), mesh.triangles().end()},
                                       mesh.name() + ", scaled");
  if (!copy.ok()) return copy.error();
  return std::make_shared<const mesh::TriangleMesh>(std::move(copy).value());
}

std::string short_name(const std::string& mesh) {
  return mesh.starts_with(mesh::made::prefix) ? mesh : std::filesystem::path(mesh).filename().string();
}

}  // namespace

Result<Workload> two_copies(const std::string& mesh) {
  const auto loaded = mesh_of(mesh);
  if (!loaded.ok()) return loaded.error();
  return Workload{short_name(mesh), {loaded.value(), loaded.value()}, false};
}

Result<Workload> unlike_pair(const std::string& a, const std::string& b) {
  const auto loaded_a = mesh_of(a);
  if (!loaded_a.ok()) return loaded_a.error();
  const auto loaded_b = mesh_of(b);
  if (!loaded_b.ok()) return loaded_b.error();
  return Workload{short_name(a) + " + " + short_name(b), {loaded_a.value(), loaded_b.value()}, false};
}

Result<Workload> nested_copies(const std::string& mesh) {
  const auto outer = mesh_of(mesh);
  if (!outer.ok()) return outer.error();
  const auto inner = scaled(*outer.value(), 0.994);
  if (!inner.ok()) return inner.error();
  return Workload{"nested in itself: " + short_name(mesh), {outer.value(), inner.value()}, true};
}

Result<std::vector<Workload>> default_workloads() {
  std::vector<std::string> names = {"made:car_body:triangles=60000", "made:bumpy_sphere:frequency=55",
                                    "made:torus_knot:along=1250,across=24", "made:plates:count=8,cells=60,wave=0.004",
                                    "made:nested_shells:frequency=39"};
  const std::filesystem::path folder = "/usr/share/doc/openfoam-examples/examples/resources/geometry";
  for (const char* file : {"flange.stl.gz", "DTC-scaled.stl.gz", "motorBike.obj.gz"}) {
    if (std::filesystem::exists(folder / file)) names.push_back((folder / file).string());
  }
  std::vector<Workload> workloads;
  for (const std::string& name : names) {
    auto workload = two_copies(name);
    if (!workload.ok()) return workload.error();
    workloads.push_back(std::move(workload).value());
  }
  auto nested = nested_copies("made:bumpy_sphere:frequency=55");
  if (!nested.ok()) return nested.error();
  workloads.push_back(std::move(nested).value());
  return workloads;
}

}  // namespace odds::benchmark
