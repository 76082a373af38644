// Contacts that a run has no time for, made over the runs that follow.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "odds/query/pair.hpp"
#include "query/known/carried_contacts.hpp"
#include "query/memory/late_manifold.hpp"
#include "query/memory/scratch_pool.hpp"
#include "query/spending.hpp"

namespace odds::query {

/// Of a few microseconds nothing is left for a contact patch. So a run leaves a question behind, its pose and what was
/// known there, and each run that follows spends what it has left on the answer, which an exact search and a patch
/// without a deadline give. It is late by some runs and is carried along with the bodies until the next one comes.
/// Takes memory when it is made; the work itself neither allocates, locks nor calls the system.
class LateContacts {
 public:
  LateContacts(const std::shared_ptr<const Shape>& a, const std::shared_ptr<const Shape>& b,
               const PairOptions& options);
  ~LateContacts();
  LateContacts(const LateContacts&) = delete;
  LateContacts& operator=(const LateContacts&) = delete;

  /// Drops the question that is being worked on, and all contacts.
  void forget() noexcept;
  /// A run begins, at `pose_b_in_a`.
  void age(const math::Pose& pose_b_in_a, double size) noexcept;
  /// Contacts of poses before, to be carried along.
  [[nodiscard]] LateManifold& manifold() noexcept { return manifold_; }
  /// Whether there is memory for work, and use in it: of bodies that cross in more places than are kept, a part says
  /// little.
  [[nodiscard]] bool can_work() const noexcept { return is_at_work() || (!too_many_ && has_room_); }
  /// The same, whether there is memory or not.
  [[nodiscard]] bool is_of_use() const noexcept { return is_at_work() || !too_many_; }
  /// The bodies were proved apart in this run. True: for so long now that the work should be dropped.
  [[nodiscard]] bool note_clear() noexcept {
    parted_ = true;
    too_many_ = false;
    return ++clear_runs_ >= most_clear_runs;
  }
  /// They met.
  void note_hit() noexcept { clear_runs_ = 0; }
  /// A run did not have the time for all contacts of what it found.
  void note_unfinished() noexcept {
    quick_ = 0;
    is_wanted_ = true;
  }
  /// Whether contacts are to be made over several runs however long a run is, for those of this pair take longer.
  [[nodiscard]] bool is_wanted() const noexcept { return is_wanted_; }
  /// What is dropped ends like any query that its budget ends, a contact patch perhaps.
  static constexpr double enough_to_drop_us = 8.0;
  /// A question is copied to where it is worked on, before its work looks at the time.
  static constexpr double enough_to_ask_us = 1.8;
  /// What is found is copied, compared with what was known, and looked at.
  static constexpr double enough_to_take_over_us = 1.2;
  /// Drops the question that is being worked on, if any.
  void drop() noexcept;
  /// This run has left no time for the work.
  void note_starved() noexcept { owed_ = guesses_ ? most_shared : 0; }
  /// Whether a question is being worked on.
  [[nodiscard]] bool is_at_work() const noexcept { return scratch_ != nullptr; }
  /// Which bodies are pressed together for a question, for what is about to touch while it is being answered.
  enum class Press : std::uint8_t { what_slides, all };
  /// Goes on with the question while `spending.may_make_contacts()`; without one, asks that of this run first: `pair`
  /// at `pose_b_in_a`, pressed together along this run's contacts if they push one way and `press` says so. True: it
  /// was answered now: contacts() and what follows are of that pose, and `pair` knows what that run knew.
  bool work(const math::Pose& pose_b_in_a, const Request& request, Pair::Implementation& pair, Spending& spending,
            Press press) noexcept;

  /// Pairs of triangles that the work has found to meet so far, at the pose that it is about; more than a run finds.
  [[nodiscard]] std::span<const TrianglePair> hits() const noexcept;
  /// After work() was true: the contacts that it has made, at the pose that it was asked about, all pairs of triangles
  /// that meet there, and the contacts to be carried.
  [[nodiscard]] std::span<const Contact> contacts() const noexcept;
  [[nodiscard]] std::span<const TrianglePair> proofs() const noexcept;
  [[nodiscard]] const CarriedContacts& carried() const noexcept;
  /// Whether nothing of their depths is held back, of bodies that were not pressed.
  [[nodiscard]] bool gives_all() const noexcept { return gives_all_ && !pressed_; }
  /// That pose, of B's mesh frame in A's.
  [[nodiscard]] const math::Pose& pose() const noexcept { return pose_; }
  /// Whether this run takes over the last guess, which has left no time for the work.
  [[nodiscard]] bool shares_guess() const noexcept { return owed_ > 0 && guessed_ > 0; }
  /// This run takes it over, for its time is for something else.
  void share_guess() noexcept { owed_ = std::max(owed_, 1); }
  /// Contacts that this run has guessed.
  void keep_guess(std::span<const Contact> contacts, const math::Pose& pose_b_in_a) noexcept;
  /// If shares_guess(): writes those that still overlap, moved along. Returns how many.
  [[nodiscard]] std::size_t write_guess(const math::Pose& pose_b_in_a, double size,
                                        std::span<Contact> contacts) noexcept;

 private:
  /// Bodies that hop are apart for a few runs.
  static constexpr int most_clear_runs = 8;
  /// A guess takes most of a run's time; these that follow are left for the work: where patches take longer than bodies
  /// stay where they are, only more work brings them back from guesses, which do not hold them, to contacts that do.
  static constexpr int most_shared = 3;
  /// Questions in a row, each answered within half of a run, after which runs are said to be long enough.
  static constexpr int enough_quick = 32;

  [[nodiscard]] bool is_far(const math::Pose& pose_b_in_a, double size) const noexcept;
  void ask(const math::Pose& pose_b_in_a, const Request& request, const Pair::Implementation& pair,
           Press press) noexcept;
  /// Whether the bodies move where they touch.
  [[nodiscard]] bool slide(const Contact& contact, double size) const noexcept;
  /// Whether they turn against each other.
  [[nodiscard]] bool turn() const noexcept;
  static void answer(void* self) noexcept;
  static std::int64_t read_clock(void* self) noexcept;
  void end() noexcept;
  void note_duration(const Request& request) noexcept;

  std::unique_ptr<Pair::Implementation> worker_;
  std::shared_ptr<ScratchPool> pool_;
  std::uint32_t last_ = 0;      ///< in the pool
  Scratch* scratch_ = nullptr;  ///< while a question is being worked on
  Spending* spending_ = nullptr;
  std::int64_t looks_to_spare_ = 0;  ///< at that run's clock
  bool pressed_ = false;             ///< what is being worked on
  bool turned_ = false;              ///< the bodies, when it was asked
  bool gives_all_ = false;           ///< of what was made last
  bool parted_ = false;              ///< the bodies were apart since it was asked
  bool too_many_ = false;            ///< the last one had more hits than are kept
  int clear_runs_ = 0;               ///< in a row
  bool dropped_ = false;             ///< it is to end as soon as it can
  bool is_wanted_ = false;
  int quick_ = 0;                        ///< questions in a row
  int asked_ = 0;                        ///< runs since the question
  int last_asked_ = Lateness::long_ago;  ///< since the one before whose contacts were kept
  double worked_us_ = 0.0;               ///< on the one that is being worked on
  LateManifold manifold_;
  std::array<HeldContact, most_contacts> guess_;
  std::size_t guessed_ = 0;
  math::Pose guess_pose_;
  bool has_room_ = false;           ///< to begin in this run: asked once, for other threads take and give it back
  bool is_aged_ = false;            ///< there was a run before this one
  math::Pose pose_now_;             ///< of this run
  math::Pose pose_last_;            ///< of the run before
  bool guesses_ = false;            ///< in this run
  int owed_ = 0;                    ///< runs that take over a guess
  math::Pose pose_;                 ///< of the question
  Vec3 place_on_b_ = Vec3::Zero();  ///< where the bodies touched then, in B's mesh frame
  Request request_;
  std::int64_t time_ns_ = 0;  ///< the worker's own, which never runs out
};

}  // namespace odds::query
