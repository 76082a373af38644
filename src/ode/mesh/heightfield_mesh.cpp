// Mesh data from the samples of a heightfield, triangle by triangle as ODE sees it.
#include <algorithm>
#include <cmath>
#include <exception>
#include <string_view>
#include <utility>
#include <vector>

#include "ode/last_error.hpp"
#include "ode/mesh/mesh_data.hpp"

namespace odds::ode {
namespace {

class HeightfieldMesh {
 public:
  explicit HeightfieldMesh(const oddsHeightfield& field)
      : nx_(static_cast<std::uint32_t>(field.width_samples)), nz_(static_cast<std::uint32_t>(field.depth_samples)) {
    const double step_x = field.width / (nx_ - 1);
    const double step_z = field.depth / (nz_ - 1);
    double lowest = HUGE_VAL;
    for (std::uint32_t z = 0; z < nz_; ++z) {
      for (std::uint32_t x = 0; x < nx_; ++x) {
        const double y =
            field.height(field.user, static_cast<int>(x), static_cast<int>(z)) * field.scale + field.offset;
        lowest = std::min(lowest, y);
        vertices.emplace_back(x * step_x - 0.5 * field.width, y, z * step_z - 0.5 * field.depth);
      }
    }
    for (std::uint32_t z = 0; z + 1 < nz_; ++z) {
      for (std::uint32_t x = 0; x + 1 < nx_; ++x) {
        add(at(x, z), at(x, z + 1), at(x + 1, z));
        add(at(x + 1, z), at(x, z + 1), at(x + 1, z + 1));
      }
    }
    if (field.thickness > 0.0) close_below(lowest - field.thickness);
  }

  std::vector<Vec3> vertices;
  std::vector<mesh::Triangle> triangles;

 private:
  [[nodiscard]] std::uint32_t at(std::uint32_t x, std::uint32_t z) const noexcept { return z * nx_ + x; }
  void add(std::uint32_t a, std::uint32_t b, std::uint32_t c) { triangles.push_back({a, b, c}); }

  // Walls down from the border, and a fan as bottom.
  void close_below(double bottom) {
    std::vector<std::uint32_t> border;  // clockwise seen from above, so that the walls face outwards
    for (std::uint32_t x = 0; x + 1 < nx_; ++x) border.push_back(at(x, 0));
    for (std::uint32_t z = 0; z + 1 < nz_; ++z) border.push_back(at(nx_ - 1, z));
    for (std::uint32_t x = nx_ - 1; x > 0; --x) border.push_back(at(x, nz_ - 1));
    for (std::uint32_t z = nz_ - 1; z > 0; --z) border.push_back(at(0, z));
    const auto below = static_cast<std::uint32_t>(vertices.size());
    for (const std::uint32_t v : border) vertices.emplace_back(vertices[v].x(), bottom, vertices[v].z());
    const auto middle = static_cast<std::uint32_t>(vertices.size());
    vertices.emplace_back(0.0, bottom, 0.0);
    const auto count = static_cast<std::uint32_t>(border.size());
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t next = (i + 1) % count;
      add(border[i], border[next], below + next);
      add(border[i], below + next, below + i);
      add(below + i, below + next, middle);
    }
  }

  std::uint32_t nx_;
  std::uint32_t nz_;
};

bool is_valid(const oddsHeightfield& field) noexcept {
  constexpr int most_samples = 1 << 13;  // 8192 x 8192: 134 million triangles, more than a mesh holds
  return field.height != nullptr && field.width > 0.0 && field.width < 1e15 && field.depth > 0.0 &&
         field.depth < 1e15 && field.width_samples >= 2 && field.width_samples <= most_samples &&
         field.depth_samples >= 2 && field.depth_samples <= most_samples && std::isfinite(field.scale) &&
         std::isfinite(field.offset) && field.thickness >= 0.0 && field.thickness < 1e15;
}

}  // namespace
}  // namespace odds::ode

int oddsMeshDataBuildHeightfield(oddsMeshDataID data, const oddsHeightfield* field,
                                 const oddsBuildParams* params) noexcept {
  using odds::ode::set_last_error;
  if (field == nullptr || !odds::ode::is_valid(*field)) {
    set_last_error(
        "oddsMeshDataBuildHeightfield: no function for the heights, or a size, count (2 .. 8192), scale, offset or "
        "thickness (>= 0) out of range");
    return 0;
  }
  try {
    odds::ode::HeightfieldMesh mesh(*field);
    return odds::ode::build_mesh_data(data, std::move(mesh.vertices), std::move(mesh.triangles), params);
  } catch (const std::exception& error) {
    set_last_error(std::string_view(error.what()));
  } catch (...) {
    set_last_error("oddsMeshDataBuildHeightfield: unknown failure");
  }
  return 0;
}
