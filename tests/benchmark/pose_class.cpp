#include "benchmark/pose_class.hpp"

#include <algorithm>
#include <cmath>

namespace odds::benchmark {
namespace {

Vec3 middle(const mesh::TriangleMesh& mesh) { return 0.5 * mesh.lower() + 0.5 * mesh.upper(); }

double diameter(const mesh::TriangleMesh& mesh) {
  double squared = 0.0;
  for (const mesh::Triangle& t : mesh.triangles()) {
    for (const std::uint32_t v : t) squared = std::max(squared, (mesh.vertices()[v] - middle(mesh)).squaredNorm());
  }
  return 2.0 * std::sqrt(squared);
}

double log_uniform(math::Random& random, double least, double greatest) {
  return least * std::pow(greatest / least, random.uniform());
}

// In units of D, positive: apart.
double draw_offset(math::Random& random, PoseClass pose_class) {
  switch (pose_class) {
    case PoseClass::near:
      return log_uniform(random, 2e-3, 5e-2);
    case PoseClass::touch:
      return (random.uniform() < 0.5 ? -1.0 : 1.0) * log_uniform(random, 3e-7, 1e-3);
    case PoseClass::shallow:
      return -log_uniform(random, 2e-3, 2e-2);
    default:
      return -log_uniform(random, 0.1, 0.5);
  }
}

math::Random random_of(std::uint64_t seed, PoseClass pose_class, std::size_t i) {
  return math::Random(seed, (static_cast<std::uint64_t>(pose_class) << 32U) + i);
}

testing::TouchingPose touching(const MeshPair& meshes, math::Random& random, const testing::Collides& collides) {
  const double size = std::max(diameter(*meshes.a), diameter(*meshes.b));
  return testing::touching_pose(random, middle(*meshes.a), middle(*meshes.b), size, collides);
}

math::Pose turned_about(const math::Pose& pose, const Vec3& point_of_b, const Quat& turn) {
  const Vec3 place = pose * point_of_b;
  const Mat3 rotation = (turn * Quat(pose.rotation)).normalized().toRotationMatrix();
  return {rotation, place - rotation * point_of_b};
}

math::Pose nested_pose(const MeshPair& meshes, math::Random& random) {
  constexpr double greatest_turn = 0.2 * std::numbers::pi / 180.0;
  math::Pose pose;
  pose.translation = middle(*meshes.a) - middle(*meshes.b);
  const Quat turn(Eigen::AngleAxisd(greatest_turn * random.uniform(), random.direction()));
  pose = turned_about(pose, middle(*meshes.b), turn);
  pose.translation += 1e-3 * lesser_diameter(meshes) * random.uniform() * random.direction();
  return pose;
}

}  // namespace

double lesser_diameter(const MeshPair& meshes) noexcept { return std::min(diameter(*meshes.a), diameter(*meshes.b)); }

std::vector<math::Pose> make_poses(const MeshPair& meshes, PoseClass pose_class, std::size_t count, std::uint64_t seed,
                                   const testing::Collides& collides) {
  std::vector<math::Pose> poses;
  const double unit = lesser_diameter(meshes);
  for (std::size_t i = 0; i < count; ++i) {
    math::Random random = random_of(seed, pose_class, i);
    if (pose_class == PoseClass::nested) {
      poses.push_back(nested_pose(meshes, random));
      continue;
    }
    testing::TouchingPose start = touching(meshes, random, collides);
    start.pose.translation += draw_offset(random, pose_class) * unit * start.direction;
    poses.push_back(start.pose);
  }
  return poses;
}

std::vector<math::Pose> make_trajectory(const MeshPair& meshes, PoseClass pose_class, std::size_t steps, double step,
                                        std::uint64_t seed, const testing::Collides& collides) {
  math::Random random = random_of(seed, pose_class, 0);
  const testing::TouchingPose start = touching(meshes, random, collides);
  const Vec3 shift = draw_offset(random, pose_class) * lesser_diameter(meshes) * start.direction;
  const Vec3 center_b = middle(*meshes.b);
  const Quat turn(Eigen::AngleAxisd(step / diameter(*meshes.b), random.direction()));
  const Vec3 along = start.direction.cross(random.direction()).normalized();
  const Vec3 across = start.direction.cross(along);
  std::vector<math::Pose> poses;
  math::Pose pose = start.pose;
  for (std::size_t i = 0; i < steps; ++i) {
    const double heading = 2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(steps);
    pose = turned_about(pose, center_b, turn);
    pose.translation += step * (std::cos(heading) * along + std::sin(heading) * across);
    pose.translation += (collides(pose) ? step : -step) * start.direction;
    poses.push_back(pose);
    poses.back().translation += shift;
  }
  return poses;
}

}  // namespace odds::benchmark
