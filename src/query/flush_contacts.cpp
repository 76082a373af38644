#include "query/flush_contacts.hpp"

#include <algorithm>
#include <cmath>
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
  std::copy_n(kept.corners.begin(), kept.count, polygon.corners.begin());
  polygon.count = kept.count;
}

}  // namespace

void FlushContacts::forget() noexcept {
  count_ = 0;
  was_seen_ = false;
  too_many_ = false;
  is_denied_ = false;
  doubt_ = 0;
}

void FlushContacts::note_clear() noexcept {
  if (is_placed_ && is_certain()) return forget();
  too_many_ = false;
  is_denied_ = false;
  doubt_ = 0;
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
  double twice_area = 0.0;
  for (std::size_t i = 0; i < overlap.count; ++i) {
    const Seen& p = overlap.corners[i];
    const Seen& next = overlap.corners[i + 1 < overlap.count ? i + 1 : 0];
    twice_area += p.u * next.v - next.u * p.v;
    const Vec3 at(p.u, p.v, 0.0);
    low = i == 0 ? at : Vec3(low.cwiseMin(at));
    high = i == 0 ? at : Vec3(high.cwiseMax(at));
    deepest = std::max(deepest, p.depth);
  }
  // Through a body its far side faces the other one, too.
  const double most = std::min({tolerances::flush_depth * size_, 0.5 * a.thickness, 0.5 * b.thickness});
  if (!(deepest >= -tolerances::late_gap * size_ && deepest <= most)) return false;
  entry.radius = 0.5 * (high - low).norm();
  // What is deeper than it is wide, as of a crate that runs into a kerb, is left by its side.
  if (!(deepest * 2.0 * entry.radius <= 0.5 * std::abs(twice_area))) return false;
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

bool FlushContacts::follow(Entry& entry) const noexcept {
  const double before = std::max(entry.depth, 0.0);
  if (!place(entry)) return false;
  const double depth = std::max(entry.depth, 0.0);
  if (entry.holds) {  // as in LateManifold::age
    const double rise = tolerances::late_rise * size_;
    const bool parts = before - depth > rise;
    entry.given += std::max(depth - before, 0.0) + (parts ? -rise : rise);
  }
  entry.holds = false;
  entry.given = std::clamp(entry.given, std::min(depth, tolerances::unmeasured_depth * size_), depth);
  return true;
}

bool FlushContacts::covers(const mesh::FlatFace& face, const Vec3& point, double slack) const noexcept {
  const double height = face.normal.dot(point) - face.offset;
  const double under = tolerances::flush_depth * size_ + slack;
  if (!(height <= slack && height >= -under)) return false;
  const double radius = face.radius + under;
  if (!((point - face.centre).squaredNorm() <= radius * radius)) return false;
  for (std::size_t i = 0; i < face.corner_count; ++i) {
    const Vec3 side = face.corner[i + 1 < face.corner_count ? i + 1 : 0] - face.corner[i];
    if (!(face.normal.cross(side).dot(point - face.corner[i]) >= -slack * side.norm())) return false;
  }
  return true;
}

template <class Agrees>
const FlushContacts::Entry* FlushContacts::find(const Vec3& at, const math::Pose& pose, double slack, bool may_be_many,
                                                Agrees agrees) noexcept {
  const Vec3 at_in_b = pose.inverse() * at;
  for (const Entry& entry : entries()) {
    if (agrees(entry.normal) && covers(faces_a_[entry.face_a], at, slack) &&
        covers(faces_b_[entry.face_b], at_in_b, slack)) {
      return &entry;
    }
  }
  const double uneven = tolerances::unmeasured_depth * size_;
  for (std::uint32_t b = 0; b < faces_b_.size(); ++b) {
    if (!covers(faces_b_[b], at_in_b, slack)) continue;
    const Vec3 normal_b = pose.rotation * faces_b_[b].normal;
    for (std::uint32_t a = 0; a < faces_a_.size(); ++a) {
      if (!(-faces_a_[a].normal.dot(normal_b) > tolerances::flush_faces) || !agrees(normal_b) ||
          !(faces_a_[a].uneven + faces_b_[b].uneven <= uneven) || !covers(faces_a_[a], at, slack)) {
        continue;
      }
      Entry entry;
      entry.face_a = a;
      entry.face_b = b;
      if (!place(entry)) continue;
      if (count_ == entries_.size()) {
        if (!may_be_many) return nullptr;
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

bool FlushContacts::explains_crossing(const Vec3& at, const Vec3& normal_a, const Vec3& normal_b) noexcept {
  // One of the two is a face, or both stand on it beside each other, as the walls of bricks of one size.
  const auto agrees = [&](const Vec3& normal) noexcept {
    constexpr double wall = 0.5;
    const double a = -normal_a.dot(normal);
    const double b = normal_b.dot(normal);
    return std::max(a, b) > tolerances::hasty_agreement || (std::abs(a) < wall && std::abs(b) < wall);
  };
  return find(at, pose_, tolerances::hasty_slack * size_, true, agrees) != nullptr;
}

bool FlushContacts::explains(const Contact& contact, const math::Pose& pose) noexcept {
  const auto agrees = [&](const Vec3& normal) noexcept {
    return contact.normal.dot(normal) > tolerances::hasty_agreement;
  };
  return find(contact.position, pose, tolerances::hasty_slack * size_, true, agrees) != nullptr;
}

void FlushContacts::straighten(Contact& guess) noexcept {
  if (!is_placed_ || !may_be()) return;
  // It is the middle of a piece of surface, whose mean normal may be that of the edge of a brick.
  const auto agrees = [&](const Vec3& normal) noexcept { return guess.normal.dot(normal) > tolerances::opposed; };
  const Entry* entry = find(guess.position, pose_, tolerances::flush_depth * size_, false, agrees);
  if (entry == nullptr) return;
  guess.normal = entry->normal;
  was_seen_ = true;
}

double FlushContacts::deepest() const noexcept {
  double most = -std::numeric_limits<double>::infinity();
  for (const Entry& entry : entries()) most = std::max(most, entry.depth);
  return most;
}

bool FlushContacts::is_certain() const noexcept {
  const double rounding = tolerances::bears_nothing * size_;
  return serves() && std::any_of(entries().begin(), entries().end(), [&](const Entry& entry) {
           return entry.depth > faces_a_[entry.face_a].uneven + faces_b_[entry.face_b].uneven + rounding;
         });
}

FlushContacts::Order FlushContacts::by_depth() const noexcept {
  Order order;
  for (std::size_t i = 0; i < count_; ++i) {
    if (!(entries_[i].depth > 0.0) || entries_[i].point_count == 0) continue;
    std::size_t at = order.count++;
    for (; at > 0 && entries_[order.entry[at - 1]].depth < entries_[i].depth; --at)
      order.entry[at] = order.entry[at - 1];
    order.entry[at] = i;
  }
  return order;
}

patch::Chosen FlushContacts::choose(Entry& entry, std::size_t most) noexcept {
  const std::span points = std::span(entry.points).first(entry.point_count);
  const patch::Witness deepest =
      *std::max_element(points.begin(), points.end(), [](const auto& p, const auto& q) { return p.depth < q.depth; });
  for (patch::Witness& point : points) point = patch::pulled_in(point, deepest);
  entry.holds = true;
  return patch::choose(points, patch::Frame(entry.normal), most, patch::spacing(entry.depth, entry.radius));
}

std::size_t FlushContacts::interleave(std::span<const std::size_t> order, std::span<const patch::Chosen> chosen,
                                      std::span<Contact> contacts) const noexcept {
  std::size_t written = 0;
  for (std::size_t round = 0; round < most_contacts; ++round) {
    for (std::size_t i = 0; i < order.size() && written < contacts.size(); ++i) {
      if (round >= chosen[i].count) continue;
      const Entry& entry = entries_[order[i]];
      const patch::Witness& w = chosen[i].witnesses[round];
      contacts[written++] = {w.middle(), entry.normal, std::min(w.depth, entry.given), w.triangle_a, w.triangle_b};
    }
  }
  return written;
}

}  // namespace odds::query
