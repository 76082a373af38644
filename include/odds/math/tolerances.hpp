// Every tolerance of the library: value, unit, reason, and the test that minds it.
#pragma once

namespace odds::tolerances {

/// Largest entry of R^T R - I that still counts as a rotation; no unit. Poses that a program accumulates in doubles
/// drift by about 1e-12 per million products; beyond 1e-6 a result would be wrong by more than a micrometre a metre.
/// Test: Pair.RefusesAPoseThatIsNotRigid.
inline constexpr double pose_orthonormality = 1e-6;

/// An unproved probability keeps at least this distance from 0 and 1; no unit. Test: Pair.OnlyProofsAreCertain.
inline constexpr double least_uncertainty = 1e-9;

}  // namespace odds::tolerances
