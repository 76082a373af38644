// A frame: collect the pairs, put them in order, call for each whose turn it is with its share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "odds/math/types.hpp"
#include "odds/ode/odds_frame.h"
#include "odds/realtime/clock.hpp"
#include "ode/frame/frame_pairs.hpp"
#include "ode/frame/frame_share.hpp"
#include "ode/frame/importance.hpp"

namespace odds::ode {

/// What the caller sets; ranges and meanings stand in odds_frame.h.
struct FrameSettings {
  double time_us = std::numeric_limits<double>::infinity();
  unsigned long work_units = 0;
  bool attends = false;
  Vec3 attention = Vec3::Zero();
  double attention_radius = 1.0;
  int sharing = ODDS_SHARE_BY_IMPORTANCE;
  int parts = 1;

  [[nodiscard]] bool in_units() const noexcept { return work_units > 0; }
};

/// A pair of this frame.
struct FrameCandidate {
  dGeomID a = nullptr;
  dGeomID b = nullptr;
  FramePair* memory = nullptr;  ///< null beyond the memory
  PairSigns signs;
  double speed = 0.0;  ///< of each against the other, m/s
  double importance = 0.0;
  double turn = 0.0;
  double need = 0.0;        ///< its least useful share
  double kept = 0.0;        ///< needs of all that come after it and whose turn it is; and what holding takes
  double weight = 0.0;      ///< its own in what the needs leave over
  double rivals = 0.0;      ///< ... its own, and those of all that come after it
  std::uint32_t order = 0;  ///< in which ODE found it
  bool planned = false;     ///< it is its turn in this frame
  bool called = false;
};

/// Fills in importance and turn of each, and sorts them, the one whose turn it most is first. Precondition: `memory` of
/// each is set. `frame`: number of this frame.
void put_in_order(std::vector<FrameCandidate>& candidates, const FrameSettings& settings, std::uint64_t frame) noexcept;

/// What a plan parts, in microseconds or work units.
struct FrameMeans {
  double left = 0.0;
  double hold = 0.0;     ///< what it takes to give the contacts held of a pair that touches and is left out
  double unknown = 0.0;  ///< need of a pair that nobody has met
  double most = 0.0;     ///< need of any
};

/// Says whose turn it is: in order, as far as the needs of all of them can be paid; and fills in what their shares are
/// made of. One that needs more than is left is passed over, and comes nearer to the front with each frame.
void plan(std::vector<FrameCandidate>& candidates, const FrameMeans& means) noexcept;

}  // namespace odds::ode

/// Behind the C interface's handle.
struct oddsFrameBudget {
 public:
  explicit oddsFrameBudget(std::size_t most_pairs);

  [[nodiscard]] const odds::ode::FrameSettings& settings() const noexcept { return settings_; }
  void set(const odds::ode::FrameSettings& settings) noexcept;
  /// In place of the fastest one. It must outlive the budget.
  void use_clock(odds::realtime::Clock clock) noexcept { clock_ = clock; }
  [[nodiscard]] const oddsFrameSummary& summary() const noexcept { return summary_; }

  /// A frame, or its next part.
  void run(dSpaceID space, void* data, dNearCallback* callback) noexcept;
  /// Whether the last run met this pair, in either order, and has not called for it.
  [[nodiscard]] bool waits(dGeomID a, dGeomID b) const noexcept;
  /// The next run begins a frame.
  void begin_anew() noexcept { part_ = 0; }

 private:
  using Candidate = odds::ode::FrameCandidate;

  static void collect(void* self, dGeomID a, dGeomID b) noexcept;
  void find_pairs(dSpaceID space) noexcept;
  [[nodiscard]] bool is_last_part() const noexcept { return part_ == 0; }
  void serve_beyond_memory(dGeomID a, dGeomID b) noexcept;
  void call(const Candidate& candidate, odds::ode::FrameShare& share) noexcept;
  void serve(Candidate& candidate, double share) noexcept;
  void hold(Candidate& candidate) noexcept;
  void learn(const Candidate& candidate, double share, double cost, const odds::ode::FrameShare& given) noexcept;
  void serve_equally() noexcept;
  void serve_by_importance() noexcept;
  void serve_with_rest() noexcept;
  void summarize() noexcept;
  [[nodiscard]] odds::ode::FrameMeans means() const noexcept;
  [[nodiscard]] double least_share() const noexcept;
  [[nodiscard]] double spent_us() const noexcept;
  [[nodiscard]] double left_us() const noexcept;
  [[nodiscard]] double left() const noexcept;
  [[nodiscard]] double left_with_parts_to_come() const noexcept;
  [[nodiscard]] bool is_late(double call_us) const noexcept;
  [[nodiscard]] bool is_over() const noexcept;
  [[nodiscard]] bool has_half_left() const noexcept;

  std::size_t most_pairs_;
  odds::ode::FrameSettings settings_;
  odds::ode::FramePairs memory_;
  std::vector<Candidate> candidates_;
  oddsFrameSummary summary_ = {};
  int beyond_turn_ = 0;  // the first of the pairs beyond the memory that has not had its turn
  // Learned from frame to frame, on this machine:
  double call_us_;    // what a call takes beyond its query's budget
  double hold_us_;    // ... a call without a search
  double margin_us_;  // what a frame keeps at its end
  odds::realtime::Clock clock_;

  // Of the frame under way.
  int part_ = 0;  // the next one; 0: of the next frame
  void* data_ = nullptr;
  dNearCallback* callback_ = nullptr;
  std::int64_t begin_ns_ = 0;
  double spent_units_ = 0.0;
};
