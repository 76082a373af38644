#include "query/flush/flush_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "odds/math/tolerances.hpp"
#include "query/flush/flat_overlap.hpp"

namespace odds::query {
namespace {

const patch::Fan fan;  // made before any query

}  // namespace

bool FlushContacts::lean() const noexcept {
  return std::any_of(entries().begin(), entries().end(),
                     [](const Entry& entry) { return entry.depth > 0.0 && entry.leans; });
}

bool FlushContacts::place(Entry& entry, const Nearness& least) const noexcept {
  const mesh::FlatFace& a = faces_a_[entry.face_a];
  const mesh::FlatFace& b = faces_b_[entry.face_b];
  const Vec3 normal_b = pose_.rotation * b.normal;
  const double cosine = -a.normal.dot(normal_b);
  if (!(cosine > least.cosine)) return false;
  entry.leans = cosine <= tolerances::flush_faces;
  const double tilt = (a.normal + normal_b).norm();
  entry.is_deeper_beyond = tilt * (a.beyond + b.beyond) > tolerances::unmeasured_depth * size_;
  const flat::Facing facing({a.normal, a.offset}, {normal_b, b.offset + normal_b.dot(pose_.translation)}, a.centre);
  entry.normal = facing.normal();

  using Corners = std::array<flat::Seen, mesh::FlatFace::most_corners>;
  Corners of_a;  // clockwise along the normal
  Corners of_b;  // counter-clockwise
  for (std::size_t i = 0; i < a.corner_count; ++i) of_a[i] = facing.seen(a.corner[i]);
  for (std::size_t i = 0; i < b.corner_count; ++i) of_b[i] = facing.seen(pose_ * b.corner[i]);
  flat::Polygon<most_points> overlap;
  for (std::size_t i = a.corner_count; i-- != 0;) overlap.corners[overlap.count++] = of_a[i];
  for (std::size_t i = 0; i < b.corner_count && overlap.count > 0; ++i) {
    const flat::Seen& from = of_b[i];
    const flat::Seen& to = of_b[i + 1 < b.corner_count ? i + 1 : 0];
    const double along[2] = {to.u - from.u, to.v - from.v};
    flat::clip(overlap,
               [&](const flat::Seen& p) noexcept { return along[0] * (p.v - from.v) - along[1] * (p.u - from.u); });
  }
  if (overlap.count < 3) return false;

  const flat::Extent extent(overlap);
  // Through a body its far side faces the other one, too.
  const double most = std::min({tolerances::flush_depth * size_, 0.5 * a.thickness, 0.5 * b.thickness});
  if (!(extent.deepest.depth >= -least.gap * size_ && extent.deepest.depth <= most)) return false;
  // What is deeper than it is wide, as of a crate that runs into a kerb, is left by its side.
  if (!(extent.deepest.depth * extent.diagonal <= extent.area)) return false;
  entry.depth = extent.deepest.depth;
  entry.radius = 0.5 * extent.diagonal;
  if (entry.leans) {
    entry.normal = flat::normal_at(extent, {std::span(of_a).first(a.corner_count), -a.normal},
                                   {std::span(of_b).first(b.corner_count), normal_b}, facing.frame());
  }

  flat::clip(overlap, [](const flat::Seen& p) noexcept { return p.depth; });
  entry.point_count = overlap.count;
  for (std::size_t i = 0; i < overlap.count; ++i) {
    const Vec3 on_a = facing.on_a(overlap.corners[i]);
    const double depth = std::max(overlap.corners[i].depth, 0.0);
    entry.points[i] = {on_a, on_a + depth * facing.normal(), depth, a.triangle, b.triangle};
  }
  return true;
}

bool FlushContacts::follow(Entry& entry) const noexcept {
  if (!place(entry, to_follow)) return false;
  if (measured_) {
    entry.given.begin(entry.depth, std::max(entry.depth, 0.0));
    return true;
  }
  // While they hold nothing their contacts are no closer to being given.
  const double rise = entry.given.holds() ? tolerances::late_rise * size_ : 0.0;
  entry.given.age(entry.depth, tolerances::unmeasured_depth * size_, rise);
  return true;
}

bool FlushContacts::covers(const mesh::FlatFace& face, const Vec3& point, const Place& place) const noexcept {
  const double height = face.normal.dot(point) - face.offset;
  const double under = tolerances::flush_depth * size_ + place.above;
  if (!(height <= place.above && height >= -under)) return false;
  const double beside = face.beyond + place.beside;
  const double radius = face.radius + under + beside;
  if (!((point - face.centre).squaredNorm() <= radius * radius)) return false;
  for (std::size_t i = 0; i < face.corner_count; ++i) {
    const Vec3 side = face.corner[i + 1 < face.corner_count ? i + 1 : 0] - face.corner[i];
    if (!(face.normal.cross(side).dot(point - face.corner[i]) >= -beside * side.norm())) return false;
  }
  return true;
}

bool FlushContacts::reach(const mesh::FlatFace& a, const mesh::FlatFace& b, const Place& place) const noexcept {
  const double height_a = a.normal.dot(place.on_a) - a.offset;
  const double height_b = b.normal.dot(place.on_b) - b.offset;
  return place.depth <= -height_a - height_b + tolerances::unmeasured_depth * size_;
}

FlushContacts::FacesThere FlushContacts::faces_at(std::span<const mesh::FlatFace> faces, const Vec3& point,
                                                  const Place& place) const noexcept {
  FacesThere there;
  for (std::uint32_t i = 0; i < faces.size() && there.count < FacesThere::most; ++i) {
    if (covers(faces[i], point, place)) there.face[there.count++] = i;
  }
  return there;
}

template <class Agrees>
const FlushContacts::Entry* FlushContacts::find(const Place& place, Agrees agrees) noexcept {
  for (const Entry& entry : entries()) {
    const mesh::FlatFace& a = faces_a_[entry.face_a];
    const mesh::FlatFace& b = faces_b_[entry.face_b];
    if (agrees(entry.normal) && covers(a, place.on_a, place) && covers(b, place.on_b, place) && reach(a, b, place)) {
      return &entry;
    }
  }
  const FacesThere of_a = faces_at(faces_a_, place.on_a, place);
  const FacesThere of_b = faces_at(faces_b_, place.on_b, place);
  for (std::size_t b = 0; b < of_b.count; ++b) {
    const mesh::FlatFace& face_b = faces_b_[of_b.face[b]];
    const Vec3 normal = pose_.rotation * face_b.normal;
    if (!agrees(normal)) continue;
    for (std::size_t a = 0; a < of_a.count; ++a) {
      const mesh::FlatFace& face_a = faces_a_[of_a.face[a]];
      if (!(-face_a.normal.dot(normal) > tolerances::flush_faces) || !reach(face_a, face_b, place)) continue;
      if (const Entry* const added = add(of_a.face[a], of_b.face[b])) return added;
    }
  }
  return nullptr;
}

const FlushContacts::Entry* FlushContacts::add(std::uint32_t face_a, std::uint32_t face_b) noexcept {
  const auto is_it = [&](const Entry& entry) noexcept { return entry.face_a == face_a && entry.face_b == face_b; };
  if (std::any_of(entries().begin(), entries().end(), is_it)) return nullptr;  // it is not what was seen
  if (!(faces_a_[face_a].uneven + faces_b_[face_b].uneven <= tolerances::unmeasured_depth * size_)) return nullptr;
  Entry entry;
  entry.face_a = face_a;
  entry.face_b = face_b;
  if (crowded_ > 0 || !place(entry, to_find)) return nullptr;
  if (count_ == entries_.size()) {
    lose_all();
    crowded_ = longest_crowd;
    return nullptr;
  }
  entry.given.begin(entry.depth, measured_ ? entry.depth : tolerances::unmeasured_depth * size_);
  entries_[count_] = entry;
  return &entries_[count_++];
}

bool FlushContacts::explains_crossing(const Vec3& at, const Vec3& normal_a, const Vec3& normal_b) noexcept {
  // Between two faces, and beside them, whatever crosses is of them: walls of bricks of one size, chamfers of cans. But
  // it does not look away from the other one, as far sides of thin sheets do.
  const auto agrees = [&](const Vec3& normal) noexcept {
    constexpr double away = -0.5;
    return -normal_a.dot(normal) > away && normal_b.dot(normal) > away;
  };
  return find(place_at(at, pose_), agrees) != nullptr;
}

bool FlushContacts::explains(const Contact& contact, const math::Pose& pose) noexcept {
  const auto agrees = [&](const Vec3& normal) noexcept {
    return contact.normal.dot(normal) > tolerances::hasty_agreement;
  };
  Place place = place_at(contact.position, pose);
  place.depth = contact.depth;
  return find(place, agrees) != nullptr;
}

bool FlushContacts::include(const Contact& contact) const noexcept {
  Place place = place_at(contact.position, pose_);
  place.above = place.beside;
  return std::any_of(entries().begin(), entries().end(), [&](const Entry& entry) {
    return contact.normal.dot(entry.normal) > tolerances::hasty_agreement &&
           covers(faces_a_[entry.face_a], place.on_a, place) && covers(faces_b_[entry.face_b], place.on_b, place);
  });
}

void FlushContacts::straighten(Contact& guess) noexcept {
  if (!is_placed_ || !may_be() || count_ == entries_.size()) return;
  // It is the middle of a piece of surface, whose mean normal may be that of the edge of a brick.
  const auto agrees = [&](const Vec3& normal) noexcept { return guess.normal.dot(normal) > tolerances::opposed; };
  Place place = place_at(guess.position, pose_);
  place.beside = place.above = tolerances::flush_depth * size_;
  place.depth = -std::numeric_limits<double>::infinity();
  if (const Entry* const entry = find(place, agrees)) guess.normal = entry->normal;
}

bool FlushContacts::tell_all() const noexcept {
  return std::none_of(entries().begin(), entries().end(),
                      [](const Entry& entry) { return entry.depth > 0.0 && entry.is_deeper_beyond; });
}

double FlushContacts::deepest() const noexcept {
  double most = -std::numeric_limits<double>::infinity();
  for (const Entry& entry : entries()) most = std::max(most, entry.depth);
  return most;
}

bool FlushContacts::gives_all() const noexcept {
  return std::all_of(entries().begin(), entries().end(), [](const Entry& entry) {
    return entry.depth <= 0.0 || entry.given.of(entry.depth) == entry.depth;
  });
}

bool FlushContacts::is_certain() const noexcept {
  const double rounding = tolerances::bears_nothing * size_;
  return overlap() && std::any_of(entries().begin(), entries().end(), [&](const Entry& entry) {
           return entry.depth > faces_a_[entry.face_a].uneven + faces_b_[entry.face_b].uneven + rounding;
         });
}

FlushContacts::Groups FlushContacts::by_normal() const noexcept {
  Group by_depth;
  for (std::size_t i = 0; i < count_; ++i) {
    if (!(entries_[i].depth > 0.0) || entries_[i].point_count == 0) continue;
    std::size_t at = by_depth.count++;
    for (; at > 0 && entries_[by_depth.entry[at - 1]].depth < entries_[i].depth; --at)
      by_depth.entry[at] = by_depth.entry[at - 1];
    by_depth.entry[at] = i;
  }
  Groups groups;
  for (const std::size_t i : std::span(by_depth.entry).first(by_depth.count)) {
    std::size_t at = 0;
    const auto is_of = [&](const Group& group) noexcept {
      return entries_[group.entry[0]].normal.dot(entries_[i].normal) > tolerances::same_face;
    };
    while (at < groups.count && !is_of(groups.group[at])) ++at;
    groups.count = std::max(groups.count, at + 1);
    groups.group[at].entry[groups.group[at].count++] = i;
  }
  return groups;
}

patch::Chosen FlushContacts::choose(const Group& group, std::size_t most) noexcept {
  const Entry& first = entries_[group.entry[0]];
  const patch::Frame frame(first.normal);
  Vec3 lower = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 upper = -lower;
  patch::Witness deepest = first.points[0];
  for (const std::size_t i : group.entries()) {
    Entry& entry = entries_[i];
    entry.given.hold();
    const std::span points = std::span(entry.points).first(entry.point_count);
    const patch::Witness own =
        *std::max_element(points.begin(), points.end(), [](const auto& p, const auto& q) { return p.depth < q.depth; });
    if (own.depth > deepest.depth) deepest = own;
    for (patch::Witness& point : points) {
      point = patch::pulled_in(point, own);
      lower = lower.cwiseMin(point.middle());
      upper = upper.cwiseMax(point.middle());
    }
  }
  const double spacing = patch::spacing(first.depth, 0.5 * (upper - lower).norm());
  if (group.count == 1) return patch::choose(std::span(first.points).first(first.point_count), frame, most, spacing);
  patch::Extremes extremes(*kernels_, frame, fan, 0.5 * (lower + upper), deepest);
  for (const std::size_t i : group.entries())
    extremes.add(std::span(entries_[i].points).first(entries_[i].point_count));
  return patch::choose(extremes.all(), frame, most, spacing);
}

const FlushContacts::Entry& FlushContacts::entry_of(const patch::Witness& witness, const Group& group) const noexcept {
  for (const std::size_t i : group.entries()) {
    const Entry& entry = entries_[i];
    if (faces_a_[entry.face_a].triangle == witness.triangle_a &&
        faces_b_[entry.face_b].triangle == witness.triangle_b) {
      return entry;
    }
  }
  return entries_[group.entry[0]];
}

std::size_t FlushContacts::interleave(std::span<const Group> groups, std::span<const patch::Chosen> chosen,
                                      std::span<Contact> contacts) const noexcept {
  std::size_t written = 0;
  for (std::size_t round = 0; round < most_contacts; ++round) {
    for (std::size_t i = 0; i < groups.size() && written < contacts.size(); ++i) {
      if (round >= chosen[i].count) continue;
      const patch::Witness& w = chosen[i].witnesses[round];
      const Entry& entry = entry_of(w, groups[i]);
      contacts[written++] = {w.middle(), entry.normal, entry.given.of(w.depth), w.triangle_a, w.triangle_b};
    }
  }
  return written;
}

}  // namespace odds::query
