// odds_same_bits: prints one number for each bounding volume, made of every bit of many answers within work units, and
// one of those with a proof. Two builds that print the same gave the same answers; tests/same_bits/run compares
// compilers and optimisation levels, tests/arm64/run another family of processors.
#include <bit>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "odds/math/random.hpp"
#include "odds/mesh/made/by_name.hpp"
#include "odds/query/pair.hpp"

namespace odds {
namespace {

/// FNV-1a, 64 bits.
class Digest {
 public:
  void add(std::uint64_t bits) noexcept {
    for (int byte = 0; byte < 8; ++byte) {
      value_ ^= bits >> (8 * byte) & 0xFFU;
      value_ *= 0x100000001B3ULL;
    }
  }
  void add(double x) noexcept { add(std::bit_cast<std::uint64_t>(x)); }
  void add(const query::Contact& contact) noexcept {
    for (int i = 0; i < 3; ++i) {
      add(contact.position[i]);
      add(contact.normal[i]);
    }
    add(contact.depth);
    add(std::uint64_t{contact.triangle_a} << 32U | contact.triangle_b);
  }
  void add(const query::Answer& answer) noexcept {
    add(static_cast<std::uint64_t>(answer.verdict) << 8U | static_cast<std::uint64_t>(answer.basis));
    add(answer.probability);
    add(answer.cost.node_pairs);
    add(answer.cost.triangle_pairs);
    if (answer.has_cell_pair) add(answer.cell_pair);
    add(answer.cell_pair_probability);
    for (const query::Contact& contact : answer.contacts) add(contact);
  }
  [[nodiscard]] std::uint64_t value() const noexcept { return value_; }

 private:
  std::uint64_t value_ = 0xCBF29CE484222325ULL;
};

struct Tally {
  Digest digest;
  Digest proofs;  ///< of answers with a proof alone
  std::uint64_t answers = 0, unproved = 0, hits = 0;
};

/// Poses from deep in each other to just apart.
math::Pose pose_at(const query::Shape& a, const query::Shape& b, std::uint64_t index) {
  math::Random random(417, index);
  const Mat3 rotation = random.rotation().toRotationMatrix();
  const double distance = random.uniform(0.2, 0.6) * 0.5 * (a.mesh().size() + b.mesh().size());
  return {rotation, Vec3(distance * random.direction())};
}

bool add_answers(const std::string& name_a, const std::string& name_b, volume::Kind volume, int poses, Tally& tally) {
  std::shared_ptr<const query::Shape> shapes[2];
  for (int side = 0; side < 2; ++side) {
    auto mesh = mesh::made::make_shape(side == 0 ? name_a : name_b);
    if (!mesh.ok()) return false;
    query::ShapeOptions options;
    options.volume = volume;
    auto built = query::Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(mesh).value()), options);
    if (!built.ok()) return false;
    shapes[side] = built.value();
  }
  auto pair = query::Pair::make(shapes[0], shapes[1], {.calibration_poses = 12});
  if (!pair.ok()) return false;
  for (int i = 0; i < poses; ++i) {
    const math::Pose pose = pose_at(*shapes[0], *shapes[1], static_cast<std::uint64_t>(i));
    for (const query::Method method :
         {query::Method::exact, query::Method::incremental, query::Method::time_critical}) {
      for (const query::EstimatorKind estimator : {query::EstimatorKind::kinematic, query::EstimatorKind::cells}) {
        for (const std::uint64_t units : {std::uint64_t{30}, std::uint64_t{200}, std::uint64_t{1500}}) {
          query::Request request;
          request.method = method;
          request.estimator = estimator;
          request.budget = query::Budget::work(units);
          request.max_contacts = i % 2 == 0 ? 1 : query::most_contacts;
          if (i % 5 == 4) request.p_min = 0.9;
          const query::Answer& answer = pair.value().run(pose, request);
          tally.digest.add(answer);
          if (answer.basis == query::Basis::proved) tally.proofs.add(answer);
          ++tally.answers;
          tally.unproved += answer.basis == query::Basis::proved ? 0 : 1;
          tally.hits += answer.verdict == query::Verdict::hit ? 1 : 0;
        }
      }
    }
  }
  return true;
}

int run(int poses) {
  for (std::size_t kind = 0; kind < volume::kind_names.size(); ++kind) {
    const auto volume = static_cast<volume::Kind>(kind);
    Tally tally;
    const bool good =
        add_answers("made:car_body:triangles=3000", "made:car_body:triangles=3000", volume, poses, tally) &&
        add_answers("made:torus_knot:along=120,across=10", "made:gear:teeth=17,flank=4", volume, poses, tally) &&
        add_answers("made:bumpy_sphere:frequency=14", "made:bumpy_sphere:frequency=14,scale=0.985", volume, poses,
                    tally);
    if (!good) {
      std::fprintf(stderr, "odds_same_bits: a mesh or a pair could not be made\n");
      return 1;
    }
    std::printf("%-8s %016llx  %llu answers, %llu without a proof, %llu hits, %016llx of proofs\n",
                volume::name(volume).data(), static_cast<unsigned long long>(tally.digest.value()),
                static_cast<unsigned long long>(tally.answers), static_cast<unsigned long long>(tally.unproved),
                static_cast<unsigned long long>(tally.hits), static_cast<unsigned long long>(tally.proofs.value()));
  }
  return 0;
}

}  // namespace
}  // namespace odds

int main(int argc, char** argv) {
  const int poses = argc > 1 ? std::atoi(argv[1]) : 200;
  if (poses < 1 || argc > 2) {
    std::fprintf(stderr, "usage: odds_same_bits [POSES, >= 1; default 200]\n");
    return 2;
  }
  return odds::run(poses);
}
