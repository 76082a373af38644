// The classes of poses in which engines are compared, after Trenkel, Weller and Zachmann 2007.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "benchmark/peer.hpp"
#include "support/near_poses.hpp"

namespace odds::benchmark {

/// Offset from the first touch along the line of approach, in units of D, the lesser diameter of the two meshes'
/// spheres about the middle of their boxes; log-uniform: near 0.2 to 5 % apart; touch within 3e-7 to 1e-3 on either
/// side; shallow 0.2 to 2 % inside; deep 10 to 50 % inside. nested: B about where A is, moved by up to 0.1 % of D and
/// turned by up to 0.2 degrees, for a B that is a smaller copy of A.
enum class PoseClass : std::uint8_t { near, touch, shallow, deep, nested };

inline constexpr std::array<std::string_view, 5> pose_class_names = {"near", "touch", "shallow", "deep", "nested"};
[[nodiscard]] constexpr std::string_view name(PoseClass pose_class) noexcept {
  return pose_class_names[static_cast<std::size_t>(pose_class)];
}

/// D, metres.
[[nodiscard]] double lesser_diameter(const MeshPair& meshes) noexcept;

/// Poses of B in A; pose i depends on seed, class and i only. `collides` finds the first touch.
[[nodiscard]] std::vector<math::Pose> make_poses(const MeshPair& meshes, PoseClass pose_class, std::size_t count,
                                                 std::uint64_t seed, const testing::Collides& collides);

/// `steps` poses of a coherent motion: B slides over A, each step `step` metres along the surface and a turn that moves
/// no point by more than half of that, while a step against or along the line of approach keeps it at first touch; the
/// whole is then shifted by one offset of the class.
[[nodiscard]] std::vector<math::Pose> make_trajectory(const MeshPair& meshes, PoseClass pose_class, std::size_t steps,
                                                      double step, std::uint64_t seed,
                                                      const testing::Collides& collides);

}  // namespace odds::benchmark
