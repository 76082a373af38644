// The claims that saved_shape.hpp makes about any result.
#include "check_saved_shape.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "odds/query/pair.hpp"
#include "odds/query/ray.hpp"
#include "odds/query/saved_shape.hpp"

namespace odds::fuzz {
namespace {

using query::Pair;
using SharedShape = std::shared_ptr<const query::Shape>;

std::string error_complaint(const Error& error, std::size_t size) {
  if (error.file != "input" || error.what.empty() || error.remedy.empty()) return "an incomplete error";
  if (!error.place.starts_with("byte ")) return "an error without a byte";
  std::uint64_t byte = 0;
  const char* const end = error.place.data() + error.place.size();
  if (std::from_chars(error.place.data() + 5, end, byte).ptr != end || byte > size) return "a byte behind the end";
  return "";
}

bool is_sound(const query::Contact& contact) {
  return contact.position.allFinite() && std::abs(contact.normal.norm() - 1.0) < 1e-6 && contact.depth >= 0.0 &&
         std::isfinite(contact.depth);
}

std::string answer_complaint(const query::Answer& answer, bool polygons) {
  if (!(answer.probability >= 0.0 && answer.probability <= 1.0)) return "a probability that is none";
  for (const query::Contact& contact : answer.contacts) {
    if (!is_sound(contact)) return "a contact that is none";
  }
  if (answer.has_cell_pair && !is_sound(answer.cell_pair)) return "a cell pair that is none";
  const bool proved_hit = answer.verdict == query::Verdict::hit && answer.basis == query::Basis::proved;
  return proved_hit && !polygons ? "a hit proved without polygons" : "";
}

std::string distance_complaint(const query::DistanceAnswer& answer) {
  if (!(answer.lower >= 0.0) || !(answer.upper >= answer.lower)) return "a distance that is none";
  if (!answer.on_a.allFinite() || !answer.on_b.allFinite()) return "a nearest point that is none";
  return "";
}

/// All searches between two shapes, in a few poses, each within a limit.
std::string pair_complaint(const SharedShape& a, const SharedShape& b) {
  auto made = Pair::make(a, b, {.queue_capacity = 64, .slice_capacity = 64, .hit_capacity = 8});
  if (!made.ok()) return "a shape that makes no pair: " + made.error().message();
  Pair pair = std::move(made).value();
  const double size = std::max(a->mesh().size(), 1e-30);
  for (const double away : {0.0, 0.3, 0.9}) {
    const math::Pose pose =
        math::Pose::from_quaternion(Vec3(away * size, 0.1 * away * size, 0.0), Quat(0.9, 0.1, 0.2, away).normalized());
    for (const query::Method method :
         {query::Method::exact, query::Method::incremental, query::Method::time_critical}) {
      for (const query::EstimatorKind estimator : {query::EstimatorKind::cells, query::EstimatorKind::kinematic}) {
        query::Request request{.method = method, .estimator = estimator, .budget = query::Budget::work(3000)};
        request.max_contacts = estimator == query::EstimatorKind::cells ? 8 : 1;
        std::string found = answer_complaint(pair.run(pose, request), a->has_polygons() && b->has_polygons());
        if (!found.empty()) return found;
        request.polygon_free = true;
        found = answer_complaint(pair.run(pose, request), false);
        if (!found.empty()) return found;
      }
    }
    const std::string found = distance_complaint(pair.distance(pose, {.budget = query::Budget::work(3000)}));
    if (!found.empty()) return found;
  }
  return "";
}

std::string lookup_complaint(const query::Shape& shape) {
  const double size = std::max(shape.mesh().size(), 1e-30);
  const Vec3 middle = 0.5 * shape.mesh().lower() + 0.5 * shape.mesh().upper();
  const Vec3 direction = Vec3(0.6, 0.0, -0.8);
  const auto hit = query::cast_ray(shape, middle - size * direction, direction, 3.0 * size, 10000);
  if (hit && !(hit->distance >= 0.0 && hit->triangle < shape.mesh().triangles().size()))
    return "a ray hit that is none";
  std::uint32_t found[32];
  const std::size_t count =
      query::triangles_in_box(shape, middle, Mat3::Identity(), Vec3::Constant(0.2 * size), found, 10000, nullptr);
  for (std::size_t i = 0; i < count; ++i) {
    if (found[i] >= shape.mesh().triangles().size()) return "a triangle that is not there";
  }
  return "";
}

}  // namespace

std::string complaint_about_shape(std::span<const std::byte> bytes, bool* loaded) {
  const auto shape = query::load_shape(bytes, "input");
  if (loaded != nullptr) *loaded = shape.ok();
  if (!shape.ok()) {
    const std::string found = error_complaint(shape.error(), bytes.size());
    return found.empty() ? "" : found + ": " + shape.error().message();
  }
  std::string found = lookup_complaint(*shape.value());
  if (found.empty()) found = pair_complaint(shape.value(), shape.value());
  if (found.empty()) found = pair_complaint(shape.value(), shape.value()->without_polygons());
  return found;
}

}  // namespace odds::fuzz
