#include "differential/fcl_oracle.hpp"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include <limits>

namespace odds::testing {

struct FclModel::Data {
  fcl::BVHModel<fcl::OBBRSSd> model;
};

namespace {

fcl::Transform3d to_fcl(const math::Pose& pose) {
  fcl::Transform3d transform = fcl::Transform3d::Identity();
  transform.linear() = pose.rotation;
  transform.translation() = pose.translation;
  return transform;
}

}  // namespace

FclModel::FclModel(const mesh::TriangleMesh& mesh) : data_(std::make_unique<Data>()) {
  auto& model = data_->model;
  model.beginModel(static_cast<int>(mesh.triangles().size()), static_cast<int>(mesh.vertices().size()));
  for (const mesh::Triangle& t : mesh.triangles()) {
    model.addTriangle(mesh.vertices()[t[0]], mesh.vertices()[t[1]], mesh.vertices()[t[2]]);
  }
  model.endModel();
}
FclModel::~FclModel() = default;
FclModel::FclModel(FclModel&&) noexcept = default;

bool fcl_collide(const FclModel& a, const FclModel& b, const math::Pose& pose_b_in_a) {
  const fcl::CollisionRequestd request(1, false);
  fcl::CollisionResultd result;
  fcl::collide(&a.data().model, fcl::Transform3d::Identity(), &b.data().model, to_fcl(pose_b_in_a), request, result);
  return result.isCollision();
}

std::size_t fcl_contacts(const FclModel& a, const FclModel& b, const math::Pose& pose_b_in_a) {
  const fcl::CollisionRequestd request(std::numeric_limits<std::size_t>::max(), true);
  fcl::CollisionResultd result;
  fcl::collide(&a.data().model, fcl::Transform3d::Identity(), &b.data().model, to_fcl(pose_b_in_a), request, result);
  return result.numContacts();
}

double fcl_distance(const FclModel& a, const FclModel& b, const math::Pose& pose_b_in_a) {
  const fcl::DistanceRequestd request(false);
  fcl::DistanceResultd result;
  fcl::distance(&a.data().model, fcl::Transform3d::Identity(), &b.data().model, to_fcl(pose_b_in_a), request, result);
  return result.min_distance;
}

}  // namespace odds::testing
