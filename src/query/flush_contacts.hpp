// Contacts of flat faces that lie on each other: two polygons, however many triangles they are cut into.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/flat_faces.hpp"
#include "odds/math/pose.hpp"
#include "odds/query/answer.hpp"
#include "odds/query/contact_patch.hpp"
#include "query/patch_select.hpp"

namespace odds::query {

/// Where one flat face of each body overlaps the other by little, the overlap is a convex polygon that clipping finds
/// in a fraction of a microsecond; the rim of the same overlap may cross hundreds of triangles. So bodies that stand on
/// each other have all of their contacts in every run, also in one without time for a patch.
///
/// Which faces those are is learnt from places where the surfaces were found to cross, and kept from run to run. What
/// came deep while nobody knew is given slowly, as by LateManifold. Of solids. In A's mesh frame, metres; `size`: of
/// the smaller body. After construction no allocation.
class FlushContacts {
 public:
  FlushContacts() = default;
  FlushContacts(std::vector<mesh::FlatFace> faces_a, std::vector<mesh::FlatFace> faces_b) noexcept
      : faces_a_(std::move(faces_a)), faces_b_(std::move(faces_b)) {}

  void forget() noexcept;

  /// Whether there are faces that might lie on each other.
  [[nodiscard]] bool may_be() const noexcept { return !faces_a_.empty() && !faces_b_.empty() && !too_many_; }
  /// A run begins.
  void begin() noexcept { is_placed_ = false; }
  /// It is one that has no time for a patch, with B's mesh frame at `pose`: what no longer lies on each other is
  /// forgotten.
  void move_to(const math::Pose& pose, double size) noexcept;
  /// Whether the surfaces cross at `place` because of a pair of faces that is known, or is found now.
  [[nodiscard]] bool explains(const Vec3& place) noexcept { return find(place) != nullptr; }
  /// A contact that is guessed where such faces are near each other has their normal.
  void straighten(Contact& guess) noexcept;

  /// Whether all that was seen of the bodies' contact was explained, and some of it overlaps now.
  [[nodiscard]] bool serves() const noexcept {
    return is_placed_ && was_seen_ && !is_denied_ && doubt_ == 0 && overlaps();
  }
  /// What a run saw: whether all of it was explained. `all`: it saw all that there is, and is believed until the next
  /// such one; what else one saw that did not is doubted for some runs.
  void note(bool explained, bool all) noexcept {
    was_seen_ = was_seen_ || explained;
    if (all) is_denied_ = !explained;
    if (!explained && !all) doubt_ = longest_doubt;
    if (explained && all) doubt_ = 0;
  }
  /// The bodies are proved apart: whatever else touched does no more.
  void note_clear() noexcept {
    too_many_ = false;
    is_denied_ = false;
    doubt_ = 0;
  }

  /// Writes the contacts, the deepest of each pair of faces first. Returns how many.
  [[nodiscard]] std::size_t write(std::span<Contact> contacts) noexcept;

 private:
  /// Pairs of faces: of more, as in a peg of many sides, a patch says more.
  static constexpr std::size_t most_entries = 6;
  /// Runs of five microseconds within which a patch of all there is comes late.
  static constexpr std::uint32_t longest_doubt = 64;
  static constexpr std::size_t most_points = 2 * mesh::FlatFace::most_corners + 2;

  /// Two faces, and where they overlap.
  struct Entry {
    std::uint32_t face_a = 0;
    std::uint32_t face_b = 0;
    double given = 0.0;  ///< of the depth, at most
    double depth = 0.0;  ///< greatest, in the last run; negative: a gap
    Vec3 normal = Vec3::UnitZ();
    Vec3 centre = Vec3::Zero();  ///< of what is seen of one through the other
    double radius = 0.0;
    std::array<patch::Witness, most_points> points;  ///< corners of the overlap
    std::size_t point_count = 0;
  };

  [[nodiscard]] bool overlaps() const noexcept;
  /// The faces that are known at a place, or found now; null: there are none, or no room for more.
  [[nodiscard]] const Entry* find(const Vec3& place) noexcept;
  /// How the faces of an entry lie now. False: not on each other.
  [[nodiscard]] bool place(Entry& entry) const noexcept;

  std::vector<mesh::FlatFace> faces_a_;
  std::vector<mesh::FlatFace> faces_b_;
  std::array<Entry, most_entries> entries_;
  std::size_t count_ = 0;
  bool too_many_ = false;
  bool is_placed_ = false;   ///< in this run
  bool was_seen_ = false;    ///< a place that they explain, since the first of them is known
  bool is_denied_ = false;   ///< by a run that saw all
  std::uint32_t doubt_ = 0;  ///< runs
  math::Pose pose_;
  double size_ = 0.0;
};

}  // namespace odds::query
