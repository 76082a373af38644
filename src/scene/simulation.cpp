// Building a scene and running its loop.
#include "odds/scene/simulation.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <thread>

#include "odds/haptics/device_registry.hpp"
#include "odds/realtime/recorder.hpp"
#include "odds/realtime/usage.hpp"
#include "scene/mesh_loading.hpp"

namespace odds::scene {
namespace {

using haptics::TickRecord;

constexpr double pose_rate_hz = 100.0;  // enough for the eye
constexpr std::size_t stack_bytes = 256 * 1024;
constexpr std::uint64_t timer_slack_ns = 1;
constexpr int warm_up_ticks = 32;
// A day at 1 kHz: beyond it the records of one run would not fit into memory.
constexpr double most_ticks = 86.4e6;

void note_usage(const realtime::ThreadUsage& used, TickRecord& record) {
  record.minor_faults = static_cast<std::uint32_t>(used.minor_faults);
  record.major_faults = static_cast<std::uint32_t>(used.major_faults);
  record.voluntary_switches = static_cast<std::uint32_t>(used.voluntary_switches);
  record.involuntary_switches = static_cast<std::uint32_t>(used.involuntary_switches);
  record.processor_us = 1e-3 * static_cast<double>(used.processor_ns);
}

/// Whether the system promises so much memory, all at once. Nothing of it is touched.
bool memory_can_be_had(double bytes) noexcept {
  void* volatile trial = std::malloc(static_cast<std::size_t>(bytes));  // volatile: compilers may leave a pair out
  const bool got = trial != nullptr;
  std::free(trial);
  return got;
}

/// An error if a run of so many ticks cannot be, or cannot be recorded.
std::optional<Error> refuse_length(const Scene& scene, double seconds, double ticks) {
  if (!(ticks >= 1.0) || ticks > most_ticks) {
    return Error{scene.file, "", fmt::format("a run of {} s is not possible", seconds),
                 "give more than 0 s and at most 86.4 million ticks"};
  }
  const double bytes =
      ticks * static_cast<double>(sizeof(TickRecord) + (scene.device ? sizeof(haptics::DeviceState) : 0));
  if (memory_can_be_had(bytes)) return std::nullopt;
  return Error{
      scene.file, "",
      fmt::format("the records of a run of {} s take {:.1f} GB, more memory than there is", seconds, 1e-9 * bytes),
      "run for fewer seconds, or at a lower rate"};
}

}  // namespace

query::Budget in_work_units(const query::Budget& limit) noexcept {
  query::Budget budget = query::Budget::work(limit.work_units);
  const double units = std::max(1.0, std::round(limit.microseconds * work_units_per_us));
  // More cannot be counted, and is no limit.
  if (units < 0x1p64) budget.work_units = std::min(budget.work_units, static_cast<std::uint64_t>(units));
  return budget;
}

Simulation::Simulation(Scene scene, const SimulationOptions& options) : scene_(std::move(scene)), options_(options) {}

Simulation::~Simulation() {
  if (device_) {
    device_->enable_forces(false);
    device_->close();
  }
}

void Simulation::report(std::string_view what, double share) const {
  if (options_.progress) options_.progress(what, share);
}

const query::Budget& Simulation::budget() const noexcept { return world_->options().query.budget; }

Result<std::unique_ptr<Simulation>> Simulation::make(Scene scene, const SimulationOptions& options) {
  std::unique_ptr<Simulation> simulation(new Simulation(std::move(scene), options));
  if (auto error = simulation->load()) return *error;
  return simulation;
}

std::optional<Error> Simulation::load() {
  const double seconds = options_.seconds.value_or(scene_.loop.seconds);
  const double wanted = std::ceil(seconds / scene_.loop.period_s() - 1e-9);
  if (auto error = refuse_length(scene_, seconds, wanted)) return error;
  ticks_ = static_cast<std::uint64_t>(wanted);
  if (options_.simulated_time) {
    scene_.query.budget = in_work_units(scene_.query.budget);
    scene_.frame = in_work_units(scene_.frame);
  }
  for (const Mesh& mesh : scene_.meshes) {
    const std::string what = fmt::format("mesh '{}'", mesh.name);
    report(what, 0.0);
    auto shape = load_shape(scene_, mesh, [&](double share) { report(what, share); });
    if (!shape) return shape.error();
    meshes_.push_back({mesh.name, mesh.file, shape.value()->mesh().triangles().size()});
    shapes_.push_back(std::move(shape).value());
    report(what, 1.0);
  }
  effects_ = scene_.make_effects();
  ode::WorldOptions world_options = scene_.world_options(*effects_);
  world_options.clock = options_.clock;
  world_options.contact_work = world_options.contact_work || options_.contact_impulse;
  Result<ode::World> world = ode::World::make(world_options);
  if (!world) return world.error();
  world_.emplace(std::move(world).value());
  if (auto error = add_bodies()) return error;
  if (auto error = add_hand()) return error;
  report("memory of the loop", 0.0);
  if (auto error = world_->prepare()) {
    error->file = scene_.file;
    return error;
  }
  if (auto error = effects_->bind(*world_)) {
    error->file = scene_.file;
    return error;
  }
  warn_of_effects();
  renderer_->set_substeps({scene_.substep_way_m, scene_.most_substeps});
  if (!renderer_->begin()) {
    return Error{scene_.file, scene_.device->place.text(),
                 fmt::format("the device '{}' gives no position: {}", scene_.device->name, device_->last_error()),
                 "check the device"};
  }
  // Where the hand was is told by the device only.
  for (Body& body : scene_.bodies) {
    if (body.follows_device) body.pose = world_->state(*tool_).pose;
  }
  report("memory of the loop", 1.0);
  return std::nullopt;
}

std::optional<Error> Simulation::add_bodies() {
  for (const Body& body : scene_.bodies) {
    const auto& shape = shapes_[body.mesh];
    Result<ode::BodyId> id = body.dynamic ? world_->add_dynamic(shape, body.pose, body.mass, body.name)
                                          : world_->add_fixed(shape, body.pose, body.name);
    if (!id) {
      return Error{scene_.file, body.place.text(), fmt::format("body '{}': {}", body.name, id.error().what),
                   id.error().remedy};
    }
    bodies_.push_back(id.value());
    if (body.dynamic && !world_->mass(id.value()).from_closed_mesh) {
      warnings_.push_back(
          fmt::format("the mesh of '{}' encloses no volume: its inertia is that of its bounding box", body.name));
    }
  }
  return std::nullopt;
}

std::optional<Error> Simulation::add_hand() {
  std::optional<haptics::Hand> hand;
  if (scene_.device) {
    const haptics::DeviceRequest request{&scene_.device->settings, scene_.base_directory};
    auto device = haptics::make_device(scene_.device->type, request);
    if (!device) return device.error();
    std::unique_ptr<haptics::Device> used = std::move(device).value();
    if (options_.use_device) used = options_.use_device(std::move(used));
    device_ = std::make_unique<haptics::RecordingDevice>(std::move(used), ticks_);
    if (auto error = device_->open()) return error;
    const haptics::DeviceSpec spec = device_->spec();
    if (!spec.actuates_force) {
      warnings_.push_back(fmt::format("the device '{}' exerts no force: the hand feels nothing", spec.name));
    }
    const auto follows =
        std::find_if(scene_.bodies.begin(), scene_.bodies.end(), [](const Body& b) { return b.follows_device; });
    tool_ = bodies_[static_cast<std::size_t>(follows - scene_.bodies.begin())];
    hand = haptics::Hand{device_.get(), *tool_, scene_.device->limits, scene_.device->scale};
  }
  renderer_ = std::make_unique<haptics::Renderer>(*world_, hand, *effects_, options_.allocations);
  return std::nullopt;
}

// After bind(): some depend on the bodies.
void Simulation::warn_of_effects() {
  for (std::size_t i = 0; i < effects_->size(); ++i) {
    for (std::string& warning : effects_->effect(i).warnings(*effects_)) warnings_.push_back(std::move(warning));
  }
  if (!device_) return;
  haptics::DeviceSpec spec = device_->spec();
  if (scene_.device->physical_damping_ns_per_m)
    spec.physical_damping_ns_per_m = *scene_.device->physical_damping_ns_per_m;
  for (std::size_t i = 0; i < effects_->size(); ++i) {
    for (std::string& warning : effects_->effect(i).device_warnings(spec, scene_.device->scale, scene_.loop.period_s()))
      warnings_.push_back(std::move(warning));
  }
}

std::string Simulation::workspace_warning() const {
  if (!device_) return {};
  const double radius_m = device_->spec().workspace_radius_m;
  const double farthest_m = renderer_->farthest_m();
  if (!(radius_m > 0.0) || farthest_m <= radius_m * (1.0 + 1e-9)) return {};
  return fmt::format(
      "the device '{}' went {:.4g} m from the centre of its workspace, which ends at {:.4g} m: a real one of its kind "
      "could not follow; give a larger workspace_scale, or another workspace_origin_m",
      device_->spec().name, farthest_m, radius_m);
}

std::string Simulation::solver_warning() const {
  const std::uint64_t count = renderer_->solver_messages();
  if (count == 0) return {};
  return fmt::format(
      "ODE's solver complained {} times (its 'LCP internal error' and the like): it gave up on a part of the contacts, "
      "whose forces may be wrong there; put no light body between heavy ones, give contacts less stiffness, or take "
      "solver = \"iterative\" in [physics]",
      count);
}

std::vector<std::string> Simulation::run_warnings() const {
  std::vector<std::string> all;
  for (std::string warning : {workspace_warning(), solver_warning(), device_complaint_}) {
    if (!warning.empty()) all.push_back(std::move(warning));
  }
  return all;
}

void Simulation::note_device(bool well, std::string_view what) {
  if (well || !device_complaint_.empty()) return;
  const std::string_view why = device_->last_error();
  device_complaint_ = fmt::format("the device '{}' {}{}{}: see that it is connected and switched on",
                                  device_->spec().name, what, why.empty() ? "" : ": ", why);
}

PoseTrack Simulation::make_pose_track() const {
  const double stride = std::round(1.0 / (pose_rate_hz * scene_.loop.period_s()));
  std::vector<ode::BodyId> moving;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (!scene_.bodies[i].dynamic) continue;
    moving.push_back(bodies_[i]);
    names.push_back(scene_.bodies[i].name);
  }
  return {std::move(moving), std::move(names), static_cast<std::uint64_t>(std::max(1.0, stride)), ticks_};
}

void Simulation::run_loop(const std::stop_token& stop, RunOutcome& outcome) {
  std::optional<realtime::Recorder<TickRecord>> recorder;
  realtime::SimulatedTime simulated;
  realtime::TimeSource time = simulated.source();
  if (!options_.simulated_time) {
    const auto ring = static_cast<std::size_t>(std::max(256.0, 1.0 / scene_.loop.period_s()));
    recorder.emplace(ring, [&](std::span<const TickRecord> batch) {
      outcome.ticks.insert(outcome.ticks.end(), batch.begin(), batch.end());
    });
    realtime::ThreadRequest request = scene_.loop.thread;
    request.timer_slack_ns = timer_slack_ns;
    request.prefault_stack_bytes = stack_bytes;
    outcome.thread = realtime::set_up_this_thread(request);
    time = realtime::real_time();
  }
  const bool found = renderer_->warm_up(warm_up_ticks);
  if (device_) {
    note_device(found, "gave no pose to begin with");
    note_device(device_->enable_forces(true), "did not switch its forces on");
  }
  const realtime::LoopPlan plan{scene_.loop.period_ns, ticks_};
  auto next = options_.served.begin();
  const auto pass_what_is_not_served = [&](std::uint64_t tick) noexcept {
    while (next != options_.served.end() && *next <= tick) ++next;
    const std::uint64_t until = next != options_.served.end() ? std::min(*next, ticks_) : ticks_;
    if (until > tick + 1) simulated.spend(static_cast<std::int64_t>(until - tick) * plan.period_ns);
  };
  outcome.loop = realtime::run_periodic(plan, time, stop, [&](const realtime::Tick& tick) noexcept {
    TickRecord record;
    const realtime::ThreadUsage before = realtime::thread_usage();
    const auto now_ns = static_cast<std::int64_t>(tick.index) * plan.period_ns;
    renderer_->tick(now_ns, record);
    record.done_ns = time.clock();
    note_usage(realtime::thread_usage() - before, record);
    record.tick = tick.index;
    record.planned_ns = tick.planned_ns;
    record.woke_ns = tick.woke_ns;
    record.skipped_before = tick.skipped_before;
    outcome.poses.note(tick.index, now_ns, *world_);
    if (recorder) {
      recorder->push(record);
    } else {
      outcome.ticks.push_back(record);  // within what was reserved
      if (!options_.served.empty()) pass_what_is_not_served(tick.index);
    }
  });
  if (recorder) {
    recorder->finish();
    outcome.records_lost = recorder->dropped();
  }
}

RunOutcome Simulation::run(const std::stop_token& stop) {
  RunOutcome outcome;
  outcome.ticks.resize(ticks_);  // touches the pages
  outcome.ticks.clear();
  outcome.poses = make_pose_track();
  // A thread of its own: real-time priority and processor must not stay with the caller.
  std::thread([&] { run_loop(stop, outcome); }).join();
  if (device_) {
    device_->enable_forces(false);
    outcome.device_track = device_->track();
  }
  if (const haptics::SafetyCounts* counts = renderer_->safety_counts()) outcome.safety = *counts;
  outcome.failed_reads = renderer_->failed_reads();
  outcome.rescued_steps = renderer_->rescued_steps();
  outcome.contacts_left_out = renderer_->contacts_left_out();
  outcome.pairs_left_out = renderer_->pairs_left_out();
  outcome.solver_messages = renderer_->solver_messages();
  outcome.frame_overshoot_us = renderer_->frame_overshoot_us();
  for (std::size_t i = 0; i < effects_->size(); ++i) outcome.effects.push_back(effects_->cost(i));
  outcome.events = effects_->events();
  outcome.events_lost = effects_->events_lost();
  if (device_) outcome.least_energy_j = renderer_->energy().least_j();
  return outcome;
}

}  // namespace odds::scene
