// The contacts of a pair from tick to tick: what a query that had no time for new ones falls back on.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "odds/math/pose.hpp"
#include "odds/math/tolerances.hpp"
#include "odds/query/answer.hpp"
#include "odds/query/held_contact.hpp"

namespace odds::ode {

/// Each contact is held as two points, one fixed in each body: as the bodies move on, its depth follows, and it is let
/// go once the points have slid or come apart. A body at rest is then not thrown off by a processor that was away for a
/// moment. All in A's mesh frame, metres. No allocation.
class HeldContacts {
 public:
  static constexpr std::size_t most = 8;
  /// Of the smaller body's size: how far the two points of a contact may slide, or come apart, until it is let go; and
  /// how far they may slide while queries end undecided, and so there is nothing better than the plane in which the
  /// bodies last touched (an intermediate representation: Adachi, Kumano and Ogino 1995, Mark et al. 1996).
  static constexpr double most_slip = 0.02;
  static constexpr double most_slip_undecided = 0.1;
  static constexpr double most_gap = 0.002;
  /// The same: how much deeper a contact may become than it was found, until it is let go. Bodies that have come
  /// farther may be anywhere, also apart on the other side.
  static constexpr double most_come = 0.5;
  /// Of the smaller body's size: nearer to each other two contacts are one.
  static constexpr double same_place = tolerances::same_contact_place;
  /// Runs that add contacts and do not find one again, after which it is let go, unless its triangle meets the other
  /// body, moved by what the contact is apart: a rim of which each run finds a tenth is found in fewer.
  static constexpr int most_added = 40;
  /// Of the smaller body's size: while bodies have moved less, all contacts that a finished run found are trusted more
  /// than the few that a starved one finds.
  static constexpr double most_trusted = 0.01;
  /// Cosine above which two contacts push to the same side.
  static constexpr double same_side = tolerances::same_contact_side;
  /// A stalled processor is away for some milliseconds.
  static constexpr int most_runs = 10;
  /// Of the smaller body's size: bodies that have moved less since what is held was made have not sunk in deeper than
  /// that anywhere else, however long ago it was.
  static constexpr double rest = 0.0001;

  /// Of triangles, for contacts that were made in a hurry: so many of them are right about the direction, and fresher,
  /// and so better, than held ones, which know of one side of a body that rocks.
  static constexpr std::uint32_t enough_pairs = 12;

  /// Tells whether a triangle of A's mesh meets B now, if B is moved by `motion`, in A's mesh frame.
  struct StillMeets {
    bool (*ask)(void* self, std::uint32_t triangle, const Vec3& motion) noexcept = nullptr;  ///< null: nobody knows
    void* self = nullptr;
  };

  /// What to give for the answer of a run: its own contacts if they were made with care or from enough triangles; what
  /// is held if the budget ended before that, or before anything was decided. Keeps what it gives. `size`: diameter of
  /// the smaller body. Valid until the next call, or the pair's next run.
  [[nodiscard]] std::span<const query::Contact> best_of(const query::Answer& answer, const math::Pose& b_in_a,
                                                        double size) noexcept;

  /// What to give for a run that saw all of the surfaces: what it found. Keeps what was held and is apart now, too:
  /// where bodies rock, they touch there next.
  [[nodiscard]] std::span<const query::Contact> with_all(std::span<const query::Contact> found,
                                                         const math::Pose& b_in_a, double size) noexcept;

  /// Of a run that saw a part of them, and that part well: what it found beside what is held. `meets` is asked once at
  /// most.
  [[nodiscard]] std::span<const query::Contact> with_part(std::span<const query::Contact> found,
                                                          const math::Pose& b_in_a, double size,
                                                          const StillMeets& meets) noexcept;

  /// Takes the place of all that was held. `careful`: not what a run gave that had no time to measure; `complete`: all
  /// that there is.
  void keep(std::span<const query::Contact> found, const math::Pose& b_in_a, bool careful, bool complete) noexcept;

  [[nodiscard]] bool is_empty() const noexcept { return count_ == 0; }

  /// Whether what `at` gave last is better than what a run gives now that had no time to measure: made with care, and
  /// either not long ago, for bodies that turn come to touch in other places, or of bodies that have hardly moved
  /// since.
  [[nodiscard]] bool better_than_rough() const noexcept { return careful_ && (runs_ <= most_runs || rests_); }

  /// Bodies that are known to be apart: what would overlap by what is held has not gone where its points say, and is
  /// let go.
  void note_apart(const math::Pose& b_in_a) noexcept;

  /// Lets go what has slid, parted, come far or turned over by the new pose; the others as contacts, deepest first,
  /// those that have parted by less with depth 0. Valid until the next call. `size`: diameter of the smaller body;
  /// `most_slid`: part of it.
  [[nodiscard]] std::span<const query::Contact> at(const math::Pose& b_in_a, double size,
                                                   double most_slid = most_slip) noexcept;

 private:
  void note_all(std::span<const query::Contact> found, const math::Pose& b_in_a, double size) noexcept;
  void add_apart(const HeldContacts& before, const math::Pose& b_in_a, double size) noexcept;
  void add(std::span<const query::Contact> found, const math::Pose& b_in_a, double size,
           const StillMeets& meets) noexcept;
  void add_one(const query::Contact& contact, bool trusted, const math::Pose& b_in_a, double size) noexcept;
  /// Of those that are less deep; `most`: none is.
  [[nodiscard]] std::size_t shallowest_above(double depth, const math::Pose& b_in_a) const noexcept;
  [[nodiscard]] bool is_trusted(const math::Pose& b_in_a, double size) const noexcept;
  [[nodiscard]] bool agrees(const Vec3& normal, const math::Pose& b_in_a) const noexcept;
  void move(std::size_t from, std::size_t to) noexcept;

  std::array<query::HeldContact, most> held_;
  std::array<Vec3, most> normals_on_b_;  ///< of each, in B's mesh frame
  std::array<int, most> added_{};        ///< of each, in how many runs contacts were added since it was found
  std::array<query::Contact, most> touching_;
  std::size_t count_ = 0;
  math::Pose made_at_;
  std::array<bool, most> complete_{};  ///< of each, whether a run gave it that gave all
  math::Pose complete_at_;             ///< where that was
  bool careful_ = false;
  bool rests_ = false;
  int runs_ = 0;  // since what is held was made
};

}  // namespace odds::ode
