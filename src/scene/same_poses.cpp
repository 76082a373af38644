// A leader whose hand is listened to, and followers whose hand is its echo.
#include "odds/scene/same_poses.hpp"

#include <utility>

namespace odds::scene {

/// What the leader's device said last.
struct SamePoses::HandState {
  haptics::DeviceState state;
  bool good = false;
};

/// The leader's device.
class SamePoses::Listener final : public haptics::Device {
 public:
  Listener(std::unique_ptr<haptics::Device> inner, std::shared_ptr<HandState> heard)
      : inner_(std::move(inner)), heard_(std::move(heard)) {}

  [[nodiscard]] std::optional<Error> open() override { return inner_->open(); }
  void close() noexcept override { inner_->close(); }
  [[nodiscard]] const haptics::DeviceSpec& spec() const noexcept override { return inner_->spec(); }
  [[nodiscard]] bool read(std::int64_t now_ns, haptics::DeviceState& state) noexcept override {
    heard_->good = inner_->read(now_ns, state);
    if (heard_->good) heard_->state = state;
    return heard_->good;
  }
  bool write(const haptics::DeviceCommand& command) noexcept override { return inner_->write(command); }
  bool enable_forces(bool on) noexcept override { return inner_->enable_forces(on); }
  [[nodiscard]] std::string_view last_error() const noexcept override { return inner_->last_error(); }

 private:
  std::unique_ptr<haptics::Device> inner_;
  std::shared_ptr<HandState> heard_;
};

/// A follower's device: no force reaches the hand.
class SamePoses::Echo final : public haptics::Device {
 public:
  Echo(haptics::DeviceSpec spec, std::shared_ptr<const HandState> heard)
      : spec_(std::move(spec)), heard_(std::move(heard)) {}

  [[nodiscard]] std::optional<Error> open() override { return std::nullopt; }
  void close() noexcept override {}
  [[nodiscard]] const haptics::DeviceSpec& spec() const noexcept override { return spec_; }
  [[nodiscard]] bool read(std::int64_t, haptics::DeviceState& state) noexcept override {
    if (heard_->good) state = heard_->state;
    return heard_->good;
  }
  bool write(const haptics::DeviceCommand&) noexcept override { return true; }
  bool enable_forces(bool) noexcept override { return true; }
  [[nodiscard]] std::string_view last_error() const noexcept override { return {}; }

 private:
  haptics::DeviceSpec spec_;
  std::shared_ptr<const HandState> heard_;
};

SamePoses::SamePoses() : hand_(std::make_shared<HandState>()) {}

Result<SamePoses::Run> SamePoses::make_run(Scene scene, const query::Budget& limit, SimulationOptions options) {
  scene.query.budget = limit;
  options.simulated_time = true;
  options.contact_impulse = true;
  auto made = Simulation::make(std::move(scene), options);
  if (!made) return made.error();
  Run run;
  run.simulation = std::move(made).value();
  return run;
}

Result<std::unique_ptr<SamePoses>> SamePoses::make(const Scene& scene, const std::vector<query::Budget>& limits,
                                                   const SimulationOptions& options) {
  if (!scene.device) {
    return Error{scene.file, "", "the scene has no device, so there is no tool whose contacts could be compared",
                 "add a [device.NAME] that a body follows"};
  }
  std::unique_ptr<SamePoses> all(new SamePoses);
  SimulationOptions leads = options;
  leads.use_device = [heard = all->hand_](std::unique_ptr<haptics::Device> device) -> std::unique_ptr<haptics::Device> {
    return std::make_unique<Listener>(std::move(device), heard);
  };
  Scene exact = scene;
  exact.query.carry_motion = 0.0;
  exact.frame = query::Budget::unlimited();
  Result<Run> leader = make_run(std::move(exact), query::Budget::unlimited(), leads);
  if (!leader) return leader.error();
  all->leader_ = std::move(leader).value();
  all->leader_.simulation->device()->enable_forces(true);
  SimulationOptions follows = options;
  follows.use_device = [heard =
                            all->hand_](std::unique_ptr<haptics::Device> device) -> std::unique_ptr<haptics::Device> {
    return std::make_unique<Echo>(device->spec(), heard);
  };
  for (const query::Budget& limit : limits) {
    Result<Run> follower = make_run(scene, limit, follows);
    if (!follower) return follower.error();
    all->followers_.push_back(std::move(follower).value());
  }
  return all;
}

void SamePoses::Run::tick(std::int64_t now_ns, haptics::TickRecord& record) noexcept {
  simulation->renderer().tick(now_ns, record);
  const Vec3 impulse_ns_now = simulation->world().contact_impulse(*simulation->tool());
  contact.force_n = (impulse_ns_now - impulse_ns) / simulation->scene().loop.period_s();
  contact.contacts = record.contacts;
  impulse_ns = impulse_ns_now;
}

void SamePoses::tick(std::int64_t now_ns, haptics::TickRecord& record) noexcept {
  const ode::World& world = leader_.simulation->world();
  for (Run& follower : followers_) {
    ode::World& own = follower.simulation->world();
    for (std::uint32_t i = 0; i < world.body_count(); ++i) {
      if (world.is_dynamic({i})) own.set_state({i}, world.state({i}));
    }
  }
  leader_.tick(now_ns, record);
  for (Run& follower : followers_) {
    haptics::TickRecord ignored;
    follower.tick(now_ns, ignored);
  }
}

}  // namespace odds::scene
