#include "benchmark/peer_fcl.hpp"

#include "differential/fcl_oracle.hpp"

namespace odds::benchmark {
namespace {

using testing::FclModel;

class FclPeer final : public Peer {
 public:
  FclPeer(const MeshPair& meshes, int builds) : Peer("FCL OBBRSS") {
    a_ = build_measured(meshes.a->triangles().size(), builds, [&] { return std::make_shared<FclModel>(*meshes.a); });
    b_ = meshes.b == meshes.a ? a_ : std::make_shared<FclModel>(*meshes.b);
  }

  [[nodiscard]] bool collide(const math::Pose& pose_b_in_a) override {
    return testing::fcl_collide(*a_, *b_, pose_b_in_a);
  }
  [[nodiscard]] std::size_t contacts(const math::Pose& pose_b_in_a) override {
    return testing::fcl_contacts(*a_, *b_, pose_b_in_a);
  }

 private:
  std::shared_ptr<FclModel> a_;
  std::shared_ptr<FclModel> b_;
};

}  // namespace

std::unique_ptr<Peer> make_fcl_peer(const MeshPair& meshes, int builds) {
  return std::make_unique<FclPeer>(meshes, builds);
}

}  // namespace odds::benchmark
