#include "query/late_contacts.hpp"

#include <cstdio>
#include <algorithm>
#include <limits>

#include "odds/math/tolerances.hpp"
#include "query/pair_memory.hpp"

namespace odds::query {
namespace {

/// For a search and a patch, which keep their arrays on it: they were seen to need 70 kB.
constexpr std::uint32_t stack_bytes = 256 * 1024;
/// Questions that are worked on at a time, of all pairs together.
constexpr std::uint32_t most_at_work = 16;
/// A time that no worker sees the end of.
constexpr double ever_us = 1e9;

/// What the search for a direction and a depth starts from, and what it ends with.
void copy_what_is_known(const Pair::Implementation& from, Pair::Implementation& to) noexcept {
  to.previous_normal = from.previous_normal;
  to.previous_position = from.previous_position;
  to.came = from.came;
  to.apart_at = from.apart_at;
  to.known_depth = from.known_depth;
  to.known_direction = from.known_direction;
}

}  // namespace

LateContacts::LateContacts(const std::shared_ptr<const Shape>& a, const std::shared_ptr<const Shape>& b,
                           const PairOptions& options)
    : worker_(std::make_unique<Pair::Implementation>(Pair::Implementation::Worker{}, a, b, options)),
      pool_(ScratchPool::of({64, options.hit_capacity, stack_bytes, most_at_work})) {
  pool_->add_pair();
}

long dbg[10];
LateContacts::~LateContacts() {
  if (dbg[0] + dbg[1] > 100) std::fprintf(stderr, "DBG rough %ld late %ld work calls %ld finished %ld ok %ld noTime %ld noScratch %ld lateAfterSearch %ld guess %ld\n", dbg[0], dbg[1], dbg[2], dbg[3], dbg[4], dbg[5], dbg[6], dbg[7], dbg[8]), std::fill_n(dbg, 10, 0L);
  forget();
  pool_->remove_pair();
}

void LateContacts::forget() noexcept {
  drop();
  manifold_.forget();
  guessed_ = 0;
}

void LateContacts::age(const math::Pose& pose_b_in_a, double size) noexcept {
  manifold_.age(pose_b_in_a, size, tolerances::unmeasured_depth * size);
}

std::span<const TrianglePair> LateContacts::hits() const noexcept {
  return is_at_work() ? worker_->hits.pairs() : std::span<const TrianglePair>();
}

void LateContacts::keep_guess(std::span<const Contact> contacts, const math::Pose& pose_b_in_a) noexcept {
  guessed_ = std::min(contacts.size(), guess_.size());
  for (std::size_t i = 0; i < guessed_; ++i) guess_[i] = HeldContact(contacts[i], pose_b_in_a);
  guess_runs_ = 0;
}

std::size_t LateContacts::write_guess(const math::Pose& pose_b_in_a, std::span<Contact> contacts) noexcept {
  if (++guess_runs_ >= runs_of_a_guess) return 0;
  std::size_t written = 0;
  for (std::size_t i = 0; i < guessed_ && written < contacts.size(); ++i) {
    Contact now = guess_[i].at(pose_b_in_a);
    if (!(now.depth > 0.0)) continue;
    now.depth = std::min(now.depth, guess_[i].depth());
    contacts[written++] = now;
  }
  return written;
}

void LateContacts::drop() noexcept {
  if (!is_at_work()) return;
  dropped_ = true;
  scratch_->fiber->resume();  // its clock says that its time is up, and asks nobody
  end();
}

bool LateContacts::work(const math::Pose& pose_b_in_a, const Request& request, Pair::Implementation& pair,
                        Spending& spending) noexcept {
  if (!spending.may_make_contacts()) { ++dbg[5]; return false; }
  ++dbg[2];
  if (!is_at_work()) {
    scratch_ = pool_->take(last_);
    if (scratch_ == nullptr) { ++dbg[6]; return false; }
    worker_->scratch.use(scratch_);
    pose_ = pose_b_in_a;
    request_ = {};
    request_.method = Method::exact;
    request_.budget.microseconds = ever_us;
    request_.budget.clock = {&LateContacts::read_clock, this};
    request_.max_contacts = request.max_contacts;
    worker_->carried.forget();
    copy_what_is_known(pair, *worker_);
    worker_->known_at = pair.known_at;
    worker_->apart_last = pair.apart_last;
    dropped_ = false;
    time_ns_ = 0;
    scratch_->fiber->start(&LateContacts::answer, this);
  }
  spending_ = &spending;
  static double wt; static long wn, wp; const double w0 = spending.left_us(); const auto t0 = time_ns_;
  scratch_->fiber->resume();
  spending_ = nullptr;
  wt += w0 - spending.left_us(); wp += (time_ns_ - t0) / 100; ++wn;
  if (scratch_->fiber->is_done()) { std::fprintf(stderr, "JOB %.1f us %ld polls %ld runs hits %zu\n", wt, wp, wn, worker_->hits.size()); wt = 0; wn = wp = 0; }
  if (!scratch_->fiber->is_done()) return false;
  end();
  ++dbg[3];
  const Answer& answer = worker_->answer;
  if (answer.contacts.empty() || !answer.contacts_complete) return false;
  ++dbg[4];
  copy_what_is_known(*worker_, pair);
  const double size = std::min(pair.a->mesh().size(), pair.b->mesh().size());
  manifold_.keep(answer.contacts, pose_, size, tolerances::unmeasured_depth * size, answer.contact_pairs);
  if (manifold_.gives_all(pose_)) pair.carried = worker_->carried;  // else what is carried would push at once
  return true;
}

void LateContacts::answer(void* self) noexcept {
  auto& late = *static_cast<LateContacts*>(self);
  run_pair(*late.worker_, late.pose_, late.request_);
}

std::int64_t LateContacts::read_clock(void* self) noexcept {
  constexpr std::int64_t tick_ns = 100;
  auto& late = *static_cast<LateContacts*>(self);
  late.time_ns_ += tick_ns;
  while (!late.dropped_ && !late.spending_->may_make_contacts()) late.scratch_->fiber->yield();
  return late.dropped_ ? std::numeric_limits<std::int64_t>::max() / 2 : late.time_ns_;
}

void LateContacts::end() noexcept {
  pool_->give_back(*scratch_, last_);
  scratch_ = nullptr;
}

}  // namespace odds::query
