#include "ode/collide/gather_pieces.hpp"

#include <cstdint>
#include <span>

#include "ode/collide/convex_patch.hpp"
#include "ode/mesh/triangle_corners.hpp"

namespace odds::ode {
namespace {

constexpr std::size_t octants = 8;
constexpr std::size_t each = Pieces::most / octants;
/// Cut whatever the time: without any a body falls through what it has just found.
constexpr std::size_t least_cut = octants;

/// Those of a tetrahedron first: any face of the body has two of them, opposite each other.
constexpr std::array<std::size_t, octants> in_order = {0, 3, 5, 6, 7, 4, 2, 1};

/// Triangles near the body by octants of it, or all in the first.
struct Near {
  std::array<std::uint32_t, Pieces::most> triangles;
  std::array<std::size_t, octants> counts = {};
  bool by_octants = false;
};

void find_near(const PreparedMesh& mesh, const math::Pose& body_in_mesh, const ConvexBody& body, Limit& limit,
               Pieces& pieces, Near& near) noexcept {
  const Vec3& half = body.box_half_extents();
  std::uint64_t visited = 0;
  const std::size_t found =
      query::triangles_in_box(*mesh.shape, body_in_mesh * body.box_center(), body_in_mesh.rotation, half,
                              near.triangles, limit.nodes_in_time(time_for_pieces), &pieces.complete, &visited);
  limit.spend(visited);
  near.counts[0] = found;
  pieces.cut_off = !pieces.complete && found < near.triangles.size();
  // Nothing is left to look anew, or no time.
  if (pieces.complete || limit.units == 0 || limit.time_is_up(time_for_pieces)) return;
  near.by_octants = true;
  near.counts[0] = 0;
  for (const std::size_t octant : in_order) {
    if (octant != in_order.front() && limit.time_is_up(time_for_pieces)) {
      pieces.cut_off = true;
      return;
    }
    const Vec3 signs(octant & 1U ? 0.5 : -0.5, octant & 2U ? 0.5 : -0.5, octant & 4U ? 0.5 : -0.5);
    const Vec3 center = body.box_center() + half.cwiseProduct(signs);
    bool octant_complete = true;
    near.counts[octant] = query::triangles_in_box(*mesh.shape, body_in_mesh * center, body_in_mesh.rotation, 0.5 * half,
                                                  std::span(near.triangles).subspan(octant * each, each),
                                                  limit.nodes_in_time(time_for_pieces), &octant_complete, &visited);
    limit.spend(visited);
    pieces.cut_off = pieces.cut_off || (!octant_complete && near.counts[octant] < each);
  }
}

}  // namespace

void gather_pieces(const PreparedMesh& mesh, const math::Pose& body_in_mesh, const ConvexBody& body, Limit& limit,
                   Pieces& pieces) noexcept {
  Near near;
  find_near(mesh, body_in_mesh, body, limit, pieces, near);
  const math::Pose mesh_in_body = body_in_mesh.inverse();
  const std::size_t groups = near.by_octants ? octants : 1;
  const std::size_t rounds = near.by_octants ? each : near.counts[0];
  std::size_t cut = 0;
  for (std::size_t round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < groups; ++i) {
      const std::size_t group = in_order[i];
      if (round >= near.counts[group]) continue;
      if (cut++ >= least_cut && limit.time_is_up(time_for_pieces)) {
        pieces.complete = false;
        pieces.cut_off = true;
        return;
      }
      const std::uint32_t triangle = near.triangles[group * each + round];
      Corners corners = mesh.corners(triangle);
      for (Vec3& corner : corners) corner = mesh_in_body * corner;
      Piece& piece = pieces.all[pieces.count];
      piece.triangle = triangle;
      if (cut_by_sides(corners, body, piece)) ++pieces.count;
    }
  }
}

}  // namespace odds::ode
