// What this library keeps for each of its geoms, and its pose.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "odds/math/pose.hpp"
#include "odds/math/tolerances.hpp"
#include "odds/ode/odds_ode.h"
#include "odds/query/request.hpp"
#include "ode/geom/ending_times.hpp"
#include "ode/geom/last_places.hpp"
#include "ode/geom/resting_contacts.hpp"
#include "ode/mesh/prepared_mesh.hpp"

namespace odds::ode {

struct PairEntry;

/// The settings of one geom; ranges and meanings stand at the setters in odds_ode.h.
struct Settings {
  double budget_us = 100.0;
  unsigned long work_units = 0;  ///< 0: no limit
  double p_min = 1.0;
  std::uint32_t k_min = 10;
  int max_contacts = 8;
  double carry_motion = tolerances::resting_motion;
  double margin_m = 0.0;
  bool late_contacts = true;
  query::Method method = query::Method::incremental;
  query::EstimatorKind estimator = query::EstimatorKind::kinematic;
  int undecided_policy = ODDS_UNDECIDED_HIT;
  double undecided_probability = 0.5;

  [[nodiscard]] bool operator==(const Settings&) const noexcept = default;
};

/// The more careful of both settings in every respect; symmetric.
[[nodiscard]] Settings combine(const Settings& a, const Settings& b) noexcept;

/// ODE aligns class data to 16 bytes only, so that holds one pointer to this.
struct GeomData {
  std::shared_ptr<const PreparedMesh> mesh;
  Settings settings;
  std::uint64_t number = 0;       ///< unique for the process, in order of creation: never reused, unlike addresses
  std::vector<PairEntry*> pairs;  ///< workspaces that this geom takes part in
  RestingContacts resting;        ///< with bodies that are no meshes
  LastPlaces met;                 ///< by those
  EndingTimes endings;            ///< of collisions with those
  math::Pose seen_at;             ///< where it stood in the last broad phase that noted it
  std::uint64_t seen_in = 0;      ///< the number of that; 0: none
};

/// A number for GeomData::number. Thread-safe.
[[nodiscard]] std::uint64_t next_geom_number() noexcept;

/// The data of a geom that is known to be of our class, or to have a mesh that stands in for it (in colliders).
[[nodiscard]] GeomData& own_data(dGeomID geom) noexcept;

/// The data of any geom, or null if it is neither one of ours nor has a mesh that stands in. Allocates nothing.
[[nodiscard]] GeomData* known_data(dGeomID geom) noexcept;

/// The same, with the last error set where there is none.
[[nodiscard]] GeomData* find_data(dGeomID geom, const char* caller) noexcept;

/// Whether a point is finite and no farther than 1e15 m from the origin.
[[nodiscard]] bool is_position(const Vec3& point) noexcept;

/// The world pose, offsets and transforms included; the rotation is made orthonormal if ODE's is slightly off. Nothing
/// if it is not finite, farther than 1e15 m, or no rotation.
[[nodiscard]] std::optional<math::Pose> world_pose(dGeomID geom) noexcept;

/// ODE's callbacks for the class.
void compute_aabb(dGeomID geom, dReal aabb[6]) noexcept;
void destroy_data(dGeomID geom) noexcept;

}  // namespace odds::ode
