#include "query/flush_contacts.hpp"

#include <algorithm>
#include <limits>

#include "odds/math/tolerances.hpp"

namespace odds::query {
namespace {

/// A corner of a polygon as seen along the normal, and how deep the overlap is there.
struct Seen {
  double u;
  double v;
  double depth;
};

template <std::size_t most>
struct Polygon {
  std::array<Seen, most> corners;
  std::size_t count = 0;
};

/// What lies to the left of the line, where `side` is not negative (Sutherland and Hodgman 1974).
template <std::size_t most, class Side>
void clip(Polygon<most>& polygon, Side&& side) noexcept {
  std::array<double, most> distance;
  bool all = true;
  for (std::size_t i = 0; i < polygon.count; ++i) {
    distance[i] = side(polygon.corners[i]);
    all = all && distance[i] >= 0.0;
  }
  if (all) return;
  Polygon<most> kept;
  for (std::size_t i = 0; i < polygon.count; ++i) {
    const std::size_t next = i + 1 < polygon.count ? i + 1 : 0;
    const Seen& from = polygon.corners[i];
    const Seen& to = polygon.corners[next];
    if (distance[i] >= 0.0 && kept.count < most) kept.corners[kept.count++] = from;
    if ((distance[i] >= 0.0) == (distance[next] >= 0.0) || kept.count == most) continue;
    const double t = distance[i] / (distance[i] - distance[next]);
    kept.corners[kept.count++] = {from.u + t * (to.u - from.u), from.v + t * (to.v - from.v),
                                  from.depth + t * (to.depth - from.depth)};
  }
  polygon = kept;
}

}  // namespace

void FlushContacts::forget() noexcept {
  count_ = 0;
  was_seen_ = false;
  note_clear();
}

bool FlushContacts::place(Entry& entry) const noexcept {
  const mesh::FlatFace& a = faces_a_[entry.face_a];
  const mesh::FlatFace& b = faces_b_[entry.face_b];
  const Vec3 normal_b = pose_.rotation * b.normal;
  if (!(-a.normal.dot(normal_b) > tolerances::flush_faces)) return false;
  // Neither is preferred: exchanging the bodies turns the normal round, and nothing else.
  const patch::Frame frame((normal_b - a.normal).normalized());
  entry.normal = frame.normal;
  const Vec3 origin = a.centre;

  // Heights of both planes over the frame's plane through the origin; B's above A's is an overlap.
  const double per_a = -1.0 / a.normal.dot(frame.normal);
  const double per_b = -1.0 / normal_b.dot(frame.normal);
  const double slope_a[2] = {per_a * a.normal.dot(frame.u), per_a * a.normal.dot(frame.v)};
  const double slope_b[2] = {per_b * normal_b.dot(frame.u), per_b * normal_b.dot(frame.v)};
  const double level_a = -per_a * (a.offset - a.normal.dot(origin));
  const double level_b = -per_b * (b.offset - b.normal.dot(pose_.rotation.transpose() * (origin - pose_.translation)));
  const auto seen = [&](const Vec3& point) noexcept {
    const Vec3 from = point - origin;
    const double u = frame.u.dot(from);
    const double v = frame.v.dot(from);
    return Seen{u, v, (level_b + slope_b[0] * u + slope_b[1] * v) - (level_a + slope_a[0] * u + slope_a[1] * v)};
  };

  std::array<Seen, mesh::FlatFace::most_corners> window;  // B's corners: counter-clockwise along the normal
  for (std::size_t i = 0; i < b.corner_count; ++i) window[i] = seen(pose_ * b.corner[i]);
  Polygon<most_points> overlap;
  for (std::size_t i = a.corner_count; i-- != 0;) overlap.corners[overlap.count++] = seen(a.corner[i]);
  for (std::size_t i = 0; i < b.corner_count && overlap.count > 0; ++i) {
    const Seen& from = window[i];
    const Seen& to = window[i + 1 < b.corner_count ? i + 1 : 0];
    const double along[2] = {to.u - from.u, to.v - from.v};
    clip(overlap, [&](const Seen& p) noexcept { return along[0] * (p.v - from.v) - along[1] * (p.u - from.u); });
  }
  if (overlap.count < 3) return false;

  Vec3 low = Vec3::Zero();
  Vec3 high = Vec3::Zero();
  double deepest = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < overlap.count; ++i) {
    const Seen& p = overlap.corners[i];
    const Vec3 at(p.u, p.v, 0.0);
    low = i == 0 ? at : Vec3(low.cwiseMin(at));
    high = i == 0 ? at : Vec3(high.cwiseMax(at));
    deepest = std::max(deepest, p.depth);
  }
  if (!(deepest >= -tolerances::late_gap * size_ && deepest <= tolerances::flush_depth * size_)) return false;
  const Vec3 middle = 0.5 * (low + high);
  entry.centre = origin + middle.x() * frame.u + middle.y() * frame.v +
                 (level_a + slope_a[0] * middle.x() + slope_a[1] * middle.y()) * frame.normal;
  entry.radius = 0.5 * (high - low).norm();
  entry.depth = deepest;

  clip(overlap, [](const Seen& p) noexcept { return p.depth; });
  entry.point_count = overlap.count;
  for (std::size_t i = 0; i < overlap.count; ++i) {
    const Seen& p = overlap.corners[i];
    const double depth = std::max(p.depth, 0.0);
    const Vec3 on_a =
        origin + p.u * frame.u + p.v * frame.v + (level_a + slope_a[0] * p.u + slope_a[1] * p.v) * frame.normal;
    entry.points[i] = {on_a, on_a + depth * frame.normal, depth, a.triangle, b.triangle};
  }
  return true;
}

void FlushContacts::move_to(const math::Pose& pose, double size) noexcept {
  pose_ = pose;
  size_ = size;
  is_placed_ = true;
  std::size_t left = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    Entry& entry = entries_[i];
    const double before = std::max(entry.depth, 0.0);
    if (!place(entry)) continue;
    const double depth = std::max(entry.depth, 0.0);
    const double deeper = std::max(depth - before, 0.0);
    entry.given = std::clamp(entry.given + deeper + tolerances::late_rise * size,
                             std::min(depth, tolerances::unmeasured_depth * size), depth);
    if (left != i) entries_[left] = entry;
    ++left;
  }
  if (left == 0) was_seen_ = false;
  if (doubt_ > 0) --doubt_;
  count_ = left;
}

void FlushContacts::straighten(Contact& guess) noexcept {
  if (!is_placed_ || !may_be()) return;
  if (const Entry* entry = find(guess.position)) guess.normal = entry->normal;
}

const FlushContacts::Entry* FlushContacts::find(const Vec3& at) noexcept {
  const double slack = tolerances::flush_depth * size_;
  for (const Entry& entry : std::span(entries_).first(count_)) {
    const Vec3 from = at - entry.centre;
    const double height = entry.normal.dot(from);
    if (std::abs(height) <= slack && (from - height * entry.normal).norm() <= entry.radius + slack) return &entry;
  }
  const auto is_at = [slack](const mesh::FlatFace& face, const Vec3& point) noexcept {
    return std::abs(face.normal.dot(point) - face.offset) <= slack &&
           (point - face.centre).squaredNorm() <= (face.radius + slack) * (face.radius + slack);
  };
  const Vec3 at_in_b = pose_.rotation.transpose() * (at - pose_.translation);
  for (std::uint32_t b = 0; b < faces_b_.size(); ++b) {
    if (!is_at(faces_b_[b], at_in_b)) continue;
    const Vec3 normal_b = pose_.rotation * faces_b_[b].normal;
    for (std::uint32_t a = 0; a < faces_a_.size(); ++a) {
      if (!(-faces_a_[a].normal.dot(normal_b) > tolerances::flush_faces) || !is_at(faces_a_[a], at)) continue;
      Entry entry;
      entry.face_a = a;
      entry.face_b = b;
      if (!place(entry)) continue;
      if (count_ == entries_.size()) {
        count_ = 0;
        was_seen_ = false;
        too_many_ = true;
        return nullptr;
      }
      entry.given = std::clamp(entry.depth, 0.0, tolerances::unmeasured_depth * size_);
      entries_[count_] = entry;
      return &entries_[count_++];
    }
  }
  return nullptr;
}

bool FlushContacts::overlaps() const noexcept {
  return std::any_of(entries_.begin(), entries_.begin() + static_cast<std::ptrdiff_t>(count_),
                     [](const Entry& entry) { return entry.depth > 0.0; });
}

std::size_t FlushContacts::write(std::span<Contact> contacts) noexcept {
  std::array<patch::Chosen, most_entries> chosen;
  std::array<std::size_t, most_entries> order;
  std::size_t pairs = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    Entry& entry = entries_[i];
    if (!(entry.depth > 0.0) || entry.point_count == 0) continue;
    const std::span points = std::span(entry.points).first(entry.point_count);
    const patch::Witness deepest =
        *std::max_element(points.begin(), points.end(), [](const auto& p, const auto& q) { return p.depth < q.depth; });
    for (patch::Witness& point : points) point = patch::pulled_in(point, deepest);
    const double spacing = patch::spacing(entry.depth, entry.radius);
    chosen[i] = patch::choose(points, patch::Frame(entry.normal), most_contacts, spacing);
    std::size_t at = pairs++;
    for (; at > 0 && entries_[order[at - 1]].depth < entry.depth; --at) order[at] = order[at - 1];
    order[at] = i;
  }
  std::size_t written = 0;
  for (std::size_t round = 0; round < most_contacts; ++round) {
    for (std::size_t k = 0; k < pairs && written < contacts.size(); ++k) {
      const Entry& entry = entries_[order[k]];
      if (round >= chosen[order[k]].count) continue;
      const patch::Witness& w = chosen[order[k]].witnesses[round];
      contacts[written++] = {w.middle(), entry.normal, std::min(w.depth, entry.given), w.triangle_a, w.triangle_b};
    }
  }
  return written;
}

}  // namespace odds::query
