// Serving the pairs of a frame: each with its share, none begun that would overrun.
#include "ode/frame_budget.hpp"

#include <algorithm>
#include <cmath>

#include "ode/frame_share.hpp"
#include "ode/pair_table.hpp"
#include "ode/space_pairs.hpp"

namespace {

constexpr double floor_us = 0.5;  // what the least important pair gets: some ten pairs of nodes
constexpr double floor_units = 10.0;
constexpr double first_demand_us = 5.0;  // of a pair that nobody has met
constexpr double units_per_us = 20.0;
constexpr double spare = 1.5;          // a pair may need more than in the last frame
constexpr double least_call_us = 0.4;  // of callback and dispatch around a query
constexpr double most_call_us = 5.0;   // more is a stall, and teaches nothing
constexpr double margin_us = 2.0;      // of the frame: for what the last query overshoots, and for coming back

}  // namespace

oddsFrameBudget::oddsFrameBudget(std::size_t most_pairs)
    : most_pairs_(most_pairs), memory_(most_pairs), call_us_(least_call_us) {
  candidates_.reserve(most_pairs);
}

void oddsFrameBudget::set(const odds::ode::FrameSettings& settings) noexcept {
  if (settings.in_units() != settings_.in_units()) memory_.forget_costs();
  settings_ = settings;
}

double oddsFrameBudget::least_share() const noexcept {
  return settings_.in_units() ? floor_units : floor_us + call_us_;
}

double oddsFrameBudget::spent_us() const noexcept { return 1e-3 * static_cast<double>(clock_() - begin_ns_); }

double oddsFrameBudget::left_us() const noexcept {
  return settings_.time_us - std::min(margin_us, 0.1 * settings_.time_us) - spent_us();
}

double oddsFrameBudget::left() const noexcept {
  return settings_.in_units() ? static_cast<double>(settings_.work_units) - spent_units_ : left_us();
}

// A query that is not begun cannot overrun.
bool oddsFrameBudget::is_over() const noexcept {
  return (settings_.in_units() && !(left() > 0.0)) || (std::isfinite(settings_.time_us) && !(left_us() > call_us_));
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

void oddsFrameBudget::learn(const Candidate& candidate, double cost) noexcept {
  odds::ode::FramePair* known = candidate.memory;
  if (known == nullptr) return;
  known->served = memory_.frame();
  known->cost = cost;
  const odds::ode::PairEntry* answered = odds::ode::answered_pair(candidate.a, candidate.b);
  if (answered == nullptr) {
    known->probability = 0.5;  // with one of ODE's own classes: nobody says how it went
    known->proved = false;
    return;
  }
  known->probability = answered->last.probability;
  known->proved = answered->last.basis == ODDS_PROVED;
  if (answered->last.contacts > 0) known->touched = memory_.frame();
  // What it did not get to prove will cost more next time.
  if (!known->proved) known->cost *= 2.0;
}

void oddsFrameBudget::serve(const Candidate& candidate, double share) noexcept {
  const bool in_units = settings_.in_units();
  odds::ode::FrameShare limit;
  if (in_units) {
    limit.work_units = static_cast<unsigned long>(std::max(1.0, share));
    limit.us = std::max(0.1, left_us());
  } else {
    limit.us = std::max(0.1, share - call_us_);
  }
  const std::int64_t before_ns = clock_();
  odds::ode::current_share = &limit;
  callback_(data_, candidate.a, candidate.b);
  odds::ode::current_share = nullptr;
  spent_units_ += static_cast<double>(limit.spent);
  const double took_us = 1e-3 * static_cast<double>(clock_() - before_ns);
  if (!in_units && took_us > limit.us) {
    const double beyond_us = std::min(took_us - limit.us, most_call_us);
    call_us_ = std::max(least_call_us, call_us_ + 0.02 * (beyond_us - call_us_));
  }
  learn(candidate, in_units ? static_cast<double>(limit.spent) : took_us);
  ++summary_.served;
}

double oddsFrameBudget::share_for(const Candidate& candidate, double after, double floor) const noexcept {
  const double rest = left();
  if (!(rest > 0.0)) return least_share();  // of the one that is called in any case
  if (!std::isfinite(rest)) return rest;
  if (settings_.sharing == ODDS_SHARE_EQUALLY) return rest / (after + 1.0);
  const double unknown = settings_.in_units() ? first_demand_us * units_per_us : first_demand_us;
  const double demand = candidate.memory->cost > 0.0 ? spare * candidate.memory->cost : unknown;
  return odds::ode::share_of({rest, demand, candidate.part, after, floor});
}

void oddsFrameBudget::serve_all() noexcept {
  auto after = static_cast<double>(candidates_.size());
  // Half of the frame goes to all alike, so that even what hardly matters is looked at; the other half by importance.
  const double floor = std::max(least_share(), 0.5 * left() / std::max(1.0, after));
  for (const Candidate& candidate : candidates_) {
    after -= 1.0;
    // One is served even where the broad phase has taken all the time: otherwise nobody's turn would ever come.
    if (is_over() && summary_.served > 0) break;
    serve(candidate, share_for(candidate, after, floor));
  }
}

void oddsFrameBudget::summarize() noexcept {
  for (const Candidate& candidate : candidates_) {
    const auto waited =
        static_cast<int>(std::min<std::uint64_t>(memory_.frame() - candidate.memory->served, 1'000'000));
    summary_.waiting_longest = std::max(summary_.waiting_longest, waited);
  }
  summary_.gross_us = spent_us();
  summary_.overshoot_us = std::max(0.0, summary_.gross_us - settings_.time_us);
  summary_.work = static_cast<unsigned long>(spent_units_);
}

void oddsFrameBudget::run(dSpaceID space, void* data, dNearCallback* callback) noexcept {
  data_ = data;
  callback_ = callback;
  clock_ = odds::realtime::fastest_clock();
  begin_ns_ = clock_();
  spent_units_ = 0.0;
  summary_ = {};
  candidates_.clear();
  memory_.begin_frame();
  odds::ode::for_each_pair(space, this, &oddsFrameBudget::collect);
  if (beyond_turn_ >= summary_.beyond_memory) beyond_turn_ = 0;
  if (settings_.sharing == ODDS_SHARE_BY_IMPORTANCE) put_in_order(candidates_, settings_, memory_.frame());
  serve_all();
  summarize();
}
