// The tick.
#include "odds/haptics/renderer.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace odds::haptics {
namespace {

constexpr std::uint64_t longest_gap_ns = 3'600'000'000'000;

void copy(const Vec3& from, std::array<double, 3>& to) { to = {from.x(), from.y(), from.z()}; }
void copy(const Quat& from, std::array<double, 4>& to) { to = {from.w(), from.x(), from.y(), from.z()}; }

void copy(const ode::StepSummary& step, TickRecord& record) {
  record.queries = step.queries;
  record.query_gross_us = step.query_gross_us;
  record.query_stall_us = step.query_stall_us;
  record.query_net_us = step.query_gross_us - step.query_stall_us;
  record.query_overshoot_us = step.query_overshoot_us;
  record.query_net_overshoot_us = step.query_net_overshoot_us;
  record.node_pairs = step.node_pairs;
  record.triangle_pairs = step.triangle_pairs;
  record.verdict = step.verdict;
  record.basis = step.basis;
  record.probability = step.probability;
  record.collision_us = step.collision_us;
  record.step_us = step.step_us;
  record.contacts = step.contacts;
  record.max_depth_m = step.max_depth_m;
  record.contact_work_j = step.contact_work_j;
}

/// How far a body's mesh reaches from a point of its frame: by its bounding box, which is no nearer.
double reach_m(const ode::World& world, ode::BodyId body, const Vec3& from_m) noexcept {
  const mesh::TriangleMesh& mesh = world.shape(body)->mesh();
  return (mesh.lower() - from_m).cwiseAbs().cwiseMax((mesh.upper() - from_m).cwiseAbs()).norm();
}

}  // namespace

Renderer::Renderer(ode::World& world, const std::optional<Hand>& hand, EffectSet& effects, AllocationCount allocations)
    : world_(&world),
      hand_(hand),
      effects_(&effects),
      allocations_(allocations),
      period_s_(world.options().step_s),
      period_ns_(std::llround(1e9 * period_s_)),
      passed_s_(period_s_),
      moved_s_(period_s_) {
  if (!hand_) return;
  world.add_coupling(hand_->tool);
  safety_.emplace(hand_->limits, hand_->scale.force);
  const DeviceSpec& spec = hand_->device->spec();
  actuates_force_ = spec.actuates_force;
  actuates_torque_ = spec.actuates_torque;
}

bool Renderer::begin() noexcept {
  failed_reads_ = 0;
  rescued_steps_ = 0;
  contacts_left_out_ = 0;
  pairs_left_out_ = 0;
  solver_messages_ = 0;
  frame_overshoot_us_ = 0.0;
  effects_->reset();
  world_->abandon_step();
  parts_done_ = 0;
  if (!hand_) {
    world_->look();
    return true;
  }
  served_ns_ = 0;
  served_ = false;
  age_ns_ = 0;
  silent_s_ = 0.0;
  farthest_m_ = 0.0;
  safety_.emplace(hand_->limits, hand_->scale.force);
  if (!begin_at_device()) return false;
  world_->look();
  return begin_at_device();  // it may have moved while that took its time
}

bool Renderer::begin_at_device() noexcept {
  DeviceState state;
  if (!hand_->device->read(0, state) || !make_usable(state)) return false;
  own_ = state;
  state = hand_->scale.in_scene(state);
  state_ = state;
  before_ = state;
  energy_.reset(own_);
  world_->set_state(hand_->tool,
                    {{state.orientation.toRotationMatrix(), state.position_m}, Vec3::Zero(), Vec3::Zero()});
  return true;
}

bool Renderer::warm_up(int ticks) {
  std::vector<ode::BodyState> before;
  for (std::uint32_t i = 0; i < world_->body_count(); ++i) before.push_back(world_->state({i}));
  for (int i = 0; i < ticks; ++i) {
    TickRecord record;
    tick(0, record);
  }
  for (std::uint32_t i = 0; i < world_->body_count(); ++i) world_->set_state({i}, before[i]);
  return begin();
}

void Renderer::count_time(std::int64_t now_ns) noexcept {
  // Unsigned, for clocks that leap from one end to the other; more than an hour is as long as an hour.
  const std::uint64_t ahead_ns = static_cast<std::uint64_t>(now_ns) - static_cast<std::uint64_t>(served_ns_);
  const std::int64_t gone_ns =
      now_ns > served_ns_ ? static_cast<std::int64_t>(std::min(ahead_ns, longest_gap_ns)) : std::int64_t{0};
  const std::int64_t passed_ns = served_ ? std::max(gone_ns, period_ns_) : gone_ns;
  age_ns_ = std::min(age_ns_ + passed_ns, static_cast<std::int64_t>(longest_gap_ns));
  passed_s_ = passed_ns > period_ns_ ? 1e-9 * static_cast<double>(passed_ns) : period_s_;
  served_ns_ = now_ns;
  served_ = true;
}

bool Renderer::ask_device(std::int64_t now_ns, DeviceState& said, DeviceState& state) noexcept {
  said = own_;
  const bool told = hand_->device->read(now_ns, said);
  said = sensed(hand_->device->spec(), said, own_);
  if (!told || !make_usable(said)) return false;
  state = hand_->scale.in_scene(said);
  return state.position_m.allFinite() && state.velocity_m_per_s.allFinite();  // which a scale may have taken away
}

void Renderer::read_device(std::int64_t now_ns) noexcept {
  DeviceState said;
  DeviceState state;
  silent_s_ += passed_s_;
  if (!ask_device(now_ns, said, state)) {
    ++failed_reads_;  // the last good state stays, and grows stale
    energy_.moved(own_);
    return;
  }
  const bool is_elsewhere =
      said.position_m != own_.position_m || said.orientation.coeffs() != own_.orientation.coeffs();
  if (state.fresh || is_elsewhere) {
    moved_s_ = silent_s_;
    silent_s_ = 0.0;
  }
  own_ = said;
  state_ = state;
  if (state.fresh) age_ns_ = 0;
  farthest_m_ = std::max(farthest_m_, (own_.position_m - hand_->scale.origin_m).norm());
  energy_.moved(own_);
}

void Renderer::write_device(std::int64_t now_ns, const ode::Wrench& on_hand, TickRecord& record) noexcept {
  DeviceCommand command{now_ns, on_hand.force_n, on_hand.torque_nm, 0};
  if (!actuates_force_) command.force_n.setZero();
  if (!actuates_torque_) command.torque_nm.setZero();
  safety_->apply(command, period_s_, 1e-9 * static_cast<double>(age_ns_), passed_s_);
  if (hand_->device->write(command)) {
    energy_.sent(command.force_n, command.torque_nm);
  } else {
    safety_->trip();  // a device that takes no commands must not keep an old one; as long as it does, it works by that
  }
  copy(command.force_n, record.force_n);
  copy(command.torque_nm, record.torque_nm);
  record.safety = command.flags;
  record.observed_energy_j = energy_.energy_j();
}

TickView Renderer::view(std::int64_t now_ns) noexcept {
  TickView view;
  view.world = world_;
  view.now_ns = now_ns;
  view.step_s = world_->options().step_s;
  view.passed_s = passed_s_;
  view.moved_s = moved_s_;
  if (!hand_) return view;
  view.device = &state_;
  view.tool = hand_->tool;
  view.energy = &energy_;
  view.force_scale = hand_->scale.force;
  view.max_force_n = actuates_force_ ? hand_->limits.max_force_n : 0.0;
  view.max_torque_nm = actuates_torque_ ? hand_->limits.max_torque_nm : 0.0;
  return view;
}

std::uint32_t Renderer::steps_needed() const noexcept {
  if (substeps_.most <= 1) return 1;
  double fastest = 0.0;  // of all points of all bodies
  if (hand_) {
    const double turned =
        state_.orientation.angularDistance(before_.orientation) * reach_m(*world_, hand_->tool, Vec3::Zero());
    fastest = ((state_.position_m - before_.position_m).norm() + turned) / period_s_;
  }
  for (std::uint32_t i = 0; i < world_->body_count(); ++i) {
    if (!world_->is_dynamic({i})) continue;
    const ode::BodyState body = world_->state({i});
    const double spin = body.angular_velocity_rad_per_s.norm();
    fastest =
        std::max(fastest, body.velocity_m_per_s.norm() + spin * reach_m(*world_, {i}, world_->mass({i}).center_m));
  }
  const double wanted = std::ceil(fastest * period_s_ / substeps_.way_m);
  return static_cast<std::uint32_t>(std::clamp(wanted, 1.0, static_cast<double>(substeps_.most)));
}

// Effects act once in a step: forces stay on the bodies until the last part solves. But pairs meet in every part.
void Renderer::step_part(TickView& tick) noexcept {
  if (parts_done_ == 0) {
    parts_ = {};
    effects_->before_step(tick);
  } else {
    effects_->go_on(tick);
  }
  last_step_ = world_->step();
  parts_.add(last_step_);
  if (++parts_done_ < world_->options().parts) return;
  parts_done_ = 0;
  tick.step = &parts_;
  effects_->after_step(tick);
}

// The hand's way since the last tick is walked in as many pieces, so that the tool meets what lies on it.
void Renderer::step_world(TickView& tick) noexcept {
  if (world_->options().parts > 1) return step_part(tick);
  const std::uint32_t steps = steps_needed();
  if (steps == 1) {
    effects_->before_step(tick);
    last_step_ = world_->step();
    tick.step = &last_step_;
    effects_->after_step(tick);
    return;
  }
  const double step_s = period_s_ / steps;
  world_->set_step(step_s);
  ode::StepSummary sum;
  DeviceState between = state_;
  for (std::uint32_t i = 1; i <= steps; ++i) {
    const double share = static_cast<double>(i) / steps;
    between.position_m = before_.position_m + share * (state_.position_m - before_.position_m);
    between.orientation = before_.orientation.slerp(share, state_.orientation);
    tick.step_s = step_s;
    tick.step = nullptr;
    if (tick.device != nullptr) tick.device = &between;
    effects_->before_step(tick);
    last_step_ = world_->step();
    tick.step = &last_step_;
    effects_->after_step(tick);
    sum.add(last_step_);
  }
  last_step_ = sum;
  tick.step_s = period_s_;
  if (tick.device != nullptr) tick.device = &state_;
  world_->set_step(period_s_);
}

void Renderer::tick(std::int64_t now_ns, TickRecord& record) noexcept {
  const std::uint64_t allocated = allocations_ != nullptr ? allocations_() : 0;
  before_ = state_;
  if (hand_) {
    count_time(now_ns);
    read_device(now_ns);
  }
  TickView tick = view(now_ns);
  step_world(tick);
  const ode::StepSummary& step = last_step_;
  const ode::Wrench on_hand = effects_->on_hand(tick);
  copy(step, record);
  contacts_left_out_ += step.contacts_left_out;
  pairs_left_out_ += step.pairs_left_out;
  solver_messages_ += step.solver_messages;
  frame_overshoot_us_ = std::max(frame_overshoot_us_, step.frame_overshoot_us);
  if (step.bodies_slowed + step.bodies_recovered > 0) ++rescued_steps_;
  if (hand_) {
    if (step.bodies_recovered > 0) safety_->trip();
    write_device(now_ns, on_hand, record);
    const ode::BodyState tool = world_->state(hand_->tool);
    copy(state_.position_m, record.device_position_m);
    copy(state_.orientation, record.device_orientation_wxyz);
    copy(tool.pose.translation, record.tool_position_m);
    copy(Quat(tool.pose.rotation), record.tool_orientation_wxyz);
  }
  if (allocations_ != nullptr) {
    record.allocations =
        static_cast<std::uint32_t>(std::min<std::uint64_t>(allocations_() - allocated, not_measured - 1));
  }
}

std::int64_t Renderer::trial(std::int64_t now_ns) noexcept {
  if (hand_) {
    DeviceState said;
    DeviceState state;
    if (ask_device(now_ns, said, state)) state_ = state;
    world_->set_coupling(hand_->tool, {});  // no stiffness, no damping: no rows, unless an effect pulls
  }
  const realtime::Clock& clock = world_->options().clock;
  const std::int64_t begin_ns = clock();
  TickView tick = view(now_ns);
  effects_->before_step(tick);
  const ode::StepSummary step = world_->step();
  tick.step = &step;
  effects_->after_step(tick);
  (void)effects_->on_hand(tick);
  return clock() - begin_ns;
}

}  // namespace odds::haptics
