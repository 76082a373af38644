// A convex polyhedron with any number of faces, made from the arrays that ODE's convex geoms are made from.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "odds/math/error.hpp"
#include "ode/geom/convex_body.hpp"

namespace odds::ode {

/// Immutable; shareable among threads.
class ConvexShape final : public ConvexBody {
 public:
  static constexpr std::size_t most_faces = 1024;
  static constexpr std::size_t most_points = 4096;

  /// `polygons` is a number of corners followed by as many indices into `points`, for each of `face_count` faces.
  /// Refused: counts out of range, indices out of range, coordinates not finite, a face without area, a point outside
  /// of a face by more than 1e-6 of the size (then it is not convex), an edge of one face only (then one is missing),
  /// no volume.
  static Result<std::shared_ptr<const ConvexShape>> make(std::span<const Vec3> points, const unsigned* polygons,
                                                         std::size_t face_count);
  ConvexShape(const ConvexShape&) = delete;
  ConvexShape& operator=(const ConvexShape&) = delete;

  [[nodiscard]] std::span<const Vec3> points() const noexcept { return points_; }

  [[nodiscard]] std::uint64_t number() const noexcept override { return number_; }
  [[nodiscard]] Vec3 farthest(const Vec3& direction) const noexcept override;
  [[nodiscard]] double way_through(const Vec3& point, const Vec3& direction) const noexcept override;
  [[nodiscard]] bool may_lean() const noexcept override { return leans_; }
  void add_exits(std::span<const Piece* const> patch, bool refined, ExitList& exits) const noexcept override;
  void add_features(const Vec3& up, double depth, Features& features) const noexcept override;

 private:
  ConvexShape() noexcept;
  [[nodiscard]] static Result<HalfSpace> face_of(std::span<const Vec3> points, std::span<const unsigned> corners,
                                                 const Vec3& inside, std::size_t number);
  /// One that a single face has, of `edges_` in order, each as often as polygons have it.
  [[nodiscard]] std::optional<std::array<unsigned, 2>> open_edge(double tolerance) const noexcept;

  void add_crossings(std::span<const Piece* const> patch, ExitList& exits) const noexcept;

  static constexpr std::size_t start_count = 96;  ///< six sides of a cube, sixteen parts of each
  void prepare_climbing();
  void prepare_many_sides();
  [[nodiscard]] unsigned climb(const Vec3& direction) const noexcept;
  [[nodiscard]] static std::size_t start_of(const Vec3& direction) noexcept;

  std::vector<Vec3> points_;
  std::vector<HalfSpace> faces_;
  std::vector<query::wide::EightSides> faces_by_eight_;  ///< of more than few
  std::vector<std::array<unsigned, 2>> edges_;
  std::vector<Vec3> edge_directions_;  ///< unit, of `edges_`, no two parallel; of many only the first
  bool leans_ = false;                 ///< two faces at one corner face away from each other
  bool climbs_ = false;                ///< the farthest point is found along edges, from a start for each direction
  std::array<unsigned, start_count> starts_{};
  std::vector<unsigned> neighbours_;     ///< of all points in turn
  std::vector<unsigned> neighbours_at_;  ///< of each point's first one, and the end
  std::uint64_t number_;                 ///< unique for the process, never 0
};

}  // namespace odds::ode
