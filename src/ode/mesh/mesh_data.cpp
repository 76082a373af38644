// Mesh data of the C interface: creation, and building from arrays or from a finished shape.
#include "ode/mesh/mesh_data.hpp"

#include <exception>
#include <new>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "odds/ode/geom.hpp"
#include "ode/last_error.hpp"

namespace odds::ode {
namespace {

std::optional<Error> check(const oddsBuildParams& params, const std::string& name) {
  if (params.volume < 0 || params.volume >= static_cast<int>(volume::kind_names.size())) {
    return Error{name, "", "oddsBuildParams.volume is unknown", "use one of ODDS_VOLUME_AABB ... ODDS_VOLUME_WIDE"};
  }
  if (params.leaf_triangles < 0 || params.leaf_triangles > 16) {
    return Error{name, "", "oddsBuildParams.leaf_triangles is out of range",
                 "use 1 .. 16, or 0 for what suits the volume (default)"};
  }
  if (!(params.tau > 0.0 && params.tau <= 1.0)) {
    return Error{name, "", "oddsBuildParams.tau is out of range", "use 0 < tau <= 1 (default 0.25)"};
  }
  return std::nullopt;
}

/// The C interface numbers volumes as volume::Kind does; tests/architecture holds them together.
volume::Kind kind_of(int volume) noexcept { return static_cast<volume::Kind>(volume); }

template <class Scalar>
int build_from_arrays(oddsMeshDataID data, const Scalar* vertices, int vertex_stride, int vertex_count,
                      const dTriIndex* indices, int index_count, int triangle_stride, const oddsBuildParams* params) {
  if (vertices == nullptr || indices == nullptr || vertex_count <= 0 || index_count <= 0 || index_count % 3 != 0) {
    set_last_error(
        "mesh data: null array, or a count that is not positive, or index_count not a multiple of 3; "
        "give vertex_count vertices and 3 indices per triangle");
    return 0;
  }
  if (vertex_stride < static_cast<int>(3 * sizeof(Scalar)) ||
      triangle_stride < static_cast<int>(3 * sizeof(dTriIndex))) {
    set_last_error("mesh data: a stride is smaller than its element; strides are in bytes");
    return 0;
  }
  std::vector<Vec3> points(static_cast<std::size_t>(vertex_count));
  const char* vertex_bytes = reinterpret_cast<const char*>(vertices);
  for (Vec3& point : points) {
    const auto* v = reinterpret_cast<const Scalar*>(vertex_bytes);
    point = Vec3(static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2]));
    vertex_bytes += vertex_stride;
  }
  std::vector<mesh::Triangle> triangles(static_cast<std::size_t>(index_count) / 3);
  const char* triangle_bytes = reinterpret_cast<const char*>(indices);
  for (mesh::Triangle& triangle : triangles) {
    const auto* t = reinterpret_cast<const dTriIndex*>(triangle_bytes);
    triangle = {t[0], t[1], t[2]};
    triangle_bytes += triangle_stride;
  }
  return build_mesh_data(data, std::move(points), std::move(triangles), params);
}

// No exception crosses the C border.
template <class Function>
int guarded(const Function& function) noexcept {
  try {
    return function();
  } catch (const std::bad_alloc&) {
    set_last_error("mesh data: out of memory; use a smaller mesh or free memory");
  } catch (const std::exception& error) {
    set_last_error(std::string_view(error.what()));
  } catch (...) {
    set_last_error("mesh data: unknown failure");
  }
  return 0;
}

}  // namespace

int build_mesh_data(oddsMeshDataID data, std::vector<Vec3> vertices, std::vector<mesh::Triangle> triangles,
                    const oddsBuildParams* params) {
  if (data == nullptr) {
    set_last_error("mesh data: the id is null; make one with oddsMeshDataCreate");
    return 0;
  }
  oddsBuildParams defaults;
  oddsBuildParamsInit(&defaults);
  const oddsBuildParams& used = params != nullptr ? *params : defaults;
  const std::string name = used.name != nullptr ? used.name : "mesh";
  if (const std::optional<Error> error = check(used, name)) {
    set_last_error(*error);
    return 0;
  }
  Result<mesh::TriangleMesh> mesh = mesh::TriangleMesh::make(std::move(vertices), std::move(triangles), name);
  if (!mesh.ok()) {
    set_last_error(mesh.error());
    return 0;
  }
  query::ShapeOptions options;
  options.volume = kind_of(used.volume);
  options.leaf_triangles = static_cast<std::uint32_t>(used.leaf_triangles);
  options.tau = used.tau;
  auto shape = query::Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(mesh).value()), options);
  if (!shape.ok()) {
    set_last_error(shape.error());
    return 0;
  }
  data->prepared = PreparedMesh::make(std::move(shape).value());
  return 1;
}

oddsMeshDataID oddsMeshDataFromShape(std::shared_ptr<const query::Shape> shape) noexcept {
  if (shape == nullptr) {
    set_last_error("oddsMeshDataFromShape: the shape is null; build one with query::Shape::build");
    return nullptr;
  }
  if (!shape->has_polygons()) {
    set_last_error("oddsMeshDataFromShape: the shape's polygons were dropped; give one that has them");
    return nullptr;
  }
  std::unique_ptr<oddsMeshData> data(oddsMeshDataCreate());
  if (data == nullptr) return nullptr;
  const int built = guarded([&] {
    data->prepared = PreparedMesh::make(std::move(shape));
    return 1;
  });
  return built != 0 ? data.release() : nullptr;
}

}  // namespace odds::ode

void oddsBuildParamsInit(oddsBuildParams* params) noexcept {
  if (params == nullptr) return;
  params->volume = ODDS_VOLUME_WIDE;
  params->leaf_triangles = 0;
  params->tau = 0.25;
  params->name = nullptr;
}

oddsMeshDataID oddsMeshDataCreate(void) noexcept {
  auto* data = new (std::nothrow) oddsMeshData;
  if (data == nullptr) odds::ode::set_last_error("oddsMeshDataCreate: out of memory");
  return data;
}

void oddsMeshDataDestroy(oddsMeshDataID data) noexcept { delete data; }

int oddsMeshDataBuildDouble(oddsMeshDataID data, const double* vertices, int vertex_stride, int vertex_count,
                            const dTriIndex* indices, int index_count, int triangle_stride,
                            const oddsBuildParams* params) noexcept {
  return odds::ode::guarded([&] {
    return odds::ode::build_from_arrays(data, vertices, vertex_stride, vertex_count, indices, index_count,
                                        triangle_stride, params);
  });
}

int oddsMeshDataBuildSingle(oddsMeshDataID data, const float* vertices, int vertex_stride, int vertex_count,
                            const dTriIndex* indices, int index_count, int triangle_stride,
                            const oddsBuildParams* params) noexcept {
  return odds::ode::guarded([&] {
    return odds::ode::build_from_arrays(data, vertices, vertex_stride, vertex_count, indices, index_count,
                                        triangle_stride, params);
  });
}

int oddsMeshDataGetTriangleCount(oddsMeshDataID data) noexcept {
  if (data == nullptr || data->prepared == nullptr) return 0;
  return static_cast<int>(data->prepared->mesh().triangles().size());
}

int oddsMeshDataIsClosed(oddsMeshDataID data) noexcept {
  return data != nullptr && data->prepared != nullptr && data->prepared->closed ? 1 : 0;
}
