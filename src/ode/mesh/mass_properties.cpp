// Volume integrals over the signed tetrahedra between a point and the triangles.
#include "ode/mesh/mass_properties.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace odds::ode {
namespace {

// Beyond these ODE's products and quotients of masses, inertias and forces overflow, and it ends the program.
constexpr double least_mass_kg = 1e-9;
constexpr double greatest_mass_kg = 1e12;
constexpr double least_size_m = 1e-9;

// A thin or flat body: no side of its box counts as less than this share of its diagonal, lest it spin without inertia.
constexpr double thinnest_side = 0.02;
// Below this share of the bounding box the enclosed volume is rounding error or the mesh cancels itself out.
constexpr double least_volume_share = 1e-6;

struct Integrals {
  double volume = 0.0;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();  // of x x^T
};

// Exact for polyhedra (Blow and Binstock, 2004). Relative to `origin`, for precision far from the mesh frame's origin.
Integrals integrate(const mesh::TriangleMesh& mesh, const Vec3& origin) {
  Integrals sum;
  for (const mesh::Triangle& triangle : mesh.triangles()) {
    const Vec3 a = mesh.vertices()[triangle[0]] - origin;
    const Vec3 b = mesh.vertices()[triangle[1]] - origin;
    const Vec3 c = mesh.vertices()[triangle[2]] - origin;
    const double six_volumes = a.dot(b.cross(c));
    const Vec3 total = a + b + c;
    sum.volume += six_volumes / 6.0;
    sum.first += six_volumes / 24.0 * total;
    sum.second +=
        six_volumes / 120.0 * (total * total.transpose() + a * a.transpose() + b * b.transpose() + c * c.transpose());
  }
  if (sum.volume < 0.0) {  // wound inside out
    sum.volume = -sum.volume;
    sum.first = -sum.first;
    sum.second = -sum.second;
  }
  return sum;
}

Mat3 inertia_of(const Mat3& second_moment) { return second_moment.trace() * Mat3::Identity() - second_moment; }

bool physical(const Mat3& inertia, double mass, double size) {
  if (!inertia.allFinite()) return false;
  const Vec3 moments = Eigen::SelfAdjointEigenSolver<Mat3>(inertia, Eigen::EigenvaluesOnly).eigenvalues();
  return moments[0] > 1e-9 * mass * size * size && moments[0] + moments[1] >= moments[2] * (1.0 - 1e-9);
}

MassProperties of_box(const mesh::TriangleMesh& mesh, double mass_kg) {
  const Vec3 sides = (mesh.upper() - mesh.lower()).cwiseMax(thinnest_side * mesh.size());
  MassProperties result;
  result.mass_kg = mass_kg;
  result.center_m = 0.5 * (mesh.lower() + mesh.upper());
  result.inertia_kg_m2 = inertia_of((mass_kg / 12.0 * sides.cwiseAbs2()).asDiagonal());
  return result;
}

}  // namespace

Result<MassProperties> mass_properties(const mesh::TriangleMesh& mesh, bool closed, const MassSpec& spec,
                                       const std::string& name) {
  if (!(mesh.size() > least_size_m)) {
    return Error{name, "", "the mesh has no extent, so no inertia", "use another mesh for a moving body"};
  }
  const Vec3 middle = 0.5 * (mesh.lower() + mesh.upper());
  const Integrals integrals = integrate(mesh, middle);
  const double box_volume = (mesh.upper() - mesh.lower()).prod();
  const bool solid = closed && integrals.volume > least_volume_share * box_volume && integrals.volume > 0.0;
  const bool by_density = spec.mass_kg == 0.0;
  if (by_density && !solid) {
    return Error{name, "", "the mesh encloses no volume, so a density gives it no mass", "give the mass in kilograms"};
  }
  const double mass_kg = by_density ? spec.density_kg_per_m3 * integrals.volume : spec.mass_kg;
  if (!(mass_kg >= least_mass_kg && mass_kg <= greatest_mass_kg)) {
    return Error{name, "", "the mass is not a number from 1e-9 kg to 1e12 kg",
                 "give another mass or density, and check the mesh's unit of length"};
  }
  if (solid) {
    MassProperties result;
    const Vec3 center = integrals.first / integrals.volume;
    const Mat3 about_center = integrals.second / integrals.volume - center * center.transpose();
    result.mass_kg = mass_kg;
    result.center_m = middle + center;
    result.inertia_kg_m2 = inertia_of(mass_kg * about_center);
    result.from_closed_mesh = true;
    if (physical(result.inertia_kg_m2, mass_kg, mesh.size())) return result;
  }
  return of_box(mesh, mass_kg);
}

void give_mass(dBodyID body, const MassProperties& properties) noexcept {
  const Mat3& inertia = properties.inertia_kg_m2;
  dMass mass;
  dMassSetParameters(&mass, properties.mass_kg, 0.0, 0.0, 0.0, inertia(0, 0), inertia(1, 1), inertia(2, 2),
                     inertia(0, 1), inertia(0, 2), inertia(1, 2));
  dBodySetMass(body, &mass);
}

}  // namespace odds::ode
