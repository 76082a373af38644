// Reduction of witnesses to contacts.
#include "query/patch/select.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "query/patch/eight.hpp"

namespace odds::query::patch {
namespace {

double cross(const Vec3& p, const Vec3& q) noexcept { return p.x() * q.y() - p.y() * q.x(); }
double flat_distance(const Vec3& p, const Vec3& q) noexcept {
  const double x = p.x() - q.x();
  const double y = p.y() - q.y();
  return std::sqrt(x * x + y * y);
}

/// A candidate in the frame of the patch: place across the normal, and depth as a share of the greatest.
struct Candidate {
  Vec3 place;
  double share = 0.0;
  std::size_t source = 0;
  bool taken = false;
};

struct Candidates {
  std::array<Candidate, 32> list;
  std::size_t count = 0;
  double deepest = 0.0;
  double radius = 0.0;
  Vec3 centre = Vec3::Zero();
};

Candidates gather(std::span<const Witness> witnesses, const Frame& frame) noexcept {
  Candidates found;
  for (const Witness& w : witnesses) found.deepest = std::max(found.deepest, w.depth);
  const Vec3 origin = witnesses.empty() ? Vec3(Vec3::Zero()) : witnesses[0].middle();
  Vec3 low = Vec3::Zero();
  Vec3 high = Vec3::Zero();
  for (std::size_t i = 0; i < witnesses.size() && found.count < found.list.size(); ++i) {
    const double share = found.deepest > 0.0 ? witnesses[i].depth / found.deepest : 1.0;
    const Vec3 place = frame(witnesses[i].middle() - origin);
    low = found.count == 0 ? place : Vec3(low.cwiseMin(place));
    high = found.count == 0 ? place : Vec3(high.cwiseMax(place));
    found.list[found.count++] = {place, share, i, false};
  }
  found.centre = 0.5 * (low + high);
  for (std::size_t i = 0; i < found.count; ++i) {
    found.radius = std::max(found.radius, flat_distance(found.list[i].place, found.centre));
  }
  return found;
}

/// The area that a point adds to the polygon of the chosen ones, times a weight for depth; for the second point the
/// length.
double gain(const Candidate& c, std::span<const Vec3> chosen) noexcept {
  const double weight = 0.5 + 0.5 * c.share;
  if (chosen.size() == 1) return weight * flat_distance(c.place, chosen[0]);
  if (chosen.size() == 2) return weight * std::abs(cross(chosen[1] - chosen[0], c.place - chosen[0]));
  double added = 0.0;  // the polygon is kept counter-clockwise: outside of a side the cross product is negative
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    const Vec3& p = chosen[i];
    const Vec3& q = chosen[(i + 1) % chosen.size()];
    added += std::max(0.0, -cross(q - p, c.place - p));
  }
  return weight * added;
}

/// Puts a point into the counter-clockwise polygon, at the side that it is farthest outside of.
void insert(std::array<Vec3, most_contacts>& polygon, std::size_t& count, const Vec3& place) noexcept {
  std::size_t at = count;
  if (count == 2 && cross(polygon[1] - polygon[0], place - polygon[0]) < 0.0) at = 1;
  if (count > 2) {
    double farthest = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3& p = polygon[i];
      const Vec3& q = polygon[(i + 1) % count];
      const double outside = -cross(q - p, place - p);
      if (outside > farthest) {
        farthest = outside;
        at = i + 1;
      }
    }
  }
  for (std::size_t i = count; i > at; --i) polygon[i] = polygon[i - 1];
  polygon[at] = place;
  ++count;
}

double area_of(std::span<const Vec3> polygon) noexcept {
  double twice = 0.0;
  for (std::size_t i = 2; i < polygon.size(); ++i) twice += cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
  return twice;
}

}  // namespace

Fan::Fan() noexcept {
  for (std::size_t i = 0; i < size; ++i) {
    const double angle = (static_cast<double>(i) + 0.381966) * std::numbers::pi / 8.0;
    u[i] = std::cos(angle);
    v[i] = std::sin(angle);
  }
}

Extremes::Extremes(const Kernels& kernels, const Frame& frame, const Fan& fan, const Vec3& centre,
                   const Witness& deepest) noexcept
    : kernels_(kernels),
      frame_(frame),
      fan_(fan),
      centre_(centre),
      per_depth_(deepest.depth > 0.0 ? 0.5 / deepest.depth : 0.0),
      least_weight_(deepest.depth > 0.0 ? 0.5 : 1.0) {
  best_[Fan::size] = deepest;
}

void Extremes::add(std::span<const Witness> witnesses) noexcept {
  for (std::size_t first = 0; first < witnesses.size(); first += at_once) {
    const std::span<const Witness> some = witnesses.subspan(first, std::min(at_once, witnesses.size() - first));
    std::array<double, at_once> u;
    std::array<double, at_once> v;
    for (std::size_t i = 0; i < some.size(); ++i) {
      const Vec3 place = (least_weight_ + per_depth_ * some[i].depth) * (some[i].middle() - centre_);
      u[i] = frame_.u.dot(place);
      v[i] = frame_.v.dot(place);
    }
    kernels_.farthest(u.data(), v.data(), some.size(), seen_, fan_, ends_);
    for (std::size_t d = 0; d < Fan::size; ++d) {
      if (ends_.end(d) >= seen_) best_[d] = some[ends_.end(d) - seen_];
    }
    seen_ += some.size();
  }
}

std::span<const Witness> Extremes::all() noexcept {
  if (seen_ == 0) return {};
  std::size_t count = 0;
  for (const Witness& w : best_) {
    bool known = false;
    for (std::size_t i = 0; i < count; ++i) known = known || (found_[i].on_a == w.on_a && found_[i].depth == w.depth);
    if (!known) found_[count++] = w;
  }
  return {found_.data(), count};
}

Chosen choose(std::span<const Witness> witnesses, const Frame& frame, std::size_t most, double spacing,
              Watch* watch) noexcept {
  Chosen chosen;
  Candidates candidates = gather(witnesses, frame);
  std::array<Vec3, most_contacts> polygon;
  std::size_t corners = 0;
  most = std::min<std::size_t>(most, most_contacts);
  while (chosen.count < most) {
    if (watch != nullptr && chosen.count > 0) static_cast<void>(watch->late());
    Candidate* best = nullptr;
    double best_score = 0.0;
    for (std::size_t i = 0; i < candidates.count; ++i) {
      Candidate& c = candidates.list[i];
      if (c.taken) continue;
      double score = 0.0;
      if (corners == 0) {
        const double out =
            candidates.radius > 0.0 ? flat_distance(c.place, candidates.centre) / candidates.radius : 0.0;
        score = c.share + 0.02 * out;
      } else {
        double nearest = flat_distance(c.place, polygon[0]);
        for (std::size_t k = 1; k < corners; ++k) nearest = std::min(nearest, flat_distance(c.place, polygon[k]));
        if (nearest <= spacing) continue;
        score = gain(c, {polygon.data(), corners});
        // From the third point on the area must grow noticeably: points on a side or inside add nothing.
        if (corners == 2 && score <= spacing * flat_distance(polygon[0], polygon[1])) continue;
        if (corners > 2 && score <= 0.05 * area_of({polygon.data(), corners})) continue;
      }
      if (best == nullptr || score > best_score) {
        best = &c;
        best_score = score;
      }
    }
    if (best == nullptr) break;
    best->taken = true;
    insert(polygon, corners, best->place);
    chosen.witnesses[chosen.count++] = witnesses[best->source];
  }
  return chosen;
}

Witness deepest_of(std::span<const Witness> witnesses, const Frame& frame, const Vec3& centre, double radius) noexcept {
  double depth = 0.0;
  for (const Witness& w : witnesses) depth = std::max(depth, w.depth);
  const double per_depth = depth > 0.0 ? 1.0 / depth : 0.0;
  const double per_radius = radius > 0.0 ? 0.02 / radius : 0.0;
  const Witness* best = &witnesses[0];
  double best_score = -1.0;
  for (const Witness& w : witnesses) {
    if (w.depth < 0.95 * depth) continue;
    const Vec3 out = w.middle() - centre;
    const double u = frame.u.dot(out);
    const double v = frame.v.dot(out);
    const double score = w.depth * per_depth + per_radius * std::sqrt(u * u + v * v);
    if (score <= best_score) continue;
    best_score = score;
    best = &w;
  }
  return *best;
}

Witness pulled_in(const Witness& witness, const Witness& deepest) noexcept {
  const double least = tolerances::shallow_share * deepest.depth;
  if (!(witness.depth < least)) return witness;
  const double t = (least - witness.depth) / (deepest.depth - witness.depth);
  Witness pulled = witness;
  pulled.on_a += t * (deepest.on_a - witness.on_a);
  pulled.on_b += t * (deepest.on_b - witness.on_b);
  pulled.depth = least;
  return pulled;
}

Witness merged(const Chosen& chosen, const Vec3& normal, const Vec3& centre) noexcept {
  Witness one = chosen.witnesses[0];
  double height = 0.0;
  for (std::size_t i = 0; i < chosen.count; ++i) {
    one.depth = std::max(one.depth, chosen.witnesses[i].depth);
    height += normal.dot(chosen.witnesses[i].middle() - centre) / static_cast<double>(chosen.count);
  }
  const Vec3 middle = centre + height * normal;
  one.on_a = middle - 0.5 * one.depth * normal;
  one.on_b = middle + 0.5 * one.depth * normal;
  return one;
}

}  // namespace odds::query::patch
