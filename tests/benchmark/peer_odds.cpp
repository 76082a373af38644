#include "benchmark/peer_odds.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <string>

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

std::string name_of(const OddsSettings& settings) {
  std::string name = "odds " + std::string(volume::name(settings.volume)) + " " + method_name(settings.method);
  if (!settings.leaf_test) name += ", leaves untested";
  if (!std::isfinite(settings.budget_us)) return name;
  std::array<char, 32> limit{};
  std::snprintf(limit.data(), limit.size(), ", %g us", settings.budget_us);
  return name + limit.data();
}

class OddsPeer final : public Peer {
 public:
  OddsPeer(const MeshPair& meshes, const OddsSettings& settings, int builds)
      : Peer(name_of(settings)), settings_(settings) {
    const query::ShapeOptions options{.volume = settings.volume};
    const auto build = [&](const auto& mesh) { return value_or_throw(query::Shape::build(mesh, options)); };
    const auto a = build_measured(meshes.a->triangles().size(), builds, [&] { return build(meshes.a); });
    const auto b = meshes.b == meshes.a ? a : build(meshes.b);
    pair_ = std::make_unique<query::Pair>(value_or_throw(query::Pair::make(a, b)));
  }

  [[nodiscard]] bool is_coherent() const noexcept override { return settings_.method == query::Method::incremental; }
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
    request.method = settings_.method;
    request.max_contacts = max_contacts;
    request.leaf_test = settings_.leaf_test;
    request.budget.microseconds = settings_.budget_us;
    request.timed = false;  // no peer tells how long it took
    return pair_->run(pose_b_in_a, request);
  }

  OddsSettings settings_;
  std::unique_ptr<query::Pair> pair_;
};

}  // namespace

std::unique_ptr<Peer> make_odds_peer(const MeshPair& meshes, const OddsSettings& settings, int builds) {
  return std::make_unique<OddsPeer>(meshes, settings, builds);
}

}  // namespace odds::benchmark
