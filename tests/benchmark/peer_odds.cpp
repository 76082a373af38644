#include "benchmark/peer_odds.hpp"

#include "odds/query/pair.hpp"
#include "support/value_or_throw.hpp"

namespace odds::benchmark {
namespace {

using testing::value_or_throw;

const char* method_name(query::Method method) {
  switch (method) {
    case query::Method::exact:
      return "exact";
    case query::Method::incremental:
      return "incremental";
    default:
      return "time-critical";
  }
}

class OddsPeer final : public Peer {
 public:
  OddsPeer(const MeshPair& meshes, volume::Kind volume, query::Method method, bool leaf_test, int builds)
      : Peer("odds " + std::string(volume::name(volume)) + " " + method_name(method) +
             (leaf_test ? "" : ", leaves untested")),
        method_(method),
        leaf_test_(leaf_test) {
    const query::ShapeOptions options{.volume = volume};
    const auto build = [&](const auto& mesh) { return value_or_throw(query::Shape::build(mesh, options)); };
    const auto a = build_measured(meshes.a->triangles().size(), builds, [&] { return build(meshes.a); });
    const auto b = meshes.b == meshes.a ? a : build(meshes.b);
    pair_ = std::make_unique<query::Pair>(value_or_throw(query::Pair::make(a, b)));
  }

  [[nodiscard]] bool is_coherent() const noexcept override { return method_ == query::Method::incremental; }
  void forget() noexcept override { pair_->reset(); }
  [[nodiscard]] bool collide(const math::Pose& pose_b_in_a) override {
    return run(pose_b_in_a, 0).verdict == query::Verdict::hit;
  }
  [[nodiscard]] std::size_t contacts(const math::Pose& pose_b_in_a) override {
    return run(pose_b_in_a, 8).contacts.size();
  }

 private:
  const query::Answer& run(const math::Pose& pose_b_in_a, int max_contacts) noexcept {
    query::Request request;
    request.method = method_;
    request.max_contacts = max_contacts;
    request.leaf_test = leaf_test_;
    return pair_->run(pose_b_in_a, request);
  }

  query::Method method_;
  bool leaf_test_;
  std::unique_ptr<query::Pair> pair_;
};

}  // namespace

std::unique_ptr<Peer> make_odds_peer(const MeshPair& meshes, volume::Kind volume, query::Method method, bool leaf_test,
                                     int builds) {
  return std::make_unique<OddsPeer>(meshes, volume, method, leaf_test, builds);
}

}  // namespace odds::benchmark
