#include "benchmark/peer_bullet.hpp"

#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <btBulletCollisionCommon.h>

namespace odds::benchmark {
namespace {

/// A mesh in Bullet's form; Bullet reads the arrays, so they live as long as its shape.
class GimpactModel {
 public:
  explicit GimpactModel(const mesh::TriangleMesh& mesh) {
    for (const Vec3& v : mesh.vertices()) {
      for (int axis = 0; axis < 3; ++axis) vertices_.push_back(static_cast<btScalar>(v[axis]));
    }
    for (const mesh::Triangle& t : mesh.triangles()) {
      for (const std::uint32_t corner : t) indices_.push_back(static_cast<int>(corner));
    }
    arrays_ = std::make_unique<btTriangleIndexVertexArray>(
        static_cast<int>(mesh.triangles().size()), indices_.data(), static_cast<int>(3 * sizeof(int)),
        static_cast<int>(mesh.vertices().size()), vertices_.data(), static_cast<int>(3 * sizeof(btScalar)));
    shape_ = std::make_unique<btGImpactMeshShape>(arrays_.get());
    shape_->setMargin(0);
    shape_->updateBound();
  }
  [[nodiscard]] btGImpactMeshShape* shape() const noexcept { return shape_.get(); }

 private:
  std::vector<btScalar> vertices_;
  std::vector<int> indices_;
  std::unique_ptr<btTriangleIndexVertexArray> arrays_;
  std::unique_ptr<btGImpactMeshShape> shape_;
};

struct CountingResult final : btManifoldResult {
  CountingResult(const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b) : btManifoldResult(a, b) {}
  void addContactPoint(const btVector3&, const btVector3&, btScalar depth) override { count += depth <= 0 ? 1U : 0U; }
  std::size_t count = 0;
};

class BulletPeer final : public Peer {
 public:
  BulletPeer(const MeshPair& meshes, int builds) : Peer("Bullet GImpact"), dispatcher_(&configuration_) {
    btGImpactCollisionAlgorithm::registerAlgorithm(&dispatcher_);
    const auto make = [](const mesh::TriangleMesh& mesh) { return std::make_shared<GimpactModel>(mesh); };
    a_ = build_measured(meshes.a->triangles().size(), builds, [&] { return make(*meshes.a); });
    // A shape carries no pose, but GImpact's locks want two of them.
    b_ = make(*meshes.b);
    object_a_.setCollisionShape(a_->shape());
    object_b_.setCollisionShape(b_->shape());
    object_a_.setWorldTransform(btTransform::getIdentity());
    const btCollisionObjectWrapper a(nullptr, a_->shape(), &object_a_, object_a_.getWorldTransform(), -1, -1);
    const btCollisionObjectWrapper b(nullptr, b_->shape(), &object_b_, object_b_.getWorldTransform(), -1, -1);
    algorithm_ = dispatcher_.findAlgorithm(&a, &b, nullptr, BT_CONTACT_POINT_ALGORITHMS);
  }
  ~BulletPeer() override {
    algorithm_->~btCollisionAlgorithm();
    dispatcher_.freeCollisionAlgorithm(algorithm_);
  }

  [[nodiscard]] bool collide(const math::Pose& pose_b_in_a) override { return contacts(pose_b_in_a) != 0; }
  [[nodiscard]] std::size_t contacts(const math::Pose& pose_b_in_a) override {
    const Mat3& r = pose_b_in_a.rotation;
    const auto real = [](double x) { return static_cast<btScalar>(x); };
    const btMatrix3x3 basis(real(r(0, 0)), real(r(0, 1)), real(r(0, 2)), real(r(1, 0)), real(r(1, 1)), real(r(1, 2)),
                            real(r(2, 0)), real(r(2, 1)), real(r(2, 2)));
    const Vec3& t = pose_b_in_a.translation;
    object_b_.setWorldTransform(btTransform(basis, btVector3(real(t.x()), real(t.y()), real(t.z()))));
    const btCollisionObjectWrapper a(nullptr, a_->shape(), &object_a_, object_a_.getWorldTransform(), -1, -1);
    const btCollisionObjectWrapper b(nullptr, b_->shape(), &object_b_, object_b_.getWorldTransform(), -1, -1);
    CountingResult result(&a, &b);
    algorithm_->processCollision(&a, &b, dispatch_info_, &result);
    return result.count;
  }

 private:
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDispatcherInfo dispatch_info_;
  std::shared_ptr<GimpactModel> a_;
  std::shared_ptr<GimpactModel> b_;
  btCollisionObject object_a_;
  btCollisionObject object_b_;
  btCollisionAlgorithm* algorithm_ = nullptr;
};

}  // namespace

std::unique_ptr<Peer> make_bullet_peer(const MeshPair& meshes, int builds) {
  return std::make_unique<BulletPeer>(meshes, builds);
}

}  // namespace odds::benchmark
