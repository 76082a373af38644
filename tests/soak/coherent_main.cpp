// odds_soak_coherent [STEPS [SEED]]: the incremental method along a continuous motion of STEPS steps (1,000,000) that
// goes in and out of contact, at most 3e-5 of the size a step: its verdict against that of a fresh exact search at
// every step, for every engine. Status 1 if any differs.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <numbers>

#include "odds/math/random.hpp"
#include "odds/query/pair.hpp"
#include "odds/volume/kind.hpp"
#include "soak/meshes.hpp"
#include "support/near_poses.hpp"

namespace {

using namespace odds;

constexpr double most_per_step = 3e-5;  ///< of the size
constexpr std::uint64_t steps_of_a_walk = 5000;

query::Pair pair_of(const soak::Mesh& a, const soak::Mesh& b, volume::Kind kind) {
  const auto shape = [kind](const soak::Mesh& mesh) { return query::Shape::build(mesh, {.volume = kind}).value(); };
  return std::move(query::Pair::make(shape(a), shape(b))).value();
}

/// Swings through first touch along a line while it turns slowly about an axis through the centre of B.
class Walk {
 public:
  Walk(math::Random& random, const testing::TouchingPose& start, double size)
      : start_(start), axis_(random.direction()), swing_(size * random.uniform(0.2, 1.0) * 1e-2), size_(size) {}

  [[nodiscard]] math::Pose at(std::uint64_t step) const {
    // A third of the path's speed for the turn, so that no point moves by more than the bound.
    const double angle = most_per_step / 3.0 * static_cast<double>(step);
    const double phase = most_per_step / 3.0 * size_ / swing_ * static_cast<double>(step);
    math::Pose pose = start_.pose;
    pose.rotation = pose.rotation * Eigen::AngleAxisd(angle, axis_).toRotationMatrix();
    pose.translation += swing_ * std::sin(phase) * start_.direction;
    return pose;
  }

 private:
  testing::TouchingPose start_;
  Vec3 axis_;
  double swing_;
  double size_;
};

}  // namespace

int main(int argc, char** argv) {
  const std::uint64_t steps = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 1'000'000;
  const std::uint64_t seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  if (steps == 0 || argc > 3) {
    std::fprintf(stderr, "usage: odds_soak_coherent [STEPS [SEED]]\n");
    return 2;
  }
  const soak::MeshPair pairs[] = {
      {"car on car", soak::made("made:car_body:triangles=4000"), soak::made("made:car_body:triangles=4000")},
      {"knot on terrain", soak::made("made:terrain:cells=40"), soak::made("made:torus_knot:along=120,across=8")}};
  std::uint64_t all_wrong = 0;
  for (std::size_t k = 0; k < volume::kind_names.size(); ++k) {
    const auto kind = static_cast<volume::Kind>(k);
    std::uint64_t hits = 0;
    std::uint64_t wrong = 0;
    std::uint64_t done = 0;
    for (const soak::MeshPair& meshes : pairs) {
      math::Random random(seed);
      query::Pair fresh = pair_of(meshes.a, meshes.b, volume::Kind::wide);
      query::Pair kept = pair_of(meshes.a, meshes.b, kind);
      const auto collides = [&](const math::Pose& pose) {
        return fresh.run(pose, {.method = query::Method::exact, .max_contacts = 0}).verdict == query::Verdict::hit;
      };
      const double size = std::max(meshes.a->size(), meshes.b->size());
      for (std::uint64_t walked = 0; walked < (steps + 1) / 2; walked += steps_of_a_walk) {
        const Walk walk(random,
                        testing::touching_pose(random, 0.5 * (meshes.a->lower() + meshes.a->upper()),
                                               0.5 * (meshes.b->lower() + meshes.b->upper()), size, collides),
                        size);
        for (std::uint64_t step = 0; step < steps_of_a_walk; ++step) {
          const math::Pose pose = walk.at(step);
          const bool truth = collides(pose);
          const query::Answer& answer = kept.run(pose, {.method = query::Method::incremental, .max_contacts = 0});
          const bool right = answer.basis == query::Basis::proved && (answer.verdict == query::Verdict::hit) == truth;
          hits += truth ? 1 : 0;
          wrong += right ? 0 : 1;
          ++done;
        }
      }
    }
    std::printf("%-8s %llu steps, %llu of them hits: %llu verdicts differ from a fresh search\n",
                std::string(volume::name(kind)).c_str(), static_cast<unsigned long long>(done),
                static_cast<unsigned long long>(hits), static_cast<unsigned long long>(wrong));
    std::fflush(stdout);
    all_wrong += wrong;
  }
  return all_wrong == 0 ? 0 : 1;
}
