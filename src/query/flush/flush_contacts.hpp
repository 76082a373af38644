// Contacts of flat faces that lie on each other: two polygons, however many triangles they are cut into.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "mesh/flat_faces.hpp"
#include "odds/math/pose.hpp"
#include "odds/math/tolerances.hpp"
#include "odds/query/answer.hpp"
#include "odds/query/contact_patch.hpp"
#include "query/known/given_depth.hpp"
#include "query/patch/select.hpp"

namespace odds::query {

/// Where one flat face of each body overlaps the other by little, the overlap is a convex polygon that clipping finds
/// in a fraction of a microsecond; the rim of the same overlap may cross hundreds of triangles. So bodies that stand on
/// each other have all of their contacts in every run, also in one without time for a patch.
///
/// Which faces those are is learnt from places where the surfaces were found to cross, and kept from run to run. What
/// came deep while they did not hold it is given slowly. Of solids. In A's mesh frame, metres;
/// `size`: of the smaller body. No allocation.
class FlushContacts {
 public:
  /// Pairs of faces, as of a table on four legs: of more, as of a peg with many sides, a patch says more.
  static constexpr std::size_t most_entries = 4;

  FlushContacts() = default;
  /// The faces must outlive it.
  FlushContacts(std::span<const mesh::FlatFace> faces_a, std::span<const mesh::FlatFace> faces_b,
                const patch::Kernels& kernels) noexcept
      : faces_a_(faces_a), faces_b_(faces_b), kernels_(&kernels) {}

  void forget() noexcept {
    lose_all();
    believe_again();
  }

  /// Whether there are faces that might lie on each other.
  [[nodiscard]] bool may_be() const noexcept { return !faces_a_.empty() && !faces_b_.empty() && crowded_ == 0; }
  /// A run begins.
  void begin() noexcept {
    is_placed_ = false;
    if (crowded_ > 0) --crowded_;
  }
  /// It may need them, with B's mesh frame at `pose`: what no longer lies on each other is forgotten. `may_go_on()` is
  /// asked before every pair of faces, some 0.3 us each; where it is false they do not serve this run. `measured`: a
  /// patch of all there is has been made at this pose, and faces that are found in it are given as deep as they are.
  template <class MayGoOn>
  void move_to(const math::Pose& pose, double size, bool measured, MayGoOn may_go_on) noexcept {
    pose_ = pose;
    size_ = size;
    measured_ = measured;
    if (doubt_ > 0) --doubt_;
    is_placed_ = true;
    std::size_t left = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      is_placed_ = is_placed_ && may_go_on();
      if (is_placed_ && !follow(entries_[i])) continue;
      if (left != i) entries_[left] = entries_[i];
      ++left;
    }
    lost_ += count_ - left;
    count_ = left;
  }

  /// Whether two triangles cross at `place` because of a pair of faces that is known, or is found now. Their normals
  /// are unit, in A's frame.
  [[nodiscard]] bool explains_crossing(const Vec3& place, const Vec3& normal_a, const Vec3& normal_b) noexcept;
  /// The same of a contact that a patch has found with B's mesh frame at `pose`, near to where it is now; it is no
  /// deeper than the faces are there.
  [[nodiscard]] bool explains(const Contact& contact, const math::Pose& pose) noexcept;
  /// A guess of where such faces are near each other has their normal; they are looked at from then on.
  void straighten(Contact& guess) noexcept;

  /// What a run saw: whether all of it was explained. `all`: it saw all that there is, and is believed until the next
  /// such one; what else one saw that did not is doubted for some runs.
  void note(bool explained, bool all) noexcept {
    if (all) is_denied_ = !explained;
    if (!explained && !all) doubt_ = longest_doubt;
    if (explained && all) doubt_ = 0;
    if (!explained || all) doubts_only_beside_ = false;
  }
  /// What a search has seen that looks beside the faces only: something else that touches, or that there is nothing.
  void note_beside(bool something) noexcept {
    if (something) {
      doubts_only_beside_ = doubts_only_beside_ || doubt_ == 0;
      doubt_ = longest_doubt;
    } else if (doubts_only_beside_) {
      doubt_ = 0;
    }
  }
  /// The bodies are proved apart: whatever else touched does no more, and faces that overlap all the same do not lie on
  /// each other but through the bodies.
  void note_clear() noexcept {
    if (is_certain()) lose_all();
    believe_again();
  }

  /// Whether some faces overlap now, whatever else touches.
  [[nodiscard]] bool overlap() const noexcept { return is_placed_ && deepest() > 0.0; }
  /// Whether all that was seen of the bodies' contact was explained, and some of it overlaps now. Of faces that lean,
  /// one on an edge of the other, that says little of what has come to touch beside: `nothing_beside` does.
  [[nodiscard]] bool serves(bool nothing_beside = false) const noexcept {
    return overlap() && !is_denied_ && doubt_ == 0 && tell_all() && (nothing_beside || !lean());
  }
  /// Whether something was seen to touch beside them that no patch has seen yet.
  [[nodiscard]] bool something_else_came() const noexcept { return overlap() && !is_denied_ && doubt_ > 0; }
  /// Whether a contact, as it is now, is one of those.
  [[nodiscard]] bool include(const Contact& contact) const noexcept;
  /// Whether their depths are given in full.
  [[nodiscard]] bool gives_all() const noexcept;
  /// Calls `see` with both faces, A's first, of every pair that overlaps now, and how deep it does, metres.
  template <class See>
  void see_faces(See see) const noexcept {
    for (const Entry& entry : entries()) {
      if (entry.depth > 0.0) see(faces_a_[entry.face_a], faces_b_[entry.face_b], entry.depth);
    }
  }
  /// How many pairs of faces were forgotten so far: what was said of the others does not hold for them. Wraps around.
  [[nodiscard]] std::uint32_t lost() const noexcept { return static_cast<std::uint32_t>(lost_); }
  /// Whether some overlap by more than they are uneven: then the surfaces meet.
  [[nodiscard]] bool is_certain() const noexcept;

  /// Writes the contacts: faces with one normal have theirs together, those that span the largest area; of several
  /// normals that of the deepest first. `may_go_on()` is asked before every normal but the first; where it is false the
  /// others are left out. Returns how many.
  template <class MayGoOn>
  [[nodiscard]] std::size_t write(std::span<Contact> contacts, MayGoOn may_go_on) noexcept {
    const Groups groups = by_normal();
    std::array<patch::Chosen, most_entries> chosen;
    std::size_t made = 0;
    for (; made < groups.count && (made == 0 || may_go_on()); ++made) {
      chosen[made] = choose(groups.group[made], most_of_each(contacts.size(), groups.count));
    }
    return interleave(std::span(groups.group).first(made), chosen, contacts);
  }

 private:
  static constexpr std::size_t most_points = 2 * mesh::FlatFace::most_corners + 2;
  /// Runs of five microseconds within which a patch of all there is comes late.
  static constexpr std::uint32_t longest_doubt = 64;
  /// After which it is looked whether there are fewer pairs of faces now.
  static constexpr std::uint32_t longest_crowd = 512;

  /// Two faces, and where they overlap.
  struct Entry {
    std::uint32_t face_a = 0;
    std::uint32_t face_b = 0;
    double depth = 0.0;  ///< greatest, in the last run; negative: a gap
    /// They lay on each other, and now one stands on an edge or a corner of its own.
    bool leans = false;
    /// A round face reaches beyond its polygon, and tilts by so much that it is deeper there.
    bool is_deeper_beyond = false;
    GivenDepth given;
    double radius = 0.0;
    Vec3 normal = Vec3::UnitZ();
    std::array<patch::Witness, most_points> points;  ///< corners of the overlap
    std::size_t point_count = 0;
  };
  /// Entries that overlap and have one normal, the deepest first.
  struct Group {
    std::array<std::size_t, most_entries> entry;
    std::size_t count = 0;

    [[nodiscard]] std::span<const std::size_t> entries() const noexcept { return std::span(entry).first(count); }
  };
  struct Groups {
    std::array<Group, most_entries> group;
    std::size_t count = 0;
  };

  void lose_all() noexcept {
    lost_ += count_;
    count_ = 0;
  }
  void believe_again() noexcept {
    crowded_ = 0;
    is_denied_ = false;
    doubt_ = 0;
    doubts_only_beside_ = false;
  }
  [[nodiscard]] std::span<const Entry> entries() const noexcept { return std::span(entries_).first(count_); }
  [[nodiscard]] double deepest() const noexcept;
  /// Whether some that overlap do so on an edge or a corner of one of them.
  [[nodiscard]] bool lean() const noexcept;
  /// Whether the faces' polygons say how deep they are.
  [[nodiscard]] bool tell_all() const noexcept;
  /// By how little faces may be turned towards each other, and how far apart they may be.
  struct Nearness {
    double cosine;
    double gap;  ///< part of the smaller body's size
  };
  static constexpr Nearness to_find{tolerances::flush_faces, tolerances::late_gap};
  static constexpr Nearness to_follow{tolerances::leaning_faces, tolerances::leaning_gap};
  /// How the faces of an entry lie now. False: not on each other.
  [[nodiscard]] bool place(Entry& entry, const Nearness& least) const noexcept;
  /// The same, and how much of the depth is given.
  [[nodiscard]] bool follow(Entry& entry) const noexcept;
  /// Where something was seen: how far beside a face, and above it, it may be, and how deep the bodies are there, if
  /// that is known.
  struct Place {
    Vec3 on_a;  ///< in A's mesh frame
    Vec3 on_b;  ///< the same in B's
    double beside;
    double above;
    double depth = 0.0;
  };
  [[nodiscard]] Place place_at(const Vec3& place, const math::Pose& pose) const noexcept {
    return {place, pose.inverse() * place, tolerances::hasty_slack * size_, tolerances::unmeasured_depth * size_};
  }
  /// Whether faces are as deep in each other at a place as was seen.
  [[nodiscard]] bool reach(const mesh::FlatFace& a, const mesh::FlatFace& b, const Place& place) const noexcept;
  /// The faces known at a place, or found now, whose normal, into A, `agrees`; null: there are none, or no room for
  /// them.
  template <class Agrees>
  [[nodiscard]] const Entry* find(const Place& place, Agrees agrees) noexcept;
  [[nodiscard]] const Entry* add(std::uint32_t face_a, std::uint32_t face_b) noexcept;
  /// Of one body's faces those at a place, the largest few.
  struct FacesThere {
    static constexpr std::size_t most = 4;
    std::array<std::uint32_t, most> face;
    std::size_t count = 0;
  };
  [[nodiscard]] FacesThere faces_at(std::span<const mesh::FlatFace> faces, const Vec3& point,
                                    const Place& place) const noexcept;
  /// Whether a point lies over a face, no higher than `place.above`, or no deeper under it than faces lie in each
  /// other.
  [[nodiscard]] bool covers(const mesh::FlatFace& face, const Vec3& point, const Place& place) const noexcept;
  [[nodiscard]] Groups by_normal() const noexcept;
  /// No more than are used where several normals share the room.
  [[nodiscard]] static std::size_t most_of_each(std::size_t room, std::size_t groups) noexcept {
    return groups < 2 ? std::min<std::size_t>(most_contacts, room)
                      : std::min<std::size_t>(most_contacts, 2 * ((room + groups - 1) / groups));
  }
  [[nodiscard]] patch::Chosen choose(const Group& group, std::size_t most) noexcept;
  [[nodiscard]] const Entry& entry_of(const patch::Witness& witness, const Group& group) const noexcept;
  [[nodiscard]] std::size_t interleave(std::span<const Group> groups, std::span<const patch::Chosen> chosen,
                                       std::span<Contact> contacts) const noexcept;

  std::span<const mesh::FlatFace> faces_a_;
  std::span<const mesh::FlatFace> faces_b_;
  const patch::Kernels* kernels_ = nullptr;  ///< null: there are no faces
  std::array<Entry, most_entries> entries_;
  std::size_t count_ = 0;
  std::size_t lost_ = 0;
  std::uint32_t crowded_ = 0;        ///< runs in which there are more pairs than entries
  bool is_placed_ = false;           ///< in this run
  bool measured_ = false;            ///< in this run
  bool is_denied_ = false;           ///< by a run that saw all
  std::uint32_t doubt_ = 0;          ///< runs
  bool doubts_only_beside_ = false;  ///< the doubt is of looks beside the faces alone, and such a look ends it
  math::Pose pose_;
  double size_ = 0.0;
};

}  // namespace odds::query
