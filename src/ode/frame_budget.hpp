// A frame: collect the pairs, put them in order, call for each with its share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "odds/math/types.hpp"
#include "odds/ode/odds_frame.h"
#include "odds/realtime/clock.hpp"
#include "ode/frame_pairs.hpp"
#include "ode/importance.hpp"

namespace odds::ode {

/// What the caller sets; ranges and meanings stand in odds_frame.h.
struct FrameSettings {
  double time_us = std::numeric_limits<double>::infinity();
  unsigned long work_units = 0;
  bool attends = false;
  Vec3 attention = Vec3::Zero();
  double attention_radius = 1.0;
  int sharing = ODDS_SHARE_BY_IMPORTANCE;

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
  double part = 1.0;        ///< of its importance and that of all after it
  std::uint32_t order = 0;  ///< in which ODE found it
};

/// Fills in importance and part of each, and sorts them, the most important first. Precondition: `memory` of each is
/// set. `frame`: number of this frame.
void put_in_order(std::vector<FrameCandidate>& candidates, const FrameSettings& settings, std::uint64_t frame) noexcept;

}  // namespace odds::ode

/// Behind the C interface's handle.
struct oddsFrameBudget {
 public:
  explicit oddsFrameBudget(std::size_t most_pairs);

  [[nodiscard]] const odds::ode::FrameSettings& settings() const noexcept { return settings_; }
  void set(const odds::ode::FrameSettings& settings) noexcept;
  [[nodiscard]] const oddsFrameSummary& summary() const noexcept { return summary_; }

  void run(dSpaceID space, void* data, dNearCallback* callback) noexcept;

 private:
  using Candidate = odds::ode::FrameCandidate;

  static void collect(void* self, dGeomID a, dGeomID b) noexcept;
  void serve_beyond_memory(dGeomID a, dGeomID b) noexcept;
  void serve(const Candidate& candidate, double share) noexcept;
  void learn(const Candidate& candidate, double cost) noexcept;
  void serve_all() noexcept;
  [[nodiscard]] double share_for(const Candidate& candidate, double after, double floor) const noexcept;
  void summarize() noexcept;
  [[nodiscard]] double least_share() const noexcept;
  [[nodiscard]] double spent_us() const noexcept;
  [[nodiscard]] double left_us() const noexcept;
  [[nodiscard]] double left() const noexcept;
  [[nodiscard]] bool is_over() const noexcept;
  [[nodiscard]] bool has_half_left() const noexcept;

  std::size_t most_pairs_;
  odds::ode::FrameSettings settings_;
  odds::ode::FramePairs memory_;
  std::vector<Candidate> candidates_;
  oddsFrameSummary summary_ = {};
  int beyond_turn_ = 0;  // the first of the pairs beyond the memory that has not had its turn
  double call_us_;       // what a call takes beyond its query's budget on this machine: learned from frame to frame

  // Of the frame under way.
  void* data_ = nullptr;
  dNearCallback* callback_ = nullptr;
  odds::realtime::Clock clock_;
  std::int64_t begin_ns_ = 0;
  double spent_units_ = 0.0;
};
