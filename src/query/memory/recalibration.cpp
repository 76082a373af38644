#include "query/memory/recalibration.hpp"

#include <array>
#include <optional>
#include <vector>

#include "odds/math/random.hpp"
#include "query/memory/first_touch.hpp"

namespace odds::query {
namespace {

constexpr std::uint64_t seed = 0x0DD5;
constexpr std::array<std::uint64_t, 5> limits = {64, 128, 256, 512, 1024};
/// Ways from first touch, parts of the size: as `odds accuracy` has them.
constexpr std::array<double, 12> offsets = {0.05,  0.01,  0.002, 1e-3,  1e-4, 1e-6,
                                            -1e-6, -1e-4, -1e-3, -1e-2, -0.1, -0.3};
constexpr double step_share = 1.0 / 64.0;
constexpr double precision_share = 1e-9;
constexpr std::uint32_t most_lines_tried = 100;

struct Learnt {
  double logit = 0.0;  ///< of the probability stated
  bool hit = false;
};

/// A line of approach: B turned, its centre at `center_a` + place * direction.
struct Line {
  Mat3 rotation;
  Vec3 direction;
  Vec3 center_a;
  Vec3 center_b;
  [[nodiscard]] math::Pose at(double place) const {
    return {rotation, Vec3(center_a + place * direction - rotation * center_b)};
  }
};

bool collides(Pair& pair, const math::Pose& pose) {
  Request request;
  request.method = Method::exact;
  request.max_contacts = 0;
  return pair.run(pose, request).verdict == Verdict::hit;
}

void learn_at(Pair& pair, const math::Pose& pose, std::vector<Learnt>& learnt) {
  const bool hit = collides(pair, pose);
  for (const std::uint64_t units : limits) {
    Request request;
    request.budget = Budget::work(units);
    request.max_contacts = 0;
    const Answer& answer = pair.run(pose, request);
    if (answer.basis == Basis::proved) break;  // more work will not undo it
    learnt.push_back({std::log(answer.probability / (1.0 - answer.probability)), hit});
  }
}

/// Newton's method for slope and shift of greatest likelihood; a few answers' worth of doubt keeps them near 1 and 0.
Recalibration fit(const std::vector<Learnt>& learnt) {
  constexpr double doubt = 4.0;
  Recalibration found;
  for (int step = 0; step < 30; ++step) {
    double g[2] = {-doubt * (found.slope - 1.0), -doubt * found.shift * 0.25};
    double h[3] = {doubt, 0.0, doubt * 0.25};
    for (const Learnt& one : learnt) {
      const double p = 1.0 / (1.0 + std::exp(-(found.slope * one.logit + found.shift)));
      const double off = (one.hit ? 1.0 : 0.0) - p;
      const double w = p * (1.0 - p);
      g[0] += off * one.logit;
      g[1] += off;
      h[0] += w * one.logit * one.logit;
      h[1] += w * one.logit;
      h[2] += w;
    }
    const double determinant = h[0] * h[2] - h[1] * h[1];
    if (!(determinant > 0.0)) break;
    const double change[2] = {(g[0] * h[2] - g[1] * h[1]) / determinant, (g[1] * h[0] - g[0] * h[1]) / determinant};
    found.slope += change[0];
    found.shift += change[1];
    if (std::abs(change[0]) + std::abs(change[1]) < 1e-9) break;
  }
  // More certain where the general odds are less is no calibration, but a sample too small.
  if (!(found.slope > 0.05) || !(found.slope < 20.0) || !(std::abs(found.shift) < 20.0)) return {};
  return found;
}

}  // namespace

Recalibration learn_recalibration(Pair& pair, std::uint32_t poses) {
  const mesh::TriangleMesh& a = pair.a().mesh();
  const mesh::TriangleMesh& b = pair.b().mesh();
  const double size = std::min(a.size(), b.size());
  const double far = 0.505 * (a.size() + b.size());
  if (!(size > 0.0)) return {};
  std::vector<Learnt> learnt;
  const auto lines = (poses + offsets.size() - 1) / offsets.size();
  std::uint32_t untouched = 0;
  for (std::uint64_t n = 0, touched = 0; touched < lines && untouched < most_lines_tried; ++n) {
    math::Random random(seed, n);
    const Line line{random.rotation().toRotationMatrix(), random.direction(), 0.5 * (a.lower() + a.upper()),
                    0.5 * (b.lower() + b.upper())};
    const std::optional<double> touch =
        first_touch(far, 0.0, std::max(step_share * size, far / 4096.0), precision_share * size,
                    [&](double place) { return collides(pair, line.at(place)); });
    if (!touch) {
      ++untouched;
      continue;
    }
    for (std::size_t k = 0; k < offsets.size() && touched * offsets.size() + k < poses; ++k) {
      learn_at(pair, line.at(*touch + offsets[k] * size), learnt);
    }
    ++touched;
  }
  return learnt.empty() ? Recalibration{} : fit(learnt);
}

}  // namespace odds::query
