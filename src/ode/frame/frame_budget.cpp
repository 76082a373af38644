// Serving the pairs of a frame: each whose turn it is with its share, none begun that would overrun.
#include "ode/frame/frame_budget.hpp"

#include <algorithm>
#include <cmath>

#include "ode/budget_clock.hpp"
#include "ode/frame/frame_share.hpp"
#include "ode/frame/space_pairs.hpp"
#include "ode/geom/pair_table.hpp"

namespace {

using odds::ode::FrameMeans;
using odds::ode::FramePair;
using odds::ode::FrameShare;
using odds::ode::Outcome;

constexpr double least_us = 0.5;  // of a search: some ten pairs of nodes
constexpr double least_units = 10.0;
constexpr double first_need_us = 5.0;  // of a pair that nobody has met
constexpr double first_need_units = 100.0;
constexpr double most_of_frame = 0.5;    // for one pair
constexpr double worth_beginning = 0.5;  // of a share: where a part has less left, the next one gives it
constexpr double least_call_us = 0.4;    // of callback and dispatch around a query
constexpr double most_call_us = 5.0;     // more is a stall, and teaches nothing
// Of the frame, for what the last call overshoots and for coming back: as much as one frame in a hundred needs more.
constexpr double least_margin_us = 2.0;
constexpr double most_margin = 0.03;  // of the frame
constexpr double margin_step_us = 0.5;
constexpr double margin_quantile = 0.01;

}  // namespace

oddsFrameBudget::oddsFrameBudget(std::size_t most_pairs)
    : most_pairs_(most_pairs),
      memory_(most_pairs),
      call_us_(least_call_us),
      hold_us_(least_call_us),
      margin_us_(least_margin_us),
      clock_(odds::ode::budget_clock()) {
  candidates_.reserve(most_pairs);
}

void oddsFrameBudget::set(const odds::ode::FrameSettings& settings) noexcept {
  if (settings.in_units() != settings_.in_units()) memory_.forget_needs();
  settings_ = settings;
}

double oddsFrameBudget::least_share() const noexcept {
  if (!std::isfinite(left())) return left();
  return settings_.in_units() ? least_units : least_us + call_us_;
}

double oddsFrameBudget::spent_us() const noexcept { return 1e-3 * static_cast<double>(clock_() - begin_ns_); }

double oddsFrameBudget::left_us() const noexcept {
  return settings_.time_us - std::min(margin_us_, 0.1 * settings_.time_us) - spent_us();
}

double oddsFrameBudget::left() const noexcept {
  return settings_.in_units() ? static_cast<double>(settings_.work_units) - spent_units_ : left_us();
}

double oddsFrameBudget::left_with_parts_to_come() const noexcept {
  const double part = settings_.in_units() ? static_cast<double>(settings_.work_units) : settings_.time_us;
  return is_last_part() ? left() : left() + part * (settings_.parts - part_);
}

// A query that is not begun cannot overrun.
bool oddsFrameBudget::is_late(double call_us) const noexcept {
  return std::isfinite(settings_.time_us) && !(left_us() > call_us);
}

bool oddsFrameBudget::is_over() const noexcept {
  return (settings_.in_units() && !(left() > 0.0)) || is_late(call_us_);
}

bool oddsFrameBudget::has_half_left() const noexcept {
  return (!settings_.in_units() || spent_units_ < 0.5 * static_cast<double>(settings_.work_units)) &&
         spent_us() < 0.5 * settings_.time_us;
}

void oddsFrameBudget::collect(void* self, dGeomID a, dGeomID b) noexcept {
  auto& budget = *static_cast<oddsFrameBudget*>(self);
  ++budget.summary_.pairs;
  if (budget.candidates_.size() >= budget.most_pairs_) return budget.serve_beyond_memory(a, b);
  Candidate& candidate = budget.candidates_.emplace_back();
  candidate.a = a;
  candidate.b = b;
  candidate.memory = &budget.memory_.at(a, b);
  candidate.order = static_cast<std::uint32_t>(budget.candidates_.size());
}

// One after the other, through as many frames as that takes. Where the broad phase takes the whole of every frame, one
// of these is called in every second frame, and one of the others in between.
void oddsFrameBudget::serve_beyond_memory(dGeomID a, dGeomID b) noexcept {
  if (summary_.beyond_memory++ != beyond_turn_) return;
  const bool called_anyway = memory_.frame() % 2 == 0 && summary_.served == 0;
  if (!has_half_left() && !called_anyway) return;
  ++beyond_turn_;
  Candidate unknown;
  unknown.a = a;
  unknown.b = b;
  serve(unknown, least_share());
}

void oddsFrameBudget::learn(const Candidate& candidate, double share, double cost, const FrameShare& given) noexcept {
  if (given.outcome == Outcome::starved) ++summary_.starved;
  FramePair* known = candidate.memory;
  if (known == nullptr) return;
  if (known->need.learn(share, cost, given.outcome, means().most)) known->served = memory_.frame();
  if (given.contacts > 0) known->touched = memory_.frame();
  // Of one of ODE's own collisions nobody says how it went; one with a primitive states no odds.
  known->probability = given.outcome == Outcome::unknown ? 0.5 : given.contacts > 0 ? 1.0 : 0.0;
  known->proved = given.outcome == Outcome::finished;
  known->touches = given.keeps && given.contacts > 0;
  const odds::ode::PairEntry* answered = odds::ode::answered_pair(candidate.a, candidate.b);
  if (answered == nullptr) return;
  known->probability = answered->last.probability;
  known->proved = answered->last.basis == ODDS_PROVED;
  known->touches = given.contacts > 0;
}

void oddsFrameBudget::call(const Candidate& candidate, FrameShare& share) noexcept {
  odds::ode::current_share = &share;
  callback_(data_, candidate.a, candidate.b);
  odds::ode::current_share = nullptr;
}

void oddsFrameBudget::serve(Candidate& candidate, double share) noexcept {
  const bool in_units = settings_.in_units();
  FrameShare limit;
  if (in_units) {
    limit.work_units = static_cast<unsigned long>(std::max(1.0, share));
    limit.us = std::max(0.1, left_us());
  } else {
    limit.us = std::max(0.1, share - call_us_);
  }
  const std::int64_t before_ns = clock_();
  call(candidate, limit);
  spent_units_ += static_cast<double>(limit.spent);
  const double took_us = std::max(0.0, 1e-3 * static_cast<double>(clock_() - before_ns) - limit.stall_us);
  if (!in_units && took_us > limit.us) {
    const double beyond_us = std::min(took_us - limit.us, most_call_us);
    call_us_ = std::max(least_call_us, call_us_ + 0.02 * (beyond_us - call_us_));
  }
  // What is far beyond the share is a stall that no query has noticed.
  const double cost = in_units ? static_cast<double>(limit.spent) : std::min(took_us, limit.us + most_call_us);
  learn(candidate, share, cost, limit);
  candidate.called = true;
  ++summary_.served;
}

// No search: contacts of an earlier frame, where the bodies are now.
void oddsFrameBudget::hold(Candidate& candidate) noexcept {
  FrameShare limit;
  limit.only_held = true;
  limit.us = 0.1;  // of a geom without anything held, which has the address of one that had
  limit.work_units = 1;
  const std::int64_t before_ns = clock_();
  call(candidate, limit);
  const double took_us = std::min(1e-3 * static_cast<double>(clock_() - before_ns), most_call_us);
  hold_us_ = std::max(least_call_us, hold_us_ + 0.02 * (took_us - hold_us_));
  candidate.memory->touches = limit.contacts > 0;
  if (candidate.memory->touches) candidate.memory->touched = memory_.frame();
  candidate.called = true;
  ++summary_.held;
}

FrameMeans oddsFrameBudget::means() const noexcept {
  const bool in_units = settings_.in_units();
  const double all = in_units ? static_cast<double>(settings_.work_units) : settings_.time_us;
  return {.left = left_with_parts_to_come(),
          .hold = in_units || !is_last_part() ? 0.0 : hold_us_,
          .unknown = in_units ? first_need_units : first_need_us,
          .most = most_of_frame * all};
}

void oddsFrameBudget::serve_equally() noexcept {
  auto after = static_cast<double>(candidates_.size());
  for (Candidate& candidate : candidates_) {
    // One is served even where the broad phase has taken all the time: otherwise nobody's turn would ever come.
    if (is_over() && summary_.served > 0) break;
    serve(candidate, left() > 0.0 ? left() / after : least_share());
    after -= 1.0;
  }
}

void oddsFrameBudget::serve_by_importance() noexcept {
  put_in_order(candidates_, settings_, memory_.frame());
  bool served_in_part = false;
  const FrameMeans plans = means();
  plan(candidates_, plans);
  for (Candidate& candidate : candidates_) {
    if (is_over() && summary_.served > 0) break;
    if (!candidate.planned) continue;
    const double rest = left_with_parts_to_come();
    double share =
        std::isfinite(rest)
            ? odds::ode::share_of({rest, candidate.need, candidate.kept, candidate.weight / candidate.rivals})
            : rest;
    // A share that buys nothing is not given, but to the first, so that nobody waits for ever. Where others took more
    // than theirs, this one comes earlier in the next frame.
    if (share < candidate.need && &candidate != &candidates_.front()) continue;
    if (!is_last_part() && served_in_part && left() < std::max(candidate.need, worth_beginning * share)) continue;
    share = std::min(share, left());
    serve(candidate, share > 0.0 ? share : least_share());
    served_in_part = true;
  }
  if (is_last_part()) serve_with_rest();
}

// What was not needed goes to those whose turn it was not; then those that touch and had none keep what is held.
void oddsFrameBudget::serve_with_rest() noexcept {
  const double hold_us = means().hold;
  double holding = 0.0;
  for (const Candidate& candidate : candidates_) {
    holding += !candidate.called && candidate.memory->touches ? hold_us : 0.0;
  }
  for (Candidate& candidate : candidates_) {
    if (candidate.called || is_over()) continue;
    const double own = candidate.memory->touches ? hold_us : 0.0;
    const double room = left() - (holding - own);
    if (candidate.need > room) continue;
    holding -= own;
    serve(candidate, odds::ode::share_of({room, candidate.need, 0.0, 0.0}));
  }
  for (Candidate& candidate : candidates_) {
    if (is_late(hold_us_)) break;
    if (!candidate.called && candidate.memory->touches) hold(candidate);
  }
}

void oddsFrameBudget::summarize() noexcept {
  for (const Candidate& candidate : candidates_) {
    const auto waited =
        static_cast<int>(std::min<std::uint64_t>(memory_.frame() - candidate.memory->served, 1'000'000));
    summary_.waiting_longest = std::max(summary_.waiting_longest, waited);
  }
  if (std::isfinite(settings_.time_us)) {
    const double step_us = (spent_us() > settings_.time_us ? 1.0 : 0.0) - margin_quantile;
    margin_us_ = std::clamp(margin_us_ + margin_step_us * step_us, least_margin_us,
                            std::max(least_margin_us, most_margin * settings_.time_us));
  }
  summary_.gross_us = spent_us();
  summary_.overshoot_us = std::max(0.0, summary_.gross_us - settings_.time_us);
  summary_.work = static_cast<unsigned long>(spent_units_);
}

bool oddsFrameBudget::waits(dGeomID a, dGeomID b) const noexcept {
  return std::any_of(candidates_.begin(), candidates_.end(), [&](const Candidate& candidate) {
    return !candidate.called && ((candidate.a == a && candidate.b == b) || (candidate.a == b && candidate.b == a));
  });
}

void oddsFrameBudget::find_pairs(dSpaceID space) noexcept {
  summary_ = {};
  candidates_.clear();
  memory_.begin_frame();
  odds::ode::for_each_pair(space, this, &oddsFrameBudget::collect);
  if (beyond_turn_ >= summary_.beyond_memory) beyond_turn_ = 0;
}

void oddsFrameBudget::run(dSpaceID space, void* data, dNearCallback* callback) noexcept {
  data_ = data;
  callback_ = callback;
  begin_ns_ = clock_();
  spent_units_ = 0.0;
  if (part_ == 0) {
    find_pairs(space);
  } else {
    std::erase_if(candidates_, [](const Candidate& candidate) { return candidate.called; });
  }
  part_ = (part_ + 1) % settings_.parts;
  if (settings_.sharing == ODDS_SHARE_EQUALLY) {
    serve_equally();
  } else {
    serve_by_importance();
  }
  summarize();
}
