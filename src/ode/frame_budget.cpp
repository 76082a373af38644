// A frame: collect the pairs, put them in order, call for each with its share.
#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <vector>

#include "odds/ode/odds_frame.h"
#include "odds/realtime/clock.hpp"
#include "ode/frame_pairs.hpp"
#include "ode/frame_share.hpp"
#include "ode/importance.hpp"
#include "ode/last_error.hpp"
#include "ode/pair_table.hpp"
#include "ode/vectors.hpp"

namespace odds::ode {
namespace {

constexpr double floor_us = 0.5;  // what the least important pair gets: some ten pairs of nodes
constexpr double floor_units = 10.0;
constexpr double first_demand_us = 5.0;  // of a pair that nobody has met
constexpr double units_per_us = 20.0;
constexpr double spare = 1.5;          // a pair may need more than in the last frame
constexpr double least_call_us = 0.4;  // of callback and dispatch around a query
constexpr double margin_us = 2.0;      // of the frame: for what the last query overshoots, and for coming back

struct Candidate {
  dGeomID a = nullptr;
  dGeomID b = nullptr;
  FramePair* memory = nullptr;
  PairSigns signs;
  double speed = 0.0;  // of each against the other, m/s
  double importance = 0.0;
  std::uint32_t order = 0;  // in which ODE found it
};

struct Box {
  Vec3 lower;
  Vec3 upper;
};

Box box_of(dGeomID geom) noexcept {
  dReal aabb[6];
  dGeomGetAABB(geom, aabb);
  // A plane's box is infinite.
  static constexpr double far = 1e9;
  const auto bound = [](dReal x) { return std::clamp(static_cast<double>(x), -far, far); };
  return {{bound(aabb[0]), bound(aabb[2]), bound(aabb[4])}, {bound(aabb[1]), bound(aabb[3]), bound(aabb[5])}};
}

Vec3 velocity_at(dGeomID geom, const Vec3& point) noexcept {
  const dBodyID body = dGeomGetBody(geom);
  if (body == nullptr) return Vec3::Zero();
  dVector3 velocity;
  dBodyGetPointVel(body, point.x(), point.y(), point.z(), velocity);
  return vector_of(velocity);
}

}  // namespace
}  // namespace odds::ode

struct oddsFrameBudget {
  explicit oddsFrameBudget(std::size_t pairs) : most_pairs(pairs), memory(pairs) { candidates.reserve(pairs); }

  using Candidate = odds::ode::Candidate;

  std::size_t most_pairs;
  double time_us = std::numeric_limits<double>::infinity();
  unsigned long work_units = 0;
  bool attends = false;
  odds::Vec3 attention = odds::Vec3::Zero();
  double attention_radius = 1.0;
  int sharing = ODDS_SHARE_BY_IMPORTANCE;
  odds::ode::FramePairs memory;
  std::vector<Candidate> candidates;
  oddsFrameSummary summary = {};
  std::uint64_t frame = 1;

  // Of the frame under way.
  void* data = nullptr;
  dNearCallback* callback = nullptr;
  odds::realtime::Clock clock;
  std::int64_t begin_ns = 0;
  double spent_units = 0.0;
  double fastest = 0.0;
  // What a call takes beyond its query's budget on this machine: learned from frame to frame.
  double call_us = odds::ode::least_call_us;

  void run(dSpaceID space) noexcept;

 private:
  static void collect(void* self, dGeomID a, dGeomID b) noexcept;
  void look(Candidate& candidate) noexcept;
  void put_in_order() noexcept;
  void serve(Candidate& candidate, double share) noexcept;
  void learn(const Candidate& candidate, double cost) noexcept;
  void serve_all() noexcept;
  [[nodiscard]] double least_share() const noexcept {
    return in_units() ? odds::ode::floor_units : odds::ode::floor_us + call_us;
  }
  [[nodiscard]] bool in_units() const noexcept { return work_units > 0; }
  [[nodiscard]] double spent_us() const noexcept { return 1e-3 * static_cast<double>(clock() - begin_ns); }
  [[nodiscard]] double left_us() const noexcept {
    return time_us - std::min(odds::ode::margin_us, 0.1 * time_us) - spent_us();
  }
  [[nodiscard]] double left() const noexcept {
    return in_units() ? static_cast<double>(work_units) - spent_units : left_us();
  }
  // A query that is not begun cannot overrun.
  [[nodiscard]] bool is_over() const noexcept {
    return (in_units() && !(left() > 0.0)) || (std::isfinite(time_us) && !(left_us() > call_us));
  }
};

void oddsFrameBudget::collect(void* self, dGeomID a, dGeomID b) noexcept {
  using namespace odds;
  auto& budget = *static_cast<oddsFrameBudget*>(self);
  if (dGeomIsSpace(a) != 0 || dGeomIsSpace(b) != 0) {
    dSpaceCollide2(a, b, self, &oddsFrameBudget::collect);
    if (dGeomIsSpace(a) != 0) dSpaceCollide(reinterpret_cast<dSpaceID>(a), self, &oddsFrameBudget::collect);
    if (dGeomIsSpace(b) != 0) dSpaceCollide(reinterpret_cast<dSpaceID>(b), self, &oddsFrameBudget::collect);
    return;
  }
  ++budget.summary.pairs;
  if (budget.candidates.size() >= budget.most_pairs) {
    ++budget.summary.beyond_memory;
    Candidate unknown;
    unknown.a = a;
    unknown.b = b;
    if (!budget.is_over()) budget.serve(unknown, budget.least_share());
    return;
  }
  Candidate& candidate = budget.candidates.emplace_back();
  candidate.a = a;
  candidate.b = b;
  candidate.order = static_cast<std::uint32_t>(budget.candidates.size());
}

void oddsFrameBudget::look(Candidate& candidate) noexcept {
  using namespace odds;
  using namespace odds::ode;
  const Box a = box_of(candidate.a);
  const Box b = box_of(candidate.b);
  const Vec3 lower = a.lower.cwiseMax(b.lower);
  const Vec3 upper = a.upper.cwiseMin(b.upper);
  const Vec3 middle = 0.5 * (lower + upper);
  candidate.speed = (velocity_at(candidate.a, middle) - velocity_at(candidate.b, middle)).norm();
  if (!std::isfinite(candidate.speed)) candidate.speed = 0.0;
  fastest = std::max(fastest, candidate.speed);
  candidate.memory = memory.at(candidate.a, candidate.b, frame);
  PairSigns& signs = candidate.signs;
  if (const FramePair* known = candidate.memory) {
    signs.hit_probability = known->probability;
    signs.proved = known->proved;
    signs.ever_contact = known->touched > 0;
    signs.since_contact = static_cast<std::uint32_t>(std::min<std::uint64_t>(frame - 1 - known->touched, 1000));
    signs.waited = static_cast<std::uint32_t>(std::min<std::uint64_t>(frame - 1 - known->served, 1000));
  }
  constexpr double frame_s = 0.01;  // nobody says how long a frame is; only the order matters
  signs.way_share = candidate.speed * frame_s / std::max((upper - lower).norm(), 1e-9);
  if (attends) {
    const double far = (middle - attention).norm() / attention_radius;
    signs.attention = std::max(0.1, 1.0 / (1.0 + far * far));
  }
}

void oddsFrameBudget::put_in_order() noexcept {
  for (Candidate& candidate : candidates) look(candidate);
  for (Candidate& candidate : candidates) {
    candidate.signs.relative_speed = fastest > 0.0 ? candidate.speed / fastest : 0.0;
    candidate.importance = odds::ode::importance(candidate.signs);
    if (candidate.memory != nullptr) candidate.memory->seen = frame;
  }
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& x, const Candidate& y) {
    return x.importance != y.importance ? x.importance > y.importance : x.order < y.order;
  });
}

void oddsFrameBudget::learn(const Candidate& candidate, double cost) noexcept {
  odds::ode::FramePair* known = candidate.memory;
  if (known == nullptr) return;
  known->served = frame;
  known->cost = cost;
  oddsAnswer answer;
  if (oddsGetLastAnswer(candidate.a, candidate.b, &answer) == 0) {
    known->probability = 0.5;  // with one of ODE's own classes: nobody says how it went
    known->proved = false;
    return;
  }
  known->probability = answer.probability;
  known->proved = answer.basis == ODDS_PROVED;
  if (answer.contacts > 0) known->touched = frame;
  // What it did not get to prove will cost more next time.
  if (!known->proved) known->cost *= 2.0;
}

void oddsFrameBudget::serve(Candidate& candidate, double share) noexcept {
  odds::ode::FrameShare limit;
  if (in_units()) {
    limit.work_units = static_cast<unsigned long>(std::max(1.0, share));
    limit.us = std::max(0.1, left_us());
  } else {
    limit.us = std::max(0.1, share - call_us);
  }
  const std::int64_t before_ns = clock();
  odds::ode::current_share = &limit;
  callback(data, candidate.a, candidate.b);
  odds::ode::current_share = nullptr;
  spent_units += static_cast<double>(limit.spent);
  const double took_us = 1e-3 * static_cast<double>(clock() - before_ns);
  constexpr double most_call_us = 5.0;  // more is a stall, and teaches nothing
  if (!in_units() && took_us > limit.us) {
    const double beyond_us = std::min(took_us - limit.us, most_call_us);
    call_us = std::max(odds::ode::least_call_us, call_us + 0.02 * (beyond_us - call_us));
  }
  const double cost = in_units() ? static_cast<double>(limit.spent) : took_us;
  if (sharing == ODDS_SHARE_BY_IMPORTANCE) learn(candidate, cost);
  ++summary.served;
}

void oddsFrameBudget::serve_all() noexcept {
  using namespace odds::ode;
  const bool equal = sharing == ODDS_SHARE_EQUALLY;
  const double unknown = in_units() ? first_demand_us * units_per_us : first_demand_us;
  double weight_left = 0.0;
  for (const Candidate& candidate : candidates) weight_left += candidate.importance;
  double after = static_cast<double>(candidates.size());
  // Half of the frame goes to all alike, so that even what hardly matters is looked at; the other half by importance.
  const double floor = std::max(least_share(), 0.5 * left() / std::max(1.0, after));
  for (Candidate& candidate : candidates) {
    after -= 1.0;
    // One is served even where the broad phase has taken all the time: otherwise nobody's turn would ever come.
    if (is_over() && summary.served > 0) break;
    const double rest = std::max(left(), least_share());
    double share = rest;
    if (std::isfinite(rest)) {
      const FramePair* known = candidate.memory;
      const double demand = known != nullptr && known->cost > 0.0 ? spare * known->cost : unknown;
      share = equal ? rest / (after + 1.0) : share_of({rest, demand, candidate.importance, weight_left, after, floor});
    }
    weight_left -= candidate.importance;
    serve(candidate, share);
  }
}

void oddsFrameBudget::run(dSpaceID space) noexcept {
  clock = odds::realtime::fastest_clock();
  begin_ns = clock();
  ++frame;
  spent_units = 0.0;
  fastest = 0.0;
  summary = {};
  candidates.clear();
  dSpaceCollide(space, this, &oddsFrameBudget::collect);
  if (sharing == ODDS_SHARE_BY_IMPORTANCE) put_in_order();
  serve_all();
  for (const Candidate& candidate : candidates) {
    if (candidate.memory == nullptr) continue;
    const auto waited = static_cast<int>(std::min<std::uint64_t>(frame - candidate.memory->served, 1'000'000));
    summary.waiting_longest = std::max(summary.waiting_longest, waited);
  }
  summary.gross_us = spent_us();
  summary.overshoot_us = std::max(0.0, summary.gross_us - time_us);
  summary.work = static_cast<unsigned long>(spent_units);
}

oddsFrameBudgetID oddsFrameBudgetCreate(int most_pairs) noexcept {
  if (most_pairs < 1 || most_pairs > 1048576) {
    odds::ode::set_last_error("oddsFrameBudgetCreate: the number of pairs must be 1 .. 1048576");
    return nullptr;
  }
  try {
    return new oddsFrameBudget(static_cast<std::size_t>(most_pairs));
  } catch (const std::bad_alloc&) {
    odds::ode::set_last_error("oddsFrameBudgetCreate: out of memory");
    return nullptr;
  }
}

void oddsFrameBudgetDestroy(oddsFrameBudgetID budget) noexcept { delete budget; }

namespace {

int refuse(const char* rule) noexcept {
  odds::ode::set_last_error(rule);
  return 0;
}

}  // namespace

int oddsFrameBudgetSetTime(oddsFrameBudgetID budget, dReal microseconds) noexcept {
  if (budget == nullptr || !(microseconds > 0)) {
    return refuse("oddsFrameBudgetSetTime: needs a budget, and a time > 0 microseconds (dInfinity: no limit)");
  }
  budget->time_us = microseconds;
  return 1;
}

int oddsFrameBudgetSetWork(oddsFrameBudgetID budget, unsigned long units) noexcept {
  if (budget == nullptr) return refuse("oddsFrameBudgetSetWork: the budget is null");
  budget->work_units = units;
  return 1;
}

int oddsFrameBudgetSetAttention(oddsFrameBudgetID budget, const dReal* position, dReal radius) noexcept {
  if (budget == nullptr) return refuse("oddsFrameBudgetSetAttention: the budget is null");
  if (position == nullptr) {
    budget->attends = false;
    return 1;
  }
  const odds::Vec3 place(position[0], position[1], position[2]);
  if (!place.allFinite() || !(radius > 0) || !std::isfinite(radius)) {
    return refuse("oddsFrameBudgetSetAttention: needs a finite place, and a radius > 0 metres");
  }
  budget->attends = true;
  budget->attention = place;
  budget->attention_radius = radius;
  return 1;
}

int oddsFrameBudgetSetSharing(oddsFrameBudgetID budget, int sharing) noexcept {
  if (budget == nullptr || (sharing != ODDS_SHARE_BY_IMPORTANCE && sharing != ODDS_SHARE_EQUALLY)) {
    return refuse("oddsFrameBudgetSetSharing: needs a budget, and ODDS_SHARE_BY_IMPORTANCE or ODDS_SHARE_EQUALLY");
  }
  budget->sharing = sharing;
  return 1;
}

int oddsFrameBudgetGetSummary(oddsFrameBudgetID budget, oddsFrameSummary* summary) noexcept {
  if (budget == nullptr || summary == nullptr) {
    return refuse("oddsFrameBudgetGetSummary: the budget or the place for the summary is null");
  }
  *summary = budget->summary;
  return 1;
}

int oddsSpaceCollide(dSpaceID space, void* data, dNearCallback* callback, oddsFrameBudgetID budget) noexcept {
  if (space == nullptr || callback == nullptr || budget == nullptr) {
    return refuse("oddsSpaceCollide: needs a space, a callback and a frame budget");
  }
  if (odds::ode::current_share != nullptr) {
    return refuse("oddsSpaceCollide: called from within the callback of another");
  }
  budget->data = data;
  budget->callback = callback;
  budget->run(space);
  return 1;
}
