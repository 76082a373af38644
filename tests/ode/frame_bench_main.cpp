// odds_bench_frames: 200 moving pairs of meshes in frames of 500 us: shares by importance beside equal ones, frame by
// frame in turn, each with bodies of its own that move alike.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <span>
#include <string_view>
#include <system_error>
#include <vector>

#include "odds/math/pose.hpp"
#include "odds/math/random.hpp"
#include "odds/mesh/made/torus_knot.hpp"
#include "odds/ode/odds_frame.h"
#include "odds/query/pair.hpp"
#include "odds/realtime/thread_setup.hpp"
#include "ode/ode_fixture.hpp"

namespace {

using odds::Vec3;
using odds::query::Pair;

/// How B of a pair moves: to and fro along z above A, turned by a fixed angle.
struct Motion {
  odds::math::Pose middle;
  double amplitude_m = 0.0;
  double frames = 0.0;  // to and fro
  double begin = 0.0;

  [[nodiscard]] odds::math::Pose at(int frame) const {
    odds::math::Pose pose = middle;
    pose.translation.z() += amplitude_m * std::sin(2.0 * std::numbers::pi * (begin + frame / frames));
    return pose;
  }
};

struct Meeting {
  Motion motion;
  bool touches = false;  // in this frame, by a search without a limit
};

/// A fifth is interlocked, two fifths come to touch and part again, two fifths only come near.
std::vector<Meeting> make_meetings(int pairs, std::uint64_t seed) {
  std::vector<Meeting> meetings(static_cast<std::size_t>(pairs));
  for (std::size_t i = 0; i < meetings.size(); ++i) {
    odds::math::Random random(seed, i);
    Motion& motion = meetings[i].motion;
    const double kind = random.uniform();
    const Vec3 axis = kind < 0.2 ? random.direction() : Vec3::UnitZ().eval();
    motion.middle.rotation = Eigen::AngleAxisd(random.uniform(0.0, 6.0), axis).toRotationMatrix();
    motion.middle.translation.z() = kind < 0.2 ? 0.04 : kind < 0.6 ? 0.097 : 0.104;
    motion.amplitude_m = random.uniform(0.5, 1.0) * 0.004;
    motion.frames = random.uniform(100.0, 600.0);
    motion.begin = random.uniform();
  }
  return meetings;
}

/// The bodies of one way of sharing, and what it came to.
class Side {
 public:
  Side(const std::shared_ptr<const odds::query::Shape>& shape, std::size_t pairs, int sharing, double frame_us)
      : sharing_(sharing),
        space_(dSweepAndPruneSpaceCreate(nullptr, dSAP_AXES_XYZ)),
        world_(dWorldCreate()),
        members_(pairs) {
    const double size = shape->mesh().size();
    for (std::size_t i = 0; i < pairs; ++i) {
      Member& member = members_[i];
      const dGeomID a = odds::test::mesh_geom(shape, space_);
      member.b = odds::test::mesh_geom(shape, space_);
      member.at = {4.0 * size * static_cast<double>(i % 20), 4.0 * size * static_cast<double>(i / 20), 0.0};
      dGeomSetPosition(a, member.at.x(), member.at.y(), 0.0);
      dGeomSetBody(member.b, dBodyCreate(world_));  // whose speed the order of the pairs depends on
      for (const dGeomID geom : {a, member.b}) dGeomSetData(geom, &member);
      oddsPreparePair(a, member.b);
    }
    budget_ = oddsFrameBudgetCreate(4096);
    oddsFrameBudgetSetTime(budget_, frame_us);
    oddsFrameBudgetSetSharing(budget_, sharing);
  }
  ~Side() {
    oddsFrameBudgetDestroy(budget_);
    dSpaceDestroy(space_);
    dWorldDestroy(world_);
  }
  Side(const Side&) = delete;
  Side& operator=(const Side&) = delete;

  void run(const std::vector<Meeting>& meetings, int frame, bool counts) {
    for (std::size_t i = 0; i < members_.size(); ++i) place(members_[i], meetings[i].motion, frame);
    stall_us_ = 0.0;
    oddsSpaceCollide(space_, this, &Side::near, budget_);
    if (counts) note(meetings);
  }

  void print() const {
    std::vector<double> sorted = gross_us_;
    std::sort(sorted.begin(), sorted.end());
    const auto frames = static_cast<double>(sorted.size());
    const double all = frames * static_cast<double>(members_.size());
    std::printf("  %-11s %7.1f %7.1f %6.2f%% %6.2f%% %8.2f %7.1f%% %6.1f%% %6.1f%% %8.1f%% %8.1f%% %7.1f%% %6d\n",
                sharing_ == ODDS_SHARE_EQUALLY ? "equal" : "importance", sorted[sorted.size() / 2],
                sorted[sorted.size() * 99 / 100], 100.0 * overran_ / frames, 100.0 * overran_net_ / frames,
                most_over_us_, 100.0 * served_ / all, 100.0 * starved_ / all, 100.0 * held_ / all,
                100.0 * touching_right_ / std::max(1.0, touching_), 100.0 * touching_fresh_ / std::max(1.0, touching_),
                100.0 * apart_right_ / std::max(1.0, apart_), longest_wait_);
  }

 private:
  struct Member {
    dGeomID b = nullptr;
    Vec3 at = Vec3::Zero();
    int contacts = 0;
    bool fresh = false;  // contacts of this frame's own search, with a proof
  };

  static void place(Member& member, const Motion& motion, int frame) {
    constexpr double frame_s = 0.01;
    const odds::math::Pose now = motion.at(frame);
    const Vec3 velocity = (motion.at(frame + 1).translation - now.translation) / frame_s;
    dMatrix3 rotation = {};
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) rotation[4 * row + column] = now.rotation(row, column);
    }
    const Vec3 position = now.translation + member.at;
    dGeomSetRotation(member.b, rotation);
    dGeomSetPosition(member.b, position.x(), position.y(), position.z());
    dBodySetLinearVel(dGeomGetBody(member.b), velocity.x(), velocity.y(), velocity.z());
    member.contacts = 0;
    member.fresh = false;
  }

  static void near(void* self, dGeomID a, dGeomID b) {
    Member& member = *static_cast<Member*>(dGeomGetData(b));
    dContactGeom contacts[8];
    member.contacts = dCollide(a, b, 8, contacts, sizeof(dContactGeom));
    oddsAnswer answer;
    if (oddsGetLastAnswer(a, b, &answer) == 0) return;
    static_cast<Side*>(self)->stall_us_ += answer.stall_us;
    member.fresh = answer.basis == ODDS_PROVED;
  }

  void note(const std::vector<Meeting>& meetings) {
    oddsFrameSummary summary;
    oddsFrameBudgetGetSummary(budget_, &summary);
    gross_us_.push_back(summary.gross_us);
    if (summary.overshoot_us > 0.0) overran_ += 1.0;
    const double over_us = summary.overshoot_us - stall_us_;
    if (over_us > 0.0) overran_net_ += 1.0;
    most_over_us_ = std::max(most_over_us_, over_us);
    longest_wait_ = std::max(longest_wait_, summary.waiting_longest);
    served_ += summary.served;
    starved_ += summary.starved;
    held_ += summary.held;
    for (std::size_t i = 0; i < members_.size(); ++i) {
      const bool right = (members_[i].contacts > 0) == meetings[i].touches;
      (meetings[i].touches ? touching_ : apart_) += 1.0;
      if (right) (meetings[i].touches ? touching_right_ : apart_right_) += 1.0;
      if (right && meetings[i].touches && members_[i].fresh) touching_fresh_ += 1.0;
    }
  }

  int sharing_;
  dSpaceID space_;
  dWorldID world_;
  oddsFrameBudgetID budget_ = nullptr;
  std::vector<Member> members_;
  double stall_us_ = 0.0;
  std::vector<double> gross_us_;
  double overran_ = 0.0, overran_net_ = 0.0, most_over_us_ = 0.0;
  double served_ = 0.0, starved_ = 0.0, held_ = 0.0;
  double touching_ = 0.0, touching_right_ = 0.0, touching_fresh_ = 0.0, apart_ = 0.0, apart_right_ = 0.0;
  int longest_wait_ = 0;
};

// The whole of `text`, or false.
template <class Number>
bool read_number(std::string_view text, Number& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size();
}

struct Options {
  int pairs = 200;
  int frames = 600;
  double frame_us = 500.0;
  int seeds = 3;
};

// False for an option that there is not, or a value that is none of its own.
bool read_options(std::span<char*> words, Options& options) {
  if (words.size() % 2 != 0) return false;
  for (std::size_t i = 0; i < words.size(); i += 2) {
    const std::string_view name = words[i];
    const std::string_view value = words[i + 1];
    const bool known = (name == "--pairs" && read_number(value, options.pairs)) ||
                       (name == "--frames" && read_number(value, options.frames)) ||
                       (name == "--seeds" && read_number(value, options.seeds)) ||
                       (name == "--frame-us" && read_number(value, options.frame_us));
    if (!known) return false;
  }
  return options.pairs >= 1 && options.frames >= 1 && options.frame_us > 0.0 && options.seeds >= 1;
}

void run_seed(const Options& options, std::uint64_t seed) {
  constexpr int learning = 30;
  const auto shape = odds::test::shape_of(odds::mesh::made::TorusKnot{.along = 512});
  std::vector<Meeting> meetings = make_meetings(options.pairs, seed);
  std::array<std::unique_ptr<Side>, 2> sides;
  for (const int sharing : {ODDS_SHARE_BY_IMPORTANCE, ODDS_SHARE_EQUALLY}) {
    sides[static_cast<std::size_t>(sharing)] =
        std::make_unique<Side>(shape, meetings.size(), sharing, options.frame_us);
  }
  auto truth = Pair::make(shape, shape);
  if (!truth.ok()) return;
  double touching = 0.0;
  for (int frame = -learning; frame < options.frames; ++frame) {
    for (Meeting& meeting : meetings) {
      truth.value().reset();
      odds::query::Request request;
      request.method = odds::query::Method::exact;
      request.max_contacts = 0;
      meeting.touches = truth.value().run(meeting.motion.at(frame), request).verdict == odds::query::Verdict::hit;
      if (frame >= 0 && meeting.touches) touching += 1.0;
    }
    const std::size_t first = frame % 2 == 0 ? 0 : 1;
    for (const std::size_t side : {first, 1 - first}) sides[side]->run(meetings, frame, frame >= 0);
  }
  std::printf("seed %d, %.1f pairs touch\n", static_cast<int>(seed), touching / options.frames);
  for (const auto& side : sides) side->print();
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  if (!read_options(std::span(argv, static_cast<std::size_t>(argc)).subspan(1), options)) {
    std::fprintf(stderr, "usage: odds_bench_frames [--pairs N] [--frames N] [--frame-us T] [--seeds N]\n");
    return 2;
  }
  if (oddsInitODE(0) == 0) return 1;
  odds::realtime::ThreadRequest request;
  request.fifo_priority = 50;  // where the system grants it, stalls are fewer
  (void)odds::realtime::set_up_this_thread(request);
  std::printf("%d pairs of torus knots, %.0f us a frame, %d frames each way, one after the other\n", options.pairs,
              options.frame_us, options.frames);
  std::printf("  %-11s %7s %7s %7s %7s %8s %8s %7s %7s %9s %9s %8s %6s\n", "shares", "p50 us", "p99 us", "over", "net",
              "most us", "served", "starved", "held", "touching", "by proof", "apart", "waited");
  for (int seed = 1; seed <= options.seeds; ++seed) run_seed(options, static_cast<std::uint64_t>(seed));
  oddsCloseODE();
  return 0;
}
