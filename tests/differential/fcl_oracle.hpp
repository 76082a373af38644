// FCL's answers, for comparison. Only the differential tests and the benchmarks see FCL.
#pragma once

#include <memory>

#include "odds/math/pose.hpp"
#include "odds/mesh/triangle_mesh.hpp"

namespace odds::testing {

/// One mesh in FCL's hierarchy of OBBRSS volumes.
class FclModel {
 public:
  explicit FclModel(const mesh::TriangleMesh& mesh);
  ~FclModel();
  FclModel(FclModel&&) noexcept;
  struct Data;
  [[nodiscard]] const Data& data() const { return *data_; }

 private:
  std::unique_ptr<Data> data_;
};

/// Boolean collision query.
[[nodiscard]] bool fcl_collide(const FclModel& a, const FclModel& b, const math::Pose& pose_b_in_a);

/// Number of all contacts, each with its position, normal and depth.
[[nodiscard]] std::size_t fcl_contacts(const FclModel& a, const FclModel& b, const math::Pose& pose_b_in_a);

/// Surface distance in metres; 0 or negative where they meet.
[[nodiscard]] double fcl_distance(const FclModel& a, const FclModel& b, const math::Pose& pose_b_in_a);

}  // namespace odds::testing
