// odds_soak_verdicts [POSES [SEED]]: every engine's verdict against brute force on POSES poses (100,000), in bands of
// distance from first touch, with every method, in both orders of the arguments; with meshes as they are, moved, scaled
// by powers of two, their triangles in another order; the wide engine with every instruction set. Status 1 if any
// verdict is wrong.
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>

#include "odds/math/random.hpp"
#include "odds/query/pair.hpp"
#include "odds/volume/kind.hpp"
#include "soak/meshes.hpp"
#include "support/brute_force.hpp"
#include "support/instruction_sets.hpp"
#include "support/near_poses.hpp"

namespace {

using namespace odds;
using query::InstructionSet;

constexpr std::array bands = {0.1, 1e-2, 1e-3, 1e-5, 1e-7, 1e-9, -1e-9, -1e-7, -1e-5, -1e-3, -1e-2, -0.1};
constexpr std::array methods = {query::Method::exact, query::Method::incremental, query::Method::time_critical};

query::Pair pair_of(const soak::Mesh& a, const soak::Mesh& b, volume::Kind kind, InstructionSet set) {
  const auto shape = [kind](const soak::Mesh& mesh) { return query::Shape::build(mesh, {.volume = kind}).value(); };
  return std::move(query::Pair::make(shape(a), shape(b), {.instruction_set = set})).value();
}

/// Both meshes changed alike, so that the truth stays the same.
struct Variant {
  double scale = 1.0;
  math::Pose move_a;
  math::Pose move_b;

  [[nodiscard]] math::Pose pose(math::Pose b_in_a) const {
    b_in_a.translation *= scale;
    return move_a * b_in_a * move_b.inverse();
  }
};

std::array<Variant, 3> variants(math::Random& random) {
  std::array<Variant, 3> all;
  all[1].scale = 0x1p-20;
  all[2].move_a = math::Pose::from_quaternion(3.0 * random.direction(), random.rotation());
  all[2].move_b = math::Pose::from_quaternion(2.0 * random.direction(), random.rotation());
  return all;
}

/// One engine on one variant of a pair of meshes, in both orders.
class Engine {
 public:
  Engine(const soak::MeshPair& meshes, const Variant& variant, std::size_t rotate, volume::Kind kind,
         InstructionSet set)
      : variant_(variant),
        name_(std::string(volume::name(kind)) + (set == InstructionSet::best ? "" : " ") +
              std::string(testing::name(set))),
        a_(testing::changed(*meshes.a, variant.scale, variant.move_a, rotate)),
        b_(testing::changed(*meshes.b, variant.scale, variant.move_b, rotate / 2)),
        ab_(pair_of(a_, b_, kind, set)),
        ba_(pair_of(b_, a_, kind, set)) {}

  [[nodiscard]] const std::string& name() const { return name_; }

  /// Verdicts that differ from the truth, of the six that are asked for.
  int wrong(const math::Pose& b_in_a, bool truth) {
    const math::Pose pose = variant_.pose(b_in_a);
    const math::Pose inverse = pose.inverse();
    int count = 0;
    for (const query::Method method : methods) {
      count += hit(ab_, pose, method) != truth ? 1 : 0;
      count += hit(ba_, inverse, method) != truth ? 1 : 0;
    }
    return count;
  }

 private:
  static bool hit(query::Pair& pair, const math::Pose& pose, query::Method method) {
    const query::Answer& answer = pair.run(pose, {.method = method, .max_contacts = 0});
    return answer.verdict == query::Verdict::hit && answer.basis == query::Basis::proved;
  }

  Variant variant_;
  std::string name_;
  soak::Mesh a_;
  soak::Mesh b_;
  query::Pair ab_;
  query::Pair ba_;
};

std::vector<Engine> engines(const soak::MeshPair& meshes, math::Random& random) {
  std::vector<Engine> all;
  std::size_t rotate = 0;
  for (const Variant& variant : variants(random)) {
    for (std::size_t k = 0; k < volume::kind_names.size(); ++k) {
      all.emplace_back(meshes, variant, rotate, static_cast<volume::Kind>(k), InstructionSet::best);
    }
    for (const InstructionSet set : testing::instruction_sets) {
      const auto shape = query::Shape::build(meshes.a).value();
      if (!query::Pair::make(shape, shape, {.instruction_set = set}).ok()) continue;  // not on this processor
      all.emplace_back(meshes, variant, rotate, volume::Kind::wide, set);
    }
    rotate += 17;
  }
  return all;
}

struct Count {
  std::uint64_t verdicts = 0;
  std::uint64_t wrong = 0;
};

}  // namespace

int main(int argc, char** argv) {
  const std::uint64_t poses = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 100'000;
  const std::uint64_t seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  if (poses == 0 || argc > 3) {
    std::fprintf(stderr, "usage: odds_soak_verdicts [POSES [SEED]]\n");
    return 2;
  }
  const std::vector<soak::MeshPair> all = soak::mesh_pairs();
  const std::uint64_t each = (poses + all.size() - 1) / all.size();
  std::map<std::string, Count> counts;
  std::uint64_t hits = 0;
  math::Random random(seed);
  for (const soak::MeshPair& meshes : all) {
    std::vector<Engine> tested = engines(meshes, random);
    query::Pair finder = pair_of(meshes.a, meshes.b, volume::Kind::aabb, InstructionSet::best);
    const double size = meshes.a->size();
    testing::TouchingPose touching;
    for (std::uint64_t i = 0; i < each; ++i) {
      if (i % bands.size() == 0) {
        touching = testing::touching_pose(
            random, 0.5 * (meshes.a->lower() + meshes.a->upper()), 0.5 * (meshes.b->lower() + meshes.b->upper()),
            std::max(size, meshes.b->size()), [&](const math::Pose& pose) {
              return finder.run(pose, {.method = query::Method::exact}).verdict == query::Verdict::hit;
            });
      }
      math::Pose pose = touching.pose;
      pose.translation += bands[i % bands.size()] * size * touching.direction;
      const bool truth = testing::brute_force(*meshes.a, *meshes.b, pose);
      hits += truth ? 1 : 0;
      for (Engine& engine : tested) {
        Count& count = counts[engine.name()];
        count.verdicts += 2 * methods.size();
        const int wrong = engine.wrong(pose, truth);
        count.wrong += static_cast<std::uint64_t>(wrong);
        if (wrong != 0) {
          const Quat q(pose.rotation);
          std::printf("%s, %s, band %g: %d verdicts are not %s at %.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n",
                      meshes.name, engine.name().c_str(), bands[i % bands.size()], wrong, truth ? "hit" : "clear",
                      pose.translation.x(), pose.translation.y(), pose.translation.z(), q.w(), q.x(), q.y(), q.z());
        }
      }
      if (i % 1000 == 0)
        std::fprintf(stderr, "\r%s: %llu of %llu poses ", meshes.name, static_cast<unsigned long long>(i),
                     static_cast<unsigned long long>(each));
    }
    std::fprintf(stderr, "\r%s: %llu poses               \n", meshes.name, static_cast<unsigned long long>(each));
  }
  const std::uint64_t asked = each * all.size();
  std::printf(
      "%llu poses of %zu pairs of meshes, %llu hits by brute force; each in 3 variants, 3 methods, both orders\n",
      static_cast<unsigned long long>(asked), all.size(), static_cast<unsigned long long>(hits));
  std::uint64_t wrong = 0;
  for (const auto& [name, count] : counts) {
    std::printf("%-14s %9llu verdicts, %llu wrong\n", name.c_str(), static_cast<unsigned long long>(count.verdicts),
                static_cast<unsigned long long>(count.wrong));
    wrong += count.wrong;
  }
  return wrong == 0 ? 0 : 1;
}
