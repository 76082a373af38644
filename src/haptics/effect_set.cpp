// Calls of the stages, and what they took.
#include "odds/haptics/effect_set.hpp"

#include <algorithm>
#include <utility>

namespace odds::haptics {

void EffectSet::add(std::string name, Place place, std::unique_ptr<Effect> effect) {
  const std::uint32_t stages = effect->stages();
  stages_ |= stages;
  EffectCost cost;
  cost.name = std::move(name);
  cost.place = place;
  entries_.push_back({std::move(effect), std::move(cost), stages, true, true, 0});
}

std::uint32_t EffectSet::needs() const noexcept {
  std::uint32_t needs = 0;
  for (const Entry& entry : entries_) needs |= entry.acts ? entry.effect->needs() : 0;
  return needs;
}

double EffectSet::pair_stiffness_n_per_m(ode::BodyId a, ode::BodyId b, double law) const noexcept {
  double stiffness = law;
  for (const Entry& entry : entries_) {
    if (entry.acts) stiffness = entry.effect->pair_stiffness_n_per_m(a, b, stiffness);
  }
  return stiffness;
}

void EffectSet::configure(ode::WorldOptions& options) const {
  const std::uint32_t all = needs();
  const bool one = (all & (need_one_contact | need_patch)) != 0;
  options.contact.enabled = one || (all & need_verdict) != 0;
  options.contact.responds = false;  // until an effect says so
  if ((all & need_patch) == 0) options.query.max_contacts = std::min(options.query.max_contacts, one ? 1 : 0);
  options.contact_velocity = (all & need_velocity) != 0;
  options.angular_friction = (all & need_angular_rows) != 0;
  options.contact_work = (all & need_contact_work) != 0;
  for (const Entry& entry : entries_) {
    if (entry.acts) entry.effect->configure(options);
  }
}

std::optional<Error> EffectSet::check(const ode::WorldOptions& options) const {
  for (const Entry& entry : entries_) {
    auto error = entry.effect->check(options);
    if (!error) continue;
    if (error->place.empty()) error->place = entry.cost.place.text();
    return error;
  }
  return std::nullopt;
}

std::optional<Error> EffectSet::bind(ode::World& world) {
  clock_ = world.options().clock;
  if (auto error = check(world.options())) return error;
  for (Entry& entry : entries_) {
    if (auto error = entry.effect->bind(world)) {
      error->place = entry.cost.place.text();
      return error;
    }
  }
  if ((stages_ & stage_meeting) != 0) world.set_meeting_hook({&EffectSet::meet, this});
  return std::nullopt;
}

void EffectSet::reset() noexcept {
  for (Entry& entry : entries_) {
    entry.effect->reset();
    entry.cost.ticks = 0;
    entry.cost.evaluations = 0;
    entry.cost.total_ns = 0;
    entry.cost.longest_ns = 0;
    entry.tick_ns = 0;
  }
}

void EffectSet::set_on(std::size_t i, bool on) noexcept {
  entries_[i].on = on;
  const auto acts = [&](std::string_view name) {
    return std::any_of(entries_.begin(), entries_.end(), [&](const Entry& e) { return e.acts && e.cost.name == name; });
  };
  for (Entry& entry : entries_) entry.acts = entry.on;
  for (std::size_t round = 0; round < entries_.size(); ++round) {  // what rests on what rests on it, and so on
    for (Entry& entry : entries_) {
      if (!entry.effect->rests_on().empty() && !acts(entry.effect->rests_on())) entry.acts = false;
    }
  }
}

void EffectSet::keep() noexcept {
  for (Entry& entry : entries_) entry.effect->keep();
}

void EffectSet::put_back() noexcept {
  for (Entry& entry : entries_) entry.effect->put_back();
}

// One reading of the clock lies between two effects: it ends the time of one and begins that of the next.
template <class Call>
void EffectSet::run(std::uint32_t stage, Call call) noexcept {
  if ((stages_ & stage) == 0) return;
  std::int64_t begin_ns = clock_();
  for (Entry& entry : entries_) {
    if (!entry.acts || (entry.stages & stage) == 0) continue;
    entry.cost.evaluations += call(*entry.effect);
    const std::int64_t end_ns = clock_();
    entry.tick_ns += end_ns - begin_ns;
    begin_ns = end_ns;
  }
}

void EffectSet::before_step(TickView& tick) noexcept {
  tick_ = &tick;
  run(stage_before_step, [&](Effect& effect) { return effect.before_step(tick); });
}

void EffectSet::meet(void* self, ode::Meeting& meeting) noexcept {
  auto& set = *static_cast<EffectSet*>(self);
  if (set.tick_ == nullptr) return;  // a step outside of any tick
  set.run(stage_meeting, [&](Effect& effect) { return effect.meet(*set.tick_, meeting); });
}

void EffectSet::after_step(const TickView& tick) noexcept {
  run(stage_after_step, [&](Effect& effect) { return effect.after_step(tick); });
}

ode::Wrench EffectSet::on_hand(const TickView& tick) noexcept {
  ode::Wrench wrench;
  if (tick.device != nullptr) run(stage_hand, [&](Effect& effect) { return effect.on_hand(tick, wrench); });
  for (Entry& entry : entries_) {
    if (!entry.acts) continue;
    ++entry.cost.ticks;
    entry.cost.total_ns += entry.tick_ns;
    entry.cost.longest_ns = std::max(entry.cost.longest_ns, std::exchange(entry.tick_ns, 0));
  }
  tick_ = nullptr;
  return wrench;
}

std::vector<ContactEvent> EffectSet::events() const {
  std::vector<ContactEvent> all;
  for (const Entry& entry : entries_) {
    const std::span<const ContactEvent> some = entry.effect->events();
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

std::uint64_t EffectSet::events_lost() const noexcept {
  std::uint64_t lost = 0;
  for (const Entry& entry : entries_) lost += entry.effect->events_lost();
  return lost;
}

}  // namespace odds::haptics
