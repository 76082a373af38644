#include "query/memory/late_contacts.hpp"

#include <algorithm>
#include <limits>

#include "odds/math/motion.hpp"
#include "odds/math/tolerances.hpp"
#include "query/memory/pair_memory.hpp"

namespace odds::query {
namespace {

/// For a search and a patch, which keep their arrays on it: they were seen to need 70 kB.
constexpr std::uint32_t stack_bytes = 256 * 1024;
/// Questions that are worked on at a time, of all pairs together: each keeps a scratch for some dozens of runs. Of a
/// pit of fifty bodies with 5 us a collision, 16 let one get an answer in ten, or fewer; more than 64 brought no more.
constexpr std::uint32_t most_at_work = 64;
/// Pairs of triangles that meet: threads cross in more places than a run can make contacts from.
constexpr std::uint32_t least_hit_capacity = 2048;
/// A time that no worker sees the end of.
constexpr double ever_us = 1e9;

PairOptions roomy(PairOptions options) noexcept {
  options.hit_capacity = std::max(options.hit_capacity, least_hit_capacity);
  return options;
}

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
    : worker_(std::make_unique<Pair::Implementation>(Pair::Implementation::Worker{}, a, b, roomy(options))),
      pool_(ScratchPool::of({64, roomy(options).hit_capacity, stack_bytes, most_at_work})) {
  pool_->add_pair();
}

LateContacts::~LateContacts() {
  forget();
  pool_->remove_pair();
}

void LateContacts::forget() noexcept {
  drop();
  manifold_.forget();
  last_asked_ = Lateness::long_ago;
  guessed_ = 0;
  owed_ = 0;
  too_many_ = false;
  clear_runs_ = 0;
  is_wanted_ = false;
  is_aged_ = false;
}

void LateContacts::age(const math::Pose& pose_b_in_a, double size) noexcept {
  guesses_ = false;
  pose_last_ = is_aged_ ? pose_now_ : pose_b_in_a;
  pose_now_ = pose_b_in_a;
  is_aged_ = true;
  has_room_ = is_at_work() || pool_->has_free();
  manifold_.age(pose_b_in_a, size);
  asked_ = std::min(asked_ + 1, Lateness::long_ago);
  last_asked_ = std::min(last_asked_ + 1, Lateness::long_ago);
}

std::span<const TrianglePair> LateContacts::hits() const noexcept {
  return is_at_work() ? worker_->hits.pairs() : std::span<const TrianglePair>();
}

std::span<const Contact> LateContacts::contacts() const noexcept { return worker_->answer.contacts; }

std::span<const TrianglePair> LateContacts::proofs() const noexcept { return worker_->hits.pairs(); }

const CarriedContacts& LateContacts::carried() const noexcept { return worker_->carried; }

void LateContacts::keep_guess(std::span<const Contact> contacts, const math::Pose& pose_b_in_a) noexcept {
  guesses_ = true;
  if (is_at_work() && !turn() && push_one_way(contacts)) owed_ = most_shared;
  guessed_ = std::min(contacts.size(), guess_.size());
  guess_pose_ = pose_b_in_a;
  for (std::size_t i = 0; i < guessed_; ++i) guess_[i] = HeldContact(contacts[i], pose_b_in_a);
}

std::size_t LateContacts::write_guess(const math::Pose& pose_b_in_a, double size,
                                      std::span<Contact> contacts) noexcept {
  if (!shares_guess()) return 0;
  --owed_;
  const double motion = math::motion_bound_about(guess_[0].on_b(), guess_pose_, pose_b_in_a, size);
  if (!(motion <= (turn() ? tolerances::hasty_slack : tolerances::late_slip) * size)) return 0;
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
  if (!scratch_->fiber->is_done()) scratch_->fiber->resume();  // its clock says that its time is up, and asks nobody
  end();
}

bool LateContacts::is_far(const math::Pose& pose_b_in_a, double size) const noexcept {
  return !are_carried(place_on_b_, pose_, pose_b_in_a, size);
}

bool LateContacts::slide(const Contact& contact, double size) const noexcept {
  return math::motion_of(contact.position, pose_last_, pose_now_).norm() > tolerances::late_still * size;
}

bool LateContacts::turn() const noexcept {
  return math::turn_between(pose_last_, pose_now_) > tolerances::late_turning;
}

void LateContacts::ask(const math::Pose& pose_b_in_a, const Request& request, const Pair::Implementation& pair,
                       Press press) noexcept {
  worker_->scratch.use(scratch_);
  pose_ = pose_b_in_a;
  asked_ = 0;
  const double size = smaller_size(pair);
  const std::span<const Contact> contacts = pair.answer.contacts;
  turned_ = turn();
  pressed_ = !turned_ && push_one_way(contacts) && (press == Press::all || slide(contacts.front(), size));
  if (pressed_) pose_.translation += tolerances::late_press * size * contacts.front().normal;
  place_on_b_ = pose_.inverse() * (contacts.empty() ? Vec3(Vec3::Zero()) : Vec3(contacts.front().position));
  request_ = {};
  request_.method = Method::exact;
  request_.budget.microseconds = ever_us;
  request_.budget.clock = {&LateContacts::read_clock, this};
  request_.max_contacts = request.max_contacts;
  worker_->carried.forget();
  copy_what_is_known(pair, *worker_);
  worker_->known_at = pair.known_at;
  worker_->apart_last = pair.apart_last;
  parted_ = false;
  dropped_ = false;
  time_ns_ = 0;
  worked_us_ = 0.0;
  scratch_->fiber->start(&LateContacts::answer, this);
}

bool LateContacts::work(const math::Pose& pose_b_in_a, const Request& request, Pair::Implementation& pair,
                        Spending& spending, Press press) noexcept {
  const double size = smaller_size(pair);
  if (!spending.may_make_contacts()) {
    note_starved();
    return false;
  }
  const bool may_drop = is_at_work() && (scratch_->fiber->is_done() || spending.left_us() > enough_to_drop_us);
  if (may_drop && is_far(pose_b_in_a, size)) drop();
  if (!is_at_work()) {
    if (!(spending.left_us() > enough_to_ask_us)) {
      note_starved();
      return false;
    }
    scratch_ = pool_->take(last_);
    if (scratch_ == nullptr) return false;
    ask(pose_b_in_a, request, pair, press);
  }
  if (!scratch_->fiber->is_done()) {
    spending_ = &spending;
    looks_to_spare_ = 0;
    const double left_us = spending.left_us();
    scratch_->fiber->resume();
    worked_us_ += left_us - spending.left_us();
    spending_ = nullptr;
  }
  if (!scratch_->fiber->is_done()) return false;
  if (!(spending.left_us() > enough_to_take_over_us)) {  // a run that has time for it does
    note_starved();
    return false;
  }
  end();
  note_duration(request);
  const Answer& answer = worker_->answer;
  if (answer.contacts.empty() || !answer.contacts_complete || is_far(pose_b_in_a, size)) return false;
  too_many_ = worker_->hits.size() == worker_->hits.capacity();
  if (too_many_) return false;
  if (!parted_) copy_what_is_known(*worker_, pair);
  manifold_.keep(answer.contacts, pose_, pose_b_in_a, size, answer.contact_pairs, {asked_, last_asked_, turned_});
  last_asked_ = asked_;
  gives_all_ = manifold_.gives_all(pose_b_in_a);
  if (gives_all_ && quick_ >= enough_quick) is_wanted_ = false;
  return true;
}

void LateContacts::note_duration(const Request& request) noexcept {
  constexpr double quick = 0.5;
  quick_ = worked_us_ < quick * request.budget.microseconds ? quick_ + 1 : 0;
}

void LateContacts::answer(void* self) noexcept {
  auto& late = *static_cast<LateContacts*>(self);
  run_pair(*late.worker_, late.pose_, late.request_);
}

std::int64_t LateContacts::read_clock(void* self) noexcept {
  constexpr std::int64_t tick_ns = 100;
  auto& late = *static_cast<LateContacts*>(self);
  late.time_ns_ += tick_ns;
  if (late.looks_to_spare_ > 0 && !late.dropped_) {
    --late.looks_to_spare_;
    return late.time_ns_;
  }
  while (!late.dropped_ && !late.spending_->may_make_contacts()) late.scratch_->fiber->yield();
  if (!late.dropped_) late.looks_to_spare_ = late.spending_->looks_to_spare();
  return late.dropped_ ? std::numeric_limits<std::int64_t>::max() / 2 : late.time_ns_;
}

void LateContacts::end() noexcept {
  pool_->give_back(*scratch_, last_);
  scratch_ = nullptr;
}

}  // namespace odds::query
